// Whitted's subdivision of patches: how often it divides; closed forms of patches that are spheres. How far from the
// patch what it reports may lie, and that it never misses, is the stability suite's
// (benchmarks/stability/curved_cases.cpp).
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

/// Radii halve with every division: log2(R0 / r) of them, the first spheres being wider than what they hold by up to 2.
TEST(PatchSubdivision, DividesAboutAsOftenAsTheRadiusHalves) {
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
