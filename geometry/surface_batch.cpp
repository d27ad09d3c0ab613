#include "geometry/surface_batch.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace raytree {
namespace {

/// Which of a block's rays hit something of one kind.
struct BlockLanes {
  explicit BlockLanes(std::size_t first_) : first(first_) {}

  std::size_t first;                ///< index of the block's first ray
  std::int32_t is_in[kLanes] = {};  ///< 1 or 0: as wide as the floats that it chooses between
  std::uint8_t lanes[kLanes];       ///< [count]
  std::size_t count = 0;

  void add(std::size_t lane) {
    is_in[lane] = 1;
    lanes[count++] = static_cast<std::uint8_t>(lane);
  }
  /// Puts the values of these lanes in their places; the others keep what they have.
  void store(const Lanes& values, float* array) const {
    if (count == kLanes) return store_lanes(values, array + first);
    Lanes kept, mixed;
    std::memcpy(kept, array + first, sizeof(kept));
    for (std::size_t i = 0; i < kLanes; ++i) mixed[i] = is_in[i] ? values[i] : kept[i];
    store_lanes(mixed, array + first);
  }
  void store(const Vec3Lanes& values, Vec3Array& array) const {
    store(values.x, array.x);
    store(values.y, array.y);
    store(values.z, array.z);
  }
  void add_all() {
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane);
  }
};

/// Whether the eight elements from `first` on are equal.
template <class Element>
bool are_equal(const Element* array, std::size_t first) {
  return std::memcmp(array + first, array + first + 1, (kLanes - 1) * sizeof(Element)) == 0;
}

void solve_spheres(const SphereArray& spheres, const RayBatch& rays, const HitBatch& hits, const BlockLanes& block,
                   SurfaceBatch& surfaces) {
  Vec3Lanes center = {};
  Lanes radius = {};
  if (block.count == kLanes && are_equal(hits.primitive, block.first)) {
    const Imath::V4f sphere = spheres.center_radius[hits.primitive[block.first]];
    center.fill({sphere.x, sphere.y, sphere.z});
    std::fill_n(radius, kLanes, sphere.w);
  } else {
    for (std::size_t k = 0; k < block.count; ++k) {
      const std::size_t lane = block.lanes[k];
      const Imath::V4f& sphere = spheres.center_radius[hits.primitive[block.first + lane]];
      center.set(lane, {sphere.x, sphere.y, sphere.z});
      radius[lane] = sphere.w;
    }
  }
  const float *ox = rays.origin_x + block.first, *oy = rays.origin_y + block.first, *oz = rays.origin_z + block.first;
  const float *dx = rays.direction_x + block.first, *dy = rays.direction_y + block.first,
              *dz = rays.direction_z + block.first;
  const float* hit_distance = hits.distance + block.first;
  Vec3Lanes position, normal;
  Lanes clearance, distance;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const detail::SphereSolution s = detail::solve_sphere(center.x[i], center.y[i], center.z[i], radius[i], ox[i],
                                                          oy[i], oz[i], dx[i], dy[i], dz[i], hit_distance[i]);
    position.x[i] = s.x, position.y[i] = s.y, position.z[i] = s.z;
    normal.x[i] = s.normal_x, normal.y[i] = s.normal_y, normal.z[i] = s.normal_z;
    clearance[i] = s.clearance, distance[i] = s.distance;
  }
  block.store(position, surfaces.position);
  block.store(normal, surfaces.geometric_normal);
  block.store(normal, surfaces.shading_normal);
  block.store(clearance, surfaces.clearance);
  block.store(distance, surfaces.distance);
}

/// The vertices of the triangles that a block's rays hit, positions or normals.
struct TriangleLanes {
  Vec3Lanes a = {}, b = {}, c = {};

  void set(std::size_t lane, const Buffer<Vec3f>& vertices, const std::uint32_t* index) {
    a.set(lane, vertices[index[0]]);
    b.set(lane, vertices[index[1]]);
    c.set(lane, vertices[index[2]]);
  }
  void fill(const Buffer<Vec3f>& vertices, const std::uint32_t* index) {
    a.fill(vertices[index[0]]);
    b.fill(vertices[index[1]]);
    c.fill(vertices[index[2]]);
  }
};

/// The lanes of triangles whose squares leave float's range, once more.
void mend_extreme_triangles(const BlockLanes& block, const TriangleLanes& vertices,
                            const std::int32_t (&in_range)[kLanes], Vec3Lanes& normal, Lanes& clearance) {
  for (std::size_t k = 0; k < block.count; ++k) {
    const std::size_t lane = block.lanes[k];
    if (in_range[lane]) continue;
    detail::TriangleSolution solution;
    detail::solve_extreme_triangle(vertices.a[lane], vertices.b[lane], vertices.c[lane], solution);
    normal.set(lane, solution.normal);
    clearance[lane] = solution.clearance;
  }
}

void interpolate_normals(const ShapeSet& shapes, const HitBatch& hits, const BlockLanes& triangles, bool uniform,
                         const Vec3Lanes& facet, SurfaceBatch& surfaces) {
  BlockLanes block(triangles.first);
  TriangleLanes normals;
  for (std::size_t k = 0; k < triangles.count; ++k) {
    const std::size_t lane = triangles.lanes[k], i = triangles.first + lane;
    const TriangleMesh& mesh = shapes.meshes[hits.geometry[i] - kFirstMeshGeometry].mesh;
    if (mesh.normals.empty()) continue;
    block.add(lane);
    if (!uniform)
      normals.set(lane, mesh.normals, detail::normal_corners(mesh, hits.primitive[i]));
    else if (k == 0)
      normals.fill(mesh.normals, detail::normal_corners(mesh, hits.primitive[i]));
  }
  if (block.count == 0) return;
  const float *u = hits.u + block.first, *v = hits.v + block.first;
  Vec3Lanes mean;
  for (std::size_t i = 0; i < kLanes; ++i)
    mean.set(i, detail::interpolated_normal(normals.a[i], normals.b[i], normals.c[i], u[i], v[i], facet[i]));
  block.store(mean, surfaces.shading_normal);
}

void solve_triangles(const ShapeSet& shapes, const HitBatch& hits, const BlockLanes& block, bool texture,
                     SurfaceBatch& surfaces) {
  // Neighbouring rays often hit one large triangle.
  const bool uniform =
      block.count == kLanes && are_equal(hits.primitive, block.first) && are_equal(hits.geometry, block.first);
  TriangleLanes vertices;
  bool any_normals = false;
  for (std::size_t k = 0; k < block.count; ++k) {
    const std::size_t lane = block.lanes[k], i = block.first + lane;
    const TriangleMesh& mesh = shapes.meshes[hits.geometry[i] - kFirstMeshGeometry].mesh;
    any_normals |= !mesh.normals.empty();
    const std::uint32_t* corner = &mesh.corners[std::size_t(hits.primitive[i]) * 3];
    if (!uniform)
      vertices.set(lane, mesh.positions, corner);
    else if (k == 0)
      vertices.fill(mesh.positions, corner);
    if (texture && !mesh.texture_coordinates.empty()) {
      const Vec2f place = detail::texture_at(mesh, hits[i]);
      surfaces.texture_x[i] = place.x, surfaces.texture_y[i] = place.y;
    }
  }
  const float *u = hits.u + block.first, *v = hits.v + block.first;
  Vec3Lanes position, normal;
  Lanes clearance;
  std::int32_t in_range[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const detail::TriangleSolution s = detail::solve_triangle(vertices.a[i], vertices.b[i], vertices.c[i], u[i], v[i]);
    position.set(i, s.position);
    normal.set(i, s.normal);
    clearance[i] = s.clearance;
    in_range[i] = s.in_range;
  }
  mend_extreme_triangles(block, vertices, in_range, normal, clearance);
  block.store(position, surfaces.position);
  block.store(normal, surfaces.geometric_normal);
  block.store(normal, surfaces.shading_normal);
  block.store(clearance, surfaces.clearance);
  for (std::size_t k = 0; k < block.count; ++k) {
    const std::size_t i = block.first + block.lanes[k];
    surfaces.distance[i] = hits.distance[i];
  }
  if (any_normals) interpolate_normals(shapes, hits, block, uniform, normal, surfaces);
}

}  // namespace

void find_surfaces(const ShapeSet& shapes, const RayBatch& rays, const HitBatch& hits, bool texture,
                   SurfaceBatch& surfaces) {
  const bool instanced = !shapes.instances.empty();
  if (texture) {
    std::fill_n(surfaces.texture_x, rays.size, 0.0f);
    std::fill_n(surfaces.texture_y, rays.size, 0.0f);
  }
  for (std::size_t first = 0; first < rays.size; first += kLanes) {
    BlockLanes spheres(first), triangles(first);
    const GeometryId common = hits.geometry[first];
    const bool alike = !instanced && first + kLanes <= rays.size && are_equal(hits.geometry, first);
    if (alike && common == kNoGeometry) continue;
    if (alike && (common == kSphereGeometry || common >= kFirstMeshGeometry)) {
      (common == kSphereGeometry ? spheres : triangles).add_all();
    } else {
      for (std::size_t i = first; i < std::min(first + kLanes, rays.size); ++i) {
        const GeometryId geometry = hits.geometry[i];
        if (geometry == kNoGeometry) continue;
        const bool in_group = instanced && hits.instance[i] != kNoInstance;
        if (geometry >= kFirstMeshGeometry && !in_group)
          triangles.add(i - first);
        else if (geometry == kSphereGeometry && !in_group)
          spheres.add(i - first);
        else
          surfaces.set(i, surface_at(shapes, rays.origin(i), rays.direction(i), hits[i], texture));
      }
    }
    if (spheres.count > 0) solve_spheres(shapes.spheres, rays, hits, spheres, surfaces);
    if (triangles.count > 0) solve_triangles(shapes, hits, triangles, texture, surfaces);
  }
}

}  // namespace raytree
