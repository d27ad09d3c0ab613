// Bounding spheres in closed form: of a cone or cylinder, and of what an instance makes of any sphere's content.
// Spheres bound themselves, discs are bound by the sphere that they are the equator of.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/bounding_sphere.h"
#include "geometry/cone.h"
#include "geometry/instance_transform.h"

namespace raytree {

/// The smallest sphere about a cone: that through the rims of both ends, or the one that has the wider rim for its
/// equator, where that holds the other. Wider by what rounds, as a share of the coordinates.
inline BoundingSphere sphere_about(const Cone& cone) {
  const Vec3d along = cone.apex - cone.base;
  const double length = along.length(), base = cone.base_radius, apex = cone.apex_radius;
  // As far from one rim as from the other: base^2 + height^2 = apex^2 + (length - height)^2.
  const double height = std::clamp((length + (apex - base) * (apex + base) / length) / 2, 0.0, length);
  const Vec3d center = cone.base + along * (height / length);
  const double radius = std::max(std::hypot(base, height), std::hypot(apex, length - height));
  return {center, radius + kSphereSlack * (radius + cone.base.length() + cone.apex.length())};
}

/// A sphere about what an instance makes of what `inside`, in the group's space, holds: an ellipsoid whose longest half
/// axis is the radius times the transform's stretch. Wide enough for what rounds on the way in, kMostCancellation times
/// as much as a sphere test does.
inline BoundingSphere sphere_about(const InstanceTransform& transform, const BoundingSphere& inside) {
  const Vec3d center = transform.point(inside.center);
  const double radius = inside.radius * transform.stretch();
  return {center, radius + kMostCancellation * kSphereSlack * (radius + center.length())};
}

}  // namespace raytree
