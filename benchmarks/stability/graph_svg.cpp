#include "benchmarks/stability/graph_svg.h"

#include <set>

#include "benchmarks/svg_plot.h"

namespace raytree::benchmarks {
namespace {

constexpr double kGraphWidth = 680, kGraphHeight = 320;

/// Ticks of x at the lines' own places, where there are no more of them.
constexpr std::size_t kMostOwnTicks = 8;

PlotScale plot_scale(StabilityGraph::Scale scale) {
  return scale == StabilityGraph::Scale::linear ? PlotScale::linear : PlotScale::logarithmic;
}

}  // namespace

std::string graph_svg(const StabilityGraph& graph) {
  LinePlot plot;
  plot.title = graph.title, plot.x_label = graph.x_label, plot.y_label = graph.y_label;
  plot.x_scale = plot_scale(graph.x_scale), plot.y_scale = plot_scale(graph.y_scale);
  std::set<double> places;
  for (const StabilityGraph::Line& line : graph.lines) {
    LinePlot::Line& drawn = plot.lines.emplace_back();
    drawn.name = line.name;
    if (line.predicted) drawn.style = LinePlot::Line::Style::predicted;
    for (const auto& [x, y] : line.points) {
      drawn.points.push_back({x, {y, y, y, 1}});
      if (x > 0) places.insert(x);
    }
  }
  if (graph.x_scale == StabilityGraph::Scale::logarithmic && places.size() <= kMostOwnTicks)
    plot.x_ticks.assign(places.begin(), places.end());
  return line_plots_svg(graph.title, {plot}, kGraphWidth, kGraphHeight);
}

}  // namespace raytree::benchmarks
