#include "benchmarks/report_page.h"

#include <fmt/format.h>

#include "renderer/machine.h"

namespace raytree::benchmarks {
namespace {

constexpr std::string_view kCommonStyle = R"(
:root { color-scheme: light dark; --paper: #fbfaf7; --ink: #1d2126; --quiet: #667079; --line: #d9d6cf; --card: #ffffff;
  --accent: #1f5fa8; --good: #1c7c4a; --warn: #a86a00; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171a; --ink: #e6e4df; --quiet: #98a1a9; --line: #33393f;
  --card: #1b1f23; --accent: #7db4f0; --good: #63c793; --warn: #e0a94a; --bad: #f08a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1240px; padding: 28px 24px 48px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
h1 { font-size: 26px; line-height: 1.25; margin: 0; }
h2 { font-size: 18px; margin: 0 0 10px; }
h3 { font-size: 15px; margin: 0 0 6px; }
.quiet, figcaption, footer { color: var(--quiet); }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 18px 20px; margin: 20px 0; }
table { border-collapse: collapse; width: 100%; }
th { text-align: left; font-weight: 600; border-bottom: 1px solid var(--line); padding: 5px 10px 5px 0; vertical-align: bottom; }
td { border-bottom: 1px solid var(--line); padding: 5px 10px 5px 0; vertical-align: top; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
code, pre { font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; margin: 0; }
figure { margin: 0; }
figcaption { font-size: 13px; }
img { max-width: 100%; image-rendering: auto; }
.holds { color: var(--good); } .known { color: var(--warn); } .fails { color: var(--bad); font-weight: 600; }
footer { font-size: 13px; margin-top: 32px; }
)";

}  // namespace

std::string escaped_html(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

std::string data_address(std::string_view media_type, const std::vector<std::byte>& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string address = fmt::format("data:{};base64,", media_type);
  address.reserve(address.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? std::to_integer<unsigned>(bytes[k]) : 0u; };
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (std::size_t digit = 0; digit < 4; ++digit)
      address += digit <= bytes.size() - i ? kDigits[group >> (18 - 6 * digit) & 63] : '=';
  }
  return address;
}

std::string script_json(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

std::string report_page(const ReportPage& page) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>{}{}</style>\n</head>\n<body>\n<header><h1>{}</h1>\n<p class=\"quiet\">{}</p></header>\n{}\n"
      "<footer>Raytree on {}.</footer>\n<script>\n{}\n</script>\n</body>\n</html>\n",
      escaped_html(page.title), kCommonStyle, page.style, escaped_html(page.title), escaped_html(page.subtitle),
      page.body, escaped_html(machine_line()), page.script);
}

std::string machine_line() {
  const Machine here = machine();
  return fmt::format("{}, {} threads, {}, {}, {}, {}", here.processor, here.hardware_threads, here.compiler,
                     here.build_type, here.instruction_set, here.tracer);
}

}  // namespace raytree::benchmarks
