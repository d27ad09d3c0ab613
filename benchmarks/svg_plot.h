// What the benchmarks' drawings share: axes onto pixels, a frame with ticks and titles, and lines over a knob with
// their spread. SVG that stands alone or in a page, light and dark by the reader's choice.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/measurement.h"

namespace raytree::benchmarks {

/// 1, 2 and 5 times powers of ten within [low, high]; powers of ten alone where there would be more than nine,
/// and of more than nine of those every so many.
std::vector<double> logarithmic_ticks(double low, double high);

enum class PlotScale : std::uint8_t { logarithmic, linear };

/// An axis onto pixels.
struct PlotAxis {
  double low, high;  ///< values at its ends, apart; of a logarithmic one > 0
  double from, to;   ///< pixels there
  PlotScale scale = PlotScale::logarithmic;
  std::string title = {};
  std::vector<std::pair<double, std::string>> ticks = {};  ///< value and label

  double at(double value) const;
};

/// Elements with one attribute or more of style ahead of their places; text is escaped.
std::string svg_line(const std::string& attributes, double x0, double y0, double x1, double y1);
std::string svg_text(const std::string& attributes, const char* anchor, double x, double y, const std::string& text);

/// Style of all drawings: class `chart`, of the <svg>, sets paper, ink and font; `quiet`, `grid` and `frame` are what
/// plot_frame() draws.
extern const char* const kPlotStyle;

/// Lines and labels at the ticks, a frame about the axes, and their titles. `y` runs upward: from > to.
std::string plot_frame(const PlotAxis& x, const PlotAxis& y);

/// Figures over a knob.
struct LinePlot {
  struct Point {
    double x;
    Spread y;  ///< with more than one sample, quartiles are drawn as a bar
  };
  struct Line {
    std::string name;
    std::vector<Point> points;  ///< those that a logarithmic axis cannot show are left out
    enum class Style { measured, predicted, scattered } style = Style::measured;
    ///< predicted: dashed, in the color of the line before; scattered: points that are no series
  };
  struct Level {
    double y;
    std::string text;
  };
  std::string title, x_label, y_label;
  PlotScale x_scale = PlotScale::logarithmic, y_scale = PlotScale::logarithmic;
  std::vector<double> x_ticks;  ///< empty: round ones
  std::vector<Line> lines;
  std::vector<Level> levels = {};  ///< dashed lines across: bounds, published figures
};

/// An <svg> element of `width` by `height` pixels a plot, one under another, with the lines' names at their right. y
/// runs between whole decades or round steps. Plots without a point that can be drawn are left out; empty: all are.
std::string line_plots_svg(const std::string& title, const std::vector<LinePlot>& plots, double width, double height);

/// An <svg> element of a page as a file of its own, which has to name its namespace. Nothing of nothing.
std::string svg_file(const std::string& element);

}  // namespace raytree::benchmarks
