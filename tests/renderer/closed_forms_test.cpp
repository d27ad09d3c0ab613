// Closed forms that belong to no single part: the torus, a room of mirrors, the band along a terminator. The list of
// all and where each is tested: docs/closed-forms.md.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/angle.h"
#include "geometry/ray_batch.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr double kRing = 2, kTube = 0.75;  ///< R and r
constexpr int kRate = 64;                  ///< segments of a quarter, around and along

/// About the y axis: a circle of four exact quarters, turned.
ShapeDescription torus(const std::string& material) {
  const double middle = (1 + 2 * std::numbers::sqrt2 / 2) / 3;  // of a quadratic's 1, 1 / sqrt 2, 1 raised to a cubic
  PatchesShape kind;
  const auto add = [&](const Vec2d& p, double weight) {
    kind.positions.emplace_back(kRing + kTube * p.x, kTube * p.y, 0);
    kind.weights.push_back(weight);
    return static_cast<std::uint32_t>(kind.positions.size() - 1);
  };
  const Vec2d quarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2d &from = quarters[i], &to = quarters[(i + 1) % 4], corner = from + to;
    const auto between = [&](const Vec2d& end) {
      return (end + corner * std::numbers::sqrt2) / (1 + std::numbers::sqrt2);
    };
    kind.lathe.push_back({add(from, 1), add(between(from), middle), add(between(to), middle), add(to, 1)});
  }
  return shape(std::move(kind), material, "torus");
}

SceneDescription torus_scene(const CameraDescription& camera) {
  SceneDescription scene = dark_scene(128, camera);
  scene.materials = {material("white", Rgb(1))};
  scene.render.tessellation.rate = kRate;
  scene.shapes = {torus("white")};
  return scene;
}

/// Distances of a ray's hit; infinity: none.
double distance_along(const Scene& scene, const Vec3d& origin, const Vec3d& direction) {
  RayBatch rays(1);
  HitBatch hits(1);
  rays.set(0, Vec3f(origin - scene.shapes->origin), Vec3f(direction), std::numeric_limits<float>::infinity());
  rays.size = 1;
  scene.intersector->intersect(rays, Coherence::mixed, hits);
  return hits.geometry[0] == kNoGeometry ? std::numeric_limits<double>::infinity() : hits[0].distance;
}

/// Facets touch the surface at their corners and lie inside it by the sagittas of both circles at most. A rational
/// quarter turns by 4 (sqrt 2 - 1) times its parameter in its middle, where it is fastest.
const double kHalfSegment = 4 * (std::numbers::sqrt2 - 1) / (2 * kRate);
const double kSagitta = (kRing + 2 * kTube) * (1 - std::cos(kHalfSegment));

TEST(ClosedForms, ATorusIsMetAlongAnAxisWhereItsTwoRadiiSay) {
  const Scene scene = prepared(torus_scene(front_camera(7)));
  // The ray passes through corners of facets: what is left is the rounding of coordinates up to 10.
  const double tolerance = 4e-6;
  const Vec3d along(-1, 0, 0);
  EXPECT_NEAR(distance_along(scene, {10, 0, 0}, along), 10 - (kRing + kTube), tolerance);
  EXPECT_NEAR(distance_along(scene, {kRing, 0, 0}, along), kTube, tolerance);
  EXPECT_NEAR(distance_along(scene, {0, 0, 0}, along), kRing - kTube, tolerance);
  EXPECT_NEAR(distance_along(scene, {-kRing, 0, 0}, along), kTube, tolerance);
  EXPECT_FALSE(std::isfinite(distance_along(scene, {-10, 0, 0}, along)));
}

TEST(ClosedForms, ATorusHasAHole) {
  const Scene scene = prepared(torus_scene(front_camera(7)));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 2000; ++i) {
    // Facets of the inner rim lie off it by the ring's sagitta, toward the axis.
    const double radius = (kRing - kTube - kSagitta) * std::sqrt(uniform(random)), angle = 2 * kPi * uniform(random);
    const Vec3d at(radius * std::cos(angle), 5, radius * std::sin(angle));
    ASSERT_FALSE(std::isfinite(distance_along(scene, at, {0, -1, 0}))) << radius;
  }
  for (const double radius : {kRing - kTube + kSagitta, kRing, kRing + kTube - kSagitta})
    EXPECT_TRUE(std::isfinite(distance_along(scene, {0, 5, radius}, {0, -1, 0}))) << radius;
}

TEST(ClosedForms, HitsOnATorusFulfilItsQuartic) {
  const Scene scene = prepared(torus_scene(front_camera(7)));
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d from = Vec3d(normal(random), normal(random), normal(random)).normalized() * 8;
    const Vec3d to = Vec3d(normal(random), 0.3 * normal(random), normal(random)).normalized() * kRing;
    const Vec3d direction = (to - from).normalized();
    const double t = distance_along(scene, from, direction);
    if (!std::isfinite(t)) continue;
    ++hits;
    const Vec3d p = from + direction * t;
    const double rho = std::hypot(p.x, p.z), sum = p.dot(p) + kRing * kRing - kTube * kTube;
    // (|P|^2 + R^2 - r^2)^2 - 4 R^2 rho^2 = (d - r) (d + r) (sum + 2 R rho), d the distance from the ring's circle; the
    // last term: floats of a ray 8 long.
    const double residual = sum * sum - 4 * kRing * kRing * rho * rho;
    const double bound = (kSagitta + 4e-6) * 2 * kTube * (sum + 2 * kRing * rho);
    ASSERT_LE(std::abs(residual), bound) << i;
  }
  EXPECT_GT(hits, 3000);
}

TEST(ClosedForms, ATorusShowsTheAreaOfItsRingAlongItsAxis) {
  CameraDescription camera = front_camera(7);
  camera.position = {0, 10, 0};
  camera.up = {0, 0, 1};
  SceneDescription scene = torus_scene(camera);
  constexpr int kEyes = 8;
  scene.render.antialias = {Antialiasing::Method::grid, kEyes};
  const RenderResult result = rendered(std::move(scene), {ChannelGroup::alpha});
  const float* const alpha = result.film.plane(ChannelGroup::alpha, 0);
  double sum = 0;
  for (std::size_t i = 0; i < 128u * 128; ++i) sum += alpha[i];
  const double pixel = 7.0 / 128, cell = pixel / kEyes, area = sum * pixel * pixel;
  const double exact = kPi * (std::pow(kRing + kTube, 2) - std::pow(kRing - kTube, 2));
  // The border's facets take their sagitta all along it; cells on it count whole or not at all, as if at random: four
  // standard deviations of so many halves.
  const double border = 2 * kPi * 2 * kRing;
  EXPECT_NEAR(area, exact, border * kSagitta + 4 * 0.5 * std::sqrt(border / cell) * cell * cell);
}

// Each of D levels adds the ambient light's share: the sum of a geometric series, whatever way the ray goes.
TEST(ClosedForms, ARoomOfMirrorsIsAsBrightAsItsSeries) {
  for (const float k : {0.25f, 0.5f, 0.9f})
    for (const int depth : {1, 2, 5, 40}) {
      CameraDescription camera;
      camera.position = {0.2, -0.1, 0.3};
      camera.target = {1, 0.4, -0.7};
      camera.field_of_view = 100;
      SceneDescription scene = dark_scene(24, camera);
      scene.ambient = Rgb(1);
      scene.render.depth = depth;
      scene.materials = {material("mirror", Rgb(0.3f, 0.2f, 0.1f))};
      scene.materials[0].reflection = Rgb(k);
      scene.shapes = {mesh_shape(box_mesh({-1, -1, -1}, {1, 1, 1}), "mirror")};
      const RenderResult result = rendered(std::move(scene));
      const double sum = (1 - std::pow(k, depth)) / (1 - k);
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x)
          // Each term is off by its own power's roundings, j + 1 of half an ulp, and so is the sum of them.
          expect_color(color_at(result.film, x, y), Rgb(0.3f, 0.2f, 0.1f) * static_cast<float>(sum),
                       0.3 * sum * (depth + 2) * 6e-8, "k " + std::to_string(k));
    }
}

// A facet of half angle theta turns from the light as a whole: what interpolated normals would light there is dark, up
// to theta beyond the terminator, where N.L is sin theta.
TEST(ClosedForms, TheTerminatorsBandIsAsWideAsAFacetsHalfAngle) {
  for (const int sides : {12, 24, 48}) {
    const double theta = kPi / sides;
    SceneDescription scene = dark_scene(400, front_camera(2.1));
    scene.materials = {material("white", Rgb(1))};
    ConeShape cylinder{{0, -2, 0}, {0, 2, 0}, 1, 1};
    cylinder.sides = sides;
    scene.shapes = {shape(cylinder, "white")};
    scene.shapes[0].shading = ShadingMethod::phong;
    // The side whose normals go from the eye's axis to 2 theta beyond it is just turned away.
    const double azimuth = 0.99 * theta;
    const Vec3d to_light(std::cos(azimuth), 0, std::sin(azimuth));
    scene.lights = {directional_light(-to_light)};
    const RenderResult result = rendered(std::move(scene));
    double most = 0;
    for (int x = 0; x < 400; ++x) {
      const Rgb n = color_at(result.film, x, 200, ChannelGroup::normal);
      const double lit = Vec3d(n.r, n.g, n.b).dot(to_light);
      if (lit > 0 && color_at(result.film, x, 200).r == 0) most = std::max(most, lit);
    }
    // Interpolated normals are off by theta^3 / (3 sqrt 3).
    EXPECT_LE(most, std::sin(theta) + theta * theta * theta / (3 * std::sqrt(3.0)) + 1e-6) << sides;
    // And its border toward the light is met to a pixel.
    EXPECT_GT(most, std::sin(azimuth) - 2.1 / 400) << sides;
  }
}

}  // namespace
}  // namespace raytree
