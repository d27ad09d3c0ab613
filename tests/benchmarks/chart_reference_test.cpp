// A chart's reference takes more samples where its halves differ, and is nearer to the truth for it.
#include "benchmarks/chart/chart_reference.h"

#include <gtest/gtest.h>

#include <numeric>

#include "renderer/builtin_scenes.h"

namespace raytree::benchmarks {
namespace {

constexpr int kWidth = 96, kHeight = 72;

/// Knows of all flags only --antialias grid:N.
ChartScene scene_with_grid(const Words& flags) {
  ChartScene scene{builtin_scene("spheres-1980"), {}};
  scene.description.image = {kWidth, kHeight};
  scene.description.render.antialias = {Antialiasing::Method::grid, 1};
  for (std::size_t i = 0; i + 1 < flags.size(); ++i)
    if (flags[i] == "--antialias") scene.description.render.antialias.grid_size = std::stoi(flags[i + 1].substr(5));
  return scene;
}

ChartReference made(const ReferencePlan& plan) {
  Warnings warnings;
  return std::move(*make_reference(plan, scene_with_grid, DisplayTransform({}), 2, nullptr, warnings));
}

TEST(ChartReference, IsNearerToTheTruthWhereHalvesDiffered) {
  ReferencePlan plan;
  const ChartReference plain = made(plan);
  plan.refined = {2000, 700};
  const ChartReference refined = made(plan);

  Warnings warnings;
  const ChartRender truth = render_timed(scene_with_grid({"--antialias", "grid:40"}), 2, nullptr, warnings);
  const DisplayTransform display({});
  const ChartPicture true_picture = chart_picture(truth.film, display);
  const auto error = [&](const ChartReference& reference) {
    return picture_errors(true_picture, chart_picture(reference.film, display)).rmse;
  };
  EXPECT_LT(error(refined), error(plain) / 2);
  EXPECT_LT(refined.floor.rmse, plain.floor.rmse / 2);
  // What the reference says of its own error is about that error: of pixels where both halves err alike it knows
  // nothing.
  EXPECT_LT(error(plain), plain.floor.rmse);
  EXPECT_LT(error(refined), 2 * refined.floor.rmse);

  // Traced anew: these pixels and no others.
  std::size_t changed = 0;
  for (std::size_t i = 0; i < std::size_t(kWidth) * kHeight; ++i)
    for (int c = 0; c < 3; ++c)
      if (plain.film.plane(ChannelGroup::color, c)[i] != refined.film.plane(ChannelGroup::color, c)[i]) {
        ++changed;
        break;
      }
  EXPECT_GT(changed, 1500u);
  EXPECT_LE(changed, 2700u);
}

// Between facing mirrors that keep k of the light, depth d misses k^(d + 1) / (1 - k) of one's own.
TEST(ChartReference, WhatDeeperTreesWouldChangeIsThatOfFacingMirrors) {
  for (const double k : {0.5, 0.9, 0.97, 0.985}) {
    const auto missing = [k](int depth) { return std::pow(k, depth + 1) / (1 - k); };
    TreeDecay decay;
    EXPECT_EQ(decay.beyond_end(), 0);
    int from = 8;
    for (const int to : {12, 16, 24, 48}) {
      decay.add(from, to, missing(from) - missing(to));
      if (to > 12) {
        EXPECT_NEAR(decay.beyond_start() / missing(from), 1, 1e-6) << k;
        EXPECT_NEAR(decay.beyond_end() / missing(to), 1, 1e-6) << k;
      }
      from = to;
    }
  }
  // One change tells nothing of the next: the slowest decay is assumed, and so it is where changes do not fall.
  TreeDecay one;
  one.add(8, 12, 1);
  EXPECT_NEAR(one.beyond_end(), std::pow(0.99, 4) / (1 - std::pow(0.99, 4)), 1e-9);
  one.add(12, 16, 1);
  EXPECT_NEAR(one.beyond_end(), std::pow(0.99, 4) / (1 - std::pow(0.99, 4)), 1e-6);
  one.add(16, 24, 0);
  EXPECT_EQ(one.beyond_end(), 0);
}

// The mirrored tray and bowl of the teapot's scene reflect each other many times over: what is planned is what a much
// deeper tree shows.
TEST(ChartReference, TheTeapotsTreeIsTracedDeepEnough) {
  const auto make = [](const Words& flags) {
    ChartScene scene{builtin_scene("teapot"), {}};
    scene.description.image = {60, 40};
    scene.description.render.antialias = {Antialiasing::Method::grid, 2};
    for (std::size_t i = 0; i + 1 < flags.size(); ++i)
      if (flags[i] == "--depth") scene.description.render.depth = std::stoi(flags[i + 1]);
    return scene;
  };
  Warnings warnings;
  ChartScene scene = make({});
  const SceneTraits traits = scene_traits(prepare(std::move(scene.description), scene.prepare, warnings));
  const ReferencePlan plan = *plan_reference(make, traits, 60, 40, 60, 2, nullptr);
  EXPECT_LT(plan.depth_residual, 0.001);
}

TEST(ChartReference, LaterRoundsHaveFinerGridsWithoutACommonSample) {
  EXPECT_EQ(grid_of_round(3, 0), 3);
  EXPECT_EQ(grid_of_round(3, 1), 7);
  EXPECT_EQ(grid_of_round(3, 3), 31);
  ReferencePlan plan;
  plan.grid = 5;
  plan.last = {"--depth", "40"};
  EXPECT_EQ(plan.last_flags(1), (Words{"--depth", "40", "--antialias", "grid:12"}));
  ReferencePlan finer = plan;
  finer.refined = {10};
  EXPECT_TRUE(finer.is_as_fine_as(plan));
  EXPECT_FALSE(plan.is_as_fine_as(finer));
  finer.grid = 4;
  EXPECT_FALSE(finer.is_as_fine_as(plan));
}

TEST(ChartReference, ErrorsAreExpectedWhereHalvesDifferAndBesideEdges) {
  Film a(5, 3, {0, 0, 5, 3}, ChannelSet{ChannelGroup::color}), b = a;
  const std::vector<int> rows(15, 4);
  EXPECT_EQ(expected_errors(a, b, rows), std::vector<float>(15, 0.0f));
  const auto set = [](Film& film, std::size_t pixel, float value) {
    film.plane(ChannelGroup::color, 0)[pixel] = value;
  };
  // .03 in linear light, less on the display-like scale.
  for (std::size_t i = 0; i < 15; ++i) set(a, i, 9.0f), set(b, i, 9.0f);
  set(b, 3, 9.03f);
  std::vector<float> errors = expected_errors(a, b, rows);
  EXPECT_NEAR(errors[3], 0.03, 1e-5);
  EXPECT_EQ(errors[2], 0);
  // An edge that both halves show alike: a fifth of it by rows^-1.5, an eighth, on both sides.
  set(a, 0, 1.0f), set(b, 0, 1.0f);
  errors = expected_errors(a, b, rows);
  for (const std::size_t beside : {0, 1, 5, 6}) EXPECT_NEAR(errors[beside], 8.0 / 5 / 8, 1e-5) << beside;
  EXPECT_EQ(errors[2], 0);
  // .01 from black is .07 on the display-like scale.
  const Film black(5, 3, {0, 0, 5, 3}, ChannelSet{ChannelGroup::color});
  Film dim = black;
  set(dim, 7, 0.01f);
  EXPECT_NEAR(expected_errors(black, dim, rows)[7], 0.0685, 1e-3);

  EXPECT_EQ(mask_of_largest({0, 2, 1, 2, 0, 3}, 2, 0), (std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(mask_of_largest({0, 2, 1, 2, 0, 3}, 9, 1), (std::vector<std::uint8_t>{0, 1, 0, 1, 0, 1}));
}

}  // namespace
}  // namespace raytree::benchmarks
