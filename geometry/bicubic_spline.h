// One uniform bicubic B-spline patch over 4 x 4 control points: its weights, and what stands for the points that a
// patch lacks where the surface ends. Knows no mesh and no OpenSubdiv.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace raytree {

/// The four weights of a uniform cubic B-spline at t in [0, 1], and of its derivatives.
struct CubicWeights {
  explicit CubicWeights(float t) {
    const float s = 1 - t, sixth = 1.0f / 6;
    value = {s * s * s * sixth, (3 * t * t * (t - 2) + 4) * sixth, (3 * s * s * (s - 2) + 4) * sixth,
             t * t * t * sixth};
    first = {-0.5f * s * s, 0.5f * t * (3 * t - 4), 0.5f * s * (4 - 3 * s), 0.5f * t * t};
    second = {s, 3 * t - 2, 3 * s - 2, t};
  }
  std::array<float, 4> value, first, second;
};

/// [4 rows from v = 0][4 points from u = 0][4 floats]
using BicubicControl = std::array<float, 64>;

/// The sum of the control points, each times its weights along u and v.
inline std::array<float, 4> weighted_sum(const BicubicControl& control, const std::array<float, 4>& u,
                                         const std::array<float, 4>& v) {
  std::array<float, 4> result{};
  for (std::size_t row = 0; row < 4; ++row) {
    const float* const c = &control[16 * row];
    for (std::size_t k = 0; k < 4; ++k)
      result[k] += v[row] * (u[0] * c[k] + u[1] * c[4 + k] + u[2] * c[8 + k] + u[3] * c[12 + k]);
  }
  return result;
}

/// Four points of a uniform cubic B-spline, each `step` from the next, become those of the Bezier curve.
template <class Point>
void spline_to_bezier(Point* p, std::size_t step) {
  Point &a = p[0], &b = p[step], &c = p[2 * step], &d = p[3 * step];
  const Point begin = (a + b * 4.0 + c) / 6.0, end = (b + c * 4.0 + d) / 6.0;
  const Point second = (b * 2.0 + c) / 3.0, third = (b + c * 2.0) / 3.0;
  a = begin, b = second, c = third, d = end;
}

/// The same for the 4 x 4 points of a patch.
template <class Point>
void spline_to_bezier(std::array<Point, 16>& points) {
  for (std::size_t i = 0; i < 4; ++i) spline_to_bezier(&points[4 * i], 1);
  for (std::size_t i = 0; i < 4; ++i) spline_to_bezier(&points[i], 4);
}

/// Bits of a set of sides along which a surface ends or is infinitely sharp, so that the points beyond count for
/// nothing.
inline constexpr std::uint8_t kBottomSide = 1, kRightSide = 2, kTopSide = 4, kLeftSide = 8;
inline constexpr std::size_t kSideSets = 16;

/// Replaces the points beyond such sides: a uniform cubic B-spline ends at its point a, with second derivative zero,
/// when the one before a is 2 a - b, b the next one inward. Beyond a corner that is done along u, then v.
inline void end_at_sides(BicubicControl& control, std::uint8_t sides) {
  const auto extend = [&](std::size_t outer, std::size_t a, std::size_t b) {
    for (std::size_t k = 0; k < 4; ++k) control[4 * outer + k] = 2 * control[4 * a + k] - control[4 * b + k];
  };
  for (std::size_t i = 0; i < 4; ++i) {
    if (sides & kLeftSide) extend(4 * i, 4 * i + 1, 4 * i + 2);
    if (sides & kRightSide) extend(4 * i + 3, 4 * i + 2, 4 * i + 1);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (sides & kBottomSide) extend(i, 4 + i, 8 + i);
    if (sides & kTopSide) extend(12 + i, 8 + i, 4 + i);
  }
}

}  // namespace raytree
