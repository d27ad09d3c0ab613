// Scattered uses of a group stand on the terrain where the scene says they may, and nowhere else.
#include "renderer/scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/embree_intersector.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

TEST(Scatter, StandsOnTheTerrainsTriangles) {
  // A ray from above the foot of each meets the ground at the foot: within the rounding of the positions.
  const TerrainParameters parameters{20000, 10, 2, 0.5, 3};
  ShapeSet shapes;
  shapes.meshes.push_back({make_terrain(parameters), 0});
  const EmbreeIntersector embree(shapes, EmbreeOptions{});
  ScatterShape scatter;
  scatter.count = 2000, scatter.steepest = 90, scatter.sink = 0;
  const auto uses = scattered(scatter, shapes.meshes[0].mesh, terrain_grid(parameters.triangles));
  ASSERT_EQ(uses.size(), 2000u);
  for (const Matrix44d& use : uses) {
    const Vec3d foot(use[3][0], use[3][1], use[3][2]);
    const Hit hit =
        embree.intersect_one(Vec3f(foot + Vec3d(0, 5, 0)), {0, -1, 0}, std::numeric_limits<float>::infinity());
    ASSERT_NE(hit.geometry, kNoGeometry);
    // Slopes of up to 20 turn half an ulp of x into as much height.
    EXPECT_NEAR(hit.distance, 5, 5e-5) << foot.x << " " << foot.z;
    // Upright, turned about y alone, scaled alike.
    const double scale = use[1][1];
    EXPECT_GE(scale, 0.8);
    EXPECT_LE(scale, 1.2);
    EXPECT_NEAR(std::hypot(use[0][0], use[0][2]), scale, 1e-12);
    EXPECT_NEAR(use.determinant(), scale * scale * scale, 1e-9);
    EXPECT_EQ(use[1][0], 0);
    EXPECT_EQ(use[0][1], 0);
    EXPECT_EQ(use[2][1], 0);
  }
}

TEST(Scatter, FillsTheGroundEvenly) {
  // 4096 places over 64 equal squares: 64 each; of a random spread one in three would be off by more than 8, of these
  // none is off by more than 20.
  const TerrainParameters parameters{2, 8, 0, 0.5, 3};
  ScatterShape scatter;
  scatter.count = 4096;
  int counts[64] = {};
  for (const Matrix44d& use : scattered(scatter, make_terrain(parameters), terrain_grid(2)))
    ++counts[8 * int(use[3][0] + 4) + int(use[3][2] + 4)];
  for (const int count : counts) EXPECT_NEAR(count, 64, 20);
}

TEST(Scatter, KeepsToHeightsSlopesAndClearings) {
  const TerrainParameters parameters{20000, 10, 2, 0.5, 3};
  const TriangleMesh terrain = make_terrain(parameters);
  const TerrainGrid grid = terrain_grid(parameters.triangles);
  ScatterShape scatter;
  scatter.count = 500, scatter.lowest = 0.8, scatter.highest = 1.2, scatter.sink = 0.25;
  for (const Matrix44d& use : scattered(scatter, terrain, grid)) {
    const double ground = use[3][1] + 0.25 * use[1][1];
    EXPECT_GE(ground, 0.8 - 1e-9);
    EXPECT_LE(ground, 1.2 + 1e-9);
  }
  ScatterShape nowhere;
  nowhere.lowest = 100;
  EXPECT_TRUE(scattered(nowhere, terrain, grid).empty());
  nowhere = {};
  nowhere.clearings = 1;
  EXPECT_TRUE(scattered(nowhere, terrain, grid).empty());
  ScatterShape flat;
  flat.count = 300, flat.steepest = 5;
  const auto level = scattered(flat, terrain, grid);
  flat.steepest = 90;
  EXPECT_GT(level.size(), 10u);
  // The same number of tries finds fewer places that are level.
  EXPECT_LT(level.size(), 16 * 300u);
}

TEST(Scatter, IsTheSameEachTimeAndAnotherForAnotherSeed) {
  const TriangleMesh terrain = make_terrain({200, 10, 2, 0.5, 3});
  ScatterShape scatter;
  const auto a = scattered(scatter, terrain, terrain_grid(200)), b = scattered(scatter, terrain, terrain_grid(200));
  scatter.seed = 5;
  const auto c = scattered(scatter, terrain, terrain_grid(200));
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
}

TEST(Scatter, InASceneGivesInstancesAndSaysWhereItFoundTooFewPlaces) {
  SceneDescription scene = dark_scene(8, front_camera(10));
  scene.materials = {material("m", Rgb(0.5f))};
  scene.groups.push_back({"ball", {shape(SphereShape{{0, 0, 0}, 0.1}, "m")}, {}});
  TerrainShape ground;
  ground.triangles = 2000;
  ScatterShape scatter;
  scatter.group = "ball", scatter.terrain = "ground", scatter.count = 50, scatter.steepest = 90;
  // Before the ground it stands on; moved with its own transform.
  scene.shapes = {shape(scatter, "", "balls"), shape(ground, "m", "ground")};
  scene.shapes[0].transform = translation({0, 7, 0});
  Warnings warnings;
  const Scene made = prepared(scene, &warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(made.shapes->instances.size(), 50u);
  EXPECT_EQ(made.shapes->instances[1].object, 2u);
  EXPECT_GT(made.shapes->instances[0].to_scene[3][1], 6.5f);
  std::get<ScatterShape>(scene.shapes[0].kind).lowest = 50;
  prepared(scene, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].count, 50);
  EXPECT_NE(warnings[0].message.find("fewer uses than asked for"), std::string::npos);
}

}  // namespace
}  // namespace raytree
