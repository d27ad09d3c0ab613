// What the page of the stability suite shows.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/graph_svg.h"
#include "benchmarks/stability/ray_probes.h"
#include "benchmarks/stability/stability_page.h"

namespace raytree::benchmarks {
namespace {

TEST(StabilityPictures, MagnifiedOnesKeepHardPixels) {
  StabilityReport report;
  StabilityEntry entry{{"Group", {1, "one", "Title", "Provoked", "Remedy", "Source", nullptr}}, {}, {}};
  entry.result.pictures.push_back(painted_picture(
      "two by one", 2, 1, [](int x, int) { return gray(x); }, 7));
  report.entries.push_back(entry);
  EXPECT_NE(stability_page(report).find("class=\"hard\""), std::string::npos);
  EXPECT_NE(stability_page(report).find("width=\"14\" height=\"7\""), std::string::npos);
}

TEST(StabilityPictures, PartsAreCutWhereAsked) {
  const StabilityPicture whole =
      painted_picture("", 4, 3, [](int x, int y) { return gray(std::pow((10 * y + x) / 255.0, 2)); });
  const StabilityPicture part = part_of(whole, {1, 1, 2, 2}, 3);
  EXPECT_EQ(part.image.planes[1], (std::vector<std::uint8_t>{11, 12, 21, 22}));
  EXPECT_EQ(part.magnified, 3);
}

TEST(StabilityPictures, DifferencesOfOneBitAreSeen) {
  Film a(3, 1, {0, 0, 3, 1}, {ChannelGroup::color}), b = a;
  b.plane(ChannelGroup::color, 2)[1] = 1e-30f;
  b.plane(ChannelGroup::color, 0)[2] = 1;
  const StabilityPicture picture = difference_picture("", a, b, 1);
  const auto& red = picture.image.planes[0];
  EXPECT_GT(red[1], 2 * red[0]) << "any difference stands out from none";
  EXPECT_GT(red[2], red[1]);
}

TEST(StabilityPictures, NormalsThatAreNoNumbersAreOrange) {
  // x = u, y = v, but for a corner without a normal.
  LitTriangles triangles{quad_of_triangles({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), std::vector<Vec3f>(6, Vec3f(0, 0, 1))};
  triangles.normals[1] = Vec3f(std::numeric_limits<float>::quiet_NaN());
  ParallelView view;
  view.size = 16, view.window = 1.8;
  const auto& red = lit_picture({}, "", triangles, view).image.planes[0];
  const auto orange = static_cast<std::uint8_t>(std::lround(255 * std::sqrt(kFaultColor.r)));
  EXPECT_EQ(red[16 * 15 + 12], orange) << "the triangle below the diagonal has that corner";
  EXPECT_NE(red[3], orange);
}

TEST(StabilityGraphs, TicksStandAtRoundValues) {
  const auto drawn = [](StabilityGraph::Scale scale, std::vector<std::pair<double, double>> points) {
    return graph_svg({"A graph", "x", "y", {{"line", std::move(points)}}, scale, scale});
  };
  const std::string linear = drawn(StabilityGraph::Scale::linear, {{-3, 0}, {7.5, 0.9}});
  for (const char* tick : {">-4<", ">0<", ">8<", ">0.2<", ">1<"})
    EXPECT_NE(linear.find(tick), std::string::npos) << tick << "\n" << linear;
  std::vector<std::pair<double, double>> many;
  for (int i = -20; i <= 20; ++i) many.emplace_back(std::pow(10.0, i), 2);
  const std::string logarithmic = drawn(StabilityGraph::Scale::logarithmic, many);
  for (const char* tick : {">1e-18<", ">1<", ">1e+18<", ">10<"})
    EXPECT_NE(logarithmic.find(tick), std::string::npos) << tick << "\n" << logarithmic;
  EXPECT_EQ(drawn(StabilityGraph::Scale::logarithmic, {{-1, 2}, {1, 0}}), "");
  EXPECT_NE(drawn(StabilityGraph::Scale::linear, {{-1, -2}}), "");
}

}  // namespace
}  // namespace raytree::benchmarks
