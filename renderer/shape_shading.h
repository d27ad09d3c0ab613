// What a shape's facets are given before they are traced, by how they will be shaded: vertex normals or none, and a
// record of what is asked for at hits (geometry/facet_record.h). How hits are shaded is facet_shading.h's.
#pragma once

#include <memory>

#include "geometry/facet_record.h"
#include "geometry/polygon_mesh.h"
#include "geometry/triangle_mesh.h"
#include "renderer/scene_description.h"

namespace raytree {

/// The scene's word, or the shape's, or what its kind says.
ShadingMethod shading_of(const ShapeDescription& shape, const FacetSettings& settings);

/// Throws Error (bad_input) where the shape's keys contradict each other.
void check_shading(const ShapeDescription& shape);

/// Sets or drops the vertex normals of polygons. Those of a mesh file are normalised already; `analytic`: the mesh has
/// the normals of its surface. Throws Error (bad_input) where analytic ones are asked for that nobody knows.
void set_vertex_normals(PolygonMesh& mesh, const ShapeDescription& shape, ShadingMethod method, bool analytic);

/// The same of triangles, which have the normals of their surface.
void set_vertex_normals(TriangleMesh& mesh, const ShapeDescription& shape, ShadingMethod method);

/// Null: hits on the shape need nothing but its triangles.
std::unique_ptr<FacetRecord> begin_record(const ShapeDescription& shape, ShadingMethod method,
                                          const FacetSettings& settings);

/// Notes what depends on the mesh as it will be traced, moved by the shape's transform.
void finish_record(const TriangleMesh& mesh, const ShapeDescription& shape, ShadingMethod method,
                   const FacetSettings& settings, FacetRecord& record);

}  // namespace raytree
