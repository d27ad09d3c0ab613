// Whether a ray passes through a polygon: its corners seen along the ray, and point-in-polygon there. Watertight: two
// polygons with a common edge decide about it with the same numbers, and exactly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "geometry/vec.h"

namespace raytree {

/// A corner as the ray sees it: x and y off the ray, and where along the ray it lies, in lengths of the direction.
struct SeenCorner {
  double x, y, depth;
};

/// The picture plane of a ray, sheared so that the ray is its third axis (Woop, Benthin and Wald 2013, sec. 3.1). A
/// corner's place in it is a function of the corner and the ray alone, rounded or not; all that follows takes these
/// places as they are.
class RayPicture {
 public:
  RayPicture(const Vec3d& origin, const Vec3d& direction) : origin_(origin) {
    const Vec3d size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
    along_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x_ = (along_ + 1) % 3, y_ = (along_ + 2) % 3;
    inverse_ = 1 / direction[along_];
    slope_x_ = direction[x_] / direction[along_];
    slope_y_ = direction[y_] / direction[along_];
  }

  SeenCorner operator()(const Vec3f& corner) const {
    const double ahead = corner[along_] - origin_[along_];
    return {(corner[x_] - origin_[x_]) - slope_x_ * ahead, (corner[y_] - origin_[y_]) - slope_y_ * ahead,
            ahead * inverse_};
  }

 private:
  Vec3d origin_;
  int along_, x_, y_;
  double inverse_, slope_x_, slope_y_;
};

/// The sign of a.x b.y - a.y b.x, exact: 1, 0 or -1. Rounding keeps order, so products that differ once rounded are in
/// that order; those that do not are told apart by what rounding took. Exact while products of what rounding took do
/// not underflow: coordinates off the ray above 1e-140, or 0.
inline int turn_sign(const SeenCorner& a, const SeenCorner& b) {
  const double left = a.x * b.y, right = a.y * b.x;
  if (left != right) return left > right ? 1 : -1;
  const double left_rest = std::fma(a.x, b.y, -left), right_rest = std::fma(a.y, b.x, -right);
  return (left_rest > right_rest) - (left_rest < right_rest);
}

/// Whether the edge between two corners crosses the half line from the ray toward +x. The tie rule: the ray stands a
/// little to the right of where it is, and above it by much less still. So a corner at its height lies below it, an
/// edge through it to its left, and no ray ever meets an edge or a corner: it passes on one side, the same for every
/// polygon that has that edge or corner.
inline bool crosses_to_the_right(const SeenCorner& a, const SeenCorner& b) {
  if ((a.y > 0) == (b.y > 0)) return false;
  return a.y > 0 ? turn_sign(b, a) > 0 : turn_sign(a, b) > 0;
}

struct PolygonCrossing {
  bool inside = false;
  double nearest_corner = std::numeric_limits<double>::infinity(), farthest_corner = -nearest_corner;  ///< depths
};

/// By the even-odd rule, so edges that are gone both ways (bridges to holes) count for nothing. corner(i): the i-th of
/// `count` corners as seen.
template <class CornerAt>
PolygonCrossing cross_polygon(std::size_t count, const CornerAt& corner) {
  PolygonCrossing result;
  SeenCorner previous = corner(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const SeenCorner current = corner(i);
    result.inside ^= crosses_to_the_right(previous, current);
    result.nearest_corner = std::min(result.nearest_corner, current.depth);
    result.farthest_corner = std::max(result.farthest_corner, current.depth);
    previous = current;
  }
  return result;
}

/// Weights of a triangle's corners b and c where the ray passes it; the third is what is left of 1.
struct TriangleWeights {
  double u, v;

  double least() const { return std::min(1 - u - v, std::min(u, v)); }
};

inline TriangleWeights weights_in_triangle(const SeenCorner& a, const SeenCorner& b, const SeenCorner& c) {
  const double of_a = b.x * c.y - b.y * c.x, of_b = c.x * a.y - c.y * a.x, of_c = a.x * b.y - a.y * b.x;
  const double sum = of_a + of_b + of_c;
  // Seen along its plane it is a line: any place in it serves.
  if (sum == 0) return {1.0 / 3, 1.0 / 3};
  return {of_b / sum, of_c / sum};
}

}  // namespace raytree
