#include "benchmarks/surface_deviation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/instance_transform.h"
#include "geometry/mesh_source.h"

namespace raytree::benchmarks {
namespace {

/// Facets lie off by up to so many times the tolerance along the line of sight and outside the frame
/// (docs/architecture.md, "Curved surfaces").
constexpr double kAnyDirection = 4;

/// Of a point found within a sphere from the surface that the sphere is about.
constexpr double kSphereDiameters = 2;

/// Of a polygon's corners from the plane through their mean with Newell's normal.
double distance_from_plane(const TriangleMesh& mesh, const MeshSource& source, std::uint32_t polygon) {
  const std::uint32_t begin = source.starts[polygon], end = source.starts[polygon + 1];
  Vec3d mean(0), normal(0);
  const auto corner = [&](std::uint32_t i) { return Vec3d(mesh.positions[source.corners[i]]); };
  for (std::uint32_t i = begin; i < end; ++i) mean += corner(i) * (1.0 / (end - begin));
  for (std::uint32_t i = begin; i < end; ++i)
    normal += (corner(i) - mean).cross(corner(i + 1 < end ? i + 1 : begin) - mean);
  const double length = normal.length();
  if (!(length > 0)) return 0;
  double most = 0;
  for (std::uint32_t i = begin; i < end; ++i) most = std::max(most, std::abs((corner(i) - mean).dot(normal)) / length);
  return most;
}

}  // namespace

SurfaceDeviation surface_deviation(const ShapeSet& shapes, const FacetTolerance& tolerance, const SurfaceId& id,
                                   std::uint32_t face, const Vec3d& point) {
  if (id.geometry < kFirstMeshGeometry || id.geometry == kNoGeometry) return {};
  std::optional<InstanceTransform> transform;
  if (id.instance != kNoInstance) transform.emplace(shapes.instances[id.instance]);
  const BoundedShapes& list = transform ? shapes.groups[shapes.instances[id.instance].group] : shapes;
  const MeshEntry& entry = list.meshes[id.geometry - kFirstMeshGeometry];
  if (!entry.source) return {};
  // The most that lengths grow by on the way to the scene.
  const double stretch = transform ? std::sqrt(transform->vector({1, 0, 0}).dot(transform->vector({1, 0, 0})) +
                                               transform->vector({0, 1, 0}).dot(transform->vector({0, 1, 0})) +
                                               transform->vector({0, 0, 1}).dot(transform->vector({0, 0, 1})))
                                   : 1;
  const MeshSource& source = *entry.source;
  if (source.curved()) {
    const Vec3d place = transform ? transform->inverse_point(point) : point;
    return {
        (kAnyDirection * tolerance.pixels + kSphereDiameters * tolerance.sphere_pixels) * source.pixel(place) * stretch,
        true};
  }
  if (source.polygon_count() == 0) return {};
  const std::uint32_t polygon = face != kNoFace                     ? face
                                : entry.mesh.triangle_faces.empty() ? id.primitive
                                                                    : entry.mesh.triangle_faces[id.primitive];
  return {distance_from_plane(entry.mesh, source, polygon) * stretch, false};
}

}  // namespace raytree::benchmarks
