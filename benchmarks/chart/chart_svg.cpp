#include "benchmarks/chart/chart_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "benchmarks/report_page.h"
#include "benchmarks/svg_plot.h"

namespace raytree::benchmarks {
namespace {

constexpr double kDrawingWidth = 1160, kDrawingHeight = 600;  ///< of the drawing; it scales
constexpr double kLeft = 84, kRight = 24, kTop = 22, kBottom = 62;
constexpr double kLetterWidth = 6.7, kLetterHeight = 12;  ///< of labels, about
constexpr double kDecadesDown = 1.5;  ///< errors smaller than the floor by more than so much stand on the lower edge

/// Beyond the common style.
constexpr const char* kDrawingStyle = R"(
.chart { --c-front: #1f5fa8; --c-dominated: #a9aeb4; --c-floor: #a86a00; }
@media (prefers-color-scheme: dark) { .chart { --c-front: #7db4f0; --c-dominated: #666e76; --c-floor: #e0a94a; } }
.chart .front { fill: none; stroke: var(--c-front); stroke-width: 2; }
.chart .knob { fill: none; stroke: var(--c-dominated); stroke-width: 1; stroke-dasharray: 2 3; opacity: .7; }
.chart .bar { stroke: var(--c-dominated); stroke-width: 1; } .chart .bar.best { stroke: var(--c-front); }
.chart .floor { stroke: var(--c-floor); stroke-width: 1.5; stroke-dasharray: 7 4; } .chart .below { fill: var(--c-floor); opacity: .07; }
.chart .floor-text { fill: var(--c-floor); } .chart .step { stroke: var(--c-quiet); stroke-dasharray: 2 4; }
.chart .point { fill: var(--c-dominated); stroke: var(--c-paper); stroke-width: 1; cursor: pointer; }
.chart .point.best { fill: var(--c-front); } .chart .point.defaults { stroke: var(--c-ink); stroke-width: 2; }
.chart .point:hover, .chart .point.chosen { stroke: var(--c-ink); stroke-width: 2.5; }
.chart .label { paint-order: stroke; stroke: var(--c-paper); stroke-width: 3px; stroke-linejoin: round; }
)";

struct LabelBox {
  double left, top, right, bottom;
  bool overlaps(const LabelBox& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

/// Words that tell a point of the front from others: values of the crossed set would be too long for a drawing.
std::string label_of(const ChartPoint& point) {
  if (point.setting.part == SweepPart::defaults) return "defaults";
  std::string text;
  if (point.setting.part == SweepPart::ends || point.setting.part == SweepPart::between) {
    text = point.setting.knob + " " + point.setting.value;
  } else {
    for (const std::string& word : point.setting.flags)
      if (word != "--set") text += (text.empty() ? "" : " ") + (word.rfind("--", 0) == 0 ? word.substr(2) : word);
  }
  constexpr std::size_t kLongest = 34;
  return text.size() > kLongest ? text.substr(0, kLongest - 1) + "\u2026" : text;
}

class ChartDrawing {
 public:
  ChartDrawing(const ChartData& data, const MetricInfo& metric)
      : data_(data), metric_(metric), front_(chart_front(data, metric)), floor_(data.floor.*metric.value) {
    x_ = {1e300, 0, kLeft, kDrawingWidth - kRight};
    y_ = {1e300, 0, kDrawingHeight - kBottom, kTop};
    for (const ChartPoint& point : data.points) {
      const Spread cpu = point.cpu();
      x_.low = std::min(x_.low, cpu.low);
      x_.high = std::max(x_.high, cpu.high);
      const double error = error_of(point);
      if (!(error > 0)) continue;
      y_.low = std::min(y_.low, error);
      y_.high = std::max(y_.high, error);
    }
    if (!(x_.low < x_.high)) x_.low = 1e-3, x_.high = 1;
    if (!(y_.low <= y_.high)) y_.low = 1e-4, y_.high = 1;
    if (floor_ > 0) {
      y_.low = std::max(y_.low, floor_ * std::pow(10, -kDecadesDown));
      y_.low = std::min(y_.low, floor_);
      y_.high = std::max(y_.high, floor_);
    }
    x_.low /= 1.25, x_.high *= 1.25;
    y_.low /= 1.6, y_.high *= 1.6;
  }

  std::string text() {
    out_ = fmt::format(
        "<svg class=\"chart\" data-metric=\"{}\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" "
        "role=\"img\">\n<title>Speed against accuracy: {}, {}</title>\n<style>{}{}</style>\n"
        "<rect class=\"paper\" width=\"{}\" height=\"{}\"/>\n",
        metric_.key, kDrawingWidth, kDrawingHeight, escaped_html(data_.scene), escaped_html(metric_.label), kPlotStyle,
        kDrawingStyle, kDrawingWidth, kDrawingHeight);
    draw_axes();
    draw_floor();
    draw_knobs();
    draw_front();
    draw_points();
    draw_labels();
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  double error_of(const ChartPoint& point) const { return point.errors.*metric_.value; }
  double x_of(const ChartPoint& point) const { return x_.at(point.cpu().median); }
  /// Errors that a logarithm cannot show stand on the lower edge.
  double y_of(const ChartPoint& point) const { return clamped_y(error_of(point)); }
  double clamped_y(double error) const { return y_.at(std::clamp(error > 0 ? error : y_.low, y_.low, y_.high)); }
  bool on_front(std::size_t i) const { return std::find(front_.begin(), front_.end(), i) != front_.end(); }

  void line(const char* kind, double x0, double y0, double x1, double y1) {
    out_ += svg_line(fmt::format("class=\"{}\"", kind), x0, y0, x1, y1);
  }
  void words(const char* kind, const char* anchor, double x, double y, const std::string& text) {
    out_ += svg_text(fmt::format("class=\"{}\"", kind), anchor, x, y, text);
  }

  void draw_axes() {
    for (const double tick : logarithmic_ticks(x_.low, x_.high)) x_.ticks.emplace_back(tick, short_seconds(tick));
    for (const double tick : logarithmic_ticks(y_.low, y_.high)) y_.ticks.emplace_back(tick, fmt::format("{:g}", tick));
    x_.title = fmt::format("processor time of a render (preparing and tracing, {} thread{})", data_.threads,
                           data_.threads == 1 ? "" : "s");
    y_.title = metric_.label;
    out_ += plot_frame(x_, y_);
  }

  void draw_floor() {
    const bool light = metric_.value == &ErrorMetrics::rmse || metric_.value == &ErrorMetrics::p999 ||
                       metric_.value == &ErrorMetrics::maximum;
    if (light && kDisplayStep > y_.low && kDisplayStep < y_.high) {
      const double y = y_.at(kDisplayStep);
      line("grid step", x_.from, y, x_.to, y);
      place("quiet", "end", x_.to - 6, y - 5, "1/255");
    }
    if (!(floor_ > 0)) return;
    const double y = clamped_y(floor_);
    out_ += fmt::format("<rect class=\"below\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"/>\n", kLeft, y,
                        kDrawingWidth - kLeft - kRight, y_.from - y);
    line("floor", x_.from, y, x_.to, y);
    place("floor-text", "start", x_.from + 8, y + 15 < y_.from - 2 ? y + 15 : y - 6,
          fmt::format("the reference's own error: {}", short_number(floor_)));
  }

  /// The values of a knob turned alone, joined from cheap to dear.
  void draw_knobs() {
    std::map<std::string, std::vector<const ChartPoint*>> knobs;
    for (const ChartPoint& point : data_.points)
      if (point.setting.part == SweepPart::ends || point.setting.part == SweepPart::between)
        knobs[point.setting.knob].push_back(&point);
    for (auto& [name, points] : knobs) {
      if (points.size() < 3) continue;
      std::sort(points.begin(), points.end(),
                [](const ChartPoint* a, const ChartPoint* b) { return a->cpu().median < b->cpu().median; });
      out_ += fmt::format("<polyline class=\"knob\" data-knob=\"{}\" points=\"", escaped_html(name));
      for (const ChartPoint* point : points) out_ += fmt::format("{:.1f},{:.1f} ", x_of(*point), y_of(*point));
      out_ += "\"/>\n";
    }
  }

  /// A staircase: what is to be had for a given time.
  void draw_front() {
    if (front_.empty()) return;
    out_ += "<path class=\"front\" d=\"";
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const ChartPoint& point = data_.points[front_[i]];
      out_ += i == 0 ? fmt::format("M{:.1f} {:.1f}", x_of(point), y_of(point))
                     : fmt::format("H{:.1f}V{:.1f}", x_of(point), y_of(point));
    }
    out_ += "\"/>\n";
  }

  void draw_point(std::size_t i) {
    const ChartPoint& point = data_.points[i];
    const bool best = on_front(i);
    const double x = x_of(point), y = y_of(point), error = error_of(point);
    const Spread cpu = point.cpu();
    const char* bar = best ? "bar best" : "bar";
    if (cpu.count > 1) line(bar, x_.at(cpu.low), y, x_.at(cpu.high), y);
    // Root mean squares obey the triangle inequality: the true error is this one, give or take the reference's.
    if (best && metric_.value == &ErrorMetrics::rmse && floor_ > 0 && error > 0)
      line(bar, x, clamped_y(error + floor_), x, clamped_y(std::max(error - floor_, y_.low)));
    out_ += fmt::format("<circle class=\"point{}{}\" data-point=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n",
                        best ? " best" : "", point.setting.part == SweepPart::defaults ? " defaults" : "", i, x, y,
                        best ? 5.5 : 4);
  }

  void draw_points() {
    for (std::size_t i = 0; i < data_.points.size(); ++i)
      if (!on_front(i)) draw_point(i);
    for (const std::size_t i : front_) draw_point(i);
    // Labels keep off points; those of the front foremost.
    for (const std::size_t i : front_) taken_.push_back(around(data_.points[i], 6));
  }

  LabelBox around(const ChartPoint& point, double radius) const {
    const double x = x_of(point), y = y_of(point);
    return {x - radius, y - radius, x + radius, y + radius};
  }

  static LabelBox box_of(const char* anchor, double x, double y, const std::string& text) {
    const double width = kLetterWidth * static_cast<double>(text.size());
    const double left = anchor[0] == 's' ? x : anchor[0] == 'e' ? x - width : x - width / 2;
    return {left, y - kLetterHeight, left + width, y + 3};
  }

  void place(const char* kind, const char* anchor, double x, double y, const std::string& text) {
    taken_.push_back(box_of(anchor, x, y, text));
    words(kind, anchor, x, y, text);
  }

  /// Where its text meets no other and stays in the frame; nowhere else.
  void draw_label(const ChartPoint& point) {
    const std::string text = label_of(point);
    const double x = x_of(point), y = y_of(point);
    struct Place {
      const char* anchor;
      double x, y;
    };
    for (const Place& at : {Place{"start", x + 9, y - 6}, Place{"end", x - 9, y + 15}, Place{"start", x + 9, y + 15},
                            Place{"end", x - 9, y - 6}, Place{"start", x + 12, y - 20}, Place{"end", x - 12, y + 29},
                            Place{"start", x + 16, y - 34}, Place{"end", x - 16, y + 43}}) {
      const LabelBox box = box_of(at.anchor, at.x, at.y, text);
      const bool inside =
          box.left > x_.from + 3 && box.right < x_.to - 3 && box.top > y_.to + 3 && box.bottom < y_.from - 3;
      if (!inside ||
          std::any_of(taken_.begin(), taken_.end(), [&](const LabelBox& other) { return box.overlaps(other); }))
        continue;
      taken_.push_back(box);
      words("label", at.anchor, at.x, at.y, text);
      return;
    }
  }

  void draw_labels() {
    for (const ChartPoint& point : data_.points)
      if (point.setting.part == SweepPart::defaults) draw_label(point);
    for (const std::size_t i : front_)
      if (data_.points[i].setting.part != SweepPart::defaults) draw_label(data_.points[i]);
  }

  const ChartData& data_;
  const MetricInfo& metric_;
  std::vector<std::size_t> front_;
  double floor_;
  PlotAxis x_{}, y_{};
  std::vector<LabelBox> taken_;
  std::string out_;
};

}  // namespace

std::string chart_svg(const ChartData& data, const MetricInfo& metric) { return ChartDrawing(data, metric).text(); }

}  // namespace raytree::benchmarks
