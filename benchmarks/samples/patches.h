// Patches with known surfaces, for tests and the stability suite.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/surface_of_revolution.h"

namespace raytree::samples {

/// Profile of the unit circle from the south pole to the north pole, or of its part on one side of the equator.
inline std::vector<BezierCurve> half_circle() {
  const double handle = 2 - std::numbers::sqrt2, weight = (1 + std::numbers::sqrt2) / 3;
  return {{{Vec3d(0, -1, 0), {handle, -1, 0}, {1, -handle, 0}, {1, 0, 0}}, {1, weight, weight, 1}},
          {{Vec3d(1, 0, 0), {1, handle, 0}, {handle, 1, 0}, {0, 1, 0}}, {1, weight, weight, 1}}};
}

/// The unit sphere in eight octants, the southern ones first.
inline std::vector<BezierPatch> sphere_patches() { return revolve(half_circle()); }

/// A straight profile.
inline BezierCurve straight(const Vec3d& a, const Vec3d& b) {
  return {{a, a + (b - a) / 3, b - (b - a) / 3, b}, {1, 1, 1, 1}};
}

/// Coefficients of u^k v^l by [l][k].
using Monomials = std::array<std::array<Vec3d, 4>, 4>;
inline Monomials no_monomials() {
  Monomials a;
  for (auto& row : a) row.fill(Vec3d(0, 0, 0));
  return a;
}

/// As a Bezier patch: b_i = sum_k C(i, k) / C(3, k) a_k.
inline BezierPatch patch_of_monomials(const Monomials& a) {
  constexpr double kBinomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  BezierPatch patch;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      Vec3d sum(0, 0, 0);
      for (std::size_t l = 0; l <= j; ++l)
        for (std::size_t k = 0; k <= i; ++k)
          sum += a[l][k] * (kBinomial[i][k] / kBinomial[3][k] * kBinomial[j][l] / kBinomial[3][l]);
      patch.points[4 * j + i] = sum;
    }
  return patch;
}

/// Control points in [-1, 1]^3, weights in [1/2, 2] if `rational`.
inline BezierPatch random_patch(std::mt19937& random, bool rational) {
  std::uniform_real_distribution<double> coordinate(-1, 1), exponent(-1, 1);
  BezierPatch patch;
  for (Vec3d& p : patch.points) p = {coordinate(random), coordinate(random), coordinate(random)};
  if (rational)
    for (double& w : patch.weights) w = std::exp2(exponent(random));
  return patch;
}

}  // namespace raytree::samples
