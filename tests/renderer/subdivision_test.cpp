// Subdivision cages in scenes: where they come from, whose rules count, what is refused and what is warned of.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "renderer/scene.h"
#include "renderer/scene_reader.h"
#include "tests/reader_checks.h"
#include "tests/temporary_folder.h"

namespace raytree {
namespace {

const std::string kCube =
    R"("positions": [[-1,-1,-1],[1,-1,-1],[-1,1,-1],[1,1,-1],[-1,-1,1],[1,-1,1],[-1,1,1],[1,1,1]],
       "faces": [[0,4,6,2],[1,3,7,5],[0,1,5,4],[2,6,7,3],[0,2,3,1],[4,5,7,6]])";

std::string cube_scene(const std::string& members) {
  // A rate of its own, so that centers of faces are points and halves of the cube have as many triangles.
  return "{\"raytree\": 1, \"render\": {\"tessellation\": {\"rate\": 8}}, \"shapes\": {\"cube\": {\"type\": "
         "\"mesh\", " +
         kCube + ",\n" + members + "}}}";
}

Scene prepared_cage(const std::string& text, Warnings& warnings) {
  return prepare(read_scene(text, "s.json", ""), PrepareOptions(), warnings);
}

Bounds3d bounds_of(const std::string& text) {
  Warnings warnings;
  return prepared_cage(text, warnings).summary.shapes.at(0).bounds;
}

TEST(Subdivision, ASceneMakesACageOfAMesh) {
  // The limit of the cube +-1 reaches as far as its face centers, 68/81.
  const Bounds3d smooth = bounds_of(cube_scene(R"("subdivision": {})"));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(smooth.max[axis], 68.0 / 81, 1e-6);
  EXPECT_EQ(bounds_of(cube_scene(R"("crease_angle": 40)")).max, Vec3d(1, 1, 1));
  // Infinite creases all around the top: it stays flat, z = 1.
  const Bounds3d creased = bounds_of(cube_scene(R"("subdivision": {"creases": [{"vertices": [4, 5, 7, 6, 4]}]})"));
  EXPECT_NEAR(creased.max.z, 1, 1e-6);
  EXPECT_GT(creased.min.z, -0.95);
  EXPECT_NEAR(bounds_of(cube_scene(R"("subdivision": {"crease_angle": 30})")).max.x, 1, 1e-6);
  EXPECT_NEAR(bounds_of(cube_scene(R"("subdivision": {"corners": [{"vertex": 7, "sharpness": 10}]})")).max.x, 1, 1e-6);
  EXPECT_NEAR(bounds_of(cube_scene(R"("subdivision": {"scheme": "bilinear"})")).max.x, 1, 1e-6);
  // A hole leaves no triangles behind.
  Warnings warnings;
  const auto triangles = [&](const std::string& members) {
    return prepared_cage(cube_scene(members), warnings).summary.shapes.at(0).triangles;
  };
  EXPECT_EQ(triangles(R"("subdivision": {"holes": [0, 1, 2]})") * 2, triangles(R"("subdivision": {})"));
  EXPECT_TRUE(warnings.empty());
}

TEST(Subdivision, WhatNothingShowsIsNotTessellated) {
  const auto array_bytes = [](const std::string& use) {
    Warnings warnings;
    const Scene scene = prepared_cage(R"({"raytree": 1, "render": {"tessellation": {"rate": 64}},
        "groups": {"blob": {"shapes": {"cube": {"type": "mesh", "subdivision": {}, )" +
                                          kCube + R"(}}},
                   "pair": {"shapes": {"a": {"type": "instance", "group": "blob"}}}},
        "shapes": {"ball": {"type": "sphere"})" +
                                          use + "}}",
                                      warnings);
    return scene.summary.array_bytes;
  };
  const std::uint64_t triangles = 6 * 2 * 64 * 64;
  EXPECT_LT(array_bytes(""), triangles) << "neither the group nor the group that uses it is used";
  EXPECT_GT(array_bytes(R"(, "it": {"type": "instance", "group": "pair"})"), 12 * triangles);
}

TEST(Subdivision, KeysAreStrict) {
  const auto refusal = [](const std::string& members) {
    try {
      Warnings warnings;
      prepared_cage(cube_scene(members), warnings);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto expect = [&](const std::string& rules, const std::string& part) {
    const std::string text = refusal("\"subdivision\": " + rules);
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.rfind("s.json:", 0), 0u) << text;
    EXPECT_NE(text.find("shapes.cube"), std::string::npos) << text;
  };
  expect(R"({"scheme": "catmull"})", "unknown value \"catmull\"");
  expect(R"({"boundary": "edge"})", "known values");
  expect(R"({"creases": [{"vertices": [0, 1], "sharpness": -1}]})", "out of range");
  expect(R"({"creases": [{"sharpness": 1}]})", "missing key \"vertices\"");
  expect(R"({"creases": [{"vertices": [0, 9]}]})", "names vertex 9; there are 8");
  expect(R"({"creases": [{"vertices": [0]}]})", "two vertices or more");
  expect(R"({"holes": [6]})", "face 6; there are 6 faces");
  expect(R"({"crease_angle": 200})", "out of range");
  expect(R"({"sharp": 1})", "unknown key \"sharp\"");
  expect(R"({"scheme": "loop"})", "face 0 (counted from 0) has 4 corners; the scheme loop takes triangles alone");
  EXPECT_EQ(refusal(R"("subdivision": {"creases": [{"vertices": [0, 4], "sharpness": 2.5}]})"), "accepted");
}

TEST(Subdivision, TagsOfAFileCountWhereTheSceneSubdivides) {
  const test::TemporaryFolder folder;
  folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nt interpolateboundary 1/0/0 1\n");
  const auto scene = [&](const std::string& members, Warnings& warnings) {
    const std::string text =
        R"({"raytree": 1, "shapes": {"square": {"type": "mesh", "file": "square.obj")" + members + "}}}";
    return prepare(read_scene(text, "s.json", folder.folder().string()), PrepareOptions(), warnings)
        .summary.shapes.at(0);
  };
  Warnings warnings;
  // With the tags, corners stay; the scene's rule is the stronger one, and rounds them: (4 p + e1 + e2) / 6.
  EXPECT_NEAR(scene(R"(, "subdivision": {})", warnings).bounds.max.x, 1, 1e-6);
  EXPECT_LT(scene(R"(, "subdivision": {"boundary": "edge_only"})", warnings).bounds.max.x, 0.97);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(scene("", warnings).triangles, 2u);
  EXPECT_EQ(test::found_warning(warnings, "subdivision tags not used"), "1 x0");
}

}  // namespace
}  // namespace raytree
