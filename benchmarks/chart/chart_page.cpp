#include "benchmarks/chart/chart_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <tuple>

#include "benchmarks/chart/chart_page_script.h"
#include "benchmarks/chart/chart_svg.h"
#include "benchmarks/report_page.h"

namespace raytree::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kChartPageStyle = R"(
#findings { margin: 0; padding-left: 20px; } #findings li { margin: 5px 0; } #findings [data-point] { cursor: pointer; }
#findings [data-point]:hover { color: var(--accent); }
.bar { display: flex; flex-wrap: wrap; gap: 8px; align-items: center; margin-bottom: 12px; }
button, select { font: inherit; font-size: 13px; color: var(--ink); background: var(--paper); border: 1px solid var(--line);
  border-radius: 6px; padding: 4px 10px; cursor: pointer; } select { max-width: 380px; }
button[aria-pressed="true"] { border-color: var(--accent); color: var(--accent); }
svg.chart { display: block; width: 100%; min-width: 720px; height: auto; }
.looked-at { display: grid; grid-template-columns: minmax(0, 3fr) minmax(0, 2fr); gap: 28px; margin-top: 16px; }
.looked-at pre { background: var(--paper); border: 1px solid var(--line); border-radius: 6px; padding: 10px 12px; margin-bottom: 8px; }
.looked-at td { padding: 2px 0; } .looked-at td.number { padding-left: 16px; } #picture { display: block; margin-top: 12px; width: 100%; max-width: 560px; border-radius: 4px; image-rendering: pixelated; }
.panes { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 12px; }
.panes canvas { width: 100%; display: block; border-radius: 4px; cursor: grab; touch-action: none; background: #000; }
.wide { overflow-x: auto; } #table { font-size: 13px; } #table th { cursor: pointer; user-select: none; }
#table th[aria-sort="ascending"]::after { content: " \2191"; } #table th[aria-sort="descending"]::after { content: " \2193"; }
#table tbody tr { cursor: pointer; } #table tbody tr:hover, #table tr.chosen { background: var(--paper); }
#table tr.best td:first-child { color: var(--accent); font-weight: 600; } #table td.value { max-width: 300px; overflow-wrap: anywhere; }
#table .number { white-space: nowrap; padding-left: 6px; }
@media (max-width: 760px) { .looked-at, .panes { grid-template-columns: 1fr; } }
)";

/// "3.42 M".
std::string short_count(std::uint64_t count) {
  const auto value = static_cast<double>(count);
  if (count >= 1'000'000) return fmt::format("{:.3g} M", value / 1e6);
  return count >= 10'000 ? fmt::format("{:.3g} k", value / 1e3) : fmt::format("{}", count);
}

std::string shown_name(const ChartPoint& point) {
  if (point.setting.part == SweepPart::defaults) return "the scene's own settings";
  if (point.setting.part == SweepPart::crossed || point.setting.part == SweepPart::added) return point.setting.value;
  return point.setting.knob + " " + point.setting.value;
}

std::string with_spread(const Spread& spread) {
  return spread.count < 2 ? short_seconds(spread.median) + ", once"
                          : fmt::format("{} ({} to {}, {} times)", short_seconds(spread.median),
                                        short_seconds(spread.low), short_seconds(spread.high), spread.count);
}

std::string rays_text(const ChartPoint& point) {
  constexpr const char* kKinds[] = {"primary", "shadow", "reflected", "refracted"};
  std::string text;
  for (std::size_t i = 0; i < point.rays.size(); ++i)
    if (point.rays[i] > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", short_count(point.rays[i]), kKinds[i]);
  return text;
}

std::string memory_text(const ChartPoint& point) {
  const auto megabytes = [](auto bytes) { return 1e-6 * static_cast<double>(bytes); };
  return fmt::format("{:.3g} MB ({}tracer {:.3g}, shapes {:.3g}, film {:.3g})", megabytes(point.memory_bytes()),
                     point.peak_bytes.empty() ? "by sizes: " : "of it ", megabytes(point.tracer_bytes),
                     megabytes(point.array_bytes), megabytes(point.film_bytes));
}

std::string error_text(const MetricInfo& metric, double value) {
  return metric.value == &ErrorMetrics::over_step ? fmt::format("{:.2g} %", 100 * value) : short_number(value);
}

/// What the script reads.
std::string chart_script_data(const ChartData& data) {
  Json json;
  json["width"] = data.width;
  json["height"] = data.height;
  json["metrics"] = Json::array();
  for (const MetricInfo& metric : kMetrics) json["metrics"].push_back({{"key", metric.key}, {"label", metric.label}});
  json["start"] = 0;
  json["reference"] = data_address("image/png", data.reference_picture);
  json["points"] = Json::array();
  for (const ChartPoint& point : data.points) {
    Json entry = {{"name", shown_name(point)},         {"command", point.command}, {"cpu", with_spread(point.cpu())},
                  {"wall", with_spread(point.wall())}, {"rays", rays_text(point)}, {"memory", memory_text(point)}};
    entry["errors"] = Json::array();
    for (const MetricInfo& metric : kMetrics) entry["errors"].push_back(error_text(metric, point.errors.*metric.value));
    entry["picture"] = data_address("image/png", point.picture);
    json["points"].push_back(std::move(entry));
  }
  return script_json(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string findings_section(const ChartData& data) {
  std::string html = "<section class=\"card\"><h2>Findings</h2>\n<ul id=\"findings\">\n";
  for (const Finding& finding : findings_of(data))
    html += finding.point ? fmt::format("<li data-point=\"{}\">{}</li>\n", *finding.point, escaped_html(finding.text))
                          : fmt::format("<li>{}</li>\n", escaped_html(finding.text));
  html += "</ul></section>\n";
  return html;
}

std::string charts_section(const ChartData& data) {
  std::string html = "<section class=\"card\"><h2>Speed against accuracy</h2>\n<div class=\"bar\" id=\"metrics\">\n";
  for (const MetricInfo& metric : kMetrics)
    if (metric.charted)
      html += fmt::format("<button data-key=\"{}\" aria-pressed=\"false\">{}</button>\n", metric.key,
                          escaped_html(metric.label));
  html += "</div>\n";
  html += "<div class=\"wide\">\n";
  for (const MetricInfo& metric : kMetrics)
    if (metric.charted) html += chart_svg(data, metric);
  html += "</div>\n";
  html +=
      "<p class=\"quiet\">Each dot is a setting: left is quicker, lower is more accurate. On the blue line lie those "
      "that no other "
      "beats in both; the rest is grey. The ringed dot is the scene as it is; dotted lines follow one knob from cheap "
      "to dear. Bars: quartiles of the time, and what the reference's own error leaves open. Click a dot for its "
      "command "
      "and picture.</p>\n"
      "<div class=\"looked-at\"><div><h3 id=\"point-name\"></h3><pre id=\"command\"></pre>\n"
      "<button id=\"copy\">copy</button>\n<img id=\"picture\" alt=\"what it renders\"></div>\n<table><tbody "
      "id=\"figures\"></tbody></table></div></section>\n";
  return html;
}

constexpr const char* kPicturesSection =
    "<section class=\"card\"><h2>Pictures</h2>\n<div class=\"bar\"><label>A <select "
    "id=\"picture-a\"></select></label>\n"
    "<button id=\"swap\" title=\"swap A and B\">\u21c4</button>\n<label>B <select id=\"picture-b\"></select></label>\n"
    "<label>error times <input id=\"gain\" type=\"range\" min=\"0\" max=\"7\" step=\"1\" value=\"4\"></label></div>\n"
    "<div class=\"panes\"><figure><canvas id=\"canvas-a\"></canvas><figcaption>A: <span "
    "id=\"name-a\"></span></figcaption></figure>\n"
    "<figure><canvas id=\"canvas-b\"></canvas><figcaption>B: <span id=\"name-b\"></span></figcaption></figure>\n"
    "<figure><canvas id=\"canvas-error\"></canvas><figcaption>A - B: <span "
    "id=\"map-words\"></span></figcaption></figure></div>\n"
    "<p class=\"quiet\">The wheel zooms, dragging moves, a double click shows all; the three move "
    "together.</p></section>\n";

std::string number_cell(double value, const std::string& text) {
  return fmt::format("<td class=\"number\" data-value=\"{}\">{}</td>",
                     std::isfinite(value) ? fmt::format("{}", value) : "", escaped_html(text));
}

/// The scene's own settings, the user's, one knob after the other, several at once; each from quick to slow.
std::vector<std::size_t> table_order(const ChartData& data) {
  const auto rank = [&](std::size_t i) {
    const ChartSetting& setting = data.points[i].setting;
    const int part = setting.part == SweepPart::defaults  ? 0
                     : setting.part == SweepPart::added   ? 1
                     : setting.part == SweepPart::crossed ? 3
                                                          : 2;
    return std::tuple(part, setting.knob, data.points[i].cpu().median);
  };
  std::vector<std::size_t> order(data.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

std::string settings_table(const ChartData& data) {
  const std::vector<std::size_t> front = chart_front(data, kMetrics.front());
  std::string html =
      "<section class=\"card\"><h2>All settings</h2><div class=\"wide\">\n<table "
      "id=\"table\"><thead><tr><th>knob</th><th>value</th>"
      "<th class=\"number\">processor</th><th class=\"number\">wall</th><th class=\"number\">rays</th><th "
      "class=\"number\">peak MB</th>"
      "<th class=\"number\">RMSE</th><th class=\"number\">FLIP</th><th class=\"number\">&gt; 1/255</th><th "
      "class=\"number\">p99.9</th>"
      "<th class=\"number\">relMSE</th><th class=\"number\">max</th><th class=\"number\">distance</th><th "
      "class=\"number\">normal</th>"
      "</tr></thead><tbody>\n";
  for (const std::size_t i : table_order(data)) {
    const ChartPoint& point = data.points[i];
    const bool best = std::find(front.begin(), front.end(), i) != front.end();
    const std::uint64_t rays = std::accumulate(point.rays.begin(), point.rays.end(), std::uint64_t{0});
    const double cpu = point.cpu().median, wall = point.wall().median;
    const double megabytes = 1e-6 * point.memory_bytes();
    html +=
        fmt::format("<tr data-point=\"{}\"{}><td>{}</td><td class=\"value\">{}</td>", i, best ? " class=\"best\"" : "",
                    escaped_html(point.setting.knob), escaped_html(point.setting.value));
    html += number_cell(cpu, short_seconds(cpu)) + number_cell(wall, short_seconds(wall)) +
            number_cell(static_cast<double>(rays), short_count(rays)) +
            number_cell(megabytes, fmt::format("{:.3g}", megabytes));
    for (const MetricInfo& metric : kMetrics) {
      const double value = point.errors.*metric.value;
      html += number_cell(value, error_text(metric, value));
    }
    html += "</tr>\n";
  }
  return html +
         "</tbody></table></div>\n<p class=\"quiet\">Blue: on the front of RMSE. Distance: mean relative error of the "
         "hit distance; normal: mean error in degrees; both over the pixels that one surface fills. Peak MB: "
         "the most memory at any time of preparing and tracing, above the program itself.</p></section>\n";
}

std::string method_section(const ChartData& data) {
  std::string html = fmt::format(
      "<section class=\"card\"><h2>How it was measured</h2>\n<p>Reference: {}; traced in {}. Its halves differ by an "
      "RMSE of {} and a FLIP of {}: "
      "what is smaller cannot be told from it.</p>\n<pre>{}</pre>\n"
      "<p class=\"quiet\">Times are those of preparing and tracing, the median of interleaved repetitions. Errors are "
      "the same on every run.</p>\n",
      escaped_html(data.plan.words), short_seconds(data.reference_seconds), short_number(data.floor.rmse),
      short_number(data.floor.flip), escaped_html(data.reference_command));
  if (!data.left_out.empty()) {
    html += "<h3>Not measured</h3>\n<ul>\n";
    for (const std::string& text : data.left_out) html += fmt::format("<li>{}</li>\n", escaped_html(text));
    html += "</ul>\n";
  }
  return html + "</section>\n";
}

}  // namespace

std::string chart_page(const ChartData& data) {
  ReportPage page;
  page.title = "Speed against accuracy: " + data.scene;
  page.subtitle = fmt::format("{}{}{} x {} pixels, {} settings, {} thread{}{}", data.title,
                              data.title.empty() ? "" : ". ", data.width, data.height, data.points.size(), data.threads,
                              data.threads == 1 ? "" : "s", data.complete ? "" : "; interrupted");
  page.style = kChartPageStyle;
  page.body =
      findings_section(data) + charts_section(data) + kPicturesSection + settings_table(data) + method_section(data);
  page.script = "const chart = " + chart_script_data(data) + ";\n" + kChartScript;
  return report_page(page);
}

}  // namespace raytree::benchmarks
