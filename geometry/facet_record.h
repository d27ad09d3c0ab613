// What is kept of a mesh beside its triangles where its facets are shaded in a way that asks for more: the polygons
// that they were cut from, the surface that they stand for, how far vertex normals lean. Made only when asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/cone.h"
#include "geometry/facet_weights.h"
#include "geometry/parametric_surface.h"
#include "geometry/polygon_mesh.h"
#include "geometry/ray_batch.h"
#include "geometry/triangle_mesh.h"

namespace raytree {

/// The smooth surface that a mesh's facets approximate.
class TrueSurface {
 public:
  virtual ~TrueSurface() = default;
  /// Its normal where it is closest in kind to the point of the triangle (barycentrics u and v of corners 1 and 2, as
  /// hits have them): outward, of any length, in the space of the surface.
  virtual Vec3d normal(const TriangleMesh& mesh, std::uint32_t triangle, float u, float v) const = 0;
  /// Of what it keeps by triangle or vertex.
  virtual std::size_t memory_bytes() const = 0;
};

/// Where a tessellation's triangles lie on their surface: 28 bytes a triangle.
struct FacetParameters {
  Buffer<std::uint32_t> faces;  ///< [triangle_count] of the parametric surface
  Buffer<Vec2f> corners;        ///< [triangle_count][3] in the face's parameters
};

/// The surface at the parameters of the point.
std::unique_ptr<TrueSurface> true_surface(std::shared_ptr<const ParametricSurface> surface, FacetParameters parameters);

/// A sphere about the mesh's origin, or a cone that begins there, of faceted_quadric.h: the normal of the radius, or of
/// the half plane about the axis, that the point lies on. `mesh` as that made it.
std::unique_ptr<TrueSurface> true_sphere(const PolygonMesh& mesh);
std::unique_ptr<TrueSurface> true_cone(const PolygonMesh& mesh, const Cone& cone);

struct FacetRecord {
  FacetInterpolation interpolation = FacetInterpolation::barycentric;

  // The polygons, by TriangleMesh::triangle_faces; empty: triangles are the facets.
  Buffer<std::uint32_t> starts;          ///< [polygon_count + 1] in the following
  Buffer<std::uint32_t> corners;         ///< indices into the mesh's positions
  Buffer<std::uint32_t> normal_corners;  ///< indices into its normals; empty: as corners

  std::unique_ptr<TrueSurface> surface;  ///< null: unknown, or not wanted
  Matrix44d surface_normal_to_mesh;      ///< normals of the surface are multiplied by this
  bool reversed = false;                 ///< corners 1 and 2 of triangles are exchanged against the surface's
  Buffer<float> least_cosines;           ///< see find_least_cosines(); empty: not wanted

  std::size_t memory_bytes() const;
};

/// Notes the polygons of a mesh that is about to be triangulated, unless all are triangles.
void note_polygons(const PolygonMesh& mesh, FacetRecord& record);

/// [normals.size()] The least cosine between a vertex normal and the facets around it. Interpolated over a facet with
/// weights that are not negative it bounds, from below, the cosine between the facet's normal and the interpolated
/// normal made unit; and it is the same from both sides of an edge.
void find_least_cosines(const TriangleMesh& mesh, FacetRecord& record);

/// A corner of the facet that a hit lies on.
struct ShadedCorner {
  Vec3f position;
  Vec3f normal;            ///< unit; the facet's own where the mesh has none
  float weight = 0;        ///< of what is interpolated
  float least_cosine = 1;  ///< where the record has them
};

/// Appends the facet's corners in the mesh's space, weights left open: the polygon's, or the triangle's. A triangle's
/// come in the order of its barycentrics.
void append_corners(const TriangleMesh& mesh, const FacetRecord& record, const Hit& hit,
                    std::vector<ShadedCorner>& corners);

/// The normal of the true surface at a hit, unit, in the mesh's space; zero where it has none.
Vec3f true_normal(const TriangleMesh& mesh, const FacetRecord& record, const Hit& hit);

}  // namespace raytree
