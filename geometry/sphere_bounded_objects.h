// The objects of the sphere-bounded tracer: one list for the scene, one for each group. What bounds each, where a ray
// meets it, and how a hit is told to others.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/bounding_sphere.h"
#include "geometry/mesh_source.h"
#include "geometry/polygon_crossing.h"
#include "geometry/reference_tracer.h"
#include "geometry/shape_set.h"

namespace raytree {

/// A ray as the objects of one space want it.
struct ObjectRay {
  ObjectRay(const Vec3d& from, const Vec3d& along)
      : origin(from), direction(along), sphere(from, along), picture(from, along) {}

  Vec3d origin, direction;
  SphereRay sphere;
  RayPicture picture;
};

/// Where a ray meets an object.
struct ObjectHit {
  double distance = 0;
  double u = 0, v = 0;  ///< of a piece of a curved surface
};

class ObjectList {
 public:
  /// Spheres, discs and cones first, then the polygons or pieces of each mesh. `shapes` must outlive it.
  ObjectList(const BoundedShapes& shapes, double sphere_pixels);

  std::size_t size() const { return spheres_.size(); }
  const std::vector<BoundingSphere>& spheres() const { return spheres_; }
  GeometryId geometry_of(std::uint32_t object) const { return objects_[object].geometry; }

  /// Nearest hit within [0, limit]. `interval`: where the ray lies in the object's sphere; the hit lies there, too.
  bool intersect(std::uint32_t object, const ObjectRay& ray, const RayInterval& interval, double limit,
                 ObjectHit& hit) const;

  /// All of a hit but its instance; the normal is in the list's space.
  ReferenceHit describe(std::uint32_t object, const ObjectRay& ray, const ObjectHit& hit) const;

  std::size_t memory_bytes() const;

 private:
  struct Object {
    GeometryId geometry;
    std::uint32_t index;  ///< sphere, disc, cone; of meshes the triangle, n-gon or piece
  };
  /// The corners of a polygon.
  struct Polygon {
    const Vec3f* positions;
    const std::uint32_t* corners;
    std::size_t count;
  };

  void add(const BoundingSphere& sphere, GeometryId geometry, std::size_t index);
  const MeshEntry& mesh_of(const Object& object) const { return shapes_->meshes[object.geometry - kFirstMeshGeometry]; }
  Polygon polygon_of(const MeshEntry& entry, std::uint32_t index) const;
  void describe_polygon(const Object& object, const ObjectRay& ray, ReferenceHit& hit) const;
  void describe_piece(const Object& object, const ObjectRay& ray, const ObjectHit& at, ReferenceHit& hit) const;

  const BoundedShapes* shapes_;
  double sphere_pixels_;
  std::vector<BoundingSphere> spheres_;  ///< [object]
  std::vector<Object> objects_;
  /// [mesh] For meshes of n-gons: [polygon] the first triangle of it; empty for others.
  std::vector<std::vector<std::uint32_t>> first_triangles_;
};

}  // namespace raytree
