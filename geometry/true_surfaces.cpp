#include "geometry/true_surfaces.h"

#include <cmath>
#include <optional>

#include "geometry/instance_transform.h"
#include "geometry/mesh_source.h"
#include "geometry/patch_subdivision.h"

namespace raytree {
namespace {

/// Parts of a surface reach kFlatShare of the least radius to either side of their middle plane, and the point itself
/// lies anywhere between; as much again for neighbors that are turned against it.
constexpr double kPartClearance = 4 * kFlatShare;

/// A distance is rounded to single precision, and so are the direction's coordinates: 2^-24 each, of the way; and as
/// much for the product.
constexpr double kDistanceError = 4 * 0x1p-24;

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
  const MeshSource* source = list->meshes[hit.geometry - kFirstMeshGeometry].source.get();
  if (source == nullptr || !source->leaves_triangles()) return;
  const Vec3d place = Vec3d(origin) + Vec3d(direction) * double(hit.distance);
  double clearance = kDistanceError * (double(hit.distance) + place.length());
  if (source->curved()) {
    const double radius = sphere_pixels * source->pixel(transform ? transform->point_inside(place) : place);
    clearance += kPartClearance * radius * (transform ? transform->stretch() : 1);
  } else if (std::abs((place - Vec3d(point.position)).dot(Vec3d(point.geometric_normal))) <=
             double(point.clearance) + clearance) {
    return;  // a flat polygon, to rounding: the triangle's own place is the better one
  }
  point.position = Vec3f(place);
  point.clearance += static_cast<float>(clearance);
  point.distance = hit.distance;
}

void move_to_true_surfaces(const ShapeSet& shapes, double sphere_pixels, const RayBatch& rays, const HitBatch& hits,
                           SurfaceBatch& surfaces) {
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (hits.geometry[i] == kNoGeometry) continue;
    SurfacePoint point = surfaces[i];
    move_to_true_surface(shapes, sphere_pixels, rays.origin(i), rays.direction(i), hits[i], point);
    surfaces.set(i, point);
  }
}

}  // namespace raytree
