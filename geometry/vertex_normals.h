// Vertex normals: the angle-weighted mean of the faces around a vertex, split where faces meet at more than a crease
// angle.
#pragma once

#include "geometry/polygon_mesh.h"

namespace raytree {

/// Fills mesh.normals (unit) and, where creases split them, mesh.normal_corners. Face normals by Newell's sum (Phong
/// 1973, eq. 4.2, unit), weighted by the corner's angle (Thuermer and Wuethrich 1998). Faces that meet across an edge
/// at more than crease_angle (radians) share no normal; crease_angle >= pi: all share. Degenerate faces contribute
/// nothing; a normal never comes out zero. Runs on the task arena's threads; the result does not depend on their
/// number.
void compute_vertex_normals(PolygonMesh& mesh, double crease_angle);

/// Makes the mesh's own normals unit; a zero or non-finite one is replaced by its face's normal. Returns how many were.
std::int64_t normalize_vertex_normals(PolygonMesh& mesh);

}  // namespace raytree
