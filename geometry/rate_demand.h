// What those who find rates share: the look that they serve, and what a face asks for. Estimates (rate_estimate.h),
// closed forms (polynomial_rates.h) and measurements (rate_measurement.h) make demands; tessellation_rates.cpp merges
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/tessellation_view.h"
#include "geometry/vec.h"

namespace raytree {

/// The share of the tolerance that rates aim at, since they are judged between the samples that chose them.
inline constexpr double kRateAim = 0.75;

struct RateGoal {
  const TessellationView& view;
  Vec3d origin;      ///< of the surface
  double tolerance;  ///< pixels
};

/// Rates of one face as they are asked for, before rounding.
struct RateDemand {
  std::vector<double> sides;
  std::array<double, 2> inner{1, 1};

  void reset(std::size_t count) {
    sides.assign(count, 1);
    inner = {1, 1};
  }
  void raise_side(std::size_t i, double rate) { sides[i] = std::max(sides[i], rate); }
  double largest() const {
    double most = std::max(inner[0], inner[1]);
    for (const double rate : sides) most = std::max(most, rate);
    return most;
  }
};

/// Smallest rates u and v, about, for which a / u^2 + 2 b / (u v) + c / v^2 <= 1: the error of linear interpolation
/// over a right triangle is that of its diagonal, where a, b and c are an eighth of the second derivatives in units of
/// the tolerance. (2 b / (u v) <= b / u^2 + b / v^2; the two halves then share the tolerance, unless one needs less.)
inline std::array<double, 2> segments(double a, double b, double c) {
  a += b;
  c += b;
  if (2 * c <= 1) return {std::sqrt(a / (1 - c)), 1};
  if (2 * a <= 1) return {1, std::sqrt(c / (1 - a))};
  return {std::sqrt(2 * a), std::sqrt(2 * c)};
}

}  // namespace raytree
