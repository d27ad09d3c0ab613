// What the benchmarks' drawings share: axes, ticks, and lines over a knob.
#include "benchmarks/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;
using test::count_of;

struct DrawnPoint {
  double x, y;
};

/// The circles of a drawing, in order.
std::vector<DrawnPoint> drawn_points(const std::string& svg) {
  std::vector<DrawnPoint> points;
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"[^>]*><title>");
  for (std::sregex_iterator match(svg.begin(), svg.end(), circle), end; match != end; ++match)
    points.push_back({std::stod((*match)[1]), std::stod((*match)[2])});
  return points;
}

LinePlot powers_plot() {
  LinePlot plot;
  plot.title = "A < B", plot.x_label = "objects", plot.y_label = "ratio";
  plot.lines.push_back({"square", {{1, {1, 1, 1, 1}}, {10, {90, 100, 110, 5}}, {100, {9e3, 1e4, 1.1e4, 5}}}});
  return plot;
}

TEST(SvgPlot, TicksAreRoundNumbers) {
  EXPECT_EQ(logarithmic_ticks(0.9, 30), (std::vector<double>{1, 2, 5, 10, 20}));
  EXPECT_EQ(logarithmic_ticks(0.5, 2e4), (std::vector<double>{1, 10, 100, 1000, 10000}));
}

TEST(SvgPlot, AxesAreLogarithmicOrNot) {
  const PlotAxis decades{1, 1000, 100, 400};
  EXPECT_DOUBLE_EQ(decades.at(1), 100);
  EXPECT_DOUBLE_EQ(decades.at(10), 200);
  EXPECT_DOUBLE_EQ(decades.at(1000), 400);
  const PlotAxis upward{0, 100, 300, 0, PlotScale::linear};
  EXPECT_DOUBLE_EQ(upward.at(25), 225);
}

/// A power law is a straight line, and twice as steep for twice the power.
TEST(SvgPlot, APowerLawIsAStraightLine) {
  const std::string svg = line_plots_svg("title", {powers_plot()}, 620, 320);
  const std::vector<DrawnPoint> points = drawn_points(svg);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].x - points[0].x, points[2].x - points[1].x, 0.11);
  EXPECT_NEAR(points[1].y - points[0].y, points[2].y - points[1].y, 0.11);
  EXPECT_LT(points[2].y, points[0].y) << "more is higher";
  EXPECT_EQ(count_of(svg, "class=\"spread\""), 2u) << "a single sample has no quartiles";
  EXPECT_TRUE(contains(svg, "A &lt; B") && contains(svg, ">square<"));
  EXPECT_FALSE(contains(svg, "nan") || contains(svg, "inf"));
}

TEST(SvgPlot, LeavesOutWhatHasNoLogarithm) {
  LinePlot plot = powers_plot();
  plot.lines[0].points = {{1, {0, 0, 0, 1}}, {2, {1, 1, 1, 1}}, {0, {1, 1, 1, 1}}, {3, {NAN, NAN, NAN, 0}}};
  const std::string svg = line_plots_svg("title", {plot}, 620, 320);
  EXPECT_EQ(drawn_points(svg).size(), 1u);
  EXPECT_FALSE(contains(svg, "nan") || contains(svg, "inf")) << svg;
  plot.lines[0].points.clear();
  EXPECT_EQ(line_plots_svg("title", {plot}, 620, 320), "");
}

/// Linear both ways: ticks at round steps about what is shown, below 0, too.
TEST(SvgPlot, LinearAxesHaveRoundTicks) {
  LinePlot plot = powers_plot();
  plot.x_scale = plot.y_scale = PlotScale::linear;
  plot.lines[0].points = {{-1, {-3, -3, -3, 1}}, {0, {0, 0, 0, 1}}, {1, {3, 3, 3, 1}}, {4, {12, 12, 12, 1}}};
  const std::string svg = line_plots_svg("title", {plot}, 620, 320);
  const std::vector<DrawnPoint> points = drawn_points(svg);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_NEAR(points[3].x - points[2].x, 3 * (points[1].x - points[0].x), 0.4);
  EXPECT_NEAR(points[3].y - points[2].y, 3 * (points[1].y - points[0].y), 0.4);
  for (const char* tick : {">-4<", ">0<", ">6<", ">12<", ">-1<", ">3<"}) EXPECT_TRUE(contains(svg, tick)) << tick;
}

TEST(SvgPlot, PlotsStandOneUnderAnotherAndLevelsLieWhereTheySay) {
  LinePlot shares = powers_plot();
  shares.y_scale = PlotScale::linear;
  shares.lines[0].points = {{1, {50, 50, 50, 1}}, {10, {75, 75, 75, 1}}, {100, {100, 100, 100, 1}}};
  shares.levels = {{75, "the paper's"}};
  const std::string svg = line_plots_svg("title", {powers_plot(), shares}, 620, 320);
  EXPECT_TRUE(contains(svg, "viewBox=\"0 0 620 640\""));
  const std::vector<DrawnPoint> points = drawn_points(svg);
  ASSERT_EQ(points.size(), 6u);
  for (int i = 0; i < 3; ++i) EXPECT_LT(points[static_cast<std::size_t>(i)].y, 320);
  const std::regex level("class=\"level\" x1=\"[0-9.]+\" y1=\"([0-9.]+)\"");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, level));
  EXPECT_NEAR(std::stod(match[1]), points[4].y, 0.11);
  EXPECT_NEAR(points[3].y - points[4].y, points[4].y - points[5].y, 0.11);
}

}  // namespace
}  // namespace raytree::benchmarks
