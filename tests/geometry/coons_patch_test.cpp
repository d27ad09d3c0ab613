// Bilinearly blended Coons patches: they meet all four curves, and equal what else they must equal.
#include "geometry/coons_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "geometry/bezier_patch.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using namespace test;

BezierCurve backwards(BezierCurve curve) {
  std::reverse(curve.points.begin(), curve.points.end());
  std::reverse(curve.weights.begin(), curve.weights.end());
  return curve;
}

CoonsPatch border_of(const BezierPatch& patch) {
  return {side_curve(patch, 0), backwards(side_curve(patch, 2)), backwards(side_curve(patch, 3)), side_curve(patch, 1)};
}

TEST(CoonsPatch, MeetsAllFourCurves) {
  std::mt19937 random(1);
  for (int n = 0; n < 100; ++n) {
    const CoonsPatch patch = border_of(random_patch(random, n % 2 == 1));
    for (int i = 0; i <= 64; ++i) {
      const double t = i / 64.0;
      // On v = 0 and 1 what the blend adds is a difference of corners that is exactly 0, on u = 0 and 1 it takes away
      // what it adds: a few roundings of numbers up to 2.
      const double tolerance = 8 * kUlp;
      EXPECT_LE((evaluate(patch, t, 0).position - to_vec3d(evaluate(patch.bottom, t).position)).length(), tolerance);
      EXPECT_LE((evaluate(patch, t, 1).position - to_vec3d(evaluate(patch.top, t).position)).length(), tolerance);
      EXPECT_LE((evaluate(patch, 0, t).position - to_vec3d(evaluate(patch.left, t).position)).length(), tolerance);
      EXPECT_LE((evaluate(patch, 1, t).position - to_vec3d(evaluate(patch.right, t).position)).length(), tolerance);
    }
  }
}

TEST(CoonsPatch, IsTheTwoRuledSurfacesLessTheBilinearOne) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> parameter(0, 1);
  for (int n = 0; n < 100; ++n) {
    const CoonsPatch patch = border_of(random_patch(random, n % 2 == 1));
    const double u = parameter(random), v = parameter(random);
    const auto on = [](const BezierCurve& curve, double t) { return to_vec3d(evaluate(curve, t).position); };
    const Vec3d ruled_v = on(patch.bottom, u) * (1 - v) + on(patch.top, u) * v;
    const Vec3d ruled_u = on(patch.left, v) * (1 - u) + on(patch.right, v) * u;
    const Vec3d bilinear = on(patch.bottom, 0) * ((1 - u) * (1 - v)) + on(patch.bottom, 1) * (u * (1 - v)) +
                           on(patch.top, 0) * ((1 - u) * v) + on(patch.top, 1) * (u * v);
    EXPECT_LE((evaluate(patch, u, v).position - (ruled_u + ruled_v - bilinear)).length(), 32 * kUlp);
  }
}

TEST(CoonsPatch, OfCubicsIsABicubicBezierPatch) {
  // Raise the three surfaces to cubics: inner control points are blends of the outer ones at thirds.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> parameter(0, 1);
  for (int n = 0; n < 50; ++n) {
    BezierPatch bezier = random_patch(random, false);
    const auto point = [&](std::size_t i, std::size_t j) -> Vec3d& { return bezier.points[4 * j + i]; };
    for (std::size_t j = 1; j <= 2; ++j)
      for (std::size_t i = 1; i <= 2; ++i) {
        const double u = double(i) / 3, v = double(j) / 3;
        point(i, j) = point(i, 0) * (1 - v) + point(i, 3) * v + point(0, j) * (1 - u) + point(3, j) * u -
                      (point(0, 0) * ((1 - u) * (1 - v)) + point(3, 0) * (u * (1 - v)) + point(0, 3) * ((1 - u) * v) +
                       point(3, 3) * (u * v));
      }
    const CoonsPatch coons = border_of(bezier);
    const double u = parameter(random), v = parameter(random);
    const PatchDerivatives a = evaluate(bezier, u, v), b = evaluate(coons, u, v);
    // Some 50 roundings of numbers up to 4; a derivative multiplies by up to 6 twice.
    EXPECT_LE((a.position - b.position).length(), 50 * 4 * kUlp);
    for (const auto& [x, y] : {std::pair(a.du, b.du), {a.dv, b.dv}, {a.duu, b.duu}, {a.duv, b.duv}, {a.dvv, b.dvv}})
      EXPECT_LE((x - y).length(), 36 * 50 * 4 * kUlp);
  }
}

TEST(CoonsPatch, DerivativesOfRationalOnesAreThoseOfTheirPoints) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> parameter(0.1, 0.9);
  for (int n = 0; n < 100; ++n) {
    const CoonsPatch patch = border_of(random_patch(random, true));
    const double u = parameter(random), v = parameter(random);
    expect_derivatives_of_points(patch, u, v);
  }
}

TEST(CoonsPatch, BetweenQuarterCirclesIsAnExactCylinder) {
  // Two rational quarter circles and two straight lines.
  const std::vector<BezierCurve> profile{straight({1, 0, 0}, {1, 2, 0})};
  const CoonsPatch patch = border_of(revolve(profile)[0]);
  for (int j = 0; j <= 16; ++j)
    for (int i = 0; i <= 16; ++i) {
      const PatchDerivatives at = evaluate(patch, i / 16.0, j / 16.0);
      EXPECT_NEAR(std::hypot(at.position.x, at.position.z), 1, 32 * kUlp);
      const Vec3d normal = patch_normal(patch, at, i / 16.0, j / 16.0, derivative_scale(patch), DegenerateNormal::none);
      EXPECT_LE(degrees_between(normal, {at.position.x, 0, at.position.z}), 1e-12);
    }
}

TEST(CoonsPatch, TransposingTurnsItInsideOut) {
  std::mt19937 random(5);
  const CoonsPatch patch = border_of(random_patch(random, true)), turned = transposed(patch);
  const PatchDerivatives a = evaluate(patch, 0.25, 0.75), b = evaluate(turned, 0.75, 0.25);
  EXPECT_LE((a.position - b.position).length(), 8 * kUlp);
  EXPECT_LE((a.du - b.dv).length(), 100 * kUlp);
}

}  // namespace
}  // namespace raytree
