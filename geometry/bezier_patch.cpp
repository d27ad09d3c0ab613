#include "geometry/bezier_patch.h"

#include <algorithm>
#include <utility>

namespace raytree {
namespace {

/// A point in homogeneous coordinates.
template <class Scalar>
struct Homogeneous {
  VectorOf<Scalar> x;
  Scalar w = 0.0;

  void add(const Vec3d& p, const Scalar& factor) {
    x = x + VectorOf<Scalar>(p) * factor;
    w = w + factor;
  }
};

/// The four rows' sums over u; then they need be formed once for all sums over v.
template <class Scalar>
std::array<Homogeneous<Scalar>, 4> row_sums(const BezierPatch& patch, const std::array<Scalar, 4>& along_u) {
  std::array<Homogeneous<Scalar>, 4> rows;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i)
      rows[j].add(patch.points[4 * j + i], Scalar(patch.weights[4 * j + i]) * along_u[i]);
  return rows;
}

template <class Scalar>
Homogeneous<Scalar> sum(const std::array<Homogeneous<Scalar>, 4>& rows, const std::array<Scalar, 4>& along_v) {
  Homogeneous<Scalar> total;
  for (std::size_t j = 0; j < 4; ++j) {
    total.x = total.x + rows[j].x * along_v[j];
    total.w = total.w + rows[j].w * along_v[j];
  }
  return total;
}

}  // namespace

PatchDerivatives evaluate(const BezierPatch& patch, double u, double v) {
  const CubicBernstein<double> in_u(u), in_v(v);
  const auto rows = row_sums(patch, in_u.value), rows_u = row_sums(patch, in_u.first),
             rows_uu = row_sums(patch, in_u.second);
  const auto s = sum(rows, in_v.value), su = sum(rows_u, in_v.value), sv = sum(rows, in_v.first);
  const auto suu = sum(rows_uu, in_v.value), suv = sum(rows_u, in_v.first), svv = sum(rows, in_v.second);
  const auto p = s.x / s.w;
  const auto pu = (su.x - p * su.w) / s.w, pv = (sv.x - p * sv.w) / s.w;
  const auto puu = (suu.x - pu * (2 * su.w) - p * suu.w) / s.w;
  const auto puv = (suv.x - pu * sv.w - pv * su.w - p * suv.w) / s.w;
  const auto pvv = (svv.x - pv * (2 * sv.w) - p * svv.w) / s.w;
  return {to_vec3d(p), to_vec3d(pu), to_vec3d(pv), to_vec3d(puu), to_vec3d(puv), to_vec3d(pvv)};
}

TangentSeries tangent_series(const BezierPatch& patch, double u, double v, const Vec2d& toward) {
  const CubicBernstein<PowerSeries> in_u(PowerSeries(u, toward.x)), in_v(PowerSeries(v, toward.y));
  const auto rows = row_sums(patch, in_u.value);
  const auto s = sum(rows, in_v.value), sv = sum(rows, in_v.first);
  const auto su = sum(row_sums(patch, in_u.first), in_v.value);
  // P_u = (X_u w - X w_u) / w^2, and what is positive does not turn it: in place of w^2 its first term.
  const PowerSeries share = 1 / (s.w.c[0] * s.w.c[0]);
  return {(su.x * s.w - s.x * su.w) * share, (sv.x * s.w - s.x * sv.w) * share};
}

double derivative_scale(const BezierPatch& patch) {
  double longest = 0;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, (patch.points[4 * j + i + 1] - patch.points[4 * j + i]).length());
      longest = std::max(longest, (patch.points[4 * i + 4 + j] - patch.points[4 * i + j]).length());
    }
  return 3 * longest;
}

BezierCurve side_curve(const BezierPatch& patch, int side) {
  constexpr std::array<std::array<std::size_t, 4>, 4> kSides{
      {{0, 1, 2, 3}, {3, 7, 11, 15}, {15, 14, 13, 12}, {12, 8, 4, 0}}};
  BezierCurve curve;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t index = kSides[static_cast<std::size_t>(side)][i];
    curve.points[i] = patch.points[index];
    curve.weights[i] = patch.weights[index];
  }
  return curve;
}

BezierPatch transposed(const BezierPatch& patch) {
  BezierPatch result = patch;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < j; ++i) {
      std::swap(result.points[4 * j + i], result.points[4 * i + j]);
      std::swap(result.weights[4 * j + i], result.weights[4 * i + j]);
    }
  return result;
}

}  // namespace raytree
