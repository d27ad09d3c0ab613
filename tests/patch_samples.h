// Patches with known surfaces (benchmarks/samples/patches.h), and what tests of all that deals with patches expect.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "benchmarks/samples/patches.h"
#include "geometry/angle.h"
#include "geometry/coons_patch.h"
#include "tests/degrees_between.h"

namespace raytree::test {

using namespace samples;

inline constexpr double kUlp = 0x1p-52;  ///< of numbers from 1 to 2

/// Expects the derivatives of a patch with points of about 1 to be those of its points, and the second ones those of
/// the first, at (u, v) inside it.
template <class Patch>
void expect_derivatives_of_points(const Patch& patch, double u, double v) {
  // Central differences: off by h^2 / 6 times a third derivative (below 1e4 for weights between 1/2 and 2) and 1e-15 /
  // h.
  const double h = 1e-5, tolerance = 1e-6;
  const PatchDerivatives at = evaluate(patch, u, v);
  const PatchDerivatives right = evaluate(patch, u + h, v), left = evaluate(patch, u - h, v),
                         up = evaluate(patch, u, v + h), down = evaluate(patch, u, v - h);
  EXPECT_LE(((right.position - left.position) / (2 * h) - at.du).length(), tolerance);
  EXPECT_LE(((up.position - down.position) / (2 * h) - at.dv).length(), tolerance);
  EXPECT_LE(((right.du - left.du) / (2 * h) - at.duu).length(), tolerance);
  EXPECT_LE(((up.du - down.du) / (2 * h) - at.duv).length(), tolerance);
  EXPECT_LE(((right.dv - left.dv) / (2 * h) - at.duv).length(), tolerance);
  EXPECT_LE(((up.dv - down.dv) / (2 * h) - at.dvv).length(), tolerance);
}

}  // namespace raytree::test
