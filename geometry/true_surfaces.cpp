#include "geometry/true_surfaces.h"

#include <cmath>
#include <optional>

#include "geometry/instance_transform.h"
#include "geometry/mesh_source.h"
#include "geometry/newell.h"
#include "geometry/patch_subdivision.h"

namespace raytree {
namespace {

/// Parts of a surface reach kFlatShare of the least radius to either side of their middle plane, and the point itself
/// lies anywhere between; as much again for neighbors that are turned against it.
constexpr double kPartClearance = 4 * kFlatShare;

/// A distance is rounded to single precision, and so are the direction's coordinates: 2^-24 each, of the way; and as
/// much for the product.
constexpr double kDistanceError = 4 * 0x1p-24;

/// A hit on an n-gon: on its plane, to the outside of which new rays start. `place`: where the ray meets it, to
/// `error`.
void move_to_polygon(const MeshEntry& entry, std::uint32_t triangle, const InstanceTransform* transform,
                     const Vec3d& place, double error, SurfacePoint& point) {
  const MeshSource& source = *entry.source;
  const std::uint32_t face = entry.mesh.triangle_faces.empty() ? triangle : entry.mesh.triangle_faces[triangle];
  const std::uint32_t first = source.starts[face], count = source.starts[face + 1] - first;
  if (count == 3) return;
  Vec3d normal = newell_normal(entry.mesh.positions.data(), &source.corners[first], count);
  if (source.reversed) normal = -normal;
  if (transform != nullptr) normal = transform->normal(normal);
  const double length = normal.length();
  if (!(length > 0)) return;
  normal /= length;
  const double off = std::abs((place - Vec3d(point.position)).dot(normal));
  if (off <= double(point.clearance) / 2 + error) {
    // Flat, to rounding: the triangle's own place is the better one. New rays clear the polygon's plane also.
    point.clearance += static_cast<float>(off);
    return;
  }
  const bool flat_shading = point.shading_normal == point.geometric_normal;
  point.position = Vec3f(place);
  point.geometric_normal = Vec3f(normal);
  if (flat_shading) point.shading_normal = point.geometric_normal;
  point.clearance += static_cast<float>(error);
}

}  // namespace

void move_to_true_surface(const ShapeSet& shapes, double sphere_pixels, const Vec3f& origin, const Vec3f& direction,
                          const Hit& hit, SurfacePoint& point) {
  if (hit.geometry == kNoGeometry || hit.geometry < kFirstMeshGeometry) return;
  std::optional<InstanceTransform> transform;
  const BoundedShapes* list = &shapes;
  if (hit.instance != kNoInstance) {
    transform.emplace(shapes.instances[hit.instance]);
    list = &shapes.groups[shapes.instances[hit.instance].group];
  }
  const MeshEntry& entry = list->meshes[hit.geometry - kFirstMeshGeometry];
  if (!entry.source || !entry.source->leaves_triangles()) return;
  const Vec3d place = Vec3d(origin) + Vec3d(direction) * double(hit.distance);
  const double error = kDistanceError * (double(hit.distance) + place.length());
  point.distance = hit.distance;
  if (!entry.source->curved()) {
    move_to_polygon(entry, hit.primitive, transform ? &*transform : nullptr, place, error, point);
    return;
  }
  const double radius = sphere_pixels * entry.source->pixel(transform ? transform->point_inside(place) : place);
  point.position = Vec3f(place);
  point.clearance += static_cast<float>(error + kPartClearance * radius * (transform ? transform->stretch() : 1));
}

void move_to_true_surfaces(const ShapeSet& shapes, double sphere_pixels, const RayBatch& rays, const HitBatch& hits,
                           SurfaceBatch& surfaces) {
  for (std::size_t i = 0; i < rays.size; ++i) {
    // What is round is what it is: its surface need not be taken out of the batch and put back.
    if (hits.geometry[i] == kNoGeometry || hits.geometry[i] < kFirstMeshGeometry) continue;
    SurfacePoint point = surfaces[i];
    move_to_true_surface(shapes, sphere_pixels, rays.origin(i), rays.direction(i), hits[i], point);
    surfaces.set(i, point);
  }
}

}  // namespace raytree
