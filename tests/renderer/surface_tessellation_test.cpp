// What a scene's settings and camera make of a curved shape.
#include "renderer/surface_tessellation.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/error.h"
#include "renderer/camera.h"
#include "tests/geometry/analytic_surfaces.h"

namespace raytree {
namespace {

CameraDescription camera_at(const Vec3d& position) {
  CameraDescription camera;
  camera.position = position;
  camera.target = {0.3, 0.1, 0};
  return camera;
}

SceneDescription scene_seen_from(const Vec3d& eye) {
  SceneDescription scene;
  scene.image = {640, 360};
  scene.cameras = {camera_at(eye)};
  return scene;
}

TEST(SurfaceTessellation, TheViewIsTheCameras) {
  for (const auto projection :
       {CameraDescription::Projection::perspective, CameraDescription::Projection::orthographic}) {
    CameraDescription description = camera_at({2, 3, 8});
    description.projection = projection;
    description.height = 12;
    const Camera camera(description, 640, 360, {0, 0, 0}, {});
    const TessellationView view = world_view(description, {640, 360}, {});
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, -0.5, 2), Vec3d(-1, 1, -3)})
      for (const Vec3d& d : {Vec3d(1e-3, 0, 0), Vec3d(0, 1e-3, 0), Vec3d(0, 0, 1e-3)}) {
        Vec2d before, after;
        ASSERT_TRUE(camera.project(p - d, before) && camera.project(p + d, after));
        // The camera is one of float: pixels of its picture, up to 640, to 1e-4; twice the displacement is about 1.
        EXPECT_NEAR(2 * view.pixels(p, d), std::max((after - before).length(), 0.0),
                    std::max(1e-3, 2 * d.length() / (kDepthSlack * view.pixel)));
        EXPECT_GE(2 * view.pixels(p, d), (after - before).length() - 1e-3);
      }
  }
}

TEST(SurfaceTessellation, TheNearestUseCountsForAll) {
  const SceneDescription scene = scene_seen_from({0, 2, 10});
  const TessellationView view = world_view(scene.cameras[0], scene.image, {});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&](double size) { return Vec3d(number(random), number(random), number(random)) * size; };
  const Bounds3d box({-0.5, -0.25, -1}, {0.5, 0.5, 1});
  for (int run = 0; run < 20; ++run) {
    std::vector<Matrix44d> uses;
    for (int i = 0; i < 5; ++i) {
      Matrix44d m, scale;
      scale.setScale(Vec3d(1, 1, 1) + vector(0.7));
      m.rotate(vector(3));
      m = scale * m;
      m[3][0] = number(random) * 6, m[3][1] = number(random) * 4, m[3][2] = number(random) * 6 - 2;
      uses.push_back(m);
    }
    const ListPlaces places = [&](const auto& function) {
      for (const Matrix44d& use : uses) function(use);
    };
    const TessellationView nearest = nearest_view(view, places, box);
    for (int k = 0; k < 200; ++k) {
      const Vec3d p = box.center() + vector(1) * box.size() * 0.5, d = vector(1e-3);
      for (const Matrix44d& use : uses) {
        TessellationView seen = view;
        seen.to_world = use;
        if ((p * use - view.eye).length() < 1) continue;  // the eye counts as a twentieth of a radius away at least
        EXPECT_GE(nearest.pixels(p, d), seen.pixels(p, d) * (1 - 1e-12));
      }
    }
  }
}

TEST(SurfaceTessellation, OneUseIsSeenAsItIs) {
  const SceneDescription scene = scene_seen_from({0, 2, 10});
  const TessellationView view = world_view(scene.cameras[0], scene.image, {});
  Matrix44d place;
  place.setTranslation(Vec3d(1, 2, 3));
  const TessellationView seen = nearest_view(
      view, [&](const auto& function) { function(place); }, Bounds3d({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(seen.projection, view.projection);
  EXPECT_EQ(seen.to_world, place);
  EXPECT_EQ(nearest_view(view, {}, {}).to_world, Matrix44d());
}

TEST(SurfaceTessellation, RateAndToleranceAreTheScenes) {
  SceneDescription scene = scene_seen_from({0, 3, 8});
  ShapeDescription shape;
  const test::AnalyticSurface surface = test::torus(6, 5);
  ShapeSummary summary;
  Warnings warnings;
  const auto make = [&] {
    return SurfaceTessellation(scene, scene.cameras[0], true).make(surface, shape, {}, summary, warnings);
  };
  std::size_t before = 0;
  for (const double tolerance : {1.0, 0.25}) {
    scene.render.tessellation.tolerance = tolerance;
    const std::size_t count = make().triangle_count();
    EXPECT_EQ(summary.tessellation->triangles, count);
    EXPECT_EQ(summary.tessellation->faces, 30u);
    EXPECT_LE(summary.tessellation->measured->largest.pixels, tolerance);
    EXPECT_LE(summary.tessellation->measured->largest.shading, tolerance);
    EXPECT_GT(count, 2 * before);
    before = count;
  }
  // Half as large in the world: fewer triangles.
  shape.transform.setScale(Vec3d(0.5, 0.5, 0.5));
  EXPECT_LT(make().triangle_count(), before);
  scene.render.tessellation.rate = 3;
  EXPECT_EQ(make().triangle_count(), 30u * 18);
  EXPECT_TRUE(warnings.empty());
}

TEST(SurfaceTessellation, BadSettingsAndCamerasAreRefused) {
  SceneDescription scene = scene_seen_from({0, 3, 8});
  const auto refused = [&] {
    EXPECT_THROW(SurfaceTessellation(scene, scene.cameras[0], false), Error);
    scene = scene_seen_from({0, 3, 8});
  };
  scene.render.tessellation.tolerance = 0;
  refused();
  scene.render.tessellation.tolerance = NAN;
  refused();
  scene.render.tessellation.rate = 1025;
  refused();
  scene.cameras[0].target = scene.cameras[0].position;
  refused();
}

}  // namespace
}  // namespace raytree
