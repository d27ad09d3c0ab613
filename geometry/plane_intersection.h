// Infinite planes, which no bounding volume holds: a linear search beside the tracer's own, in double.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"

namespace raytree {

inline constexpr std::uint32_t kNoPlane = 0xffffffffu;

/// Nearest plane of each ray, and its distance: the ray's max_distance where no plane is nearer.
struct PlaneHits {
  std::vector<std::uint32_t> plane;  ///< [rays.size + padding]
  std::vector<float> distance;
};

/// Distance along the ray to the plane, > 0, or -1: parallel, behind, or starting on it.
inline float plane_distance(const Plane& plane, const Vec3f& origin, const Vec3f& direction) {
  const double slope = plane.normal.x * direction.x + plane.normal.y * direction.y + plane.normal.z * direction.z;
  const double height = plane.normal.x * (plane.point.x - origin.x) + plane.normal.y * (plane.point.y - origin.y) +
                        plane.normal.z * (plane.point.z - origin.z);
  const double distance = height / slope;
  // A quotient beyond float's range is no hit; NaN (0 / 0, or a ray that is not finite) fails the comparison too.
  return distance > 0 && distance < 3e38 ? static_cast<float>(distance) : -1.0f;
}

void intersect_planes(const std::vector<Plane>& planes, const RayBatch& rays, PlaneHits& hits) noexcept;

}  // namespace raytree
