// The lateral surface of a cone cut off at both ends (a cylinder where the two radii are equal), exact: where a ray
// meets it, its normal and its bounds. Open at both ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/vec.h"

namespace raytree {

struct Cone {
  Vec3d base, apex;                         ///< centers of the two ends, apart from each other
  double base_radius = 1, apex_radius = 0;  ///< >= 0, not both 0
};

/// The cone's axis and slope, as its equations want them.
struct ConeFrame {
  explicit ConeFrame(const Cone& cone) : base(cone.base), base_radius(cone.base_radius) {
    const Vec3d along = cone.apex - cone.base;
    length = along.length();
    axis = along * (1 / length);
    slope = (cone.apex_radius - cone.base_radius) / length;
  }

  Vec3d base, axis;
  double length;  ///< of the axis
  double base_radius;
  double slope;  ///< radius gained per unit along the axis
};

/// A line as the cone's equation sees it: how far its points lie off the surface, |across|^2 - radius(height)^2, is
/// a s^2 + 2 half_b s + c. s is the distance along the line from its point nearest to the middle of the axis, so that
/// a far eye costs no digits; `shift` is what lies before that.
struct ConeLine {
  /// direction: unit.
  ConeLine(const ConeFrame& cone, const Vec3d& origin, const Vec3d& direction) {
    const Vec3d middle = cone.base + cone.axis * (cone.length / 2);
    shift = (middle - origin).dot(direction);
    const Vec3d start = origin + direction * shift - cone.base;
    start_height = start.dot(cone.axis), climb = direction.dot(cone.axis);
    const Vec3d start_across = start - cone.axis * start_height, across = direction - cone.axis * climb;
    const double r = cone.base_radius + cone.slope * start_height, k = cone.slope * climb;
    a = across.dot(across) - k * k;
    half_b = start_across.dot(across) - r * k;
    c = start_across.dot(start_across) - r * r;
  }

  double shift, start_height, climb, a, half_b, c;

  double height(double s) const { return start_height + s * climb; }
};

/// Distances at which the line origin + t direction (unit) meets the surface, nearer first; infinity for none.
struct ConeCrossings {
  double near = std::numeric_limits<double>::infinity(), far = near;
};

inline ConeCrossings cone_crossings(const ConeFrame& cone, const Vec3d& origin, const Vec3d& direction) {
  const ConeLine line(cone, origin, direction);
  ConeCrossings result;
  const auto offer = [&](double t) {
    const double height = line.height(t);
    // The equation also holds on the mirror cone beyond the tip, where the radius is negative; no height between the
    // ends lies there.
    if (!(height >= 0 && height <= cone.length)) return;
    t += line.shift;
    if (t < result.near)
      result.far = result.near, result.near = t;
    else
      result.far = std::min(result.far, t);
  };
  const double discriminant = line.half_b * line.half_b - line.a * line.c;
  if (!(discriminant >= 0)) return result;
  // The root whose two terms have one sign, and the other by the product of both: neither cancels.
  const double q = -(line.half_b + std::copysign(std::sqrt(discriminant), line.half_b));
  if (q != 0) offer(line.c / q);
  if (line.a != 0) offer(q / line.a);
  return result;
}

/// Unit normal, outward, at a point of the surface. At the tip of a cone, which has none, along the axis.
inline Vec3d cone_normal(const ConeFrame& cone, const Vec3d& point) {
  const Vec3d from_base = point - cone.base;
  const double height = from_base.dot(cone.axis);
  const Vec3d across = from_base - cone.axis * height;
  const double distance = across.length();
  if (!(distance > 0)) return cone.slope > 0 ? -cone.axis : cone.axis;
  return (across * (1 / distance) - cone.axis * cone.slope).normalized();
}

inline Bounds3d bounds(const Cone& cone) {
  const Vec3d axis = (cone.apex - cone.base).normalized();
  Bounds3d box;
  const auto add_end = [&](const Vec3d& center, double radius) {
    const auto reach = [&](double n) { return radius * std::sqrt(std::max(0.0, 1 - n * n)); };
    const Vec3d half(reach(axis.x), reach(axis.y), reach(axis.z));
    box.extendBy(center - half);
    box.extendBy(center + half);
  };
  add_end(cone.base, cone.base_radius);
  add_end(cone.apex, cone.apex_radius);
  return box;
}

}  // namespace raytree
