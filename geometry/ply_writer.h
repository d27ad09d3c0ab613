// Binary little-endian PLY of a mesh, the counterpart of ply_reader.h.
#pragma once

#include <string>

#include "geometry/polygon_mesh.h"

namespace raytree {

/// The mesh as PLY: positions (float; double where the mesh has an origin, which is added), normals nx ny nz and
/// texture coordinates s t of vertices, faces of any size. PLY knows a vertex as one thing: where corners at one
/// position have normals or texture coordinates of their own, it is written once for each. Groups, materials and
/// subdivision tags have no place in it.
std::string ply_bytes(const PolygonMesh& mesh);

}  // namespace raytree
