#include "benchmarks/stability/graph_svg.h"

#include <set>

#include "benchmarks/svg_plot.h"

namespace raytree::benchmarks {
namespace {

constexpr double kGraphWidth = 620, kGraphHeight = 320;

}  // namespace

std::string graph_svg(const StabilityGraph& graph) {
  LinePlot plot;
  plot.title = graph.title, plot.x_label = graph.x_label, plot.y_label = graph.y_label;
  std::set<double> ticks;
  for (const StabilityGraph::Line& line : graph.lines) {
    LinePlot::Line& drawn = plot.lines.emplace_back();
    drawn.name = line.name;
    if (line.predicted) drawn.style = LinePlot::Line::Style::predicted;
    for (const auto& [x, y] : line.points) {
      drawn.points.push_back({x, {y, y, y, 1}});
      if (x > 0 && y > 0) ticks.insert(x);
    }
  }
  plot.x_ticks.assign(ticks.begin(), ticks.end());
  return line_plots_svg(graph.title, {plot}, kGraphWidth, kGraphHeight);
}

}  // namespace raytree::benchmarks
