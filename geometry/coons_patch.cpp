#include "geometry/coons_patch.h"

#include <algorithm>

namespace raytree {
namespace {

BezierCurve backwards(const BezierCurve& curve) {
  BezierCurve result = curve;
  std::reverse(result.points.begin(), result.points.end());
  std::reverse(result.weights.begin(), result.weights.end());
  return result;
}

template <class Scalar>
VectorOf<Scalar> blend(const VectorOf<Scalar>& a, const VectorOf<Scalar>& b, const Scalar& t) {
  return a * (Scalar(1.0) - t) + b * t;
}

template <class Scalar>
struct Derivatives {
  VectorOf<Scalar> position, du, dv, duu, duv, dvv;
};

template <class Scalar>
Derivatives<Scalar> derivatives(const CoonsPatch& patch, const Scalar& u, const Scalar& v) {
  const auto bottom = evaluate(patch.bottom, u), top = evaluate(patch.top, u);
  const auto left = evaluate(patch.left, v), right = evaluate(patch.right, v);
  const VectorOf<Scalar> p00(patch.bottom.points.front()), p10(patch.bottom.points.back());
  const VectorOf<Scalar> p01(patch.top.points.front()), p11(patch.top.points.back());
  // One ruled surface, and by how much the other pair of curves leaves its rulings: 0 in the corners, so that nothing
  // is added there and taken away again.
  const auto off_left = left.position - blend(p00, p01, v), off_right = right.position - blend(p10, p11, v);
  const auto off_left_1 = left.first - (p01 - p00), off_right_1 = right.first - (p11 - p10);
  Derivatives<Scalar> at;
  at.position = blend(bottom.position, top.position, v) + blend(off_left, off_right, u);
  at.du = blend(bottom.first, top.first, v) + (off_right - off_left);
  at.dv = (top.position - bottom.position) + blend(off_left_1, off_right_1, u);
  at.duu = blend(bottom.second, top.second, v);
  at.duv = (top.first - bottom.first) + (off_right_1 - off_left_1);
  at.dvv = blend(left.second, right.second, u);
  return at;
}

}  // namespace

PatchDerivatives evaluate(const CoonsPatch& patch, double u, double v) {
  const auto at = derivatives(patch, u, v);
  return {to_vec3d(at.position), to_vec3d(at.du),  to_vec3d(at.dv),
          to_vec3d(at.duu),      to_vec3d(at.duv), to_vec3d(at.dvv)};
}

TangentSeries tangent_series(const CoonsPatch& patch, double u, double v, const Vec2d& toward) {
  const auto at = derivatives(patch, PowerSeries(u, toward.x), PowerSeries(v, toward.y));
  return {at.du, at.dv};
}

double derivative_scale(const CoonsPatch& patch) {
  double longest = 0;
  for (const BezierCurve* curve : {&patch.bottom, &patch.top, &patch.left, &patch.right})
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, (curve->points[i + 1] - curve->points[i]).length());
  return 3 * longest;
}

BezierCurve side_curve(const CoonsPatch& patch, int side) {
  switch (side) {
    case 0:
      return patch.bottom;
    case 1:
      return patch.right;
    case 2:
      return backwards(patch.top);
    default:
      return backwards(patch.left);
  }
}

CoonsPatch transposed(const CoonsPatch& patch) { return {patch.left, patch.right, patch.bottom, patch.top}; }

std::optional<BezierPatch> as_bezier_patch(const CoonsPatch& patch) {
  for (const BezierCurve* curve : {&patch.bottom, &patch.top, &patch.left, &patch.right})
    for (const double weight : curve->weights)
      if (weight != patch.bottom.weights[0]) return std::nullopt;
  BezierPatch result;
  const Vec3d &a = patch.bottom.points[0], &b = patch.bottom.points[3], &c = patch.top.points[0],
              &d = patch.top.points[3];
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      // The parameter itself is the cubic with control values 0, 1/3, 2/3, 1.
      const double u = double(i) / 3, v = double(j) / 3;
      const Vec3d across_v = patch.bottom.points[i] * (1 - v) + patch.top.points[i] * v;
      const Vec3d across_u = patch.left.points[j] * (1 - u) + patch.right.points[j] * u;
      const Vec3d corners = (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
      result.points[4 * j + i] = across_v + across_u - corners;
    }
  return result;
}

}  // namespace raytree
