// The ray tree against closed forms: facing mirrors, slabs, spheres of glass, attenuation; what it counts; how it
// stops; what it does with numbers that are not finite.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <limits>
#include <thread>

#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "geometry/ray_batch.h"
#include "geometry/surface.h"
#include "renderer/optics.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Two mirrors that face each other, each with ambient light of its own; the eye stands between them.
SceneDescription facing_mirrors(float k_s, int depth) {
  SceneDescription scene = dark_scene(4, front_camera(1, 0.5));
  scene.ambient = Rgb(1);
  scene.materials = {material("front", Rgb(0.5f, 0.25f, 0)), material("back", Rgb(0.25f, 0.25f, 1))};
  for (MaterialDescription& m : scene.materials) m.reflection = Rgb(k_s, k_s / 2, k_s / 4);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "front"), shape(PlaneShape{{0, 0, 1}, {0, 0, -1}}, "back")};
  scene.render.depth = depth;
  return scene;
}

TEST(RayTree, FacingMirrorsGiveTheGeometricSum) {
  for (const float k : {0.5f, 0.9f, 1.0f})
    for (const int depth : {1, 2, 3, 8, 60}) {
      const RenderResult result = rendered(facing_mirrors(k, depth));
      Vec3d expected(0, 0, 0), weight(1, 1, 1);
      for (int level = 1; level <= depth; ++level) {
        expected += weight * (level % 2 == 1 ? Vec3d(0.5, 0.25, 0) : Vec3d(0.25, 0.25, 1));
        weight *= Vec3d(k, k / 2, k / 4);
      }
      // A level rounds a few times: relative error grows with the depth.
      expect_color(color_at(result.film, 2, 1),
                   Rgb(static_cast<float>(expected.x), static_cast<float>(expected.y), static_cast<float>(expected.z)),
                   kFloatError * depth * expected.x);
      // Depth N shows N - 1 reflections: rays and the deepest level say so.
      EXPECT_EQ(result.statistics.rays[static_cast<int>(RayKind::reflected)], 16u * static_cast<unsigned>(depth - 1));
      EXPECT_EQ(result.statistics.branches_at_depth_limit, 16u);
      EXPECT_EQ(result.statistics.deepest_level, depth);
    }
}

TEST(RayTree, AThousandLevelsNeedNoStackAndNoTruncation) {
  SceneDescription scene = facing_mirrors(1, 3000);
  const RenderResult result = rendered(scene);
  EXPECT_NEAR(color_at(result.film, 0, 0).r, 1500 * 0.75, 0.1);
  EXPECT_EQ(result.statistics.not_finite_samples, 0u);
  expect_finite(result.film);
}

TEST(RayTree, LinearAttenuationActsOnChildSegmentsAndIsClampedAtZero) {
  for (const double rate : {0.25, 0.75, 1.0, 2.0}) {
    SceneDescription scene = facing_mirrors(0.5f, 3);
    scene.render.distance_attenuation = rate;
    const double share = std::max(0.0, 1 - rate);  // the mirrors are one unit apart
    const double expected = 0.5 + 0.5 * share * (0.25 + 0.5 * share * 0.5);
    EXPECT_NEAR(color_at(rendered(scene).film, 1, 1).r, expected, 4 * kFloatError) << rate;
  }
  // Neither the eye's segment nor a ray that leaves the scene is attenuated.
  SceneDescription scene = dark_scene(4, front_camera(1, 0.9));
  scene.background = ConstantBackground{Rgb(1)};
  scene.materials = {material("m", Rgb(0))};
  scene.materials[0].reflection = Rgb(0.5f);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.render.distance_attenuation = 1;
  EXPECT_NEAR(color_at(rendered(scene).film, 1, 1).r, 0.5, kFloatError);
}

/// A glass slab between z = -thickness and 0; behind it, at z = -2, a wall whose checker tells where a ray arrives.
/// The camera looks at it under the angle i in the x-z plane.
SceneDescription slab_scene(double angle, double thickness, bool mesh) {
  CameraDescription camera = front_camera(1e-3);
  camera.position = Vec3d(std::sin(angle), 0, std::cos(angle)) * 5.0;
  SceneDescription scene = dark_scene(2, camera);
  scene.materials = {material("glass", Rgb(0)), material("wall", Rgb(0))};
  scene.materials[0].transmission = Rgb(1);
  scene.materials[0].index_of_refraction = 1.5;
  if (mesh)
    scene.shapes = {mesh_shape(box_mesh({-50, -50, static_cast<float>(-thickness)}, {50, 50, 0}), "glass")};
  else
    scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "glass"),
                    shape(PlaneShape{{0, 0, -thickness}, {0, 0, -1}}, "glass")};
  scene.shapes.push_back(shape(PlaneShape{{0, 0, -2}, {0, 0, 1}}, "wall"));
  return scene;
}

TEST(RayTree, ASlabShiftsARayByItsClosedForm) {
  const double thickness = 0.5, n = 1.5;
  for (const bool mesh : {false, true})
    for (const double degrees : {10.0, 30.0, 50.0, 70.0}) {
      const double i = degrees * kDegree, t = std::asin(std::sin(i) / n);
      const double shift = thickness * std::sin(i - t) / std::cos(t);
      // The shift is measured across the ray; along the wall it is shift / cos i.
      const double straight = -2 * std::tan(i);  // the ray travels toward -x
      const double arrives = straight + shift / std::cos(i);
      // A wall that is white from x on and black before it, moved over the expected place, tells to within `step`.
      // Hit points and directions are off by up to 1e-6 of distances of about 10; at 70 degrees times 1 / cos i^2.
      const double step = 1e-4;
      for (const int side : {-1, 1}) {
        SceneDescription scene = slab_scene(i, thickness, mesh);
        CheckerPattern edge;
        edge.plane = CheckerPattern::Plane::xy;
        edge.even = Rgb(1), edge.odd = Rgb(0);
        edge.size = 100;
        // Pixels lie .25e-3 / cos i about the center: the edge is judged against the pixel's own ray.
        const double pixel = -0.25e-3 / std::cos(i);
        edge.offset = {arrives + pixel + side * step, -50};
        scene.materials[1].diffuse = edge;
        scene.ambient = Rgb(1);
        const RenderResult result = rendered(scene);
        EXPECT_EQ(color_at(result.film, 0, 0).r, side < 0 ? 1 : 0)
            << degrees << " degrees, mesh " << mesh << ", side " << side;
      }
    }
}

TEST(RayTree, FresnelSlabReflectsAndTransmitsTheTextbooksTotals) {
  // Infinitely many bounces inside: R_total = 2R / (1 + R), T_total = (1 - R) / (1 + R).
  for (const double degrees : {0.0, 30.0, 56.3099, 80.0}) {
    const double i = degrees * kDegree;
    SceneDescription scene = slab_scene(i, 0.5, false);
    scene.shapes.pop_back();
    if (degrees == 0) scene.cameras[0].up = {0, 1, 0};
    scene.materials[0].reflection = scene.materials[0].transmission = Rgb(1);
    scene.render.fresnel = true;
    scene.render.depth = 24;
    scene.background = ConstantBackground{Rgb(1)};
    // With light from everywhere the two totals add up to all of it.
    EXPECT_NEAR(color_at(rendered(scene).film, 0, 0).r, 1, 1e-5) << degrees;

    // Dark walls above and below take one of the two each.
    const double r = fresnel_reflectance(std::cos(i), 1.5);
    SceneDescription reflected = scene;
    reflected.shapes.push_back(shape(PlaneShape{{0, 0, -2}, {0, 0, 1}}, "wall"));
    EXPECT_NEAR(color_at(rendered(reflected).film, 0, 0).r, 2 * r / (1 + r), 1e-5) << degrees;
  }
}

TEST(RayTree, TheFresnelSwitchOfAMaterialOverridesTheScenes) {
  SceneDescription scene = dark_scene(2, front_camera(1e-3));
  scene.background = ConstantBackground{Rgb(1)};
  scene.materials = {material("m", Rgb(0))};
  scene.materials[0].reflection = Rgb(0.5f, 1, 0.25f);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.render.depth = 2;
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(0.5f, 1, 0.25f), 0);
  scene.render.fresnel = true;
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(0.02f, 0.04f, 0.01f), kFloatError);
  scene.materials[0].fresnel = false;
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(0.5f, 1, 0.25f), 0);
  scene.render.fresnel = false;
  scene.materials[0].fresnel = true;
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(0.02f, 0.04f, 0.01f), kFloatError);
}

TEST(RayTree, ColoredCoefficientsMultiplyPerChannelDownTheTree) {
  SceneDescription scene = slab_scene(0.4, 0.5, false);
  scene.materials[0].transmission = Rgb(1, 0.5f, 0.25f);
  scene.materials[1].diffuse = Rgb(1, 1, 0.5f);
  scene.ambient = Rgb(1);
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(1, 0.25f, 0.03125f), kFloatError);
}

TEST(RayTree, ACameraInsideGlassSeesTheOutsideThroughTheSurface) {
  // The eye a = .5 off the center of a glass sphere: under the angle p from the outward axis the ray meets the surface
  // at i with sin i = a sin p, leaves at t with sin t = 1.5 sin i, or is totally reflected.
  CameraDescription camera;
  camera.position = {0, 0, 0.9};
  camera.target = {1, 0, 0.9};
  camera.field_of_view = 20;
  SceneDescription scene = dark_scene(64, camera);
  scene.materials = {material("glass", Rgb(0))};
  scene.materials[0].transmission = Rgb(1);
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "glass")};
  scene.background = GradientBackground{Rgb(0), Rgb(0), Rgb(1)};
  for (const double index : {1.5, 1.0}) {
    scene.materials[0].index_of_refraction = index;
    const RenderResult result = rendered(scene);
    const double pixel = 2 * std::tan(10 * kDegree) / 64;
    int total = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        // The camera looks along +x, up is +y, right is +z.
        const Vec3d d = unit(Vec3d(1, (32 - y - 0.5) * pixel, (x + 0.5 - 32) * pixel)), o(0, 0, 0.9);
        const double b = o.dot(d), t = -b + std::sqrt(b * b - o.dot(o) + 1);
        const Vec3d p = o + d * t;
        const auto exit = refracted_direction(d, -unit(p), index);
        const double cos_out = exit ? exit->dot(p) : 0;
        if (cos_out < 0.05 && exit) continue;  // conditioning at the critical angle
        total += !exit;
        EXPECT_NEAR(color_at(result.film, x, y).r, exit ? std::max(0.0, exit->y) : 0, 4e-6 / std::max(cos_out, 0.05))
            << x << " " << y;
      }
    if (index == 1.5) {
      EXPECT_GT(total, 500);
    }
    if (index == 1.0) {
      EXPECT_EQ(total, 0);
    }
  }
}

TEST(RayTree, AGlassSphereFocusesAsABallLens) {
  // Near the axis a ray at height h leaves toward the focus n D / (4 (n - 1)) from the center.
  SceneDescription scene = dark_scene(2, front_camera(0.02, 3));
  scene.materials = {material("glass", Rgb(0))};
  scene.materials[0].transmission = Rgb(1);
  scene.materials[0].index_of_refraction = 1.5;
  scene.background = GradientBackground{Rgb(1), Rgb(0), Rgb(0)};
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "glass")};
  const double h = 0.005, focus = 1.5 * 2 / (4 * 0.5);
  // The upper pixel's ray runs down: its direction's y is -h / f to first order, (h/f)^3 in the next.
  EXPECT_NEAR(color_at(rendered(scene).film, 0, 0).r, h / focus, 1e-6);
}

TEST(RayTree, ChannelsDescribeTheFirstHit) {
  SceneDescription scene = dark_scene(32, front_camera(4, 10));
  scene.background = ConstantBackground{Rgb(0.5f)};
  scene.materials = {material("red", Rgb(1, 0, 0)), material("mirror", Rgb(0, 0, 0.5f))};
  scene.materials[1].reflection = Rgb(1);
  scene.shapes = {shape(SphereShape{{-1, 0, 0}, 0.75}, "red"), shape(DiscShape{{1, 0, 1}, {0, 0, -2}, 0.75}, "mirror")};
  const RenderResult result = rendered(scene);
  const Film& film = result.film;
  int sphere = 0, disc = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double px = (x + 0.5 - 16) / 8, py = (16 - y - 0.5) / 8;
      const double from_sphere = std::hypot(px + 1, py), from_disc = std::hypot(px - 1, py);
      const std::size_t i = pixel_index(film, x, y);
      const auto plane = [&](ChannelGroup group, int p) { return film.plane(group, p)[i]; };
      if (from_sphere < 0.75) {
        ++sphere;
        const double z = std::sqrt(0.75 * 0.75 - from_sphere * from_sphere);
        EXPECT_EQ(film.id_plane(ChannelGroup::object_id)[i], 1u);
        EXPECT_EQ(film.id_plane(ChannelGroup::material_id)[i], 1u);
        EXPECT_NEAR(plane(ChannelGroup::depth, 0), 10 - z, 1e-5);
        EXPECT_NEAR(plane(ChannelGroup::normal, 0), (px + 1) / 0.75, 1e-5);
        EXPECT_NEAR(plane(ChannelGroup::normal, 2), z / 0.75, 1e-5);
        expect_color(color_at(film, x, y, ChannelGroup::albedo), Rgb(1, 0, 0), 0);
      } else if (from_disc < 0.75) {
        ++disc;
        EXPECT_EQ(film.id_plane(ChannelGroup::object_id)[i], 2u);
        EXPECT_EQ(film.id_plane(ChannelGroup::material_id)[i], 2u);
        EXPECT_NEAR(plane(ChannelGroup::depth, 0), 9, 1e-5);
        EXPECT_EQ(plane(ChannelGroup::normal, 2), 1);  // turned to the viewer
        EXPECT_EQ(film.id_plane(ChannelGroup::ray_count)[i], 2u);
        expect_color(color_at(film, x, y), Rgb(0.5f), 0);
      } else {
        EXPECT_EQ(film.id_plane(ChannelGroup::object_id)[i], 0u);
        EXPECT_EQ(plane(ChannelGroup::alpha, 0), 0);
        EXPECT_EQ(film.id_plane(ChannelGroup::ray_count)[i], 1u);
      }
    }
  EXPECT_GT(sphere, 50);
  EXPECT_GT(disc, 50);
  expect_finite(film);
}

TEST(RayTree, RayCountsOfThePixelsAddUpToTheStatistics) {
  SceneDescription scene = slab_scene(0.5, 0.5, true);
  scene.image = {70, 45};
  scene.cameras[0].height = 3;
  scene.materials[0].reflection = Rgb(0.2f);
  scene.materials[1].diffuse = Rgb(0.5f);
  scene.lights = {directional_light({0.3, -1, -0.5}), point_light({3, 2, 4})};
  for (const int grid : {1, 2, 3}) {
    scene.render.antialias = {Antialiasing::Method::grid, grid};
    SceneDescription copy = scene;
    copy.shapes[0] = mesh_shape(box_mesh({-50, -50, -0.5f}, {50, 50, 0}), "glass");
    const RenderResult result = rendered(std::move(copy));
    std::uint64_t sum = 0;
    for (int i = 0; i < 70 * 45; ++i) sum += result.film.id_plane(ChannelGroup::ray_count)[i];
    EXPECT_EQ(sum, result.statistics.total_rays());
    EXPECT_EQ(result.statistics.samples, static_cast<std::uint64_t>(70 * 45 * grid * grid));
    EXPECT_EQ(result.statistics.rays[0], result.statistics.samples);
    EXPECT_GT(result.statistics.rays[static_cast<int>(RayKind::refracted)], 0u);
  }
}

TEST(RayTree, AGridOfSamplesIsTheirMean) {
  // An edge through the middle of a cell column: with grid N the pixel's share is a whole number of columns.
  SceneDescription scene = dark_scene(8, front_camera(8));
  CheckerPattern edge;
  edge.filtered = false;
  edge.plane = CheckerPattern::Plane::xy;
  edge.even = Rgb(1), edge.odd = Rgb(0);
  edge.size = 1000;
  edge.offset = {0.6, -500};
  scene.ambient = Rgb(1);
  scene.materials = {material("m", edge)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  for (const int n : {1, 2, 4, 5}) {
    scene.render.antialias = {Antialiasing::Method::grid, n};
    const RenderResult result = rendered(scene);
    int columns = 0;
    for (int i = 0; i < n; ++i) columns += (i + 0.5) / n > 0.6;
    EXPECT_FLOAT_EQ(color_at(result.film, 4, 3).r, static_cast<float>(columns) / static_cast<float>(n)) << n;
    EXPECT_EQ(color_at(result.film, 3, 3).r, 0);
    EXPECT_EQ(color_at(result.film, 5, 3).r, 1);
  }
}

// --- numbers that are not finite ---

SceneDescription sphere_on_floor(int size = 16) {
  SceneDescription scene = dark_scene(size, front_camera(4));
  scene.background = ConstantBackground{Rgb(0.25f)};
  scene.ambient = Rgb(0.1f);
  scene.materials = {material("m", Rgb(0.5f)), material("mirror", Rgb(0.1f))};
  scene.materials[1].reflection = Rgb(0.5f);
  scene.lights = {directional_light({0, -1, -1})};
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "mirror"), shape(PlaneShape{{0, -1, 0}, {0, 1, 0}}, "m")};
  return scene;
}

TEST(NotFinite, ColorsThatAreNotNumbersCountZeroAndAreReported) {
  for (const float poison : {kNan, kInfinity, -kInfinity}) {
    SceneDescription scene = sphere_on_floor();
    scene.materials[1].diffuse = Rgb(poison, 0, 0);
    const RenderResult result = rendered(scene);
    expect_finite(result.film);
    EXPECT_GT(result.statistics.not_finite_samples, 0u);
    EXPECT_LT(result.statistics.not_finite_samples, 256u);
    EXPECT_EQ(color_at(result.film, 8, 8), Rgb(0));
    // What does not see the sphere is as it was.
    EXPECT_EQ(color_at(result.film, 0, 0), color_at(rendered(sphere_on_floor()).film, 0, 0));
  }
  SceneDescription scene = sphere_on_floor();
  scene.background = ConstantBackground{Rgb(0, kNan, 0)};
  const RenderResult background = rendered(scene);
  expect_finite(background.film);
  EXPECT_GT(background.statistics.not_finite_samples, 0u);
  scene = sphere_on_floor();
  scene.lights[0].color = Rgb(kInfinity, 1, 1);
  const RenderResult light = rendered(scene);
  expect_finite(light.film);
  EXPECT_GT(light.statistics.not_finite_samples, 0u);
}

TEST(NotFinite, OneBadSampleOfAPixelTakesOnlyItsShare) {
  // Half of the checker is poisoned; with grid:2 a pixel on the edge keeps the other half of its samples.
  SceneDescription scene = dark_scene(2, front_camera(2));
  CheckerPattern edge;
  edge.plane = CheckerPattern::Plane::xy;
  edge.even = Rgb(kNan), edge.odd = Rgb(1);
  edge.filtered = false;
  edge.size = 1000;
  edge.offset = {0.5, -500};
  scene.ambient = Rgb(1);
  scene.materials = {material("m", edge)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  const RenderResult result = rendered(scene);
  EXPECT_EQ(color_at(result.film, 1, 0).r, 0.5f);
  EXPECT_EQ(color_at(result.film, 0, 0).r, 1);
  EXPECT_EQ(result.statistics.not_finite_samples, 4u);
  expect_finite(result.film);
}

TEST(NotFinite, PatternsAndBumpsOfAnySizeGiveNumbers) {
  for (const double size : {1e-300, 1e-18, 1e-6, 1.0, 1e6, 1e18})
    for (const auto method : {Antialiasing::Method::none, Antialiasing::Method::whitted}) {
      SceneDescription scene = sphere_on_floor();
      scene.cameras[0].position = {0, 1, 10};  // sees the floor up to the horizon
      scene.cameras[0].target = {0, 1 - 1e-3, 0};
      scene.cameras[0].projection = CameraDescription::Projection::perspective;
      scene.render.antialias.method = method;
      scene.render.adaptive.levels = 1;
      StripesPattern stripes;
      stripes.size = size;
      NoisePattern noise;
      noise.size = size, noise.octaves = 3;
      CheckerPattern checker;
      checker.size = size;
      for (const ColorPattern& pattern : {ColorPattern(stripes), ColorPattern(noise), ColorPattern(checker)})
        for (const auto kind : {BumpDescription::Kind::noise, BumpDescription::Kind::wrinkles,
                                BumpDescription::Kind::ripples, BumpDescription::Kind::stripes})
          for (const double amplitude : {1e-18, 1.0, -1e18}) {
            for (MaterialDescription& m : scene.materials) {
              m.diffuse = pattern;
              m.bump = BumpDescription{kind, amplitude, size};
            }
            const RenderResult result = rendered(scene);
            ASSERT_EQ(result.statistics.not_finite_samples, 0u) << size << " " << amplitude;
            expect_finite(result.film);
          }
    }
}

TEST(NotFinite, RaysThatAreNotFiniteAreReportedAndAreNotBackground) {
  Scene scene = prepared(sphere_on_floor());
  CameraDescription camera = front_camera(4);
  camera.position = {0, 0, 10};
  // A scene origin that is not a number poisons every eye ray's origin.
  scene.camera = Camera(camera, 16, 16, {0, std::numeric_limits<double>::infinity(), 0}, {});
  RenderOptions options;
  options.channels = all_channels();
  const RenderResult result = render(scene, options);
  EXPECT_EQ(result.statistics.not_finite_samples, 256u);
  EXPECT_EQ(color_at(result.film, 4, 4), Rgb(0));
  expect_finite(result.film);
}

TEST(NotFinite, ALightWhereTheEyeOrTheSurfaceIsGivesNoNan) {
  SceneDescription scene = dark_scene(5, front_camera(5, 10));
  scene.materials = {material("m", Rgb(0.5f))};
  scene.materials[0].highlight = {Rgb(0.5f), 20};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  // At the very point that the middle pixel sees; then at the eye.
  for (const Vec3d& place : {Vec3d(0, 0, 0), Vec3d(0, 0, 10)})
    for (const HighlightForm form : {HighlightForm::reflected, HighlightForm::halfway}) {
      scene.lights = {point_light(place)};
      scene.render.highlights = form;
      const RenderResult result = rendered(scene);
      EXPECT_EQ(result.statistics.not_finite_samples, 0u);
      expect_finite(result.film);
      if (place.z > 0) {
        EXPECT_NEAR(color_at(result.film, 2, 2).r, 1, kFloatError);
      }
    }
}

TEST(NotFinite, VertexNormalsThatCancelOrAreNotNumbersFallBackToTheFacet) {
  for (const int poison : {0, 1, 2}) {
    auto mesh = triangles({{-4, -4, 0}, {4, -4, 0}, {0, 4, 0}}, {0, 1, 2});
    SceneDescription description = dark_scene(16, front_camera(2));
    description.background = ConstantBackground{Rgb(0.25f)};
    description.materials = {material("m", Rgb(0.5f))};
    description.materials[0].reflection = description.materials[0].transmission = Rgb(0.5f);
    description.lights = {directional_light({0, 0, -1})};
    description.shapes = {mesh_shape(mesh, "m")};
    Scene scene = prepared(description);
    auto shapes = std::make_unique<ShapeSet>(*scene.shapes);
    const Vec3f bad = poison == 0 ? Vec3f(0, 0, 0) : poison == 1 ? Vec3f(kNan, 0, 1) : Vec3f(0, 0, kInfinity);
    shapes->meshes[0].mesh.normals.assign(3, bad);
    scene.intersector.reset();
    scene.shapes = std::move(shapes);
    scene.intersector = std::make_unique<EmbreeIntersector>(*scene.shapes, EmbreeOptions{});
    RenderOptions options;
    options.channels = all_channels();
    const RenderResult result = render(scene, options);
    expect_finite(result.film);
    EXPECT_NEAR(color_at(result.film, 8, 8).r, 0.5 + 0.25 * 0.5 + 0.25 * 0.5, kFloatError) << poison;
  }
}

TEST(NotFinite, ABoundTooLargeForFloatCutsNoNan) {
  // A material that nothing wears makes green's bound overflow: (rho = 4)^200. The mirrors' green weight is 0, and 0
  // times that bound is 0.
  SceneDescription scene = facing_mirrors(0.5f, 200);
  for (MaterialDescription& m : scene.materials) {
    m.diffuse = Rgb(1);
    m.reflection = Rgb(0.5f, 0, 0);
  }
  scene.materials.push_back(material("unused", Rgb(1)));
  scene.materials[2].reflection = Rgb(0, 4, 0);
  scene.render.cutoff = 0.01;
  const RenderResult result = rendered(scene);
  expect_finite(result.film);
  const Rgb truncation = color_at(result.film, 1, 1, ChannelGroup::truncation);
  EXPECT_GT(truncation.r, 0);
  EXPECT_LE(truncation.r, 0.01f);
  EXPECT_EQ(truncation.g, 0);
  EXPECT_NEAR(color_at(result.film, 1, 1).r, 2, 0.01);
  EXPECT_EQ(color_at(result.film, 1, 1).g, 1);
}

// --- stopping, windows ---

TEST(Stop, EndsARenderPromptlyAndSaysSo) {
  SceneDescription scene = sphere_on_floor(1024);
  scene.render.antialias = {Antialiasing::Method::grid, 16};  // seconds of work
  const Scene ready = prepared(scene);
  std::atomic<bool> stop{false};
  RenderOptions options;
  options.stop = &stop;
  std::chrono::steady_clock::time_point asked;
  std::thread interrupter([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    asked = std::chrono::steady_clock::now();
    stop = true;
  });
  const RenderResult result = render(ready, options);
  const auto ended = std::chrono::steady_clock::now();
  interrupter.join();
  EXPECT_FALSE(result.complete);
  EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 1.0);
  EXPECT_LT(result.statistics.samples, 1024u * 1024 * 256);
}

TEST(Stop, IsHeardWithinOneDeepTile) {
  // One tile whose tree takes very long: 2^30 rays a sample if nothing stopped it.
  SceneDescription scene = dark_scene(32, front_camera(1, 0.5));
  scene.materials = {material("m", Rgb(0))};
  scene.materials[0].reflection = scene.materials[0].transmission = Rgb(0.5f);
  scene.materials[0].index_of_refraction = 1;
  scene.background = ConstantBackground{Rgb(1)};
  for (int i = 0; i < 64; ++i) scene.shapes.push_back(shape(PlaneShape{{0, 0, -i * 1.0}, {0, 0, 1}}, "m"));
  scene.render.depth = 60;
  const Scene ready = prepared(scene);
  std::atomic<bool> stop{false};
  RenderOptions options;
  options.stop = &stop;
  std::chrono::steady_clock::time_point asked;
  std::thread interrupter([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    asked = std::chrono::steady_clock::now();
    stop = true;
  });
  const RenderResult result = render(ready, options);
  const auto ended = std::chrono::steady_clock::now();
  interrupter.join();
  EXPECT_FALSE(result.complete);
  EXPECT_LT(std::chrono::duration<double>(ended - asked).count(), 1.0);
}

TEST(Stop, SetBeforehandTracesAndPreparesNothing) {
  std::atomic<bool> stop{true};
  RenderOptions options;
  options.stop = &stop;
  const RenderResult result = render(prepared(sphere_on_floor()), options);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.statistics.total_rays(), 0u);
  PrepareOptions preparing;
  preparing.stop = &stop;
  EXPECT_THROW(prepared(sphere_on_floor(), nullptr, preparing), Error);
}

TEST(Render, ReportsEveryTileAndRefusesAWindowOutsideTheFrame) {
  const Scene scene = prepared(sphere_on_floor(100));
  RenderOptions options;
  std::uint64_t calls = 0, rays = 0;
  options.on_progress = [&](const RenderProgress& progress) {
    EXPECT_EQ(progress.tiles_done, ++calls);
    EXPECT_EQ(progress.tiles_total, 16u);
    rays = progress.rays;
  };
  const RenderResult result = render(scene, options);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(calls, 16u);
  EXPECT_EQ(rays, result.statistics.total_rays());
  for (const PixelWindow& window : {PixelWindow{-1, 0, 10, 10}, PixelWindow{0, 0, 101, 10}, PixelWindow{95, 95, 6, 5},
                                    PixelWindow{0, 0, 10, -3}, PixelWindow{0, 0, 10, 0}}) {
    options.window = window;
    EXPECT_THROW(render(scene, options), Error);
  }
}

}  // namespace
}  // namespace raytree
