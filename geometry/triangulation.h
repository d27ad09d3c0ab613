// From n-gons to triangles: concave polygons are cut right, convex ones cheaply; a triangle knows its face.
#pragma once

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "geometry/triangle_mesh.h"

namespace raytree {

/// Consumes the mesh: arrays that need no change are moved, not copied. An n-gon gives n - 2 triangles that keep its
/// orientation (by Newell's normal); one that cannot be cut without overlap (self-intersecting) is cut as best it can
/// be and counted in `warnings`. Normals must already be per position or per corner, unit. `where` names the shape.
TriangleMesh triangulate(PolygonMesh&& mesh, const SourceLocation& where, Warnings& warnings);

}  // namespace raytree
