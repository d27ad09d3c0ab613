// The shapes of a scene in tracing form, all in scene space: world space less `origin`, so that a scene far from the
// world's origin loses nothing to float. Spheres, discs and planes stand in one array each.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/ray_batch.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"

namespace raytree {

/// Index into the scene's list of shapes: the unit that has a name, a material and an object id.
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

struct Plane {
  Vec3d point;   ///< scene space
  Vec3d normal;  ///< unit
  ShapeId shape = 0;
};

struct MeshEntry {
  TriangleMesh mesh;  ///< positions in scene space: mesh.origin is zero
  ShapeId shape = 0;
};

struct ShapeSet {
  Vec3d origin{0, 0, 0};          ///< world position of scene space's origin
  SphereArray spheres;            ///< kSphereGeometry
  DiscArray discs;                ///< kDiscGeometry
  std::vector<Plane> planes;      ///< kPlaneGeometry
  std::vector<MeshEntry> meshes;  ///< kFirstMeshGeometry + index

  /// Shape that a hit lies on.
  ShapeId shape_of(GeometryId geometry, std::uint32_t primitive) const {
    if (geometry >= kFirstMeshGeometry) return meshes[geometry - kFirstMeshGeometry].shape;
    if (geometry == kSphereGeometry) return spheres.shape[primitive];
    if (geometry == kDiscGeometry) return discs.shape[primitive];
    return planes[primitive].shape;
  }
};

/// Bytes of all arrays.
std::size_t memory_bytes(const ShapeSet& shapes);

}  // namespace raytree
