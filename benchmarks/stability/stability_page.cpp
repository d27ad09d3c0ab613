#include "benchmarks/stability/stability_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/report_page.h"
#include "benchmarks/stability/graph_svg.h"
#include "benchmarks/stability/stability_report.h"
#include "renderer/image_file.h"

namespace raytree::benchmarks {
namespace {

constexpr const char* kStabilityStyle = R"(
.counts { display: flex; flex-wrap: wrap; gap: 12px; margin: 20px 0; }
.count { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px 18px; min-width: 150px; }
.count b { display: block; font-size: 28px; line-height: 1.2; font-variant-numeric: tabular-nums; }
.planted { border-color: var(--bad); }
nav a, td a { color: var(--accent); text-decoration: none; } nav a { margin-right: 18px; white-space: nowrap; }
.tools { position: sticky; top: 0; background: var(--paper); padding: 10px 0; display: flex; flex-wrap: wrap; gap: 8px; z-index: 1; }
.tools button, .tools input { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line);
  border-radius: 6px; padding: 4px 12px; }
.tools button { cursor: pointer; } .tools button[aria-pressed="true"] { border-color: var(--accent); color: var(--accent); }
.tools input { flex: 1; min-width: 180px; }
.head { display: flex; justify-content: space-between; align-items: baseline; gap: 16px; }
.head h3 { font-size: 17px; }
.chip { font-size: 13px; font-weight: 600; border: 1px solid currentColor; border-radius: 10px; padding: 1px 10px; white-space: nowrap; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 14px; margin: 8px 0 14px; }
dt { color: var(--quiet); } dd { margin: 0; }
.pictures { display: flex; flex-wrap: wrap; gap: 16px; margin: 0 0 14px; }
.pictures figure { width: min-content; } .pictures img { display: block; border-radius: 4px; max-width: none; outline: 1px solid var(--line); }
.pictures img.hard { image-rendering: pixelated; border-radius: 0; }
.unseen { border-left: 3px solid var(--line); padding-left: 12px; margin: 0 0 14px; }
.graph { width: 100%; max-width: 700px; display: block; margin: 0 0 14px; }
.figures { overflow-x: auto; } .figures th, .figures td { font-size: 14px; }
.verdict { white-space: nowrap; } summary { cursor: pointer; margin: 14px 0; }
.interval { color: var(--quiet); white-space: nowrap; }
[hidden] { display: none; }
)";

constexpr const char* kStabilityScript = R"(
const cases = [...document.querySelectorAll('article')], buttons = [...document.querySelectorAll('.tools button')];
const search = document.querySelector('.tools input');
let verdict = '';
function show() {
  const words = search.value.toLowerCase();
  for (const one of cases)
    one.hidden = !(one.dataset.verdicts.split(' ').includes(verdict) || verdict === '') ||
      !one.textContent.toLowerCase().includes(words);
  for (const group of document.querySelectorAll('section.group'))
    group.hidden = [...group.querySelectorAll('article')].every(one => one.hidden);
  for (const button of buttons) button.setAttribute('aria-pressed', button.dataset.verdict === verdict);
}
for (const button of buttons) button.onclick = () => { verdict = button.dataset.verdict; show(); };
search.oninput = show;
show();
)";

/// Of the common sheet.
const char* verdict_class(StabilityVerdict verdict) {
  switch (verdict) {
    case StabilityVerdict::holds:
      return "holds";
    case StabilityVerdict::fails_as_known:
      return "known";
    case StabilityVerdict::fails:
      break;
  }
  return "fails";
}

std::string png_address(const DisplayImage& picture) {
  Image image;
  image.frame_width = picture.width, image.frame_height = picture.height;
  image.window = {0, 0, picture.width, picture.height};
  image.color_space = "srgb";
  constexpr const char* kNames[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c)
    image.planes.push_back({kNames[c], PixelType::uint8, PixelType::uint8, picture.planes[c].data()});
  return data_address("image/png", encode_image(image, ImageFormat::png));
}

std::string pictures_html(const std::vector<StabilityPicture>& pictures) {
  if (pictures.empty()) return {};
  std::string html = "<div class=\"pictures\">";
  for (const StabilityPicture& picture : pictures)
    html += fmt::format(
        "<figure><img{} src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>",
        picture.magnified > 1 ? " class=\"hard\"" : "", png_address(picture.image),
        picture.magnified * picture.image.width, picture.magnified * picture.image.height,
        escaped_html(picture.caption), escaped_html(picture.caption));
  return html + "</div>\n";
}

std::string figures_html(const StabilityEntry& entry) {
  if (!entry.error.empty())
    return fmt::format("<p class=\"fails\">The case ended early: {}</p>\n", escaped_html(entry.error));
  if (entry.result.figures.empty()) return "<p class=\"fails\">Nothing was measured.</p>\n";
  std::string html =
      "<div class=\"figures\"><table><tr><th>Method</th><th>Quantity</th><th class=\"number\">Measured</th>"
      "<th class=\"number\">Must lie in</th><th>Best known</th><th>Verdict</th></tr>\n";
  for (const StabilityFigure& figure : entry.result.figures)
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number interval\">{}</td><td>{}</td>"
        "<td class=\"{} verdict\">{}</td></tr>\n",
        escaped_html(figure.method), escaped_html(figure.quantity), figure_text(figure.measured), interval_text(figure),
        escaped_html(figure.known), verdict_class(figure.verdict()), verdict_words(figure.verdict()));
  return html + "</table></div>\n";
}

std::string case_html(const StabilityEntry& entry) {
  const StabilityCase& what = entry.grouped.what;
  std::string verdicts(verdict_class(entry.verdict()));
  for (const StabilityFigure& figure : entry.result.figures) {
    const std::string one = verdict_class(figure.verdict());
    if (verdicts.find(one) == std::string::npos) verdicts += " " + one;
  }
  std::string graphs;
  for (const StabilityGraph& graph : entry.result.graphs) graphs += graph_svg(graph);
  if (!entry.result.nothing_to_see.empty())
    graphs += fmt::format("<p class=\"unseen\">Nothing to see: {}</p>\n", escaped_html(entry.result.nothing_to_see));
  return fmt::format(
      "<article class=\"card\" id=\"{0}\" data-verdicts=\"{1}\"><div class=\"head\"><h3>{2}</h3>"
      "<span class=\"chip {3}\">{4}</span></div>\n<p class=\"quiet\"><code>{0}</code>, row {5}</p>\n"
      "<dl><dt>Provoked by</dt><dd>{6}</dd><dt>Remedy</dt><dd>{7}</dd><dt>Source</dt><dd>{8}</dd></dl>\n{9}{10}{11}"
      "</article>\n",
      escaped_html(what.name), verdicts, escaped_html(what.title), verdict_class(entry.verdict()),
      verdict_words(entry.verdict()), what.row, escaped_html(what.provocation), escaped_html(what.remedy),
      escaped_html(what.source), pictures_html(entry.result.pictures), graphs, figures_html(entry));
}

/// Each case in a line, with how many of its figures came out how.
std::string glance_html(const StabilityReport& report) {
  std::string html =
      "<details><summary>All cases at a glance</summary><div class=\"card figures\"><table><tr><th>Case</th>"
      "<th class=\"number\">Row</th><th class=\"number\">Hold</th><th class=\"number\">Fail as known</th>"
      "<th class=\"number\">Fail</th><th>Verdict</th></tr>\n";
  for (const StabilityEntry& entry : report.entries) {
    StabilityCounts counts;
    for (const StabilityFigure& figure : entry.result.figures) counts.add(figure.verdict());
    html += fmt::format(
        "<tr><td><a href=\"#{}\">{}</a></td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"{} verdict\">{}</td></tr>\n",
        escaped_html(entry.grouped.what.name), escaped_html(entry.grouped.what.title), entry.grouped.what.row,
        counts.holds, counts.fails_as_known, counts.fails, verdict_class(entry.verdict()),
        verdict_words(entry.verdict()));
  }
  return html + "</table></div></details>\n";
}

std::string count_html(std::size_t count, const char* style, const char* words) {
  return fmt::format("<div class=\"count\"><b class=\"{}\">{}</b>{}</div>", style, count, words);
}

std::string counts_html(const StabilityReport& report) {
  const StabilityCounts figures = report.figures();
  std::string html = "<div class=\"counts\">" + count_html(report.entries.size(), "", "cases") +
                     count_html(figures.holds, "holds", "figures hold") +
                     count_html(figures.fails_as_known, "known", "fail as known") +
                     count_html(figures.fails, figures.fails > 0 ? "fails" : "", "fail") + "</div>\n";
  html +=
      "<p><span class=\"holds\">Holds</span>: the renderer's own method, within its derived bound. "
      "<span class=\"known\">Fails as known</span>: a method kept for comparison, or a remedy switched off, that fails "
      "as its paper says. <span class=\"fails\">Fails</span>: anything else, and a defect.</p>\n";
  if (const std::string planted = planted_text(report.faults); !planted.empty())
    html += fmt::format(
        "<p class=\"card planted\">Faults were planted to see that the suite notices them: <code>{}</code>. Verdicts "
        "on this page are not those of the renderer.</p>\n",
        planted);
  return html;
}

}  // namespace

std::string stability_page(const StabilityReport& report, const std::vector<PageSection>& more) {
  std::string links, sections, groups;
  const auto link = [&](const std::string& id, const std::string& title) {
    links += fmt::format("<a href=\"#{}\">{}</a>\n", escaped_html(id), escaped_html(title));
  };
  for (const PageSection& section : more) {
    link(section.id, section.title);
    sections += fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", escaped_html(section.id),
                            escaped_html(section.title), section.html);
  }
  const char* open = nullptr;
  int number = 0;
  for (const StabilityEntry& entry : report.entries) {
    if (open == nullptr || std::string_view(open) != entry.grouped.group) {
      const std::string id = fmt::format("group-{}", ++number);
      link(id, entry.grouped.group);
      groups += fmt::format("{}<section class=\"group\" id=\"{}\"><h2>{}</h2>\n", open != nullptr ? "</section>\n" : "",
                            id, escaped_html(entry.grouped.group));
      open = entry.grouped.group;
    }
    groups += case_html(entry);
  }
  if (open != nullptr) groups += "</section>\n";
  ReportPage page;
  page.title = "Stability";
  page.subtitle = fmt::format("Where methods of rendering fail, by how much, and what helps. {}, at {:.0f} % effort.",
                              counts_text(report), 100 * report.effort);
  page.style = kStabilityStyle;
  page.body = counts_html(report) + "<nav>" + links + "</nav>\n" + glance_html(report) + sections +
              "<div class=\"tools\"><button data-verdict=\"\">All</button><button data-verdict=\"fails\">Fails</button>"
              "<button data-verdict=\"known\">Fails as known</button><button data-verdict=\"holds\">Holds</button>"
              "<input type=\"search\" placeholder=\"Search cases\" aria-label=\"Search cases\"></div>\n" +
              groups;
  page.script = kStabilityScript;
  return report_page(page);
}

}  // namespace raytree::benchmarks
