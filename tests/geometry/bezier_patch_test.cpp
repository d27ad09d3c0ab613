// Bicubic Bezier patches: closed forms of points, derivatives and normals, and exact quadrics as rational patches.
#include "geometry/bezier_patch.h"

#include <gtest/gtest.h>

#include "geometry/surface_of_revolution.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using namespace test;

/// Whole-numbered control points, so that sums of dyadic fractions of them are exact.
BezierPatch whole_numbered_patch(std::mt19937& random) {
  std::uniform_int_distribution<int> coordinate(-1000, 1000);
  BezierPatch patch;
  for (Vec3d& p : patch.points) p = Vec3d(coordinate(random), coordinate(random), coordinate(random));
  return patch;
}

TEST(BezierPatch, MeetsItsCornerPoints) {
  std::mt19937 random(1);
  for (const bool rational : {false, true}) {
    const BezierPatch patch = random_patch(random, rational);
    // The other terms are 0 and w P / w is off by two roundings at most.
    const double tolerance = 2 * kUlp;
    EXPECT_LE((evaluate(patch, 0, 0).position - patch.points[0]).length(), tolerance);
    EXPECT_LE((evaluate(patch, 1, 0).position - patch.points[3]).length(), tolerance);
    EXPECT_LE((evaluate(patch, 0, 1).position - patch.points[12]).length(), tolerance);
    EXPECT_LE((evaluate(patch, 1, 1).position - patch.points[15]).length(), tolerance);
  }
}

TEST(BezierPatch, HasTheMidpointOfDeCasteljau) {
  std::mt19937 random(2);
  for (int n = 0; n < 100; ++n) {
    const BezierPatch patch = whole_numbered_patch(random);
    constexpr double kRow[4] = {1, 3, 3, 1};
    Vec3d expected(0, 0, 0);
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) expected += patch.points[4 * j + i] * (kRow[i] * kRow[j] / 64);
    // Products of whole numbers up to 9000 and sixty-fourths are exact in any order.
    EXPECT_EQ(evaluate(patch, 0.5, 0.5).position, expected);
  }
}

TEST(BezierPatch, HasTheCornersTangentsAndNormal) {
  std::mt19937 random(3);
  for (int n = 0; n < 100; ++n) {
    const BezierPatch patch = whole_numbered_patch(random);
    const PatchDerivatives at = evaluate(patch, 0, 0);
    EXPECT_EQ(at.du, (patch.points[1] - patch.points[0]) * 3.0);
    EXPECT_EQ(at.dv, (patch.points[4] - patch.points[0]) * 3.0);
    EXPECT_EQ(at.duu, (patch.points[2] - patch.points[1] * 2.0 + patch.points[0]) * 6.0);
    EXPECT_EQ(at.duv, (patch.points[5] - patch.points[1] - patch.points[4] + patch.points[0]) * 9.0);
    const Vec3d normal = (patch.points[1] - patch.points[0]).cross(patch.points[4] - patch.points[0]);
    const Vec3d found = patch_normal(patch, at, 0, 0, derivative_scale(patch), DegenerateNormal::none);
    EXPECT_NEAR(found.length(), 1, 4 * kUlp);
    EXPECT_LE(degrees_between(found, normal), 1e-13);
  }
}

/// Bezier's own algorithm: repeated linear interpolation, in homogeneous coordinates.
Vec3d de_casteljau(const BezierPatch& patch, double u, double v) {
  struct Homogeneous {
    Vec3d x;
    double w;
  };
  const auto reduce = [](std::array<Homogeneous, 4> p, double t) {
    for (std::size_t last = 3; last > 0; --last)
      for (std::size_t i = 0; i < last; ++i)
        p[i] = {p[i].x * (1 - t) + p[i + 1].x * t, p[i].w * (1 - t) + p[i + 1].w * t};
    return p[0];
  };
  std::array<Homogeneous, 4> rows;
  for (std::size_t j = 0; j < 4; ++j) {
    std::array<Homogeneous, 4> row;
    for (std::size_t i = 0; i < 4; ++i)
      row[i] = {patch.points[4 * j + i] * patch.weights[4 * j + i], patch.weights[4 * j + i]};
    rows[j] = reduce(row, u);
  }
  const Homogeneous p = reduce(rows, v);
  return p.x / p.w;
}

TEST(BezierPatch, AgreesWithRepeatedInterpolation) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> parameter(0, 1);
  for (int n = 0; n < 200; ++n) {
    const BezierPatch patch = random_patch(random, n % 2 == 1);
    const double u = parameter(random), v = parameter(random);
    // About 30 roundings of numbers up to 2 (weights) times 1 (coordinates), over a weight of at least 1/2.
    EXPECT_LE((evaluate(patch, u, v).position - de_casteljau(patch, u, v)).length(), 30 * 4 * kUlp);
  }
}

TEST(BezierPatch, DerivativesAreThoseOfTheirPoints) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> parameter(0.1, 0.9);
  for (int n = 0; n < 100; ++n) {
    const BezierPatch patch = random_patch(random, n % 2 == 1);
    const double u = parameter(random), v = parameter(random);
    expect_derivatives_of_points(patch, u, v);
  }
}

TEST(BezierPatch, RationalOctantsAreAnExactSphere) {
  const std::vector<BezierPatch> octants = sphere_patches();
  ASSERT_EQ(octants.size(), 8u);
  for (const BezierPatch& patch : octants)
    for (int j = 0; j <= 16; ++j)
      for (int i = 0; i <= 16; ++i) {
        const double u = i / 16.0, v = j / 16.0;
        const PatchDerivatives at = evaluate(patch, u, v);
        // Sixteen terms of a few roundings each over a weight of at least 0.64.
        const double tolerance = 32 * kUlp;
        EXPECT_NEAR(at.position.length(), 1, tolerance);
        // P.P = 1, differentiated. First derivatives are up to 1.8, second ones up to 6.
        EXPECT_NEAR(at.position.dot(at.du), 0, 10 * tolerance);
        EXPECT_NEAR(at.position.dot(at.dv), 0, 10 * tolerance);
        EXPECT_NEAR(at.position.dot(at.duu) + at.du.dot(at.du), 0, 100 * tolerance);
        EXPECT_NEAR(at.position.dot(at.duv) + at.du.dot(at.dv), 0, 100 * tolerance);
        EXPECT_NEAR(at.position.dot(at.dvv) + at.dv.dot(at.dv), 0, 100 * tolerance);
        // The normal is the point itself, poles too, where P_u vanishes.
        const Vec3d normal = patch_normal(patch, at, u, v, derivative_scale(patch), DegenerateNormal::limit);
        EXPECT_LE(degrees_between(normal, at.position), 1e-11) << u << ' ' << v;
      }
}

TEST(BezierPatch, RationalQuartersAreAnExactCylinder) {
  const std::vector<BezierCurve> profile{straight({2, -1, 0}, {2, 3, 0})};
  for (const BezierPatch& patch : revolve(profile))
    for (int j = 0; j <= 16; ++j)
      for (int i = 0; i <= 16; ++i) {
        const PatchDerivatives at = evaluate(patch, i / 16.0, j / 16.0);
        EXPECT_NEAR(std::hypot(at.position.x, at.position.z), 2, 64 * kUlp);
        EXPECT_NEAR(at.position.y, -1 + 4 * j / 16.0, 64 * kUlp);
        const Vec3d normal =
            patch_normal(patch, at, i / 16.0, j / 16.0, derivative_scale(patch), DegenerateNormal::none);
        EXPECT_LE(degrees_between(normal, {at.position.x, 0, at.position.z}), 1e-12);
      }
}

TEST(BezierPatch, TransposingTurnsItInsideOut) {
  std::mt19937 random(6);
  const BezierPatch patch = random_patch(random, true), turned = transposed(patch);
  const PatchDerivatives a = evaluate(patch, 0.25, 0.75), b = evaluate(turned, 0.75, 0.25);
  EXPECT_LE((a.position - b.position).length(), 8 * kUlp);
  EXPECT_LE((a.du - b.dv).length(), 100 * kUlp);
  for (int side = 0; side < 4; ++side) {
    const BezierCurve curve = side_curve(patch, side);
    EXPECT_EQ(curve.points[3], side_curve(patch, (side + 1) % 4).points[0]) << "once around";
  }
}

}  // namespace
}  // namespace raytree
