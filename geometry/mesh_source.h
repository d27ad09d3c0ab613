// What a mesh was before it became triangles: n-gons, or pieces of a curved surface. Kept beside the mesh only where a
// tracer is asked for that wants the truth (PrepareOptions::intersector).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/facet_record.h"
#include "geometry/limit_patch.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"

namespace raytree {

/// How wide a pixel is at a place, in the units of the space that the mesh lies in.
struct PixelSize {
  Matrix44d from_eye;      ///< that space to places relative to the eye, in world units
  double at_distance = 0;  ///< a perspective view's pixel one world unit from the eye, by units of that space
  double everywhere = 1;   ///< added to it: what an orthographic view's pixel is; 0 for a perspective view

  double operator()(const Vec3d& place) const { return at_distance * (place * from_eye).length() + everywhere; }
};

struct MeshSource {
  // n-gons, by TriangleMesh::triangle_faces; empty: the mesh was one of triangles
  Buffer<std::uint32_t> starts;   ///< [polygon_count + 1] in the following
  Buffer<std::uint32_t> corners;  ///< indices into the mesh's positions, as the file has them

  // curved surface
  std::vector<LimitPatch> patches;  ///< in the mesh's space; empty: not curved, or no such pieces are known
  FacetParameters parameters;       ///< where the mesh's triangles lie on the surface
  PixelSize pixel;

  /// The mesh is a mirror image of its source, with corners 1 and 2 of its triangles exchanged.
  bool reversed = false;

  bool curved() const { return !patches.empty(); }
  std::size_t polygon_count() const { return starts.empty() ? 0 : starts.size() - 1; }
  /// Whether hits may lie off the triangles that stand for them: on a curved surface, or on n-gons.
  bool leaves_triangles() const { return curved() || polygon_count() > 0; }
  std::size_t memory_bytes() const;
};

/// Notes the n-gons of a mesh that is about to be triangulated, unless all are triangles.
void note_polygons(const PolygonMesh& mesh, MeshSource& source);

/// An affine map of a patch is the patch of the mapped control points.
void move_patches(MeshSource& source, const Matrix44d& m);

}  // namespace raytree
