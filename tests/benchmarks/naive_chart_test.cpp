// The chart of row naive is drawn from the row's figures.
#include <gtest/gtest.h>

#include <string>

#include "benchmarks/naive.h"
#include "benchmarks/rows.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;
using test::count_of;

Figure placed(const char* plot, const char* line, double x, double y) {
  Figure figure;
  figure.row = "naive";
  figure.measured = {0.9 * y, y, 1.1 * y, 5};
  figure.place = {plot, line, x};
  return figure;
}

/// Every figure that has a place is in the chart, in its plot, beside the two shares that Whitted reports.
TEST(NaiveChart, ShowsTheRowsFigures) {
  const std::vector<Figure> figures = {
      placed(kRatioPlot, "spheres, one by one", 10, 2),   placed(kSharePlot, "spheres, one by one", 10, 70),
      placed(kRatioPlot, "spheres, one by one", 100, 20), placed(kSharePlot, "spheres, one by one", 100, 97),
      placed(kRatioPlot, kDatabases, 5000, 300),          placed(kRatioPlot, "", 3, 1)};
  const std::string svg = naive_chart_svg(figures);
  EXPECT_EQ(count_of(svg, "</title></circle>"), 5u);
  EXPECT_EQ(count_of(svg, "class=\"line\" stroke=\"#d55e00\" d="), 2u) << "one in each plot, of one color";
  EXPECT_EQ(count_of(svg, ", one by one</text>"), 2u);
  EXPECT_EQ(svg.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\" class=", 0), 0u) << "a file of its own";
  EXPECT_TRUE(contains(svg, "75 %: Whitted 1980") && contains(svg, "95 %"));
  EXPECT_EQ(naive_chart_svg({placed(kRatioPlot, "", 3, 1)}), "");
  for (const Row& row : kRows) EXPECT_EQ(row.chart_svg != nullptr, row.name == std::string("naive")) << row.name;
  const std::string json = figures_json({}, figures);
  EXPECT_TRUE(contains(json, "\"line\": \"spheres, one by one\"") && contains(json, "\"x\": 5000.0"));
}

}  // namespace
}  // namespace raytree::benchmarks
