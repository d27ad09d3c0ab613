// What the page of the stability suite shows: every case has a picture or a graph, or is named here as one that has
// nothing to see and says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/graph_svg.h"
#include "benchmarks/stability/ray_probes.h"
#include "benchmarks/stability/stability_page.h"

namespace raytree::benchmarks {
namespace {

/// Cases without a picture; each says why on the page.
const std::set<std::string> kNothingToSee = {"wide-box", "bad-topology", "denormals"};

bool shows_one_color(const DisplayImage& image) {
  return std::all_of(std::begin(image.planes), std::end(image.planes), [](const std::vector<std::uint8_t>& plane) {
    return std::all_of(plane.begin(), plane.end(), [&](std::uint8_t value) { return value == plane[0]; });
  });
}

TEST(StabilityPictures, EveryCaseHasOneOrSaysThatThereIsNothingToSee) {
  StabilityOptions options;
  options.run.effort = kLeastEffort;
  const StabilityReport report = run_stability(stability_cases(), options);
  ASSERT_EQ(report.entries.size(), stability_cases().size());
  std::set<std::string> nothing_to_see;
  for (const StabilityEntry& entry : report.entries) {
    const StabilityResult& result = entry.result;
    SCOPED_TRACE(entry.grouped.what.name);
    EXPECT_EQ(entry.error, "");
    std::set<std::string> captions;
    std::size_t plain = 0;
    for (const StabilityPicture& picture : result.pictures) {
      EXPECT_TRUE(captions.insert(picture.caption).second) << "twice: " << picture.caption;
      EXPECT_GE(picture.magnified, 1);
      plain += shows_one_color(picture.image);
      for (const auto& plane : picture.image.planes)
        EXPECT_EQ(plane.size(),
                  static_cast<std::size_t>(picture.image.width) * static_cast<std::size_t>(picture.image.height));
    }
    // A remedy may leave nothing but paper; a failure may not.
    EXPECT_LE(plain, result.pictures.empty() ? 0 : result.pictures.size() - 1);
    for (const StabilityGraph& graph : result.graphs) EXPECT_NE(graph_svg(graph), "") << graph.title;
    if (result.graphs.empty() && !result.pictures.empty()) {
      EXPECT_GE(result.pictures.size(), 2u) << "a failure beside what?";
    }
    const bool shows = !result.pictures.empty() || !result.graphs.empty();
    EXPECT_NE(shows, !result.nothing_to_see.empty());
    if (!shows) nothing_to_see.insert(entry.grouped.what.name);
  }
  EXPECT_EQ(nothing_to_see, kNothingToSee);
  const std::string page = stability_page(report);
  EXPECT_LT(page.size(), 8u << 20) << "bytes of a page that is sent around";
  std::size_t said = 0;
  for (std::size_t at = page.find("Nothing to see: "); at != std::string::npos;
       at = page.find("Nothing to see: ", at + 1))
    ++said;
  EXPECT_EQ(said, kNothingToSee.size());
}

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
  for (const char* tick : {">-2<", ">0<", ">6<", ">0.2<", ">1<"})
    EXPECT_NE(linear.find(tick), std::string::npos) << tick << "\n" << linear;
  std::vector<std::pair<double, double>> many;
  for (int i = -20; i <= 20; ++i) many.emplace_back(std::pow(10.0, i), 2);
  const std::string logarithmic = drawn(StabilityGraph::Scale::logarithmic, many);
  for (const char* tick : {">1e-20<", ">1<", ">1e20<", ">10<"})
    EXPECT_NE(logarithmic.find(tick), std::string::npos) << tick << "\n" << logarithmic;
  EXPECT_EQ(logarithmic.find(">1e-19<"), std::string::npos) << "forty-one labels would not be legible";
  EXPECT_EQ(drawn(StabilityGraph::Scale::logarithmic, {{-1, 2}, {1, 0}}), "");
  EXPECT_NE(drawn(StabilityGraph::Scale::linear, {{-1, -2}}), "");
}

}  // namespace
}  // namespace raytree::benchmarks
