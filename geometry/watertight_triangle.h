// A ray against a triangle in double, watertight (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT
// 2(1), 2013). The sign of an edge function is right or it is zero: two products of doubles are rounded in the order
// that they have, and where they come out equal their difference is taken again without rounding. Zero counts as
// inside, and two triangles reckon with one edge by the same products, so no ray passes between them.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "geometry/vec.h"

namespace raytree {

struct TriangleCrossing {
  double distance;  ///< in lengths of the direction; may lie behind the origin
  double u, v;      ///< weights of corner 1 and corner 2, within [0, 1] but for rounding
};

/// What a ray's tests of triangles have in common: the axes renamed so that it runs most along z, and the shear that
/// makes it run along z alone.
class WatertightRay {
 public:
  /// `direction` of any length but 0.
  WatertightRay(const Vec3d& origin, const Vec3d& direction) : origin_(origin) {
    const Vec3d size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
    z_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    x_ = (z_ + 1) % 3, y_ = (z_ + 2) % 3;
    if (direction[z_] < 0) std::swap(x_, y_);
    shear_ = Vec3d(direction[x_], direction[y_], 1) * (1 / direction[z_]);
  }

  /// Where the line meets the triangle, from either side; none where it passes it by or lies in its plane.
  std::optional<TriangleCrossing> crossing(const Vec3d& corner0, const Vec3d& corner1, const Vec3d& corner2) const {
    const Vec3d a = sheared(corner0), b = sheared(corner1), c = sheared(corner2);
    const double u = edge_function(c, b), v = edge_function(a, c), w = edge_function(b, a);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return std::nullopt;
    const double sum = u + v + w;
    if (sum == 0) return std::nullopt;
    return TriangleCrossing{(u * a.z + v * b.z + w * c.z) / sum, v / sum, w / sum};
  }

 private:
  Vec3d sheared(const Vec3d& corner) const {
    const Vec3d p = corner - origin_;
    return {p[x_] - shear_.x * p[z_], p[y_] - shear_.y * p[z_], shear_.z * p[z_]};
  }

  /// p.x q.y - p.y q.x, its sign exact.
  static double edge_function(const Vec3d& p, const Vec3d& q) {
    const double first = p.x * q.y, second = p.y * q.x;
    if (first != second) return first - second;
    return std::fma(p.x, q.y, -first) - std::fma(p.y, q.x, -second);
  }

  Vec3d origin_, shear_;
  int x_, y_, z_;
};

}  // namespace raytree
