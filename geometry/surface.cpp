#include "geometry/surface.h"

namespace raytree::detail {

SurfacePoint sphere_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit) {
  const Imath::V4f& sphere = shapes.spheres.center_radius[hit.primitive];
  const Vec3d center(sphere.x, sphere.y, sphere.z);
  const double radius = sphere.w;

  // The intersector says which sphere and which of its two sides; where exactly is solved again in double, by way of
  // the ray's closest point to the center, which keeps its digits for far and small spheres.
  const Vec3d o(origin), d(direction);
  const Vec3d to_center = center - o;
  const double inverse_square = 1 / d.dot(d);
  const double along = to_center.dot(d) * inverse_square;
  const Vec3d closest = d * along - to_center;  // from the center
  const double half_chord = std::sqrt(std::max(0.0, (radius * radius - closest.dot(closest)) * inverse_square));
  const double near = along - half_chord, far = along + half_chord;
  const bool takes_near = std::abs(near - hit.distance) <= std::abs(far - hit.distance);
  const Vec3d from_center = closest + d * (takes_near ? -half_chord : half_chord);
  // A ray that grazes the sphere within the intersector's error has no chord: its closest point lies off the surface.
  const Vec3d normal = half_chord > 0 ? from_center * (1 / radius) : unit(from_center);

  SurfacePoint point;
  point.geometric_normal = point.shading_normal = Vec3f(normal);
  point.position = Vec3f(center + normal * radius);
  const double largest = std::max(std::abs(center.x), std::max(std::abs(center.y), std::abs(center.z)));
  point.clearance = static_cast<float>(kSurfaceError * (largest + radius));
  point.distance = static_cast<float>(std::max(0.0, takes_near ? near : far));
  return point;
}

namespace {

SurfacePoint flat_surface(const Vec3d& through, const Vec3d& normal, const Vec3f& origin, const Vec3f& direction,
                          const Hit& hit) {
  const Vec3d o(origin), d(direction);
  const double slope = d.dot(normal);
  const double distance = slope != 0 ? (through - o).dot(normal) / slope : double(hit.distance);
  const Vec3d position = o + d * distance;

  SurfacePoint point;
  point.position = Vec3f(position);
  point.geometric_normal = point.shading_normal = Vec3f(normal);
  const auto largest = [&](int axis) {
    return static_cast<float>(std::max(std::abs(position[axis]), std::abs(through[axis])));
  };
  point.clearance = clearance(point.geometric_normal, {largest(0), largest(1), largest(2)});
  point.distance = static_cast<float>(distance);
  return point;
}

}  // namespace

SurfacePoint disc_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit) {
  const Imath::V4f& disc = shapes.discs.center_radius[hit.primitive];
  return flat_surface(Vec3d(disc.x, disc.y, disc.z), Vec3d(shapes.discs.normal[hit.primitive]), origin, direction, hit);
}

SurfacePoint plane_surface(const ShapeSet& shapes, const Vec3f& origin, const Vec3f& direction, const Hit& hit) {
  const Plane& plane = shapes.planes[hit.primitive];
  return flat_surface(plane.point, plane.normal, origin, direction, hit);
}

}  // namespace raytree::detail
