#include "benchmarks/stability/graph_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "benchmarks/report_page.h"
#include "benchmarks/stability/stability_report.h"

namespace raytree::benchmarks {
namespace {

// Units of the viewBox.
constexpr double kGraphWidth = 680, kGraphHeight = 320;
constexpr double kPlotLeft = 70, kPlotRight = 420, kPlotTop = 36, kPlotBottom = 272;

/// Told apart by the color-blind, on light and dark (Okabe and Ito 2008).
constexpr const char* kLineColors[] = {"#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// Room between the plot's sides and the first and last point.
constexpr double kPlotMargin = 12;
/// Ticks of x at the lines' own places, where there are no more of them.
constexpr std::size_t kMostOwnTicks = 8;

using GraphScale = StabilityGraph::Scale;

/// From values to places between `first` and `last`.
class GraphAxis {
 public:
  /// `low` < `high`, positive where the scale is logarithmic.
  GraphAxis(GraphScale scale, double low, double high, double first, double last)
      : scale_(scale), low_(at_scale(low)), factor_((last - first) / (at_scale(high) - low_)), first_(first) {}
  double at(double value) const { return first_ + (at_scale(value) - low_) * factor_; }

 private:
  double at_scale(double value) const { return scale_ == GraphScale::logarithmic ? std::log10(value) : value; }

  GraphScale scale_;
  double low_, factor_, first_;
};

/// What an axis shows, and where its ticks stand.
struct GraphRange {
  double low, high;
  std::vector<double> ticks;
};

/// Decades about [low, high], every one or every so many that at most seven remain.
GraphRange decade_range(double low, double high) {
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - 1e-9)));
  const int step = (last - first + 6) / 7;
  GraphRange range{std::pow(10.0, first), std::pow(10.0, last), {}};
  for (int decade = first; decade <= last; ++decade)
    if (decade % step == 0) range.ticks.push_back(std::pow(10.0, decade));
  return range;
}

/// Multiples of 1, 2 or 5 times a power of ten about [low, high], some five of them.
GraphRange linear_range(double low, double high) {
  const double span = high > low ? high - low : std::max(1.0, std::abs(low));
  const double decade = std::pow(10.0, std::floor(std::log10(span / 5)));
  const double fifth = span / 5 / decade;  // in [1, 10)
  const double step = decade * (fifth < 1.5 ? 1 : fifth < 3.5 ? 2 : fifth < 7.5 ? 5 : 10);
  GraphRange range{std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, {}};
  if (range.high <= range.low) range.high = range.low + step;
  const int steps = static_cast<int>(std::lround((range.high - range.low) / step));
  // Sums of steps would not come out round.
  for (int i = 0; i <= steps; ++i) range.ticks.push_back((std::round(range.low / step) + i) * step);
  return range;
}

/// Without the sign of a 0 that was rounded to.
std::string tick_text(double tick) { return fmt::format("{:.4g}", tick + 0.0); }

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
  const auto can_be_drawn = [&](const std::pair<double, double>& point) {
    const auto fits = [](double value, GraphScale scale) {
      return std::isfinite(value) && (value > 0 || scale == GraphScale::linear);
    };
    return fits(point.first, graph.x_scale) && fits(point.second, graph.y_scale);
  };
  std::set<double> places;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const StabilityGraph::Line& line : graph.lines)
    for (const auto& point : line.points) {
      if (!can_be_drawn(point)) continue;
      places.insert(point.first);
      least = std::min(least, point.second), most = std::max(most, point.second);
    }
  if (places.empty()) return {};
  const GraphRange of_y = graph.y_scale == GraphScale::linear ? linear_range(least, most) : decade_range(least, most);
  GraphRange of_x = graph.x_scale == GraphScale::linear ? linear_range(*places.begin(), *places.rbegin())
                                                        : decade_range(*places.begin(), *places.rbegin());
  if (graph.x_scale == GraphScale::logarithmic && places.size() <= kMostOwnTicks) {
    const double room = places.size() == 1 ? 2 : 1;
    of_x = {*places.begin() / room, *places.rbegin() * room, {places.begin(), places.end()}};
  }
  const GraphAxis x(graph.x_scale, of_x.low, of_x.high, kPlotLeft + kPlotMargin, kPlotRight - kPlotMargin);
  const GraphAxis y(graph.y_scale, of_y.low, of_y.high, kPlotBottom, kPlotTop);

  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" class=\"graph\" font-size=\"12\" fill=\"var(--ink)\">",
      kGraphWidth, kGraphHeight, escaped_html(graph.title));
  svg += text_at(kPlotLeft, 18, "start", graph.title, " font-weight=\"600\"");
  for (const double tick : of_y.ticks) {
    svg += line_between(kPlotLeft, y.at(tick), kPlotRight, y.at(tick), "stroke:var(--line)");
    svg += text_at(kPlotLeft - 8, y.at(tick) + 4, "end", tick_text(tick));
  }
  for (const double tick : of_x.ticks) {
    svg += line_between(x.at(tick), kPlotBottom, x.at(tick), kPlotBottom + 5, "stroke:var(--quiet)");
    svg += text_at(x.at(tick), kPlotBottom + 19, "middle", tick_text(tick));
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
