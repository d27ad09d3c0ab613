// What makes Whitted's adaptive sampling look closer: differences as a display shows them, not as light adds up; and
// things that not even the last level's samples meet, which get a ray of their own.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/angle.h"
#include "renderer/adaptive_sampling.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr int kStepSize = 16;

/// Samples that a step between two grays takes: one plane of one normal, so that nothing but its color differs.
std::uint64_t samples_of_step(float left, float right, double threshold) {
  SceneDescription scene = white_on_black(kStepSize);
  CheckerPattern step;
  step.plane = CheckerPattern::Plane::xy;
  step.even = Rgb(left), step.odd = Rgb(right);
  step.size = 1000, step.offset = {0.3, -500};
  step.filtered = false;
  scene.materials = {material("step", step)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "step")};
  scene.render.adaptive.threshold = threshold;
  return rendered(std::move(scene), {ChannelGroup::color}).statistics.samples;
}

constexpr std::uint64_t kCorners = (kStepSize + 1) * (kStepSize + 1);

TEST(AdaptiveJudgment, EqualStepsOfADisplayAreJudgedAlikeInTheDarkAndInTheLight) {
  constexpr double kThreshold = 0.1;
  for (const float dark : {0.0f, 0.01f, 0.1f, 0.4f, 0.8f}) {
    const auto lighter_by = [&](float step) {
      const float shown = display_like(Rgb(dark)).r + step;
      return shown * shown - kDisplayToe;
    };
    EXPECT_EQ(samples_of_step(dark, lighter_by(0.97f * kThreshold), kThreshold), kCorners) << dark;
    // Three rows of squares, at least, are divided in the pixels that the step crosses.
    EXPECT_GT(samples_of_step(dark, lighter_by(1.03f * kThreshold), kThreshold), kCorners + 3 * kStepSize) << dark;
  }
  // In linear light the first of these differs seven times as much as the second.
  EXPECT_EQ(samples_of_step(0.5f, 0.63f, kThreshold), kCorners);
  EXPECT_GT(samples_of_step(0.0f, 0.02f, kThreshold), kCorners);
}

TEST(AdaptiveJudgment, TheScaleFollowsADisplaysCurve) {
  const auto srgb = [](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; };
  const auto shown = [](double x) {
    return double(display_like(Rgb(static_cast<float>(x))).g - display_like(Rgb(0)).g);
  };
  EXPECT_NEAR(shown(1e-6) / 1e-6, 12.92, 0.1) << "the slope at black";
  for (int i = 0; i <= 100; ++i) EXPECT_NEAR(shown(i / 100.0), srgb(i / 100.0), 0.08) << i;
  EXPECT_GT(shown(4), shown(1) + 0.5) << "not clipped above";
}

/// The mean light of spheres that lie anywhere between samples, one in each block of 4 x 4 pixels; `hidden`: behind a
/// black wall. Counts in `lost` the blocks without light.
double light_of_specks(double radius, int levels, bool hidden, int& lost) {
  constexpr int kBlocks = 24, kBlock = 4;
  SceneDescription scene = white_on_black(kBlocks * kBlock);
  scene.render.adaptive.levels = levels;
  scene.materials.push_back(material("black", Rgb(0)));
  std::mt19937 random(28);
  std::uniform_real_distribution<double> place(1, 3);
  for (int i = 0; i < kBlocks * kBlocks; ++i) {
    const double x = kBlock * (i % kBlocks - kBlocks / 2.0) + place(random);
    const double y = kBlock * (kBlocks / 2.0 - i / kBlocks) - place(random);
    scene.shapes.push_back(shape(SphereShape{{x, y, 0}, radius}, "white"));
  }
  if (hidden) scene.shapes.push_back(shape(PlaneShape{{0, 0, 1}, {0, 0, 1}}, "black"));
  const RenderResult result = rendered(std::move(scene), {ChannelGroup::color});
  double sum = 0;
  lost = 0;
  for (int i = 0; i < kBlocks * kBlocks; ++i) {
    double here = 0;
    for (int k = 0; k < kBlock * kBlock; ++k)
      here += color_at(result.film, kBlock * (i % kBlocks) + k % kBlock, kBlock * (i / kBlocks) + k / kBlock).g;
    lost += here <= 0;
    sum += here;
  }
  return sum / (kBlocks * kBlocks);
}

TEST(AdaptiveJudgment, WhatNoSampleMeetsGetsARayAndWeighsItsArea) {
  for (const int levels : {0, 2, 4, 6})
    for (const double share : {0.9, 0.3, 0.05}) {
      // Of half of the distance between the last level's samples.
      const double radius = share * std::pow(0.5, levels + 1);
      int lost = 0;
      const double light = light_of_specks(radius, levels, false, lost);
      EXPECT_EQ(lost, 0) << "levels " << levels << ", radius " << radius;
      // Outlines are polygons.
      EXPECT_NEAR(light / (kPi * radius * radius), 1, 0.02) << "levels " << levels << ", radius " << radius;
      EXPECT_EQ(light_of_specks(radius, levels, true, lost), 0) << "behind something";
    }
}

}  // namespace
}  // namespace raytree
