// Power series in one variable cut off after a few terms, and vectors of them: numbers that carry their derivatives
// along a line. A formula written for any scalar type gives, with series for numbers, its own Taylor expansion.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "geometry/vec.h"

namespace raytree {

/// c[0] + c[1] t + ... ; products and quotients drop what lies beyond the last term.
struct PowerSeries {
  static constexpr std::size_t kTerms = 12;
  std::array<double, kTerms> c{};

  PowerSeries() = default;
  PowerSeries(double constant) { c[0] = constant; }  // NOLINT(google-explicit-constructor): a number is a series
  PowerSeries(double constant, double slope) { c[0] = constant, c[1] = slope; }

  friend PowerSeries operator+(PowerSeries a, const PowerSeries& b) {
    for (std::size_t i = 0; i < kTerms; ++i) a.c[i] += b.c[i];
    return a;
  }
  friend PowerSeries operator-(PowerSeries a, const PowerSeries& b) {
    for (std::size_t i = 0; i < kTerms; ++i) a.c[i] -= b.c[i];
    return a;
  }
  friend PowerSeries operator*(const PowerSeries& a, const PowerSeries& b) {
    PowerSeries product;
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; i + j < kTerms; ++j) product.c[i + j] += a.c[i] * b.c[j];
    return product;
  }
  /// b.c[0] must not be 0.
  friend PowerSeries operator/(const PowerSeries& a, const PowerSeries& b) {
    PowerSeries quotient;
    for (std::size_t i = 0; i < kTerms; ++i) {
      double rest = a.c[i];
      for (std::size_t j = 0; j < i; ++j) rest -= quotient.c[j] * b.c[i - j];
      quotient.c[i] = rest / b.c[0];
    }
    return quotient;
  }
};

/// A vector over any scalar that formulas of this folder are written for: double or PowerSeries.
template <class Scalar>
struct VectorOf {
  Scalar x = 0.0, y = 0.0, z = 0.0;

  VectorOf() = default;
  VectorOf(Scalar x_, Scalar y_, Scalar z_) : x(x_), y(y_), z(z_) {}
  explicit VectorOf(const Vec3d& v) : x(v.x), y(v.y), z(v.z) {}

  friend VectorOf operator+(const VectorOf& a, const VectorOf& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend VectorOf operator-(const VectorOf& a, const VectorOf& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend VectorOf operator*(const VectorOf& a, const Scalar& s) { return {a.x * s, a.y * s, a.z * s}; }
  friend VectorOf operator/(const VectorOf& a, const Scalar& s) { return {a.x / s, a.y / s, a.z / s}; }
  VectorOf cross(const VectorOf& b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
};

inline Vec3d to_vec3d(const VectorOf<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace raytree
