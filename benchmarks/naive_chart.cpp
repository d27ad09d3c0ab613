// The chart of row naive: what acceleration buys over Whitted's tracer, and that tracer's share of intersection, both
// over the number of objects.
#include <map>

#include "benchmarks/naive.h"
#include "benchmarks/rows.h"
#include "benchmarks/svg_plot.h"

namespace raytree::benchmarks {
namespace {

constexpr double kPlotWidth = 860, kPlotHeight = 400;

/// The lines of one plot in the order in which the figures name them.
std::vector<LinePlot::Line> naive_lines(const std::vector<Figure>& figures, const char* plot) {
  std::vector<LinePlot::Line> lines;
  std::map<std::string, std::size_t> places;
  for (const Figure& figure : figures) {
    if (figure.place.line.empty() || figure.place.plot != plot) continue;
    const auto [at, is_new] = places.emplace(figure.place.line, lines.size());
    if (is_new) {
      LinePlot::Line& line = lines.emplace_back();
      line.name = figure.place.line;
      if (line.name == kWhittedFigures || line.name == kDatabases) line.style = LinePlot::Line::Style::scattered;
    }
    lines[at->second].points.push_back({figure.place.x, figure.measured});
  }
  return lines;
}

}  // namespace

std::string naive_chart_svg(const std::vector<Figure>& figures) {
  LinePlot ratio, share;
  ratio.title = "Time of Whitted's tracer of 1980 over Embree's, the same picture, one thread";
  ratio.x_label = "objects: spheres, polygons, triangles";
  ratio.y_label = "time by bounding spheres / time by Embree";
  ratio.lines = naive_lines(figures, kRatioPlot);
  share.title = "Share of intersection in that tracer's time, its objects tried one by one";
  share.x_label = ratio.x_label;
  share.y_label = "% of the time";
  share.y_scale = PlotScale::linear;
  share.lines = naive_lines(figures, kSharePlot);
  share.levels = {{kSimpleShare, "75 %: Whitted 1980, simple scenes"}, {kComplexShare, "95 %: more complex scenes"}};
  return svg_file(
      line_plots_svg("What acceleration buys over Whitted's tracer", {ratio, share}, kPlotWidth, kPlotHeight));
}

}  // namespace raytree::benchmarks
