// The surface at a hit: exact position, normals, texture coordinates, and how far a new ray must start from it.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"
#include "geometry/vec.h"

namespace raytree {

/// Bound on the distance between a computed hit point and the surface, in units of half an ulp of the coordinates that
/// it was computed from. Barycentric points are off by up to 12 ulp, and the intersector's own test of a ray that
/// starts there errs by as much again; 64 half ulps cover both (tests/renderer/self_intersection_test.cpp).
inline constexpr float kSurfaceError = 64 * 0x1p-24f;

struct SurfacePoint {
  Vec3f position;          ///< scene space
  Vec3f geometric_normal;  ///< unit, outward (as wound); not turned to the ray
  Vec3f shading_normal;    ///< unit; the same side as geometric_normal where the mesh's normals are sane
  float clearance = 0;     ///< distance along the geometric normal at which a new ray starts
  float distance = 0;      ///< along the ray
  Vec2f texture;           ///< texture coordinates; (0, 0) where the shape has none
};

inline Vec3f unit(const Vec3f& v) { return v * (1 / std::sqrt(v.dot(v))); }
inline Vec3d unit(const Vec3d& v) { return v * (1 / std::sqrt(v.dot(v))); }

namespace detail {

SurfacePoint sphere_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit);
SurfacePoint disc_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit);
SurfacePoint plane_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit);

inline SurfacePoint triangle_surface(const TriangleMesh& mesh, const Hit& hit, bool texture) {
  const std::uint32_t* corner = &mesh.corners[std::size_t(hit.primitive) * 3];
  const Vec3f &a = mesh.positions[corner[0]], &b = mesh.positions[corner[1]], &c = mesh.positions[corner[2]];
  const float u = hit.u, v = hit.v, w = 1 - u - v;

  SurfacePoint point;
  point.position = a * w + b * u + c * v;
  const Vec3f normal = (b - a).cross(c - a);
  const float length_squared = normal.dot(normal);
  point.geometric_normal =
      length_squared > 0 ? normal * (1 / std::sqrt(length_squared)) : Vec3f(unit(Vec3d(b - a).cross(Vec3d(c - a))));

  // Per component: a horizontal floor of 1e4 units has no error in height, however wide it is.
  const Vec3f& n = point.geometric_normal;
  const auto largest = [](float x, float y, float z) {
    return std::max(std::abs(x), std::max(std::abs(y), std::abs(z)));
  };
  point.clearance = kSurfaceError * (std::abs(n.x) * largest(a.x, b.x, c.x) + std::abs(n.y) * largest(a.y, b.y, c.y) +
                                     std::abs(n.z) * largest(a.z, b.z, c.z));
  point.distance = hit.distance;

  point.shading_normal = point.geometric_normal;
  if (!mesh.normals.empty()) {
    const std::uint32_t* index =
        mesh.normal_corners.empty() ? corner : &mesh.normal_corners[std::size_t(hit.primitive) * 3];
    const Vec3f mean = mesh.normals[index[0]] * w + mesh.normals[index[1]] * u + mesh.normals[index[2]] * v;
    const float square = mean.dot(mean);
    // Opposite vertex normals cancel (catalogue of failures: interpolated normal -> 0); the facet's own is always
    // there.
    if (square > 1e-12f) point.shading_normal = mean * (1 / std::sqrt(square));
  }
  if (texture && !mesh.texture_coordinates.empty()) {
    const std::uint32_t* index =
        mesh.texture_corners.empty() ? corner : &mesh.texture_corners[std::size_t(hit.primitive) * 3];
    point.texture = mesh.texture_coordinates[index[0]] * w + mesh.texture_coordinates[index[1]] * u +
                    mesh.texture_coordinates[index[2]] * v;
  }
  return point;
}

}  // namespace detail

/// The surface that `hit` (of a ray from `origin` along unit `direction`) lies on. `texture`: whether texture
/// coordinates are wanted.
inline SurfacePoint surface_at(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                               bool texture) {
  if (hit.geometry >= kFirstMeshGeometry)
    return detail::triangle_surface(shapes.meshes[hit.geometry - kFirstMeshGeometry].mesh, hit, texture);
  if (hit.geometry == kSphereGeometry) return detail::sphere_surface(shapes, origin, direction, hit);
  if (hit.geometry == kDiscGeometry) return detail::disc_surface(shapes, origin, direction, hit);
  return detail::plane_surface(shapes, origin, direction, hit);
}

/// Origin of a ray that leaves `point` to the side of `normal` (unit, geometric, pointing to that side): clear of the
/// surface by the bound on its error (Waechter and Binder 2019 in purpose; error-bounded per component so that it
/// scales with the scene).
inline Vec3f offset_origin(const SurfacePoint& point, const Vec3f& normal) {
  return point.position + normal * point.clearance;
}

}  // namespace raytree
