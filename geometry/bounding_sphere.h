// Whitted's one bounding volume (1980, sec. 3): spheres about objects, and the part of a ray that lies in one. In
// double, and wide by more than rounding: what is inside is never found outside.
#pragma once

#include <cmath>

#include "geometry/vec.h"

namespace raytree {

/// A stretch of a ray, in lengths of its direction; empty where enter > leave.
struct RayInterval {
  double enter, leave;

  bool empty() const { return !(enter <= leave); }
  void intersect(double from, double to) {
    if (from > enter) enter = from;
    if (to < leave) leave = to;
  }
};

/// A ray as spheres are tested with it; the direction need not be unit.
struct SphereRay {
  SphereRay(const Vec3d& from, const Vec3d& along)
      : origin(from), direction(along), inverse_square(1 / along.dot(along)) {}

  Vec3d origin, direction;
  double inverse_square;
};

/// What is added to a radius, as a share of the distance to the center and the radius: 2^7 half ulps. A sphere test
/// rounds less than 16 times, each by half an ulp of what it adds up; what objects compute of themselves (places of
/// corners seen along the ray, distances to planes) as often again.
inline constexpr double kSphereSlack = 0x1p-46;

struct BoundingSphere {
  Vec3d center{0, 0, 0};
  double radius = 0;

  /// Where the line of the ray lies inside, also behind its origin. Empty: it passes by.
  RayInterval inside(const SphereRay& ray) const {
    const Vec3d to_center = center - ray.origin;
    const double distance = std::abs(to_center.x) + std::abs(to_center.y) + std::abs(to_center.z);
    const double reach = radius + kSphereSlack * (distance + radius);
    // By way of the line's point closest to the center, so that a far origin costs no digits.
    const double middle = to_center.dot(ray.direction) * ray.inverse_square;
    const Vec3d off = ray.direction * middle - to_center;
    const double square = (reach * reach - off.dot(off)) * ray.inverse_square;
    if (!(square >= 0)) return {1, -1};
    const double half = std::sqrt(square);
    return {middle - half, middle + half};
  }
};

/// About points, none of them further from the middle of their box than the radius says. Points: begin() and end().
template <class Points>
BoundingSphere sphere_about(const Points& points) {
  Bounds3d box;
  for (const auto& p : points) box.extendBy(Vec3d(p));
  BoundingSphere sphere{box.center(), 0};
  for (const auto& p : points) sphere.radius = std::fmax(sphere.radius, (Vec3d(p) - sphere.center).length());
  return sphere;
}

/// About two spheres, or one of them where it holds the other.
inline BoundingSphere sphere_about(const BoundingSphere& a, const BoundingSphere& b) {
  const Vec3d across = b.center - a.center;
  const double distance = across.length();
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = (distance + a.radius + b.radius) / 2;
  return {a.center + across * ((radius - a.radius) / distance), radius * (1 + kSphereSlack)};
}

}  // namespace raytree
