// Bumps against the normals that their heights imply: gradients, a ripple's normal, reflection and highlight in closed
// form, and that no normal leaves its side.
#include "renderer/bump.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/angle.h"
#include "geometry/surface.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr BumpDescription::Kind kKinds[] = {BumpDescription::Kind::noise, BumpDescription::Kind::wrinkles,
                                            BumpDescription::Kind::ripples, BumpDescription::Kind::stripes};

class Numbers {
 public:
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1));
      if (const double square = v.dot(v); square > 0.01 && square < 1) return unit(v);
    }
  }

 private:
  std::mt19937_64 random_{1978};
};

TEST(Bump, GradientsAreThoseOfCentralDifferences) {
  Numbers number;
  for (const auto kind : kKinds)
    for (int i = 0; i < 200; ++i) {
      BumpDescription description{kind, number(-1, 1), number(0.5, 4), 2, 0.5, static_cast<std::uint32_t>(i)};
      description.offset = {number(-1, 1), number(-1, 1), number(-1, 1)};
      description.direction = number.direction() * 3;
      const Bump bump(description, {0, 0, 0});
      // Binary fractions: a float holds each place and its neighbours.
      const auto rounded = [&] { return static_cast<float>(std::round(number(-3, 3) * 4096) / 4096); };
      const Vec3f place(rounded(), rounded(), rounded());
      constexpr float kStep = 0x1p-14f;
      const auto height = [&](const Vec3f& at) { return bump.height(Vec3d(at) - description.offset, 0); };
      const Vec3d gradient = height(place).gradient;
      // h^2 / 6 times third derivatives of up to 4 x 500 (2 / kCreaseWidth)^2 / size^3 for ridges, (2 pi / size)^3 for
      // waves.
      const double third = kind == BumpDescription::Kind::wrinkles ? 4000 * 4 / (kCreaseWidth * kCreaseWidth) : 4000;
      const double tolerance =
          kStep * kStep / 6.0 * third * std::abs(description.amplitude) / std::pow(std::min(1.0, description.size), 3) +
          1e-9;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3f low = place, high = place;
        low[axis] -= kStep, high[axis] += kStep;
        EXPECT_NEAR(gradient[axis], (height(high).value - height(low).value) / (2 * kStep), tolerance)
            << static_cast<int>(kind);
      }
    }
}

/// A wall in the plane z = 0, seen from the front, waves A sin(2 pi y / length) across it.
SceneDescription rippled_wall(double amplitude, double length) {
  SceneDescription scene = dark_scene(64, front_camera(2));
  scene.materials = {material("m", Rgb(0))};
  BumpDescription bump;
  bump.kind = BumpDescription::Kind::stripes;
  bump.amplitude = amplitude, bump.size = length, bump.direction = {0, 2, 0};
  scene.materials[0].bump = bump;
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  return scene;
}
double pixel_height(int y) { return (32 - y - 0.5) / 32; }
Vec3d ripple_normal(double amplitude, double length, double y) {
  const double k = 2 * kPi / length;
  return unit(Vec3d(0, -amplitude * k * std::cos(k * y), 1));
}
/// Float rounding of a position of up to 1 (2^-24), times how fast the normal turns with it, and of the normal itself.
double normal_tolerance(double amplitude, double length) {
  const double k = 2 * kPi / length;
  return 4e-7 + 0x1p-23 * amplitude * k * k;
}

TEST(Bump, ARipplesNormalIsThatOfItsSine) {
  for (const double amplitude : {0.01, 0.05, -0.1}) {
    const RenderResult result = rendered(rippled_wall(amplitude, 0.8));
    for (int y = 0; y < 64; ++y) {
      const Vec3d expected = ripple_normal(amplitude, 0.8, pixel_height(y));
      const std::size_t i = pixel_index(result.film, 11, y);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(result.film.plane(ChannelGroup::normal, c)[i], expected[c],
                    normal_tolerance(std::abs(amplitude), 0.8));
    }
  }
}

TEST(Bump, FromBehindTheSameSurfaceIsSeen) {
  SceneDescription scene = rippled_wall(0.05, 0.8);
  scene.cameras[0].position.z = -10;
  const RenderResult result = rendered(std::move(scene));
  for (int y = 0; y < 64; ++y) {
    const Vec3d outside = ripple_normal(0.05, 0.8, pixel_height(y));
    const std::size_t i = pixel_index(result.film, 11, y);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(result.film.plane(ChannelGroup::normal, c)[i], -outside[c], normal_tolerance(0.05, 0.8));
  }
}

TEST(Bump, ReflectionAndHighlightFollowTheRipple) {
  const double amplitude = 0.04, length = 0.8, exponent = 30;
  const Vec3d to_light = unit(Vec3d(0, 0.3, 1)), sight(0, 0, -1);
  SceneDescription scene = rippled_wall(amplitude, length);
  scene.materials[0].reflection = Rgb(1);
  GradientBackground background;
  background.bottom = Rgb(0), background.horizon = Rgb(0.5f), background.top = Rgb(1);
  scene.background = background;
  scene.materials[0].highlight = {Rgb(0.7f), exponent};
  scene.lights = {directional_light(-to_light)};
  for (const HighlightForm form : {HighlightForm::reflected, HighlightForm::halfway}) {
    scene.render.highlights = form;
    const RenderResult result = rendered(scene);
    for (int y = 0; y < 64; ++y) {
      const Vec3d normal = ripple_normal(amplitude, length, pixel_height(y));
      const Vec3d mirrored = sight - normal * (2 * sight.dot(normal));
      const double base =
          form == HighlightForm::reflected ? mirrored.dot(to_light) : normal.dot(unit(to_light - sight));
      // The background blends in proportion to the height of the direction, from 0 straight down to 1 straight up.
      const double expected = (1 + mirrored.y) / 2 + 0.7 * std::pow(base, exponent);
      expect_color(color_at(result.film, 20, y), Rgb(static_cast<float>(expected)),
                   (2 + exponent) * 2 * normal_tolerance(amplitude, length));
    }
  }
}

TEST(Bump, DiffuseLightFollowsTheRipple) {
  SceneDescription scene = rippled_wall(0.06, 0.8);
  scene.materials[0].diffuse = Rgb(1);
  const Vec3d to_light = unit(Vec3d(0.2, 0.6, 1));
  scene.lights = {directional_light(-to_light)};
  const RenderResult result = rendered(std::move(scene));
  for (int y = 0; y < 64; ++y)
    EXPECT_NEAR(color_at(result.film, 3, y).r, std::max(0.0, ripple_normal(0.06, 0.8, pixel_height(y)).dot(to_light)),
                1e-6);
}

TEST(Bump, NoNormalLeavesItsSideOrTheViewersSide) {
  Numbers number;
  int laid_down = 0;
  for (const auto kind : kKinds)
    for (int i = 0; i < 5000; ++i) {
      BumpDescription description{kind, std::pow(10, number(-3, 9)), 0.5, 2, 0.5, static_cast<std::uint32_t>(i)};
      description.direction = number.direction();
      const Bump bump(description, {0, 0, 0});
      const Vec3d side = number.direction();
      Vec3d normal = number.direction(), to_viewer = number.direction();
      if (normal.dot(side) < 0) normal = -normal;
      if (to_viewer.dot(side) < 0) to_viewer = -to_viewer;
      const Vec3f place(static_cast<float>(number(-3, 3)), static_cast<float>(number(-3, 3)), 0);
      const Vec3f bent = bump.bent(Vec3f(normal), Vec3f(side), Vec3f(to_viewer), i % 2 == 1, place, {}, nullptr);
      // Both additions together at most double the length.
      const float least = kLeastFacing / 2 * (1 - 1e-3f);
      ASSERT_GE(bent.dot(Vec3f(side)), least);
      ASSERT_GE(bent.dot(Vec3f(to_viewer)), least);
      ASSERT_NEAR(bent.length(), 1, 1e-6);
      laid_down += bent.dot(Vec3f(side)) < 2 * kLeastFacing;
    }
  EXPECT_GT(laid_down, 1000);
}

TEST(Bump, OutlineAndDepthStayWhatTheyWere) {
  SceneDescription smooth = dark_scene(40, front_camera(3));
  smooth.materials = {material("m", Rgb(0.5f))};
  smooth.ambient = Rgb(1);
  smooth.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "m")};
  SceneDescription bumped = smooth;
  bumped.materials[0].bump = BumpDescription{};
  const RenderResult a = rendered(std::move(smooth)), b = rendered(std::move(bumped));
  int turned = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const std::size_t i = pixel_index(a.film, x, y);
      EXPECT_EQ(a.film.plane(ChannelGroup::depth, 0)[i], b.film.plane(ChannelGroup::depth, 0)[i]);
      EXPECT_EQ(a.film.id_plane(ChannelGroup::object_id)[i], b.film.id_plane(ChannelGroup::object_id)[i]);
      EXPECT_EQ(color_at(a.film, x, y), color_at(b.film, x, y));  // ambient light knows no normal
      turned += a.film.plane(ChannelGroup::normal, 0)[i] != b.film.plane(ChannelGroup::normal, 0)[i];
    }
  EXPECT_GT(turned, 300);
}

TEST(Bump, KeepsItsDigitsFarFromTheWorldsOrigin) {
  for (const auto kind : kKinds) {
    const auto traced = [&](const Vec3d& at) {
      CameraDescription camera = front_camera(3);
      camera.position += at, camera.target += at;
      SceneDescription scene = dark_scene(32, camera);
      scene.materials = {material("m", Rgb(1))};
      BumpDescription bump{kind, 0.05, 0.7, 3};
      bump.offset = at + Vec3d(0.1, 0.2, 0.3);
      scene.materials[0].bump = bump;
      scene.lights = {directional_light({-1, -1, -2})};
      scene.shapes = {shape(SphereShape{at, 1}, "m")};
      return rendered(std::move(scene));
    };
    const RenderResult here = traced({0, 0, 0}), there = traced({1048576, -2097152, 4194304});
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        // `at` is exact in binary; offset + at has an error of 2^-31.
        EXPECT_NEAR(color_at(here.film, x, y).r, color_at(there.film, x, y).r, 2e-6) << static_cast<int>(kind);
  }
}

TEST(Bump, FadesWhereItIsFinerThanThePixel) {
  // 64 pixels over 2 units: waves of a tenth of a pixel are gone, those of three pixels are not.
  for (const auto& [length, gone] : {std::pair{0.003, true}, {0.1, false}}) {
    const RenderResult result = rendered(rippled_wall(0.1 * length, length));
    int level = 0;
    for (int y = 0; y < 64; ++y)
      level += result.film.plane(ChannelGroup::normal, 2)[pixel_index(result.film, 5, y)] == 1;
    EXPECT_EQ(level == 64, gone) << length;
  }
}

}  // namespace
}  // namespace raytree
