// Cubic Bezier curves, polynomial and rational: points and derivatives. Written once for numbers and for power series.
#pragma once

#include <array>
#include <cstddef>

#include "geometry/power_series.h"
#include "geometry/vec.h"

namespace raytree {

/// All in the origin; Imath's vectors begin with whatever lay in memory.
template <std::size_t Count>
std::array<Vec3d, Count> points_at_origin() {
  std::array<Vec3d, Count> points;
  points.fill(Vec3d(0, 0, 0));
  return points;
}

/// Cubic; a rational one where the weights differ.
struct BezierCurve {
  std::array<Vec3d, 4> points = points_at_origin<4>();  ///< the curve begins in the first and ends in the last
  std::array<double, 4> weights{1, 1, 1, 1};            ///< positive
};

/// The four cubic Bernstein polynomials of one parameter, and their derivatives.
template <class Scalar>
struct CubicBernstein {
  std::array<Scalar, 4> value, first, second;

  explicit CubicBernstein(const Scalar& t) {
    const Scalar one = 1.0, two = 2.0, three = 3.0, six = 6.0, s = one - t;
    value = {s * s * s, three * s * s * t, three * s * t * t, t * t * t};
    const Scalar a = three * s * s, b = six * s * t, c = three * t * t;
    first = {Scalar(0.0) - a, a - b, b - c, c};
    second = {six * s, six * (t - two * s), six * (s - two * t), six * t};
  }
};

/// A point with its derivatives by the curve's parameter.
template <class Scalar>
struct CurveDerivatives {
  VectorOf<Scalar> position, first, second;
};

/// At a parameter of [0, 1]. The ends are exact.
template <class Scalar>
CurveDerivatives<Scalar> evaluate(const BezierCurve& curve, const Scalar& t) {
  const CubicBernstein<Scalar> basis(t);
  // Homogeneous: X = sum w_i B_i P_i over w = sum w_i B_i.
  VectorOf<Scalar> x, x1, x2;
  Scalar w = 0.0, w1 = 0.0, w2 = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const VectorOf<Scalar> p(curve.points[i]);
    const Scalar weight = curve.weights[i];
    const Scalar b = weight * basis.value[i], b1 = weight * basis.first[i], b2 = weight * basis.second[i];
    x = x + p * b, x1 = x1 + p * b1, x2 = x2 + p * b2;
    w = w + b, w1 = w1 + b1, w2 = w2 + b2;
  }
  CurveDerivatives<Scalar> at;
  at.position = x / w;
  at.first = (x1 - at.position * w1) / w;
  at.second = (x2 - at.first * (w1 + w1) - at.position * w2) / w;
  return at;
}

}  // namespace raytree
