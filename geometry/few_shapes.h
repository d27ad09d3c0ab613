// Shapes that are tested one by one beside the tracer's own, in double: infinite planes, which no bounding volume
// holds, and spheres and discs where they are so few that a hierarchy of their type would cost every ray more.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"

namespace raytree {

/// Up to so many spheres, and as many discs, are tested one by one. That a few beside a large mesh cost its rays little
/// is what the row `types` measures, and that so many small ones still do better than in a hierarchy of their own.
inline constexpr std::size_t kMostFewShapes = 32;

/// Which shapes of a scene those are.
struct FewShapes {
  const ShapeSet* shapes = nullptr;
  bool spheres = false, discs = false;

  FewShapes() = default;
  /// Planes, and spheres and discs where each are no more than `most`; the others are left to the tracer.
  FewShapes(const ShapeSet& set, std::size_t most)
      : shapes(&set),
        spheres(!set.spheres.shape.empty() && set.spheres.shape.size() <= most),
        discs(!set.discs.shape.empty() && set.discs.shape.size() <= most) {}

  bool any() const { return spheres || discs || !shapes->planes.empty(); }
};

/// Nearest of the few shapes for each ray, and its distance: kNoGeometry and the ray's max_distance where none is
/// nearer.
struct FewHits {
  std::vector<GeometryId> geometry;      ///< [rays.size + padding]
  std::vector<std::uint32_t> primitive;  ///< defined where there is a geometry
  std::vector<float> distance;
};

/// Distance along the ray to the plane, > 0, or -1: parallel, behind, or starting on it.
inline float plane_distance(const Vec3d& point, const Vec3d& normal, const Vec3f& origin, const Vec3f& direction) {
  const double slope = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
  const double height =
      normal.x * (point.x - origin.x) + normal.y * (point.y - origin.y) + normal.z * (point.z - origin.z);
  const double distance = height / slope;
  // A quotient beyond float's range is no hit; NaN (0 / 0, or a ray that is not finite) fails the comparison too.
  return distance > 0 && distance < 3e38 ? static_cast<float>(distance) : -1.0f;
}
inline float plane_distance(const Plane& plane, const Vec3f& origin, const Vec3f& direction) {
  return plane_distance(plane.point, plane.normal, origin, direction);
}

/// Distance along the ray (unit direction) to the sphere's nearer crossing that lies ahead, or -1.
inline float sphere_distance(const Imath::V4f& sphere, const Vec3f& origin, const Vec3f& direction) {
  const double x = double(sphere.x) - origin.x, y = double(sphere.y) - origin.y, z = double(sphere.z) - origin.z;
  const double dx = direction.x, dy = direction.y, dz = direction.z, radius = sphere.w;
  // As sphere_surface() has it: by way of the ray's closest point to the center.
  const double inverse_square = 2 - (dx * dx + dy * dy + dz * dz);
  const double along = (x * dx + y * dy + z * dz) * inverse_square;
  const double cx = dx * along - x, cy = dy * along - y, cz = dz * along - z;
  const double square = (radius * radius - (cx * cx + cy * cy + cz * cz)) * inverse_square;
  const double half_chord = std::sqrt(square > 0 ? square : 0);
  const double near = along - half_chord, far = along + half_chord;
  const double distance = near > 0 ? near : far;
  const bool meets = (square >= 0) & (distance > 0) & (distance < 3e38);
  return meets ? static_cast<float>(distance) : -1.0f;
}

/// Distance along the ray to the disc, > 0, or -1.
inline float disc_distance(const Imath::V4f& disc, const Vec3f& normal, const Vec3f& origin, const Vec3f& direction) {
  const Vec3d center(disc.x, disc.y, disc.z);
  const float distance = plane_distance(center, Vec3d(normal), origin, direction);
  const double x = double(origin.x) + double(distance) * direction.x - center.x,
               y = double(origin.y) + double(distance) * direction.y - center.y,
               z = double(origin.z) + double(distance) * direction.z - center.z;
  const bool meets = (distance > 0) & (x * x + y * y + z * z <= double(disc.w) * disc.w);
  return meets ? distance : -1.0f;
}

void intersect_few(const FewShapes& few, const RayBatch& rays, FewHits& hits) noexcept;

/// The same for one ray.
Hit intersect_few(const FewShapes& few, const Vec3f& origin, const Vec3f& direction, float max_distance) noexcept;

}  // namespace raytree
