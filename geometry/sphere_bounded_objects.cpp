#include "geometry/sphere_bounded_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/newell.h"
#include "geometry/patch_subdivision.h"
#include "geometry/quadric_bounds.h"

namespace raytree {
namespace {

bool is_curved(const MeshEntry& entry) { return entry.source && entry.source->curved(); }
bool is_polygonal(const MeshEntry& entry) { return entry.source && entry.source->polygon_count() > 0; }

/// The nearer of two distances along a ray that is not behind its origin, or else the other.
double first_ahead(double near, double far) { return near >= 0 ? near : far; }

/// Distance to a plane; NaN or infinite where the ray runs along it.
double distance_to_plane(const Vec3d& point, const Vec3d& normal, const ObjectRay& ray) {
  return (point - ray.origin).dot(normal) / ray.direction.dot(normal);
}

/// By way of the line's point closest to the center, so that a far origin costs no digits.
double distance_to_sphere(const Vec3d& center, double radius, const SphereRay& ray) {
  const Vec3d to_center = center - ray.origin;
  const double middle = to_center.dot(ray.direction) * ray.inverse_square;
  const Vec3d off = ray.direction * middle - to_center;
  const double half = std::sqrt((radius * radius - off.dot(off)) * ray.inverse_square);  // NaN: passes by
  return first_ahead(middle - half, middle + half);
}

double distance_to_disc(const Vec3d& center, double radius, const Vec3d& normal, const ObjectRay& ray) {
  const double distance = distance_to_plane(center, normal, ray);
  const Vec3d off = ray.origin + ray.direction * distance - center;
  return off.dot(off) <= radius * radius ? distance : std::numeric_limits<double>::infinity();
}

double distance_to_cone(const Cone& cone, const ObjectRay& ray) {
  const double inverse_length = std::sqrt(ray.sphere.inverse_square);
  const ConeCrossings crossings = cone_crossings(ConeFrame(cone), ray.origin, ray.direction * inverse_length);
  return first_ahead(crossings.near, crossings.far) * inverse_length;
}

/// A point of the polygon's plane: the mean of its corners.
Vec3d mean_corner(const Vec3f* positions, const std::uint32_t* corners, std::size_t count) {
  const Vec3d first(positions[corners[0]]);
  Vec3d sum(0, 0, 0);
  for (std::size_t i = 1; i < count; ++i) sum += Vec3d(positions[corners[i]]) - first;
  return first + sum / static_cast<double>(count);
}

Vec3d unit_or(const Vec3d& v, const Vec3d& otherwise) {
  const double length = v.length();
  return length > 0 ? v / length : otherwise;
}

}  // namespace

ObjectList::ObjectList(const BoundedShapes& shapes, double sphere_pixels)
    : shapes_(&shapes), sphere_pixels_(sphere_pixels), first_triangles_(shapes.meshes.size()) {
  const auto round = [](const Imath::V4f& v) { return BoundingSphere{{v.x, v.y, v.z}, v.w}; };
  std::size_t count = shapes.spheres.shape.size() + shapes.discs.shape.size() + shapes.cones.shape.size();
  for (const MeshEntry& entry : shapes.meshes)
    count += is_curved(entry)      ? entry.source->patches.size()
             : is_polygonal(entry) ? entry.source->polygon_count()
                                   : entry.mesh.triangle_count();
  spheres_.reserve(count);
  objects_.reserve(count);
  for (std::size_t i = 0; i < shapes.spheres.shape.size(); ++i)
    add(round(shapes.spheres.center_radius[i]), kSphereGeometry, i);
  for (std::size_t i = 0; i < shapes.discs.shape.size(); ++i)
    add(round(shapes.discs.center_radius[i]), kDiscGeometry, i);
  for (std::size_t i = 0; i < shapes.cones.shape.size(); ++i) add(sphere_about(shapes.cones[i]), kConeGeometry, i);
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const MeshEntry& entry = shapes.meshes[m];
    const GeometryId geometry = kFirstMeshGeometry + static_cast<GeometryId>(m);
    if (is_curved(entry)) {
      for (std::size_t i = 0; i < entry.source->patches.size(); ++i)
        add(sphere_about(entry.source->patches[i].patch), geometry, i);
      continue;
    }
    std::size_t polygons = entry.mesh.triangle_count();
    if (is_polygonal(entry)) {
      polygons = entry.source->polygon_count();
      std::vector<std::uint32_t>& first = first_triangles_[m];
      first.assign(polygons, kNoFace);
      for (std::size_t t = entry.mesh.triangle_count(); t-- > 0;) {
        const Buffer<std::uint32_t>& faces = entry.mesh.triangle_faces;
        first[faces.empty() ? t : faces[t]] = static_cast<std::uint32_t>(t);
      }
    }
    std::vector<Vec3f> corners;
    for (std::size_t i = 0; i < polygons; ++i) {
      if (is_polygonal(entry) && first_triangles_[m][i] == kNoFace) continue;  // fewer than three corners
      const Polygon polygon = polygon_of(entry, static_cast<std::uint32_t>(i));
      corners.clear();
      for (std::size_t k = 0; k < polygon.count; ++k) corners.push_back(polygon.positions[polygon.corners[k]]);
      add(sphere_about(corners), geometry, i);
    }
  }
}

void ObjectList::add(const BoundingSphere& sphere, GeometryId geometry, std::size_t index) {
  spheres_.push_back(sphere);
  objects_.push_back({geometry, static_cast<std::uint32_t>(index)});
}

ObjectList::Polygon ObjectList::polygon_of(const MeshEntry& entry, std::uint32_t index) const {
  const Vec3f* positions = entry.mesh.positions.data();
  if (!is_polygonal(entry)) return {positions, &entry.mesh.corners[3 * std::size_t(index)], 3};
  const std::uint32_t first = entry.source->starts[index], end = entry.source->starts[index + 1];
  return {positions, &entry.source->corners[first], end - first};
}

bool ObjectList::intersect(std::uint32_t object, const ObjectRay& ray, const RayInterval& interval, double limit,
                           ObjectHit& hit) const {
  const Object& it = objects_[object];
  double distance = std::numeric_limits<double>::quiet_NaN();
  if (it.geometry == kSphereGeometry) {
    const BoundingSphere& sphere = spheres_[object];
    distance = distance_to_sphere(sphere.center, sphere.radius, ray.sphere);
  } else if (it.geometry == kDiscGeometry) {
    const BoundingSphere& sphere = spheres_[object];
    distance = distance_to_disc(sphere.center, sphere.radius, Vec3d(shapes_->discs.normal[it.index]), ray);
  } else if (it.geometry == kConeGeometry) {
    distance = distance_to_cone(shapes_->cones[it.index], ray);
  } else if (const MeshEntry& entry = mesh_of(it); is_curved(entry)) {
    const LeastRadius least_radius{entry.source->pixel, sphere_pixels_};
    PatchHit found;
    if (intersect_patch(entry.source->patches[it.index].patch, ray.sphere, interval, limit, least_radius, found))
      distance = found.distance, hit.u = found.u, hit.v = found.v;
  } else {
    const Polygon polygon = polygon_of(entry, it.index);
    const PolygonCrossing crossing =
        cross_polygon(polygon.count, [&](std::size_t i) { return ray.picture(polygon.positions[polygon.corners[i]]); });
    if (!crossing.inside) return false;
    distance = distance_to_plane(mean_corner(polygon.positions, polygon.corners, polygon.count),
                                 newell_normal(polygon.positions, polygon.corners, polygon.count), ray);
    // Seen nearly edge on, rounding may put the plane's crossing anywhere; the polygon lies between its corners.
    if (!(distance == distance)) distance = crossing.nearest_corner;
    distance = std::clamp(distance, crossing.nearest_corner, crossing.farthest_corner);
  }
  if (!std::isfinite(distance)) return false;
  // Rounding alone could take it out of the sphere, and a search that skips by spheres would then find something else.
  hit.distance = std::clamp(distance, interval.enter, interval.leave);
  return hit.distance >= 0 && hit.distance <= limit;
}

void ObjectList::describe_polygon(const Object& object, const ObjectRay& ray, ReferenceHit& hit) const {
  const MeshEntry& entry = mesh_of(object);
  const TriangleMesh& mesh = entry.mesh;
  const Polygon polygon = polygon_of(entry, object.index);
  hit.normal =
      unit_or(newell_normal(polygon.positions, polygon.corners, polygon.count), unit_or(-ray.direction, {0, 0, 1}));
  const auto weights = [&](std::size_t triangle) {
    const std::uint32_t* corner = &mesh.corners[3 * triangle];
    return weights_in_triangle(ray.picture(mesh.positions[corner[0]]), ray.picture(mesh.positions[corner[1]]),
                               ray.picture(mesh.positions[corner[2]]));
  };
  std::size_t triangle = object.index;
  TriangleWeights best{0, 0};
  if (is_polygonal(entry)) {
    if (entry.source->reversed) hit.normal = -hit.normal;
    hit.face = object.index;
    const std::size_t first = first_triangles_[object.geometry - kFirstMeshGeometry][object.index];
    double least = -std::numeric_limits<double>::infinity();
    for (std::size_t t = first; t < first + polygon.count - 2; ++t)
      if (const TriangleWeights found = weights(t); found.least() > least)
        triangle = t, best = found, least = found.least();
  } else {
    best = weights(triangle);
  }
  hit.primitive = static_cast<std::uint32_t>(triangle);
  hit.u = best.u, hit.v = best.v;
}

namespace {

/// Of facets [first, end) of a face the one that holds a place in its parameters, with the weights of corners 1 and 2.
/// `at(k)`: the k-th corner of all facets, in the plane of `place`.
template <class CornerAt>
std::pair<std::size_t, TriangleWeights> facet_holding(std::size_t first, std::size_t end, const Vec2d& place,
                                                      const CornerAt& at) {
  std::pair<std::size_t, TriangleWeights> best{first, {1.0 / 3, 1.0 / 3}};
  double least = -std::numeric_limits<double>::infinity();
  for (std::size_t facet = first; facet < end && least < 0; ++facet) {
    const auto seen = [&](std::size_t k) {
      const Vec2d p = at(3 * facet + k) - place;
      return SeenCorner{p.x, p.y, 0};
    };
    const TriangleWeights weights = weights_in_triangle(seen(0), seen(1), seen(2));
    if (weights.least() > least) best = {facet, weights}, least = weights.least();
  }
  return best;
}

/// Weights within the triangle: of the point of it that they are closest to, along a line to its middle.
TriangleWeights drawn_inside(TriangleWeights weights) {
  const double least = weights.least();
  if (least >= 0) return weights;
  const double share = (1.0 / 3) / (1.0 / 3 - least);
  return {1.0 / 3 + (weights.u - 1.0 / 3) * share, 1.0 / 3 + (weights.v - 1.0 / 3) * share};
}

}  // namespace

void ObjectList::describe_piece(const Object& object, const ObjectRay& ray, const ObjectHit& at,
                                ReferenceHit& hit) const {
  const MeshEntry& entry = mesh_of(object);
  const MeshSource& source = *entry.source;
  const LimitPatch& piece = source.patches[object.index];
  hit.face = piece.face;
  const PatchDerivatives surface = evaluate(piece.patch, at.u, at.v);
  const Vec3d normal =
      patch_normal(piece.patch, surface, at.u, at.v, derivative_scale(piece.patch), DegenerateNormal::limit);
  hit.normal = unit_or(source.reversed ? -normal : normal, unit_or(-ray.direction, {0, 0, 1}));

  const Buffer<std::uint32_t>& faces = source.parameters.faces;
  const auto facets = std::equal_range(faces.begin(), faces.end(), piece.face);
  const auto first = static_cast<std::size_t>(facets.first - faces.begin());
  const auto end = static_cast<std::size_t>(facets.second - faces.begin());
  if (first == end) return;  // a face whose facets have no area
  std::pair<std::size_t, TriangleWeights> found;
  if (piece.domain == FaceDomain::quad) {
    found = facet_holding(first, end, piece.face_parameters(at.u, at.v),
                          [&](std::size_t k) { return Vec2d(source.parameters.corners[k]); });
    if (source.reversed) std::swap(found.second.u, found.second.v);
  } else {
    // An n-gon's parameters are squares side by side, and its facets lie across them: they are looked at along the
    // surface's normal instead.
    const RayPicture picture(ray.origin + ray.direction * at.distance, hit.normal);
    found = facet_holding(first, end, {0, 0}, [&](std::size_t k) {
      const SeenCorner seen = picture(entry.mesh.positions[entry.mesh.corners[k]]);
      return Vec2d(seen.x, seen.y);
    });
  }
  const TriangleWeights weights = drawn_inside(found.second);
  hit.primitive = static_cast<std::uint32_t>(found.first);
  hit.u = weights.u, hit.v = weights.v;
}

ReferenceHit ObjectList::describe(std::uint32_t object, const ObjectRay& ray, const ObjectHit& at) const {
  const Object& it = objects_[object];
  ReferenceHit hit;
  hit.geometry = it.geometry;
  hit.primitive = it.index;
  hit.distance = at.distance;
  const Vec3d position = ray.origin + ray.direction * at.distance;
  if (it.geometry == kSphereGeometry)
    hit.normal = unit_or(position - spheres_[object].center, {0, 0, 1});
  else if (it.geometry == kDiscGeometry)
    hit.normal = unit_or(Vec3d(shapes_->discs.normal[it.index]), {0, 0, 1});
  else if (it.geometry == kConeGeometry)
    hit.normal = cone_normal(ConeFrame(shapes_->cones[it.index]), position);
  else if (is_curved(mesh_of(it)))
    describe_piece(it, ray, at, hit);
  else
    describe_polygon(it, ray, hit);
  return hit;
}

std::size_t ObjectList::memory_bytes() const {
  std::size_t sum = spheres_.capacity() * sizeof(BoundingSphere) + objects_.capacity() * sizeof(Object);
  for (const auto& first : first_triangles_) sum += first.capacity() * sizeof(first[0]);
  return sum;
}

}  // namespace raytree
