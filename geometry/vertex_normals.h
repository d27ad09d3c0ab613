// Vertex normals: a mean over the faces around a vertex, by any of the ways that Gouraud and Phong name, split where
// faces meet at more than a crease angle.
#pragma once

#include "geometry/polygon_mesh.h"

namespace raytree {

/// What a face gives to the normal at one of its corners. All agree on a regular fan; on others they differ
/// (tests/geometry/normal_methods_test.cpp).
enum class NormalMethod : std::uint8_t {
  angle,              ///< its unit normal times the corner's angle (Gouraud 1971, p. 30; Thuermer and Wuethrich 1998)
  unit,               ///< its unit normal (Gouraud 1971, p. 29; Phong 1973, p. 40)
  area,               ///< the sum of Phong 1973, eq. 4.2: twice its area long
  edges,              ///< the sum of eq. 4.1 over the number of its edges: faces of fewer edges count more (p. 40)
  terminating_edges,  ///< the cross product of the corner's two edges (eq. 4.3; Gouraud 1971, p. 29): long edges count
  corners             ///< the same made unit (Gouraud 1971, p. 30)
};

struct NormalRules {
  NormalMethod method = NormalMethod::angle;
  double crease_angle = 0;  ///< radians; faces that meet across an edge at more share no normal; >= pi: all share
  /// Whether vertices of equal position count as one, so that the pieces of an object share normals along their common
  /// boundary (Gouraud 1971, p. 30-32).
  bool across_pieces = false;
};

/// Fills mesh.normals (unit) and, where creases or seams split them, mesh.normal_corners. Face normals by Newell's sum
/// (Phong 1973, eq. 4.2). Degenerate faces contribute nothing; a normal never comes out zero: where the sum cancels,
/// the largest summand serves. Runs on the task arena's threads; the result does not depend on their number.
void compute_vertex_normals(PolygonMesh& mesh, const NormalRules& rules);

/// The same by the corners' angles.
inline void compute_vertex_normals(PolygonMesh& mesh, double crease_angle) {
  compute_vertex_normals(mesh, NormalRules{NormalMethod::angle, crease_angle, false});
}

/// Makes the mesh's own normals unit; a zero or non-finite one is replaced by its face's normal. Returns how many were.
std::int64_t normalize_vertex_normals(PolygonMesh& mesh);

}  // namespace raytree
