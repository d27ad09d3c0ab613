// The choice of the tracer's hierarchy: by rays, by memory, by name, and what a frame is expected to trace.
#include "renderer/tracer_choice.h"

#include <gtest/gtest.h>

#include "geometry/error.h"

namespace raytree {
namespace {

std::string chosen(std::uint64_t primitives, double rays, std::uint64_t memory = 0) {
  return choose_hierarchy({primitives, rays, memory}).chosen->name;
}

// Pixels must not depend on threads, so what does is never chosen by itself, however much time it saves.
TEST(TracerChoice, WhatDependsOnThreadsIsTakenByNameAlone) {
  EXPECT_EQ(chosen(10'000'000, 2e6), "balanced");
  EXPECT_FALSE(hierarchy_named("quick").chosen->repeatable);
  EXPECT_EQ(chosen(10'000'000, 1e9), "balanced");
  EXPECT_EQ(chosen(1000, 2e6), "balanced");
  EXPECT_EQ(chosen(0, 0), "balanced");
}

TEST(TracerChoice, MemoryIsKept) {
  EXPECT_EQ(chosen(10'000'000, 2e6, 700'000'000), "balanced");
  EXPECT_EQ(chosen(10'000'000, 1e9, 400'000'000), "compact");
  const HierarchyChoice none = choose_hierarchy({10'000'000, 1e9, 1000});
  EXPECT_STREQ(none.chosen->name, "compact");
  EXPECT_NE(none.reason.find("more than the memory allowed"), std::string::npos);
}

TEST(TracerChoice, NamesAreTakenOrListed) {
  EXPECT_TRUE(hierarchy_named("compact").chosen->compact);
  EXPECT_EQ(hierarchy_named("quick").chosen->quality, EmbreeOptions::Quality::low);
  try {
    hierarchy_named("best");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("balanced, quick, compact"), std::string::npos);
  }
}

TEST(TracerChoice, ExpectedRaysFollowTheFrameAndTheScene) {
  SceneDescription scene;
  scene.image = {100, 50};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  scene.lights.resize(2);
  EXPECT_EQ(expected_rays(scene), 100 * 50 * 4 * 3);
  scene.render.shadows = false;
  EXPECT_EQ(expected_rays(scene), 100 * 50 * 4);
  scene.materials.resize(1);
  scene.materials[0].reflection = Rgb(0.5f);
  EXPECT_EQ(expected_rays(scene), 100 * 50 * 4 * 2);
  scene.render.depth = 1;
  EXPECT_EQ(expected_rays(scene), 100 * 50 * 4);
}

}  // namespace
}  // namespace raytree
