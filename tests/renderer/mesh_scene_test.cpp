// The scene around a bare mesh: whatever the object's shape, size and place, its projection fills the frame and stays
// inside, and the ground touches it from below.
#include "renderer/mesh_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.h"
#include "geometry/error.h"

namespace raytree {
namespace {

/// Triangles over points on an ellipsoid of these half axes about `origin`, plus one vertex that no face uses.
std::shared_ptr<PolygonMesh> ellipsoid(Vec3d half, Vec3d origin) {
  constexpr int kRings = 24, kSides = 48;
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->origin = origin;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const double a = kPi * i / kRings, b = 2 * kPi * j / kSides;
      mesh->positions.push_back(
          Vec3f(Vec3d(half.x * std::sin(a) * std::cos(b), half.y * std::cos(a), half.z * std::sin(a) * std::sin(b))));
    }
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t j = 0; j < kSides; ++j) {
      const std::uint32_t a = i * kSides + j, b = i * kSides + (j + 1) % kSides;
      for (const std::uint32_t corner : {a, b, a + kSides, b, b + kSides, a + kSides}) mesh->corners.push_back(corner);
    }
  mesh->positions.push_back(Vec3f(Vec3d(1e3 * half.length())));
  return mesh;
}

struct ProjectedBounds {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;  ///< -1 and 1: the frame's edges
  double nearest = 1e300;
};

/// By the camera's definition alone (docs/scene-format.md), not by the way the fit was found.
ProjectedBounds projected_bounds(const PolygonMesh& mesh, const CameraDescription& camera,
                                 const ImageDescription& image) {
  const Vec3d forward = (camera.target - camera.position).normalized();
  const Vec3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const double slope = std::tan(camera.field_of_view * kPi / 360);
  ProjectedBounds box;
  for (const std::uint32_t corner : mesh.corners) {
    const Vec3d to = Vec3d(mesh.positions[corner]) + (mesh.origin - camera.position);
    const double depth = to.dot(forward);
    const double x = to.dot(right) / (depth * slope * image.width / image.height), y = to.dot(up) / (depth * slope);
    box.left = std::min(box.left, x), box.right = std::max(box.right, x);
    box.bottom = std::min(box.bottom, y), box.top = std::max(box.top, y);
    box.nearest = std::min(box.nearest, depth);
  }
  return box;
}

TEST(MeshScene, TheObjectFillsTheFrameWhateverItsShapeSizeAndPlace) {
  const Vec3d shapes[] = {{1, 1, 1},       {1, 0, 1}, {1, 1e-3, 0.5}, {0.02, 1, 0.02}, {1, 0.02, 0.02},
                          {0.02, 0.02, 1}, {0, 1, 1}, {1, 1, 0},      {0.3, 1, 2}};
  const ImageDescription images[] = {{960, 540}, {540, 960}, {500, 500}, {2000, 100}, {100, 2000}};
  for (const Vec3d& shape : shapes)
    for (const double scale : {1e-4, 1.0, 1e6})
      for (const double offset : {0.0, 1e3})  // in sizes of the object
        for (const ImageDescription& image : images) {
          const auto mesh = ellipsoid(shape * scale, Vec3d(offset, -2 * offset, offset / 3) * scale);
          const SceneDescription scene = mesh_scene(mesh, "test.obj", image);
          const ProjectedBounds box = projected_bounds(*mesh, scene.cameras.at(0), image);
          SCOPED_TRACE(testing::Message() << shape << " x " << scale << " offset " << offset << " in " << image.width
                                          << "x" << image.height);
          ASSERT_GT(box.nearest, 0);
          // The camera's position is a double and offsets are 1e3 sizes, so the fit is exact to about 1e-12.
          const double most = 1 - 2 * kMeshSceneMargin;
          EXPECT_GE(box.left, -most - 1e-9);
          EXPECT_LE(box.right, most + 1e-9);
          EXPECT_GE(box.bottom, -most - 1e-9);
          EXPECT_LE(box.top, most + 1e-9);
          const double fill = std::max(box.right - box.left, box.top - box.bottom) / 2;
          EXPECT_GE(fill, .8);
          EXPECT_LE(fill, .96);
        }
}

TEST(MeshScene, FarFromTheOriginTheFitStillHolds) {
  const auto mesh = ellipsoid({1, 2, 1}, {1e6, -1e6, 1e6});
  const SceneDescription scene = mesh_scene(mesh, "test.obj");
  const ProjectedBounds box = projected_bounds(*mesh, scene.cameras.at(0), scene.image);
  EXPECT_NEAR(std::max(box.right - box.left, box.top - box.bottom) / 2, 1 - 2 * kMeshSceneMargin, 1e-6);
}

TEST(MeshScene, TheGroundTouchesTheLowestPointAndNothingLiesInIt) {
  for (const Vec3d& half : {Vec3d(1, 1, 1), Vec3d(1, 0, 1), Vec3d(1e-4, 1e-5, 1e-4), Vec3d(1e6, 2e6, 1e6)}) {
    const SceneDescription scene = mesh_scene(ellipsoid(half, {0, 5 * half.x, 0}), "test.obj");
    const auto& ground = std::get<PlaneShape>(scene.shapes.at(1).kind);
    const double lowest = 5 * half.x - half.y, size = half.length() * 2;
    EXPECT_LT(ground.point.y, lowest);
    EXPECT_GT(ground.point.y, lowest - (half.y > 0 ? 1e-5 : 3e-3) * size);
    EXPECT_EQ(ground.normal, Vec3d(0, 1, 0));
    EXPECT_GT(scene.cameras.at(0).position.y, ground.point.y);
  }
}

TEST(MeshScene, TheGroundMeetsTheBackgroundWithoutAnEdge) {
  const SceneDescription scene = mesh_scene(ellipsoid({1, 1, 1}, {0, 0, 0}), "test.obj");
  const MaterialDescription& ground = scene.materials.at(1);
  const auto& background = std::get<GradientBackground>(scene.background);
  // Whitted's eq. 2 on the unshadowed ground, whose mirrored ray at the horizon sees the horizon.
  Rgb light = scene.ambient;
  for (const LightDescription& each : scene.lights)
    light += each.color * static_cast<float>(-std::get<DirectionalLight>(each.kind).direction.normalized().y);
  const Rgb shade = std::get<Rgb>(ground.diffuse) * light + ground.reflection * background.horizon;
  EXPECT_NEAR(shade.r, background.horizon.r, 1e-5);  // a few float operations on values below 1
  EXPECT_NEAR(shade.g, background.horizon.g, 1e-5);
  EXPECT_NEAR(shade.b, background.horizon.b, 1e-5);
  EXPECT_LT(max_channel(background.horizon), 0.9f);  // leaves room below white
  EXPECT_EQ(ground.highlight.weight, Rgb());         // a highlight would not be constant over the plane
}

TEST(MeshScene, NamesAndMaterialsAreConnected) {
  const auto mesh = ellipsoid({1, 1, 1}, {0, 0, 0});
  const SceneDescription scene = mesh_scene(mesh, "folder/object.ply");
  EXPECT_EQ(scene.name, "folder/object.ply");
  EXPECT_EQ(scene.title, "object.ply");
  EXPECT_EQ(std::get<MeshShape>(scene.shapes.at(0).kind).mesh, mesh);
  for (const ShapeDescription& shape : scene.shapes) {
    bool found = false;
    for (const MaterialDescription& material : scene.materials) found |= material.name == shape.material;
    EXPECT_TRUE(found) << shape.material;
  }
}

TEST(MeshScene, AMeshWithoutFacesIsBadInputThatNamesTheFile) {
  try {
    mesh_scene(std::make_shared<PolygonMesh>(), "empty.obj");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().file, "empty.obj");
  }
}

}  // namespace
}  // namespace raytree
