#include "benchmarks/stability/graph_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "benchmarks/report_page.h"
#include "benchmarks/stability/stability_report.h"

namespace raytree::benchmarks {
namespace {

// Units of the viewBox.
constexpr double kGraphWidth = 620, kGraphHeight = 320;
constexpr double kPlotLeft = 70, kPlotRight = 420, kPlotTop = 36, kPlotBottom = 272;

/// Told apart by the color-blind, on light and dark (Okabe and Ito 2008).
constexpr const char* kLineColors[] = {"#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// From [low, high], both positive, to [first, last].
class LogScale {
 public:
  LogScale(double low, double high, double first, double last)
      : low_(std::log(low)), factor_((last - first) / (std::log(high) - std::log(low))), first_(first) {}
  double at(double value) const { return first_ + (std::log(value) - low_) * factor_; }

 private:
  double low_, factor_, first_;
};

bool can_be_drawn(const std::pair<double, double>& point) {
  return point.first > 0 && point.second > 0 && std::isfinite(point.first) && std::isfinite(point.second);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor, more,
                     escaped_html(text));
}

std::string line_between(double x0, double y0, double x1, double y1, const char* style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" style=\"{}\"/>", x0, y0, x1, y1,
                     style);
}

}  // namespace

std::string graph_svg(const StabilityGraph& graph) {
  std::set<double> ticks;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const StabilityGraph::Line& line : graph.lines)
    for (const auto& point : line.points) {
      if (!can_be_drawn(point)) continue;
      ticks.insert(point.first);
      least = std::min(least, point.second), most = std::max(most, point.second);
    }
  if (ticks.empty()) return {};
  const int first_decade = static_cast<int>(std::floor(std::log10(least) + 1e-9));
  const int last_decade = std::max(first_decade + 1, static_cast<int>(std::ceil(std::log10(most) - 1e-9)));
  const bool one_tick = ticks.size() == 1;
  const LogScale x(*ticks.begin() / (one_tick ? 2 : 1), *ticks.rbegin() * (one_tick ? 2 : 1), kPlotLeft + 12,
                   kPlotRight - 12);
  const LogScale y(std::pow(10, first_decade), std::pow(10, last_decade), kPlotBottom, kPlotTop);

  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" class=\"graph\" font-size=\"12\" fill=\"var(--ink)\">",
      kGraphWidth, kGraphHeight, escaped_html(graph.title));
  svg += text_at(kPlotLeft, 18, "start", graph.title, " font-weight=\"600\"");
  for (int decade = first_decade; decade <= last_decade; ++decade) {
    const double at = y.at(std::pow(10, decade));
    svg += line_between(kPlotLeft, at, kPlotRight, at, "stroke:var(--line)");
    svg += text_at(kPlotLeft - 8, at + 4, "end", fmt::format("{:g}", std::pow(10, decade)));
  }
  for (const double tick : ticks) {
    svg += line_between(x.at(tick), kPlotBottom, x.at(tick), kPlotBottom + 5, "stroke:var(--quiet)");
    svg += text_at(x.at(tick), kPlotBottom + 19, "middle", figure_text(tick));
  }
  svg += text_at((kPlotLeft + kPlotRight) / 2, kPlotBottom + 38, "middle", graph.x_label);
  svg += fmt::format("<g transform=\"translate(14 {:.1f}) rotate(-90)\">{}</g>", (kPlotTop + kPlotBottom) / 2,
                     text_at(0, 0, "middle", graph.y_label));
  double key = kPlotTop + 8;
  for (std::size_t i = 0; i < graph.lines.size(); ++i) {
    const StabilityGraph::Line& line = graph.lines[i];
    // A prediction wears the color of the line before it, which it is about.
    const std::size_t of = line.predicted && i > 0 ? i - 1 : i;
    const std::string style =
        fmt::format("fill:none;stroke:{};stroke-width:2{}", kLineColors[of % std::size(kLineColors)],
                    line.predicted ? ";stroke-dasharray:2 4" : "");
    std::string path, dots;
    for (const auto& point : line.points) {
      if (!can_be_drawn(point)) continue;
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(point.first), y.at(point.second));
      dots +=
          fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"><title>{}: {} at {}</title></circle>",
                      x.at(point.first), y.at(point.second), kLineColors[of % std::size(kLineColors)],
                      escaped_html(line.name), figure_text(point.second), figure_text(point.first));
    }
    svg += fmt::format("<path d=\"{}\" style=\"{}\"/>", path, style);
    if (!line.predicted) svg += dots;
    svg += line_between(kPlotRight + 10, key, kPlotRight + 34, key, style.c_str());
    svg += text_at(kPlotRight + 40, key + 4, "start", line.name);
    key += 18;
  }
  return svg + "</svg>";
}

}  // namespace raytree::benchmarks
