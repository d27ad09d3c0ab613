// What small pictures say of large ones.
#include "benchmarks/chart/chart_cost.h"

#include <gtest/gtest.h>

#include "renderer/builtin_scenes.h"

namespace raytree::benchmarks {
namespace {

ChartSceneMaker maker(const std::string& name) {
  return [name](const Words&) { return ChartScene{builtin_scene(name), {}}; };
}

// Without an adaptive method and without a tree, rays go with the pixels: the small picture's views are the large
// one's.
TEST(ChartCost, RaysAreCountedBySmallPictures) {
  ChartScene scene = maker("cone")({});
  scene.description.render.antialias.method = Antialiasing::Method::none;
  const double expected = expected_rays(scene, 480, 320, 2, nullptr).value();
  scene.description.image = {480, 320};
  Warnings warnings;
  const ChartRender whole = render_timed(std::move(scene), 2, nullptr, warnings);
  EXPECT_NEAR(expected / static_cast<double>(whole.total_rays()), 1, 0.02);
}

// A tenth of the budget affords a tenth of the pixels, within the steps of the width; a large one shows all.
TEST(ChartCost, PicturesAreAsLargeAsTheBudgetAffords) {
  const auto size = [](const std::string& scene, double budget, int threads) {
    return affordable_size(maker(scene), budget, threads, nullptr).value();
  };
  const ChartSize large = size("rough", 3600, 2), medium = size("rough", 60, 2), small = size("rough", 20, 2);
  EXPECT_EQ(large.width, kWidestChart);
  EXPECT_LT(medium.width, large.width);
  EXPECT_LT(small.width, medium.width);
  EXPECT_GE(small.width, kNarrowestChart);
  EXPECT_EQ(size("rough", 60, 1).width, medium.width) << "by rays, not by time";
  EXPECT_EQ(size("cone", 60, 2).width, kWidestChart) << "a cheap scene";
}

TEST(ChartCost, AStopIsHeeded) {
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(affordable_size(maker("rough"), 60, 1, &stop));
}

}  // namespace
}  // namespace raytree::benchmarks
