// The choice of the tracer's hierarchy: by rays, by memory, by name, and what a frame is expected to trace.
#include "renderer/tracer_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/error.h"
#include "geometry/lattice_grids.h"
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

/// Of a mesh that is one lattice; cells: those of a grid, in the mean.
std::string chosen_of_lattice(std::uint64_t triangles, double rays, double cells, std::uint64_t memory = 0) {
  HierarchyDemand demand{triangles, triangles / 2, rays, memory};
  demand.grids = static_cast<std::uint64_t>(double(triangles) / 2 / cells);
  return choose_hierarchy(demand).chosen->name;
}

// Of two that save enough the quicker one, by a twentieth or more.
TEST(TracerChoice, TheQuickestOfThoseThatSaveEnoughIsTaken) {
  HierarchyDemand demand{10'000'000, 5'000'000, 1.7e7, 0};
  demand.grids = 1'600'000;
  EXPECT_STREQ(choose_hierarchy(demand).chosen->name, "grids");
  demand.rays = 4e7;
  EXPECT_STREQ(choose_hierarchy(demand).chosen->name, "quads");
}

TEST(TracerChoice, GridsAreTakenWhereBuildingCountsAndMeshesAreLattices) {
  EXPECT_EQ(chosen_of_lattice(10'000'000, 4e6, 4), "grids");
  EXPECT_EQ(chosen_of_lattice(10'000'000, 4e6, 3), "grids");
  EXPECT_EQ(chosen_of_lattice(10'000'000, 1e9, 4), "balanced") << "many rays";
  EXPECT_EQ(chosen_of_lattice(10'000'000, 2e7, 1.2), "quads") << "grids of one cell";
  EXPECT_EQ(chosen_of_lattice(1000, 2e6, 4), "balanced") << "building takes no time";
  EXPECT_EQ(chosen_of_lattice(10'000'000, 1e9, 4, 150'000'000), "grids") << "nothing else fits";
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

TEST(TracerChoice, PairsAndGridsAreCountedWhereTheyMayBeWorthIt) {
  TerrainParameters terrain;
  terrain.triangles = 200'000;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh = make_terrain(terrain);
  const std::uint64_t triangles = mesh.triangle_count();
  const HierarchyDemand lattice = hierarchy_demand(shapes, triangles + 5, 1e5, 0);
  EXPECT_EQ(lattice.grids, count_grids(mesh.corners).grids + 5);
  EXPECT_EQ(lattice.grid_points, mesh.positions.size());
  EXPECT_EQ(lattice.quads, triangles / 2 + 5);
  EXPECT_STREQ(choose_hierarchy(lattice).chosen->name, "grids");
  const HierarchyDemand many_rays = hierarchy_demand(shapes, triangles, 1e9, 0);
  EXPECT_EQ(many_rays.quads, triangles) << "nothing to gain";
  EXPECT_EQ(many_rays.grids, 0u) << "nothing to gain";

  // The same triangles in another order are pairs, but no lattice.
  for (std::size_t i = 0; i + 12 <= mesh.corners.size(); i += 12)
    std::swap_ranges(&mesh.corners[i], &mesh.corners[i] + 6, &mesh.corners[i] + 6);
  const HierarchyDemand pairs = hierarchy_demand(shapes, triangles, 1e5, 0);
  EXPECT_EQ(pairs.grids, 0u);
  EXPECT_LT(double(pairs.quads), 0.51 * double(triangles));
  EXPECT_STREQ(choose_hierarchy(pairs).chosen->name, "quads");
}

TEST(TracerChoice, NamesAreTakenOrListed) {
  EXPECT_TRUE(hierarchy_named("compact").chosen->compact);
  EXPECT_EQ(hierarchy_named("compact-quads").chosen->primitives, EmbreeOptions::Primitives::quads);
  EXPECT_EQ(hierarchy_named("grids").chosen->primitives, EmbreeOptions::Primitives::grids);
  EXPECT_EQ(hierarchy_named("quick").chosen->quality, EmbreeOptions::Quality::low);
  try {
    hierarchy_named("best");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("balanced, quads, grids, quick, compact, compact-quads"),
              std::string::npos);
  }
}

TEST(TracerChoice, ExpectedRaysFollowTheFrameAndTheScene) {
  SceneDescription scene;
  scene.image = {100, 50};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  scene.lights.resize(2);
  EXPECT_DOUBLE_EQ(expected_rays(scene), 100 * 50 * 4 * (1 + 2 * 0.6));
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
