// What the picture shows of narrow things: hulls, rectangles and areas against closed forms, and which shapes are
// small.
#include "renderer/small_objects.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/angle.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

TEST(SmallObjects, HullsAreConvexAndHoldTheirPoints) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 100; ++round) {
    std::vector<Vec2d> points(static_cast<std::size_t>(3 + round));
    for (Vec2d& p : points) p = {normal(random), normal(random) * (round % 3 == 0 ? 1e-3 : 1)};
    const std::vector<Vec2d> hull = convex_hull(points);
    ASSERT_GE(hull.size(), 3u);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Vec2d a = hull[i], edge = hull[(i + 1) % hull.size()] - a;
      for (const Vec2d& p : points) EXPECT_GE(edge.x * (p.y - a.y) - edge.y * (p.x - a.x), -1e-12);
    }
    // The narrowest rectangle is no wider than that of any direction, and holds every point.
    const ImageRectangle box = narrowest_rectangle(hull);
    double least = 1e9;
    for (int i = 0; i < 3600; ++i) {
      const double angle = kPi * i / 3600;
      double low = 1e9, high = -1e9;
      for (const Vec2d& p : points) {
        const double v = p.x * std::cos(angle) + p.y * std::sin(angle);
        low = std::min(low, v), high = std::max(high, v);
      }
      least = std::min(least, high - low);
    }
    EXPECT_LE(2 * box.half_width, least + 1e-12);
    EXPECT_GE(2 * box.half_width, least - 0.01);
    for (const Vec2d& p : points) EXPECT_TRUE(box.overlaps(p, 1e-9));
  }
  std::vector<Vec2d> line{{0, 0}, {1, 1}, {2, 2}, {0, 0}};
  EXPECT_LT(convex_hull(line).size(), 3u);
}

TEST(SmallObjects, AreasInSquaresAddUpAndMatchClosedForms) {
  const std::vector<Vec2d> triangle{{0.5, 0.5}, {3.5, 0.5}, {0.5, 4.5}};
  double sum = 0;
  Vec2d moment(0, 0), centroid;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) {
      const double area = area_in_square(triangle, x, y, 1, centroid);
      sum += area;
      if (area <= 0) continue;
      moment += centroid * area;
      EXPECT_TRUE(centroid.x >= x && centroid.x <= x + 1 && centroid.y >= y && centroid.y <= y + 1);
    }
  EXPECT_NEAR(sum, 6, 1e-12);
  EXPECT_NEAR(moment.x / sum, 1.5, 1e-12);
  EXPECT_NEAR(moment.y / sum, 0.5 + 4.0 / 3, 1e-12);
  EXPECT_NEAR(area_in_square(triangle, 0, 0, 1, centroid), 0.25, 1e-12);
  EXPECT_EQ(area_in_square(triangle, 4, 4, 1, centroid), 0);
}

SmallObjects small_objects_of(SceneDescription scene) {
  scene.render.antialias.method = Antialiasing::Method::whitted;
  return std::move(prepared(std::move(scene)).small_objects);
}

TEST(SmallObjects, ThoseNarrowerThanFourPixelsAreFound) {
  SceneDescription scene = dark_scene(100, front_camera(100));
  scene.materials = {material("m", Rgb(1))};
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1.9}, "m"),                       // 0: small
                  shape(SphereShape{{20, 0, 0}, 2.1}, "m"),                      // 1: not
                  shape(DiscShape{{0, 20, 0}, {0, 1, 0.05}, 20}, "m"),           // 2: nearly from its edge
                  shape(DiscShape{{0, -20, 0}, {0, 0, 1}, 20}, "m"),             // 3: not
                  mesh_shape(box_mesh({-30, -30, 0}, {30, -29.9f, 0.1f}), "m"),  // 4: a wire
                  mesh_shape(box_mesh({-30, 30, 0}, {30, 35, 0.1f}), "m"),       // 5: not
                  shape(SphereFlakeShape{2, {-30, 0, 0}, 0.01}, "m"),            // 6: all of it is small
                  shape(SphereFlakeShape{2, {30, 0, 0}, 10}, "m"),               // 7: its spheres are no objects
                  shape(PlaneShape{{0, 0, -50}, {0, 0, 1}}, "m"),                // 8
                  mesh_shape(globe_mesh(0.5, 60, 40), "m")};                     // 9: small, many triangles
  const SmallObjects small = small_objects_of(std::move(scene));
  std::vector<ShapeId> found;
  for (std::uint32_t i = 0; i < small.size(); ++i) {
    found.push_back(small[i].shape);
    if (small[i].shape == 0) {
      EXPECT_NEAR(small[i].width(), 3.8, 0.05);
    }
    if (small[i].shape == 4) {
      EXPECT_NEAR(small[i].width(), 0.1, 1e-5);
      EXPECT_NEAR(small[i].box.half_length, 30, 1e-4);
    }
    if (small[i].shape == 9) {
      EXPECT_NEAR(small[i].width(), 1, 0.01);
    }
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<ShapeId>{0, 2, 4, 6, 9}));
  // The wire lies 30 pixels below the middle: in each tile of that row that it crosses.
  int tiles_of_wire = 0;
  for (int x = 0; x < 100; x += kTileSize)
    for (const std::uint32_t i : small.of_tile(x, 64)) tiles_of_wire += small[i].shape == 4;
  EXPECT_EQ(tiles_of_wire, 3);
}

TEST(SmallObjects, ASphereSeenInPerspectiveCoversItsConeOfTangents) {
  CameraDescription camera;
  camera.position = {1, 2, 3};
  camera.target = {1, 2, -10};
  camera.field_of_view = 90;
  SceneDescription scene = dark_scene(200, camera);
  scene.materials = {material("m", Rgb(1))};
  // In a corner of a wide view, where a circle becomes an ellipse: solid angle over the cosine cubed.
  const Vec3d to_center(8, 7, -10);
  scene.shapes = {shape(SphereShape{camera.position + to_center, 0.1}, "m"),
                  shape(SphereShape{camera.position - to_center, 0.1}, "m")};  // behind the eye
  const SmallObjects small = small_objects_of(std::move(scene));
  ASSERT_EQ(small.size(), 1u);
  const double distance = to_center.length(), cosine = 10 / distance;
  const double expected = kPi * 0.01 / (distance * distance) / (cosine * cosine * cosine) * 100 * 100;
  Vec2d centroid;
  EXPECT_NEAR(area_in_square(small[0].outline, 0, 0, 200, centroid), expected, 1e-3 * expected);
  EXPECT_NEAR(centroid.x, 100 + 80, 0.05);
  EXPECT_NEAR(centroid.y, 100 - 70, 0.05);
}

TEST(Camera, ProjectsPointsToWhereTheirRaysStart) {
  for (const auto projection :
       {CameraDescription::Projection::perspective, CameraDescription::Projection::orthographic}) {
    CameraDescription description;
    description.projection = projection;
    description.position = {3, -2, 5};
    description.target = {-1, 0.5, -7};
    const Camera camera(description, 640, 360, {0, 0, 0}, {});
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {320.5f, 12.25f}, {640.0f, 360.0f}, {-100.0f, 500.0f}}) {
      Vec3f origin, direction;
      camera.ray(x, y, origin, direction);
      Vec2d image;
      ASSERT_TRUE(camera.project(Vec3d(origin + direction * 7.5f), image));
      EXPECT_NEAR(image.x, x, 2e-3);
      EXPECT_NEAR(image.y, y, 2e-3);
    }
    Vec2d image;
    EXPECT_NE(camera.project({7, -4.5, 17}, image), projection == CameraDescription::Projection::perspective);
  }
}

}  // namespace
}  // namespace raytree
