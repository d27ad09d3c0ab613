#include "benchmarks/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>

#include "benchmarks/report_page.h"

namespace raytree::benchmarks {
namespace {

/// Told apart by the color-blind, on light and dark (Okabe and Ito 2008).
constexpr const char* kLineColors[] = {"#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

constexpr const char* kLinePlotStyle = R"(
.chart .line { fill: none; stroke-width: 2; } .chart .predicted { stroke-dasharray: 2 4; } .chart .spread { stroke-width: 1.5; }
.chart .level { stroke: var(--c-quiet); stroke-width: 1.5; stroke-dasharray: 7 4; } .chart .title { font-weight: 600; }
)";

constexpr double kLineLeft = 70, kLineTop = 36, kLineBottom = 48;
constexpr double kKeyWidth = 215, kKeyStep = 18;  ///< the names at the right
constexpr double kInset = 12;                     ///< of the first and the last point

bool fits(double value, PlotScale scale) { return std::isfinite(value) && (value > 0 || scale == PlotScale::linear); }
bool is_shown(const LinePlot& plot, const LinePlot::Point& point) {
  return fits(point.x, plot.x_scale) && fits(point.y.median, plot.y_scale);
}

/// Multiples of 1, 2 or 5 times a power of ten, some five of them in [low, high].
double round_step(double low, double high) {
  const double span = high > low ? high - low : std::max(1.0, std::abs(low));
  const double decade = std::pow(10.0, std::floor(std::log10(span / 5)));
  const double share = span / 5 / decade;
  return decade * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

std::vector<double> linear_ticks(double low, double high, double step) {
  std::vector<double> ticks;
  // Sums of steps would not come out round.
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push_back(i * step);
  return ticks;
}

/// "0.001", "500", "1e6".
std::string number_label(double value) {
  if (value == 0) return "0";
  if (!(std::abs(value) >= 1e-4 && std::abs(value) < 1e5)) {
    const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
    return fmt::format("{:g}e{}", value / std::pow(10.0, power), power);
  }
  return fmt::format("{:g}", value);
}

/// Of lines by their names, the same in all plots of a drawing.
class LineColors {
 public:
  const char* of(const std::string& name) {
    const std::size_t index = indices_.emplace(name, indices_.size()).first->second;
    return kLineColors[index % std::size(kLineColors)];
  }

 private:
  std::map<std::string, std::size_t> indices_;
};

/// One plot, its upper edge at `top`.
class LineDrawing {
 public:
  LineDrawing(const LinePlot& plot, double width, double height, double top, LineColors& colors)
      : plot_(plot), top_(top), colors_(colors) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    x_ = {kFar, -kFar, kLineLeft, width - kKeyWidth, plot.x_scale, plot.x_label};
    y_ = {kFar, -kFar, top + height - kLineBottom, top + kLineTop, plot.y_scale, plot.y_label};
    for (const LinePlot::Line& line : plot.lines)
      for (const LinePlot::Point& point : line.points) {
        if (!is_shown(plot, point)) continue;
        x_.low = std::min(x_.low, point.x), x_.high = std::max(x_.high, point.x);
        for (const double y : {point.y.low, point.y.median, point.y.high})
          if (fits(y, plot.y_scale)) y_.low = std::min(y_.low, y), y_.high = std::max(y_.high, y);
      }
    is_empty_ = !(x_.low <= x_.high);
    if (!is_empty_) choose_axes();
  }

  bool is_empty() const { return is_empty_; }

  std::string text() {
    out_ = svg_text("class=\"title\"", "start", kLineLeft, top_ + 18, plot_.title) + "\n" + plot_frame(x_, y_);
    for (const LinePlot::Level& level : plot_.levels) {
      const double y = y_.at(level.y);
      out_ += svg_line("class=\"level\"", x_.from, y, x_.to, y) +
              svg_text("class=\"quiet\"", "end", x_.to - 6, y + 15, level.text);
    }
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) draw(i);
    return std::move(out_);
  }

 private:
  void choose_axes() {
    if (x_.low == x_.high) {
      const double room = x_.scale == PlotScale::logarithmic ? x_.low / 2 : 1;
      x_.low -= room, x_.high += 2 * room;
    }
    // The frame reaches beyond the first and the last point by so many pixels.
    const double share = kInset / (x_.to - x_.from - 2 * kInset);
    if (x_.scale == PlotScale::logarithmic) {
      const double beyond = std::pow(x_.high / x_.low, share);
      x_.low /= beyond, x_.high *= beyond;
    } else {
      const double beyond = share * (x_.high - x_.low);
      x_.low -= beyond, x_.high += beyond;
    }
    if (!plot_.x_ticks.empty())
      set_ticks(x_, plot_.x_ticks);
    else
      set_ticks(x_, x_.scale == PlotScale::linear ? linear_ticks(x_.low, x_.high, round_step(x_.low, x_.high))
                                                  : logarithmic_ticks(x_.low, x_.high));

    for (const LinePlot::Level& level : plot_.levels)
      y_.low = std::min(y_.low, level.y), y_.high = std::max(y_.high, level.y);
    if (y_.scale == PlotScale::logarithmic) {
      const double first = std::floor(std::log10(y_.low) + 1e-9);
      const double last = std::max(first + 1, std::ceil(std::log10(y_.high) - 1e-9));
      y_.low = std::pow(10, first), y_.high = std::pow(10, last);
      set_ticks(y_, logarithmic_ticks(y_.low, y_.high));
    } else {
      const double step = round_step(y_.low, y_.high);
      y_.low = std::floor(y_.low / step + 1e-9) * step, y_.high = std::ceil(y_.high / step - 1e-9) * step;
      if (!(y_.high > y_.low)) y_.high = y_.low + step;
      set_ticks(y_, linear_ticks(y_.low, y_.high, step));
    }
  }

  static void set_ticks(PlotAxis& axis, const std::vector<double>& values) {
    for (const double value : values) axis.ticks.emplace_back(value, number_label(value));
  }

  void draw(std::size_t i) {
    const LinePlot::Line& line = plot_.lines[i];
    using Style = LinePlot::Line::Style;
    const bool predicted = line.style == Style::predicted;
    // A prediction wears the color of the line before it, which it is about.
    const char* color = colors_.of(plot_.lines[predicted && i > 0 ? i - 1 : i].name);
    const std::string path_style = fmt::format("class=\"line{}\" stroke=\"{}\"", predicted ? " predicted" : "", color);
    std::string path, marks;
    for (const LinePlot::Point& point : line.points) {
      if (!is_shown(plot_, point)) continue;
      const double x = x_.at(point.x), y = y_.at(point.y.median);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
      if (point.y.count > 1 && fits(point.y.low, plot_.y_scale))
        marks += svg_line(fmt::format("class=\"spread\" stroke=\"{}\"", color), x, y_.at(point.y.low), x,
                          y_.at(point.y.high));
      marks += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"><title>{}: {:.4g} at {:.6g}</title></circle>\n", x,
          y, color, escaped_html(line.name), point.y.median, point.x);
    }
    const double key = y_.to + 8 + kKeyStep * static_cast<double>(i);
    if (line.style == Style::scattered)
      out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>", x_.to + 22, key, color);
    else
      out_ += fmt::format("<path {} d=\"{}\"/>\n", path_style, path) +
              svg_line(path_style, x_.to + 10, key, x_.to + 34, key);
    if (!predicted) out_ += marks;
    out_ += svg_text("class=\"key\"", "start", x_.to + 40, key + 4, line.name) + "\n";
  }

  const LinePlot& plot_;
  double top_;
  LineColors& colors_;
  PlotAxis x_, y_;
  bool is_empty_ = false;
  std::string out_;
};

}  // namespace

const char* const kPlotStyle = R"(
.chart { --c-paper: #ffffff; --c-ink: #1d2126; --c-quiet: #667079; --c-line: #e3e0d9; font: 12px system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
@media (prefers-color-scheme: dark) { .chart { --c-paper: #1b1f23; --c-ink: #e6e4df; --c-quiet: #98a1a9; --c-line: #30363c; } }
.chart .paper { fill: var(--c-paper); } .chart text { fill: var(--c-ink); } .chart .quiet { fill: var(--c-quiet); }
.chart .grid { stroke: var(--c-line); stroke-width: 1; } .chart .frame { fill: none; stroke: var(--c-quiet); stroke-width: 1; }
)";

std::vector<double> logarithmic_ticks(double low, double high) {
  constexpr std::size_t kMostTicks = 9;
  std::vector<double> fine, powers;
  const int first = static_cast<int>(std::floor(std::log10(low))), last = static_cast<int>(std::log10(high)) + 1;
  const int step = (last - first) / static_cast<int>(kMostTicks) + 1;
  for (int power = first; power <= last; ++power)
    for (const int digit : {1, 2, 5}) {
      const double tick = digit * std::pow(10.0, power);
      if (tick < low || tick > high) continue;
      fine.push_back(tick);
      if (digit == 1 && power % step == 0) powers.push_back(tick);
    }
  return fine.size() > kMostTicks ? powers : fine;
}

double PlotAxis::at(double value) const {
  const double share = scale == PlotScale::logarithmic
                           ? (std::log(value) - std::log(low)) / (std::log(high) - std::log(low))
                           : (value - low) / (high - low);
  return from + (to - from) * share;
}

std::string svg_line(const std::string& attributes, double x0, double y0, double x1, double y1) {
  return fmt::format("<line {} x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", attributes, x0, y0, x1,
                     y1);
}

std::string svg_text(const std::string& attributes, const char* anchor, double x, double y, const std::string& text) {
  return fmt::format("<text {} text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", attributes, anchor, x, y,
                     escaped_html(text));
}

std::string plot_frame(const PlotAxis& x, const PlotAxis& y) {
  std::string svg;
  for (const auto& [value, label] : x.ticks)
    svg += svg_line("class=\"grid\"", x.at(value), y.from, x.at(value), y.to) +
           svg_text("class=\"quiet\"", "middle", x.at(value), y.from + 18, label);
  for (const auto& [value, label] : y.ticks)
    svg += svg_line("class=\"grid\"", x.from, y.at(value), x.to, y.at(value)) +
           svg_text("class=\"quiet\"", "end", x.from - 8, y.at(value) + 4, label);
  return svg +
         fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", x.from,
                     y.to, x.to - x.from, y.from - y.to) +
         svg_text("class=\"axis\"", "middle", (x.from + x.to) / 2, y.from + 44, x.title) +
         fmt::format("<g transform=\"translate(18 {:.1f}) rotate(-90)\">{}</g>\n", (y.from + y.to) / 2,
                     svg_text("class=\"axis\"", "middle", 0, 0, y.title));
}

std::string line_plots_svg(const std::string& title, const std::vector<LinePlot>& plots, double width, double height) {
  std::string drawn;
  double top = 0;
  LineColors colors;
  for (const LinePlot& plot : plots) {
    LineDrawing drawing(plot, width, height, top, colors);
    if (drawing.is_empty()) continue;
    drawn += drawing.text();
    top += height;
  }
  if (drawn.empty()) return {};
  return fmt::format(
      "<svg class=\"chart graph\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\">\n"
      "<title>{2}</title>\n<style>{3}{4}</style>\n<rect class=\"paper\" width=\"{0:g}\" "
      "height=\"{1:g}\"/>\n{5}</svg>\n",
      width, top, escaped_html(title), kPlotStyle, kLinePlotStyle, drawn);
}

std::string svg_file(const std::string& element) {
  constexpr std::string_view kTag = "<svg";
  if (element.empty()) return {};
  return fmt::format("{} xmlns=\"http://www.w3.org/2000/svg\"{}", kTag, element.substr(kTag.size()));
}

}  // namespace raytree::benchmarks
