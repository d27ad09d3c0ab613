// The surface at a hit: exact position, normals, texture coordinates, and how far a new ray must start from it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"
#include "geometry/vec.h"

namespace raytree {

/// Bound on the distance between a computed hit point and the surface as the intersector sees it from there, in units
/// of half an ulp of the coordinates that it was computed from. The point itself rounds three products and two sums
/// (2 units), its offset once more, the intersector's differences, cross and dot products another few: false hits
/// begin to show at 3 units and are gone at 4 (tests/renderer/self_intersection_test.cpp, 16 sizes and places). Four
/// times that serves.
inline constexpr float kSurfaceError = 16 * kRoundoff;

/// The same for the part that a triangle's thinness magnifies: the rounding of the cross product of its edges, which
/// turns the normal, times how far the triangle reaches. For a triangle of height h over an edge of length l it grows
/// as l^2 / h, so slivers need it and other triangles hardly feel it.
inline constexpr float kNormalError = 2 * kRoundoff;

/// At most this share of a triangle's reach is added for its thinness.
inline constexpr float kMostNormalError = 0x1p-9f;

/// Share of the largest coordinate that counts as error in every direction: a floor at height 0 has no error in height,
/// yet a ray must start off it, not on it.
inline constexpr float kLeastError = 0x1p-10f;

struct SurfacePoint {
  Vec3f position;          ///< scene space
  Vec3f geometric_normal;  ///< unit, outward (as wound); not turned to the ray
  Vec3f shading_normal;    ///< unit; the same side as geometric_normal where the mesh's normals are sane
  float clearance = 0;     ///< distance along the geometric normal at which a new ray starts
  float distance = 0;      ///< along the ray
  Vec2f texture{0, 0};     ///< texture coordinates; (0, 0) where the shape has none
};

inline Vec3f unit(const Vec3f& v) { return v * (1 / std::sqrt(v.dot(v))); }
inline Vec3d unit(const Vec3d& v) { return v * (1 / std::sqrt(v.dot(v))); }

/// A vector that is unit but for rounding made unit again: one step of Newton's method for the inverse root, so that
/// the length does not drift over a deep tree.
template <class Vec>
Vec renormalized(const Vec& v) {
  using Real = typename Vec::BaseType;
  return v * (Real(1.5) - Real(0.5) * v.dot(v));
}

namespace detail {

/// std::max and std::min by value: through references, g++ makes branches of them that keep loops from being
/// vectorized.
inline float larger(float a, float b) { return a < b ? b : a; }
inline double larger(double a, double b) { return a < b ? b : a; }
inline float smaller(float a, float b) { return b < a ? b : a; }
/// Of three numbers' sizes.
inline float largest_size(float x, float y, float z) { return larger(std::abs(x), larger(std::abs(y), std::abs(z))); }

/// Distance from which a new ray starts, for a point computed from coordinates of up to `largest` per component. Per
/// component, since a horizontal floor of 1e4 units has next to no error in height, however wide it is.
inline float clearance(const Vec3f& normal, const Vec3f& largest) {
  return kSurfaceError *
         (std::abs(normal.x) * largest.x + std::abs(normal.y) * largest.y + std::abs(normal.z) * largest.z +
          kLeastError * larger(largest.x, larger(largest.y, largest.z)));
}

/// Where a ray meets a sphere: what SurfacePoint says of it.
struct SphereSolution {
  float x, y, z;                       ///< position
  float normal_x, normal_y, normal_z;  ///< unit
  float clearance, distance;
};

/// The intersector says which sphere and, by the distance, which of its two sides; where exactly is solved again in
/// double, by way of the ray's closest point to the center, which keeps its digits for far and small spheres. Written
/// in components and without branches, so that a loop over many hits is vectorized.
inline SphereSolution solve_sphere(double center_x, double center_y, double center_z, double radius, double origin_x,
                                   double origin_y, double origin_z, double dx, double dy, double dz,
                                   float hit_distance) {
  // 1 / d.d to first order: d is unit but for float's rounding, whose square is under double's.
  const double inverse_square = 2 - (dx * dx + dy * dy + dz * dz);
  const double to_x = center_x - origin_x, to_y = center_y - origin_y, to_z = center_z - origin_z;
  const double along = (to_x * dx + to_y * dy + to_z * dz) * inverse_square;
  const double closest_x = dx * along - to_x, closest_y = dy * along - to_y, closest_z = dz * along - to_z;
  const double closest_square = closest_x * closest_x + closest_y * closest_y + closest_z * closest_z;
  const double chord_square = (radius * radius - closest_square) * inverse_square;
  const double half_chord = std::sqrt(chord_square > 0 ? chord_square : 0.0);
  const double near = along - half_chord, far = along + half_chord;
  const bool takes_near = std::abs(near - hit_distance) <= std::abs(far - hit_distance);
  const double step = takes_near ? -half_chord : half_chord, distance = takes_near ? near : far;
  const double x = closest_x + dx * step, y = closest_y + dy * step, z = closest_z + dz * step;  // from the center
  // A ray that grazes the sphere within the intersector's error has no chord: its closest point lies off the surface.
  const double length = half_chord > 0 ? radius : std::sqrt(x * x + y * y + z * z);
  const double scale = 1 / length;
  const double nx = x * scale, ny = y * scale, nz = z * scale;
  const double xy = larger(std::abs(center_x), std::abs(center_y));
  return {static_cast<float>(center_x + nx * radius),
          static_cast<float>(center_y + ny * radius),
          static_cast<float>(center_z + nz * radius),
          static_cast<float>(nx),
          static_cast<float>(ny),
          static_cast<float>(nz),
          static_cast<float>(kSurfaceError * (larger(xy, std::abs(center_z)) + radius)),
          static_cast<float>(distance > 0 ? distance : 0.0)};
}

inline void sphere_surface(const Vec3d& center, double radius, const Vec3f& origin, const Vec3f& direction,
                           const Hit& hit, SurfacePoint& point) {
  const SphereSolution s = solve_sphere(center.x, center.y, center.z, radius, origin.x, origin.y, origin.z, direction.x,
                                        direction.y, direction.z, hit.distance);
  point.position = {s.x, s.y, s.z};
  point.geometric_normal = point.shading_normal = {s.normal_x, s.normal_y, s.normal_z};
  point.clearance = s.clearance;
  point.distance = s.distance;
}

inline void flat_surface(const Vec3d& through, const Vec3d& normal, const Vec3f& origin, const Vec3f& direction,
                         const Hit& hit, SurfacePoint& point) {
  const Vec3d o(origin), d(direction);
  const double slope = d.dot(normal);
  const double distance = slope != 0 ? (through - o).dot(normal) / slope : double(hit.distance);
  const Vec3d position = o + d * distance;

  point.position = Vec3f(position);
  point.geometric_normal = point.shading_normal = Vec3f(normal);
  const auto largest = [&](int axis) {
    return static_cast<float>(std::max(std::abs(position[axis]), std::abs(through[axis])));
  };
  point.clearance = clearance(point.geometric_normal, {largest(0), largest(1), largest(2)});
  point.distance = static_cast<float>(distance);
}

inline void sphere_surface(const BoundedShapes& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                           SurfacePoint& point) {
  const Imath::V4f& sphere = shapes.spheres.center_radius[hit.primitive];
  sphere_surface(Vec3d(sphere.x, sphere.y, sphere.z), double(sphere.w), origin, direction, hit, point);
}

inline void disc_surface(const BoundedShapes& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                         SurfacePoint& point) {
  const Imath::V4f& disc = shapes.discs.center_radius[hit.primitive];
  flat_surface(Vec3d(disc.x, disc.y, disc.z), Vec3d(shapes.discs.normal[hit.primitive]), origin, direction, hit, point);
}

/// As the sphere's: the intersector says which cone and which of its sides; where exactly is solved again in double.
inline void cone_surface(const Cone& cone, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                         SurfacePoint& point) {
  const ConeFrame frame(cone);
  const Vec3d o(origin), d = unit(Vec3d(direction));
  const ConeCrossings crossings = cone_crossings(frame, o, d);
  double distance = std::abs(crossings.near - hit.distance) <= std::abs(crossings.far - hit.distance) ? crossings.near
                                                                                                      : crossings.far;
  // At a rim or a grazing ray the two solutions may disagree about whether there is a crossing at all.
  if (!std::isfinite(distance)) distance = hit.distance;
  Vec3d position = o + d * distance;
  const Vec3d normal = cone_normal(frame, position);
  // Onto the surface, along the radius: what the ray's own length takes from the digits comes back.
  const Vec3d from_base = position - frame.base;
  const double height = from_base.dot(frame.axis);
  const Vec3d across = from_base - frame.axis * height;
  if (const double off_axis = across.length(); off_axis > 0)
    position += across * ((frame.base_radius + frame.slope * height) / off_axis - 1);
  point.position = Vec3f(position);
  point.geometric_normal = point.shading_normal = Vec3f(normal);
  const Bounds3d box = bounds(cone);
  const auto largest = [&](int axis) {
    return static_cast<float>(std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
  };
  point.clearance = kSurfaceError * std::max(largest(0), std::max(largest(1), largest(2)));
  point.distance = static_cast<float>(std::max(0.0, distance));
}

inline void plane_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                          SurfacePoint& point) {
  const Plane& plane = shapes.planes[hit.primitive];
  flat_surface(plane.point, plane.normal, origin, direction, hit, point);
}

/// What SurfacePoint says of a point of a triangle, but for what its vertices interpolate.
struct TriangleSolution {
  Vec3f position;
  Vec3f normal;  ///< unit; void unless in_range
  float clearance;
  bool in_range;  ///< the squares of its edges stay within float's range
};

/// `u`, `v`: weights of b and c. Without branches, so that a loop over many hits is vectorized.
inline TriangleSolution solve_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, float u, float v) {
  TriangleSolution result;
  const float w = 1 - u - v;
  result.position = a * w + b * u + c * v;
  // The cross product of two edges, its two products apart: the larger they are beside their difference, the less its
  // direction is worth.
  const Vec3f e = b - a, f = c - a;
  const Vec3f plus(e.y * f.z, e.z * f.x, e.x * f.y), minus(e.z * f.y, e.x * f.z, e.y * f.x);
  const Vec3f normal = plus - minus;
  const float length_squared = normal.dot(normal);
  result.in_range = (length_squared > 0x1p-100f) & (length_squared <= std::numeric_limits<float>::max());
  const float over_length = 1 / std::sqrt(length_squared);
  result.normal = normal * over_length;
  const Vec3f coordinates(largest_size(a.x, b.x, c.x), largest_size(a.y, b.y, c.y), largest_size(a.z, b.z, c.z));
  const Vec3f reach(std::abs(e.x) + std::abs(f.x), std::abs(e.y) + std::abs(f.y), std::abs(e.z) + std::abs(f.z));
  const float turned = (std::abs(plus.x) + std::abs(minus.x)) * reach.x +
                       (std::abs(plus.y) + std::abs(minus.y)) * reach.y +
                       (std::abs(plus.z) + std::abs(minus.z)) * reach.z;
  result.clearance =
      clearance(result.normal, coordinates) +
      smaller(kNormalError * turned * over_length, kMostNormalError * larger(reach.x, larger(reach.y, reach.z)));
  return result;
}

/// The unit normal of a triangle whose edges' squares leave float's range, and the clearance from it.
void solve_extreme_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, TriangleSolution& solution);

/// The mean of vertex normals, unit; where they cancel (catalogue of failures: interpolated normal -> 0) the facet's
/// own, which is always there.
inline Vec3f interpolated_normal(const Vec3f& a, const Vec3f& b, const Vec3f& c, float u, float v, const Vec3f& facet) {
  const Vec3f mean = a * (1 - u - v) + b * u + c * v;
  const float square = mean.dot(mean);
  const float over_length = 1 / std::sqrt(square);
  const bool is_sane = (square > 1e-12f) & (square <= std::numeric_limits<float>::max());
  return {is_sane ? mean.x * over_length : facet.x, is_sane ? mean.y * over_length : facet.y,
          is_sane ? mean.z * over_length : facet.z};
}

/// Texture coordinates at a hit on a mesh that has some.
inline Vec2f texture_at(const TriangleMesh& mesh, const Hit& hit) {
  const Buffer<std::uint32_t>& corners = mesh.texture_corners.empty() ? mesh.corners : mesh.texture_corners;
  const std::uint32_t* index = &corners[std::size_t(hit.primitive) * 3];
  return mesh.texture_coordinates[index[0]] * (1 - hit.u - hit.v) + mesh.texture_coordinates[index[1]] * hit.u +
         mesh.texture_coordinates[index[2]] * hit.v;
}

/// Indices of the triangle's three vertex normals.
inline const std::uint32_t* normal_corners(const TriangleMesh& mesh, std::uint32_t triangle) {
  return mesh.normal_corners.empty() ? &mesh.corners[std::size_t(triangle) * 3]
                                     : &mesh.normal_corners[std::size_t(triangle) * 3];
}

inline void triangle_surface(const TriangleMesh& mesh, const Hit& hit, bool texture, SurfacePoint& point) {
  const std::uint32_t* corner = &mesh.corners[std::size_t(hit.primitive) * 3];
  const Vec3f &a = mesh.positions[corner[0]], &b = mesh.positions[corner[1]], &c = mesh.positions[corner[2]];
  TriangleSolution solution = solve_triangle(a, b, c, hit.u, hit.v);
  if (!solution.in_range) solve_extreme_triangle(a, b, c, solution);
  point.position = solution.position;
  point.geometric_normal = point.shading_normal = solution.normal;
  point.clearance = solution.clearance;
  point.distance = hit.distance;
  if (!mesh.normals.empty()) {
    const std::uint32_t* index = normal_corners(mesh, hit.primitive);
    point.shading_normal = interpolated_normal(mesh.normals[index[0]], mesh.normals[index[1]], mesh.normals[index[2]],
                                               hit.u, hit.v, solution.normal);
  }
  if (texture && !mesh.texture_coordinates.empty()) point.texture = texture_at(mesh, hit);
}

}  // namespace detail

/// The same for a hit on an instance.
void find_instance_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                           bool texture, SurfacePoint& point);

/// The surface that `hit` (of a ray from `origin` along unit `direction`), not on an instance, lies on. `texture`:
/// whether texture coordinates are wanted.
inline void find_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                         bool texture, SurfacePoint& point) {
  if (hit.geometry >= kFirstMeshGeometry)
    detail::triangle_surface(shapes.meshes[hit.geometry - kFirstMeshGeometry].mesh, hit, texture, point);
  else if (hit.geometry == kSphereGeometry)
    detail::sphere_surface(shapes, origin, direction, hit, point);
  else if (hit.geometry == kDiscGeometry)
    detail::disc_surface(shapes, origin, direction, hit, point);
  else if (hit.geometry == kConeGeometry)
    detail::cone_surface(shapes.cones[hit.primitive], origin, direction, hit, point);
  else
    detail::plane_surface(shapes, origin, direction, hit, point);
}

inline SurfacePoint surface_at(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                               bool texture) {
  SurfacePoint point;
  if (hit.instance != kNoInstance)
    find_instance_surface(shapes, origin, direction, hit, texture, point);
  else
    find_surface(shapes, origin, direction, hit, texture, point);
  return point;
}

/// Origin of a ray that leaves `point` to the side of `normal` (unit, geometric, pointing to that side): clear of the
/// surface by the bound on its error (Waechter and Binder 2019 in purpose; error-bounded per component so that it
/// scales with the scene).
inline Vec3f offset_origin(const SurfacePoint& point, const Vec3f& normal) {
  return point.position + normal * point.clearance;
}

}  // namespace raytree
