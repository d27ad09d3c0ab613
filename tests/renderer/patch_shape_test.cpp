// Shapes of type "patches": what scene files give, what is refused by file, line and key, and what it looks like.
#include "renderer/patch_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/patch_reader.h"
#include "renderer/builtin_scenes.h"
#include "renderer/mesh_scene.h"
#include "renderer/scene_reader.h"
#include "tests/patch_samples.h"
#include "tests/reader_checks.h"
#include "tests/renderer/test_scenes.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using namespace test;

SceneDescription scene_with(const std::string& shape) {
  return read_scene("{\"raytree\": 1,\n\"shapes\": {\"it\": {\n" + shape + "}}}", "test.json", "");
}

constexpr const char* kHalfCircle =
    "\"type\": \"patches\", \"positions\": [[0, -1, 0], [0.585786437626905, -1, 0], [1, -0.585786437626905, 0], "
    "[1, 0, 0], [1, 0.585786437626905, 0], [0.585786437626905, 1, 0], [0, 1, 0]], \"weights\": [1, 0.804737854124365, "
    "0.804737854124365, 1, 0.804737854124365, 0.804737854124365, 1], \"lathe\": [[0, 1, 2, 3], [3, 4, 5, 6]]";

PatchesShape shape_of(const SceneDescription& scene) { return std::get<PatchesShape>(scene.shapes.at(0).kind); }

std::vector<SurfacePatch> patches_of(const PatchesShape& shape) {
  Warnings warnings;
  return surface_patches(shape, "", {"test.json", 3, "shapes.it"}, warnings);
}

TEST(PatchShape, IsRead) {
  const PatchesShape shape = shape_of(
      scene_with("\"type\": \"patches\", \"positions\": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], \"weights\": [1, 2, 3],\n"
                 "\"bezier\": [[0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 1]],\n"
                 "\"coons\": [[0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 0, 0]],\n\"lathe\": [[0, 0, 1, 2]],\n"
                 "\"crease_angle\": 30, \"flip\": true, \"degenerate_normals\": \"gouraud\""));
  EXPECT_EQ(shape.crease_angle, 30);
  EXPECT_TRUE(shape.flip);
  EXPECT_EQ(shape.degenerate_normals, DegenerateNormal::gouraud);
  const std::vector<SurfacePatch> patches = patches_of(shape);
  ASSERT_EQ(patches.size(), 1u + 1u + 4u);
  const auto& bezier = std::get<BezierPatch>(patches[0]);
  EXPECT_EQ(bezier.points[2], Vec3d(1, 1, 0));
  EXPECT_EQ(bezier.weights[15], 2);
  const auto& coons = std::get<CoonsPatch>(patches[1]);
  EXPECT_EQ(coons.bottom.points, (std::array<Vec3d, 4>{{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}}}));
  EXPECT_EQ(coons.right.points, (std::array<Vec3d, 4>{{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}}}));
  EXPECT_EQ(coons.top.points, (std::array<Vec3d, 4>{{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}}}));
  EXPECT_EQ(coons.left.points, (std::array<Vec3d, 4>{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 1, 0}}}));
  EXPECT_EQ(coons.left.weights, (std::array<double, 4>{1, 1, 1, 3}));
}

TEST(PatchShape, WhatIsWrongIsRefusedByLineAndKey) {
  const std::string three = "\"positions\": [[0, 0, 0], [1, 0, 0], [-1, 1, 0]]";
  const auto expect_refused = [](const std::string& shape, std::int64_t line, const std::string& part) {
    expect_refusal([&] { scene_with("\"type\": \"patches\", " + shape); }, "test.json", line, part);
  };
  expect_refused("\"flip\": false", 2, "patches need \"file\", or \"positions\"");
  expect_refused(three, 2, "patches need \"file\", or \"positions\" and one of");
  expect_refused("\"lathe\": [[0, 1, 2, 3]]", 2, "patches need");
  expect_refused("\"file\": \"a.bpt\", " + three, 2, "either \"file\" or");
  expect_refused(three + ", \"lathe\": [[0, 1, 1, 3]]", 2, "shapes.it.lathe[0]: index 3 is out of range");
  expect_refused(three + ", \"lathe\": [[0, 1, 1, 2]]", 2, "a radius must not be negative");
  expect_refused(three + ",\n\"bezier\": [[0, 1, 2]]", 4, "expected 16 indices");
  expect_refused(three + ",\n\"coons\": [7]", 4, "expected 12 indices");
  expect_refused(three + ",\n\"coons\": [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1]]", 4, "out of range");
  expect_refused(three + ", \"weights\": [1, 2], \"lathe\": [[0, 1, 1, 1]]", 2, "shapes.it.weights: 2 for 3 positions");
  expect_refused(three + ",\n\"weights\": [1, 0, 1], \"lathe\": [[0, 1, 1, 1]]", 4, "must be greater than 0");
  expect_refused(three + ",\n\"degenerate_normals\": \"phong\"", 4, "known values: limit, first_order, gouraud, none");
  expect_refused(three + ",\n\"patch\": []", 4, "unknown key \"patch\"");
}

TEST(PatchShape, ADescriptionOutOfRangeIsRefusedWhenPrepared) {
  PatchesShape shape;
  shape.positions = {{0, 0, 0}};
  shape.lathe = {{0, 0, 0, 1}};
  expect_refusal([&] { patches_of(shape); }, "test.json", 3, "index 1 of a control point is out of range");
  shape.lathe = {{0, 0, 0, 0}};
  shape.weights = {1, 1};
  expect_refusal([&] { patches_of(shape); }, "test.json", 3, "as many weights as positions");
  shape = {};
  shape.file = "teapot.txt";
  expect_refusal([&] { patches_of(shape); }, "test.json", 3, ".bpt");
  shape.file = "no such teapot.bpt";
  expect_refusal([&] { patches_of(shape); }, "test.json", 3, "no such teapot.bpt");
}

TEST(PatchShape, ATurnedHalfCircleLooksLikeTheSphere) {
  SceneDescription scene = scene_with(kHalfCircle);
  for (const bool flip : {false, true}) {
    constexpr int kSize = 65;
    SceneDescription picture = dark_scene(kSize, front_camera(2.5));
    picture.shapes = scene.shapes;
    picture.render.tessellation.rate = 32;
    std::get<PatchesShape>(picture.shapes[0].kind).flip = flip;
    const RenderResult result = rendered(std::move(picture));
    int seen = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double px = (x + 0.5 - kSize / 2.0) * 2.5 / kSize, py = (kSize / 2.0 - y - 0.5) * 2.5 / kSize;
        const double r2 = px * px + py * py;
        if (r2 > 0.95) continue;
        ++seen;
        const double z = std::sqrt(1 - r2);
        // 32 segments a quarter, at most 3.3 degrees each: a sagitta of 4e-4, over the surface's slope toward the eye.
        EXPECT_NEAR(result.film.plane(ChannelGroup::depth, 0)[pixel_index(result.film, x, y)], 10 - z, 4e-4 / z * 2);
        // Between true normals at corners, interpolation is off by the angle cubed; the place by the sagitta.
        const Rgb normal = color_at(result.film, x, y, ChannelGroup::normal);
        EXPECT_NEAR(normal.r, px, 2e-3) << x << ' ' << y;
        EXPECT_NEAR(normal.g, py, 2e-3);
      }
    EXPECT_GT(seen, 1500);
  }
}

TEST(PatchShape, IsClosedWhereItsPatchesAre) {
  for (const bool open : {false, true}) {
    SceneDescription scene = dark_scene(3, front_camera(2));
    scene.shapes = scene_with(kHalfCircle).shapes;
    if (open) std::get<PatchesShape>(scene.shapes[0].kind).lathe.pop_back();
    MaterialDescription glass;
    glass.name = "glass";
    glass.transmission = Rgb(1);
    scene.materials = {glass};
    scene.shapes[0].material = "glass";
    Warnings warnings;
    prepared(std::move(scene), &warnings);
    EXPECT_EQ(warnings.size(), open ? 1u : 0u);
  }
}

TEST(PatchShape, ABareFileStandsUpright) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "raytree_patch_shape_test.bpt";
  {
    // A square roof, 4 x 2 in x and y, whose middle rises to z = 3.
    std::ofstream file(path);
    file << "1\n3 3\n";
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) file << i * 4 / 3.0 << ' ' << j * 2 / 3.0 << ' ' << (i % 3 && j % 3 ? 3 : 0) << '\n';
  }
  Warnings warnings;
  SceneDescription description = mesh_scene(path.string(), warnings);
  description.render.tessellation.rate = 32;  // its top is a point of the surface then
  std::filesystem::path gone = path;
  const Scene scene = prepared(std::move(description));
  std::filesystem::remove(gone);
  const ShapeSummary& roof = scene.summary.shapes.at(0);
  EXPECT_EQ(roof.kind, "patches");
  EXPECT_EQ(roof.faces_by_size[1], 1);
  // The bicubic's top is 3 (3/4)^2 = 1.6875; y becomes -z.
  EXPECT_NEAR((roof.bounds.min - Vec3d(0, 0, -2)).length(), 0, 1e-5);
  EXPECT_NEAR((roof.bounds.max - Vec3d(4, 1.6875, 0)).length(), 0, 1e-5);
}

TEST(PatchShape, TheBuiltInTeapotIsThePublishedOne) {
  const SceneDescription scene = builtin_scene("teapot");
  const auto teapot = std::find_if(scene.shapes.begin(), scene.shapes.end(),
                                   [](const ShapeDescription& shape) { return shape.name == "teapot"; });
  ASSERT_NE(teapot, scene.shapes.end());
  const std::vector<SurfacePatch> patches = patches_of(std::get<PatchesShape>(teapot->kind));
  EXPECT_EQ(patches.size(), 32u);
  bool looked_at = false;
  for (const auto& path : test_data_files("patches")) {
    if (path.filename() != "newell_teapot.bpt") continue;
    looked_at = true;
    Warnings warnings;
    const std::vector<BezierPatch> published = read_patch_file(path.string(), warnings);
    for (std::size_t i = 0; i < 32; ++i)
      EXPECT_EQ(std::get<BezierPatch>(patches[i]).points, published[i].points) << "patch " << i + 1;
  }
  if (!looked_at) std::fprintf(stderr, "LEFT OUT: the built-in teapot against the published file\n");
}

}  // namespace
}  // namespace raytree
