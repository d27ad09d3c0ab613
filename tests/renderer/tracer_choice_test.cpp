// The choice of the tracer's hierarchy: by rays, by memory, by name, and what a frame is expected to trace.
#include "renderer/tracer_choice.h"

#include <gtest/gtest.h>

#include "geometry/error.h"
#include "geometry/terrain.h"

namespace raytree {
namespace {

/// partners: the share of triangles that have one.
std::string chosen(std::uint64_t primitives, double rays, std::uint64_t memory = 0, double partners = 0) {
  const auto quads = static_cast<std::uint64_t>(double(primitives) * (1 - partners / 2));
  return choose_hierarchy({primitives, quads, rays, memory}).chosen->name;
}

// Pixels must not depend on threads, so what does is never chosen by itself, however much time it saves.
TEST(TracerChoice, WhatDependsOnThreadsIsTakenByNameAlone) {
  for (const double rays : {0.0, 2e6, 1e9})
    for (const std::uint64_t primitives : {0u, 1000u, 10'000'000u})
      for (const double partners : {0.0, 1.0}) EXPECT_NE(chosen(primitives, rays, 0, partners), "quick");
  EXPECT_FALSE(hierarchy_named("quick").chosen->repeatable);
  EXPECT_EQ(chosen(10'000'000, 1e9), "balanced");
  EXPECT_EQ(chosen(1000, 2e6), "balanced");
  EXPECT_EQ(chosen(0, 0), "balanced");
}

TEST(TracerChoice, QuadsAreTakenWhereBuildingCountsAndTrianglesPair) {
  EXPECT_EQ(chosen(10'000'000, 2e6, 0, 1), "quads");
  EXPECT_EQ(chosen(10'000'000, 1e9, 0, 1), "balanced") << "many rays";
  EXPECT_EQ(chosen(1000, 2e6, 0, 1), "balanced") << "building takes no time";
  EXPECT_EQ(chosen(10'000'000, 2e7, 0, 0.3), "balanced") << "few have partners";
}

// What is handed over in fewer bytes is also built sooner.
TEST(TracerChoice, CompactOnesAreTakenForFewRays) { EXPECT_EQ(chosen(10'000'000, 2e6), "compact"); }

TEST(TracerChoice, MemoryIsKept) {
  EXPECT_EQ(chosen(10'000'000, 2e7, 700'000'000), "balanced");
  EXPECT_EQ(chosen(10'000'000, 1e9, 600'000'000, 1), "quads");
  EXPECT_EQ(chosen(10'000'000, 1e9, 400'000'000), "compact");
  EXPECT_EQ(chosen(10'000'000, 1e9, 320'000'000, 1), "compact-quads");
  const HierarchyChoice none = choose_hierarchy({10'000'000, 10'000'000, 1e9, 1000});
  EXPECT_STREQ(none.chosen->name, "compact");
  EXPECT_NE(none.reason.find("more than the memory allowed"), std::string::npos);
}

TEST(TracerChoice, PairsAreCountedWhereTheyMayBeWorthIt) {
  TerrainParameters terrain;
  terrain.triangles = 200'000;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  shapes.meshes[0].mesh = make_terrain(terrain);
  const std::uint64_t triangles = shapes.meshes[0].mesh.triangle_count();
  EXPECT_EQ(hierarchy_demand(shapes, triangles + 5, 1e5, 0).quads, triangles / 2 + 5);
  EXPECT_EQ(hierarchy_demand(shapes, triangles, 1e9, 0).quads, triangles) << "nothing to gain";
}

TEST(TracerChoice, NamesAreTakenOrListed) {
  EXPECT_TRUE(hierarchy_named("compact").chosen->compact);
  EXPECT_EQ(hierarchy_named("compact-quads").chosen->primitives, EmbreeOptions::Primitives::quads);
  EXPECT_EQ(hierarchy_named("quick").chosen->quality, EmbreeOptions::Quality::low);
  try {
    hierarchy_named("best");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("balanced, quads, quick, compact, compact-quads"), std::string::npos);
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
