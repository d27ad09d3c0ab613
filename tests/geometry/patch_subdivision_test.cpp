// Whitted's subdivision of patches: how far from the patch what it reports may lie, that it never misses what is hit,
// how often it divides; closed forms of patches that are spheres and planes.
#include "geometry/patch_subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "geometry/ray_batch.h"
#include "tests/geometry/reference_shapes.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using test::Random;

/// A pixel of one unit everywhere, so that pixels are units.
const PixelSize kUnit{};

std::optional<PatchHit> traced(const BezierPatch& patch, const Vec3d& from, const Vec3d& direction, double radius,
                               double limit = kInfinity) {
  const SphereRay ray(from, direction);
  PatchHit hit;
  if (!intersect_patch(patch, ray, sphere_about(patch).inside(ray), limit, {kUnit, radius}, hit)) return std::nullopt;
  return hit;
}

/// Least distance from a point to the patch, by looking ever closer at where it is least.
double distance_to(const BezierPatch& patch, const Vec3d& point) {
  double best = kInfinity, u = 0.5, v = 0.5, width = 0.5;
  for (int round = 0; round < 14; ++round) {
    double next_u = u, next_v = v;
    const int steps = round == 0 ? 60 : 6;
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j) {
        const double a = std::clamp(u + width * i / steps, 0.0, 1.0), b = std::clamp(v + width * j / steps, 0.0, 1.0);
        if (const double d = (evaluate(patch, a, b).position - point).length(); d < best)
          best = d, next_u = a, next_v = b;
      }
    u = next_u, v = next_v, width /= round == 0 ? 30 : 2.5;
  }
  return best;
}

/// Row 66 of the catalogue of failures: rays at points of the patch, and beside its silhouette and borders.
TEST(PatchSubdivision, ReportsNothingFartherThanTwoRadiiAndMissesNothing) {
  std::mt19937 engine(66);
  Random random(66);
  int hits = 0, dilated = 0;
  for (int trial = 0; trial < 16; ++trial) {
    const BezierPatch patch = test::random_patch(engine, trial % 2 == 1);
    const double size = sphere_about(patch).radius;
    for (const double radius : {size / 16, size / 200}) {
      for (int i = 0; i < 12; ++i) {
        const Vec3d place = evaluate(patch, random.uniform(0, 1), random.uniform(0, 1)).position;
        const Vec3d from = place + random.direction() * size * 4;
        const Vec3d direction = (place - from) * random.uniform(0.2, 3);
        const auto hit = traced(patch, from, direction, radius);
        ASSERT_TRUE(hit) << "a ray at a point of the patch missed it";
        const double at = (place - from).length() / direction.length();
        EXPECT_LE(hit->distance, at + 2 * radius / direction.length());
        EXPECT_LE(distance_to(patch, from + direction * hit->distance), 2 * radius);
        ++hits;
        // Beside it by up to four radii: what is reported all the same lies within two of them.
        const Vec3d beside = direction + random.direction() * (4 * radius * direction.length() / (4 * size));
        if (const auto near = traced(patch, from, beside, radius)) {
          const double off = distance_to(patch, from + beside * near->distance);
          EXPECT_LE(off, 2 * radius);
          dilated += off > 1e-9 * size;
        }
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(dilated, 0);  // that the method does report what the ray does not meet
}

/// Radii halve with every division: log2(R0 / r) of them, the first spheres being wider than what they hold by up to 2.
TEST(PatchSubdivision, DividesAsOftenAsTheRadiusHalves) {
  BezierPatch flat;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) flat.points[4 * j + i] = {double(i), double(j), 0};
  const double whole = sphere_about(flat).radius;
  for (int levels = 0; levels < 20; ++levels) {
    const auto hit = traced(flat, {1, 1.1, 5}, {0.01, 0.02, -1}, whole * std::ldexp(1.0, -levels) * (1 + 1e-9));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->level, levels);
    EXPECT_NEAR(hit->distance, 5, 1e-14);
    EXPECT_NEAR(hit->u, 1.05 / 3, 1e-14);
    EXPECT_NEAR(hit->v, 1.2 / 3, 1e-14);
  }
  // Curved ones are divided on until they are flat to a share of the radius, a few times more at most.
  for (const BezierPatch& patch : test::sphere_patches()) {
    const Vec3d toward = evaluate(patch, 0.5, 0.5).position;
    for (const double radius : {0.1, 0.01, 0.001}) {
      const auto hit = traced(patch, toward * 3.0, -toward, radius);
      ASSERT_TRUE(hit);
      const double expected = std::log2(sphere_about(patch).radius / radius);
      EXPECT_GE(hit->level, std::floor(expected) - 1);
      EXPECT_LE(hit->level, std::ceil(expected) + 1 + kMostFlatteningLevels);
    }
  }
}

/// Rational patches are the sphere exactly: distances are its closed form, from far and near, grazing too.
TEST(PatchSubdivision, OctantsOfASphereMeetItsClosedForm) {
  Random random(8);
  const std::vector<BezierPatch> octants = test::sphere_patches();
  const double radius = 1e-3;
  int grazing = 0;
  for (int i = 0; i < 1500; ++i) {
    // Past the center by up to the silhouette.
    const Vec3d direction = random.direction(), side = direction.cross(random.direction()).normalized();
    const double off = i % 4 == 0 ? 1 - std::exp(random.uniform(-12, -3)) : random.uniform(0, 0.99);
    const double away = random.uniform(1.5, 200);
    const Vec3d from = side * off - direction * away;
    double nearest = kInfinity;
    for (const BezierPatch& octant : octants)
      if (const auto hit = traced(octant, from, direction, radius)) nearest = std::min(nearest, hit->distance);
    const double half = std::sqrt(1 - off * off), expected = away - half;
    ASSERT_LT(nearest, kInfinity) << off;
    // Newton's last step is 2^-40 of the parameters at most; toward the silhouette a place off by e is off by e / half
    // along the ray. Where the part is hit without a crossing found in it, the sphere's size is what holds.
    const double exact = 1e-11 * (1 + away) / half;
    // Where two octants meet, the one may stop within its own flatness of what the other meets.
    if (std::abs(nearest - expected) > exact + 2 * kFlatShare * radius / half) {
      EXPECT_LT(half, 4 * std::sqrt(2 * radius)) << "far from the silhouette";
      EXPECT_LT(std::abs((from + direction * nearest).length() - 1), 2 * radius);
      ++grazing;
    }
  }
  EXPECT_LT(grazing, 400);
}

/// A ray that starts on the surface, clear of it by what the renderer gives it, does not meet it again.
TEST(PatchSubdivision, RaysThatLeaveDoNotMeetTheSurfaceAgain) {
  Random random(9);
  const std::vector<BezierPatch> octants = test::sphere_patches();
  for (const double radius : {1e-2, 1e-3}) {
    for (int i = 0; i < 3000; ++i) {
      const Vec3d normal = random.direction();
      Vec3d direction = random.direction();
      if (direction.dot(normal) < 0) direction = -direction;
      if (i % 2 == 0) direction = (direction - normal * direction.dot(normal) * 0.999).normalized();
      const Vec3d from = normal * (1 + 4 * kFlatShare * radius);
      for (const BezierPatch& octant : octants) EXPECT_FALSE(traced(octant, from, direction, radius)) << i;
    }
  }
}

TEST(PatchSubdivision, LimitsAreKept) {
  const BezierPatch octant = test::sphere_patches()[4];
  const Vec3d toward = evaluate(octant, 0.5, 0.5).position;
  EXPECT_TRUE(traced(octant, toward * 3.0, -toward, 1e-3, 2.0 + 1e-9));
  EXPECT_FALSE(traced(octant, toward * 3.0, -toward, 1e-3, 2.0 - 1e-9));
  EXPECT_FALSE(traced(octant, toward * 3.0, toward, 1e-3));
}

}  // namespace
}  // namespace raytree
