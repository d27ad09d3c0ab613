// The surface at a hit on an instance: found in the group's space, taken to scene space, with the error of both ways.
#include "geometry/instance_transform.h"
#include "geometry/surface.h"

namespace raytree {
namespace {

Vec3d absolute(const Vec3d& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
Vec3d absolute(const Vec3f& v) { return absolute(Vec3d(v)); }

/// What the way into the group adds to the clearance of a point in scene space, whose normal in group space is n
/// (unit) and whose primitive reaches `reach` along the axes of scene space. The tracer's direction is off like its
/// origin, so a ray that leaves low over its primitive must clear that too, as far as the primitive goes.
double added_clearance(const InstanceTransform& transform, const Vec3d& n, const Vec3f& position, const Vec3d& reach) {
  const Vec3d largest = absolute(position) + absolute(transform.origin()) + reach;
  return kInstanceError * transform.inverse_error(n, largest);
}

void triangle(const InstanceTransform& transform, const TriangleMesh& mesh, const Hit& hit, bool texture,
              SurfacePoint& point) {
  detail::triangle_surface(mesh, hit, texture, point);
  const Vec3d normal(point.geometric_normal), outside_normal = transform.normal(normal);
  // One unit along the normal in group space is so far from the surface in scene space.
  const double stretch = 1 / std::sqrt(outside_normal.dot(outside_normal));
  point.position = Vec3f(transform.point(Vec3d(point.position)));
  point.geometric_normal = Vec3f(outside_normal * stretch);
  if (mesh.normals.empty()) {
    point.shading_normal = point.geometric_normal;
  } else {
    const Vec3d shading = transform.normal(Vec3d(point.shading_normal));
    point.shading_normal = Vec3f(shading * (1 / std::sqrt(shading.dot(shading))));
  }
  const std::uint32_t* corner = &mesh.corners[std::size_t(hit.primitive) * 3];
  const Vec3f& a = mesh.positions[corner[0]];
  const Vec3d e(mesh.positions[corner[1]] - a), f(mesh.positions[corner[2]] - a);
  const Vec3d reach = absolute(transform.vector(e)) + absolute(transform.vector(f));
  const double clearance = (point.clearance + added_clearance(transform, normal, point.position, reach)) * stretch;
  point.clearance =
      static_cast<float>(clearance) + detail::clearance(point.geometric_normal, Vec3f(absolute(point.position)));
}

/// Adds the way into the group to a clearance that was found in scene space.
void clear_of_instance(const InstanceTransform& transform, double reach, SurfacePoint& point) {
  // Unit normals of group space are those of scene space turned back: scale and mirroring leave them at unit length.
  const Vec3d n(point.geometric_normal);
  const double scale = transform.scale();
  const Vec3d inside(transform.vector({1, 0, 0}).dot(n) / scale, transform.vector({0, 1, 0}).dot(n) / scale,
                     transform.vector({0, 0, 1}).dot(n) / scale);
  point.clearance += static_cast<float>(added_clearance(transform, inside, point.position, Vec3d(reach)) * scale);
}

}  // namespace

void find_instance_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit,
                           bool texture, SurfacePoint& point) {
  const Instance& instance = shapes.instances[hit.instance];
  const BoundedShapes& group = shapes.groups[instance.group];
  const InstanceTransform transform(instance);
  if (hit.geometry >= kFirstMeshGeometry) {
    triangle(transform, group.meshes[hit.geometry - kFirstMeshGeometry].mesh, hit, texture, point);
    return;
  }
  // Spheres and discs are used with one scale for all axes: they are the same in scene space.
  const bool sphere = hit.geometry == kSphereGeometry;
  const Imath::V4f& round =
      sphere ? group.spheres.center_radius[hit.primitive] : group.discs.center_radius[hit.primitive];
  const Vec3d center = transform.point({round.x, round.y, round.z});
  const double radius = round.w * transform.scale();
  if (sphere) {
    detail::sphere_surface(center, radius, origin, direction, hit, point);
    // The center's own coordinates count in group space, where they may be larger than here.
    const double largest =
        std::max(std::abs(double(round.x)), std::max(std::abs(double(round.y)), std::abs(double(round.z))));
    point.clearance += static_cast<float>(kSurfaceError * largest * transform.scale());
  } else {
    const Vec3d n(group.discs.normal[hit.primitive]);
    detail::flat_surface(center, unit(transform.normal(n)), origin, direction, hit, point);
    const Vec3f within(std::abs(round.x) + round.w, std::abs(round.y) + round.w, std::abs(round.z) + round.w);
    point.clearance += detail::clearance(Vec3f(n), within) * static_cast<float>(transform.scale());
  }
  clear_of_instance(transform, 2 * radius, point);
}

}  // namespace raytree
