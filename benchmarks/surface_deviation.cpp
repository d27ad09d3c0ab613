#include "benchmarks/surface_deviation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/bezier_patch.h"
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

/// A mesh of the scene or of a group, and the way from there to the scene.
struct PlacedMesh {
  const MeshEntry* entry = nullptr;  ///< null: the surface is no mesh that knows what it stands for
  std::optional<InstanceTransform> transform;

  PlacedMesh(const ShapeSet& shapes, const SurfaceId& id) {
    if (id.geometry < kFirstMeshGeometry || id.geometry == kNoGeometry) return;
    if (id.instance != kNoInstance) transform.emplace(shapes.instances[id.instance]);
    const BoundedShapes& list = transform ? shapes.groups[shapes.instances[id.instance].group] : shapes;
    const MeshEntry& mesh = list.meshes[id.geometry - kFirstMeshGeometry];
    if (mesh.source) entry = &mesh;
  }
  Vec3d in_scene(const Vec3d& point) const { return transform ? transform->point(point) : point; }
};

/// Of the limit surface, in the mesh's space; nothing of the faces whose parameters are those of several pieces side by
/// side.
std::optional<Vec3d> limit_point(const MeshSource& source, std::uint32_t triangle, double u, double v) {
  // A mirrored mesh has corners 1 and 2 of its triangles exchanged.
  if (source.reversed) std::swap(u, v);
  const Vec2f* const corners = source.parameters.corners.data() + 3 * std::size_t(triangle);
  const Vec2d at = Vec2d(corners[0]) * (1 - u - v) + Vec2d(corners[1]) * u + Vec2d(corners[2]) * v;
  constexpr double kBorder = 1e-6;  // the corners are single precision
  for (const LimitPatch& piece : source.patches) {
    if (piece.face != source.parameters.faces[triangle]) continue;
    if (piece.domain != FaceDomain::quad) return std::nullopt;
    const Vec2d off = at - piece.corner;
    const double determinant = piece.along_u.x * piece.along_v.y - piece.along_u.y * piece.along_v.x;
    const double s = (off.x * piece.along_v.y - off.y * piece.along_v.x) / determinant,
                 t = (piece.along_u.x * off.y - piece.along_u.y * off.x) / determinant;
    const double border = kBorder / std::sqrt(std::abs(determinant));
    if (!(s >= -border && s <= 1 + border && t >= -border && t <= 1 + border)) continue;
    return evaluate(piece.patch, std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0)).position;
  }
  return std::nullopt;
}

}  // namespace

bool facet_stands_for_surface(const ShapeSet& shapes, const ReferenceTracer& truth, const SurfaceId& id, double u,
                              double v, double deviation, const Vec3d* place) {
  const PlacedMesh mesh(shapes, id);
  // A polygon's triangles lie no further from its plane than its corners do, which is the deviation.
  if (mesh.entry == nullptr || !mesh.entry->source->curved()) return true;
  const MeshSource& source = *mesh.entry->source;
  const TriangleMesh& triangles = mesh.entry->mesh;
  Vec3d corner[3];
  for (std::size_t c = 0; c < 3; ++c)
    corner[c] = mesh.in_scene(Vec3d(triangles.positions[triangles.corners[3 * std::size_t(id.primitive) + c]]));
  const Vec3d facet = corner[0] * (1 - u - v) + corner[1] * u + corner[2] * v;
  const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
  Vec3d surface = facet;
  if (place != nullptr) {
    surface = *place;
  } else {
    const std::optional<Vec3d> limit = limit_point(source, id.primitive, u, v);
    if (!limit) {
      const ReferenceHit across = truth.nearest(facet + normal * deviation, -normal, 2 * deviation);
      return across.geometry == id.geometry && across.instance == id.instance;
    }
    surface = mesh.in_scene(*limit);
  }
  const Vec3d off = surface - facet;
  const double size =
      std::max({(corner[1] - corner[0]).length(), (corner[2] - corner[1]).length(), (corner[0] - corner[2]).length()});
  return std::abs(off.dot(normal)) <= deviation && off.length() <= deviation + size;
}

SurfaceDeviation surface_deviation(const ShapeSet& shapes, const FacetTolerance& tolerance, const SurfaceId& id,
                                   std::uint32_t face, const Vec3d& point) {
  const PlacedMesh mesh(shapes, id);
  if (mesh.entry == nullptr) return {};
  const MeshEntry& entry = *mesh.entry;
  const std::optional<InstanceTransform>& transform = mesh.transform;
  const double stretch = transform ? transform->stretch() : 1;
  const MeshSource& source = *entry.source;
  if (source.curved()) {
    const Vec3d place = transform ? transform->point_inside(point) : point;
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
