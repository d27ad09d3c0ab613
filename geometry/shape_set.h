// The shapes of a scene in tracing form, all in scene space: world space less `origin`, so that a scene far from the
// world's origin loses nothing to float. Spheres, discs, cones and planes stand in one array each. Groups hold shapes
// in a space of their own and are used, as often as one likes, through instances.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/cone.h"
#include "geometry/ray_batch.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"

namespace raytree {

/// Index into the scene's list of shapes, those of groups behind those of the scene: the unit that has a name and a
/// material.
using ShapeId = std::uint32_t;

struct SphereArray {
  Buffer<Imath::V4f> center_radius;  ///< [sphere_count], scene space; Embree shares it
  Buffer<ShapeId> shape;             ///< [sphere_count]
};

struct DiscArray {
  Buffer<Imath::V4f> center_radius;  ///< [disc_count]
  Buffer<Vec3f> normal;              ///< [disc_count], unit
  Buffer<ShapeId> shape;
};

/// Lateral surfaces of cut-off cones and of cylinders; see cone.h.
struct ConeArray {
  Buffer<Imath::V4f> base_radius;  ///< [cone_count] center and radius of one end
  Buffer<Imath::V4f> apex_radius;  ///< [cone_count] of the other
  Buffer<ShapeId> shape;

  Cone operator[](std::size_t i) const {
    const Imath::V4f &b = base_radius[i], &a = apex_radius[i];
    return {{b.x, b.y, b.z}, {a.x, a.y, a.z}, b.w, a.w};
  }
};

struct Plane {
  Vec3d point;   ///< scene space
  Vec3d normal;  ///< unit
  ShapeId shape = 0;
};

struct FacetRecord;  // facet_record.h
struct MeshSource;   // mesh_source.h

inline constexpr std::uint32_t kNoTag = 0xffffffffu;

struct MeshEntry {
  TriangleMesh mesh;  ///< positions in scene space: mesh.origin is zero
  ShapeId shape = 0;
  /// [triangle_count] what whoever filled the set wants to find again at a hit, kNoTag for nothing; empty: no triangle
  /// has a tag. Tracers do not look at it.
  Buffer<std::uint32_t> triangle_tags = {};
  /// What shading asks for beside the triangles; null: nothing.
  std::shared_ptr<const FacetRecord> facets = {};
  /// What the triangles were made of; null: not kept.
  std::shared_ptr<const MeshSource> source = {};
};

/// What lies within bounds.
struct BoundedShapes {
  /// Where the space of these arrays begins: of the scene's own shapes in the world, of a group's in the coordinates
  /// that the group is described in.
  Vec3d origin{0, 0, 0};
  SphereArray spheres;            ///< kSphereGeometry
  DiscArray discs;                ///< kDiscGeometry
  ConeArray cones;                ///< kConeGeometry
  std::vector<MeshEntry> meshes;  ///< kFirstMeshGeometry + index

  bool empty() const { return spheres.shape.empty() && discs.shape.empty() && cones.shape.empty() && meshes.empty(); }

  /// Shape that a hit on anything but a plane lies on.
  ShapeId bounded_shape_of(GeometryId geometry, std::uint32_t primitive) const {
    if (geometry >= kFirstMeshGeometry) return meshes[geometry - kFirstMeshGeometry].shape;
    if (geometry == kSphereGeometry) return spheres.shape[primitive];
    return geometry == kDiscGeometry ? discs.shape[primitive] : cones.shape[primitive];
  }

  /// The tag of a triangle that was hit; kNoTag for all else.
  std::uint32_t tag_of(GeometryId geometry, std::uint32_t primitive) const {
    if (geometry < kFirstMeshGeometry) return kNoTag;
    const Buffer<std::uint32_t>& tags = meshes[geometry - kFirstMeshGeometry].triangle_tags;
    return tags.empty() ? kNoTag : tags[primitive];
  }
};

/// One use of a group. As single precision has it, since that is what a tracer sees; no inverse is kept, so that a
/// million uses take 60 MB.
struct Instance {
  float to_scene[4][3];      ///< group to scene space, row vectors: x, y and z axis, origin
  std::uint32_t group = 0;   ///< of ShapeSet::groups
  ShapeId shape = 0;         ///< the scene's shape that uses the group, directly or through other groups
  std::uint32_t object = 0;  ///< index among the scene's objects: shapes, and uses of groups beyond a shape's first one

  Vec3f axis(int i) const { return {to_scene[i][0], to_scene[i][1], to_scene[i][2]}; }
  Vec3f origin() const { return axis(3); }
};

struct ShapeSet : BoundedShapes {
  std::vector<Plane> planes;          ///< kPlaneGeometry
  std::vector<BoundedShapes> groups;  ///< each in a space of its own; none holds another: nesting is resolved
  Buffer<Instance> instances;         ///< those of one shape stand together

  /// Shape that a hit lies on.
  ShapeId shape_of(GeometryId geometry, std::uint32_t primitive, InstanceId instance = kNoInstance) const {
    if (instance != kNoInstance) return groups[instances[instance].group].bounded_shape_of(geometry, primitive);
    return geometry == kPlaneGeometry ? planes[primitive].shape : bounded_shape_of(geometry, primitive);
  }
};

/// Bytes of all arrays.
std::size_t memory_bytes(const ShapeSet& shapes);

}  // namespace raytree
