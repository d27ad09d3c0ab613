// Wavefront OBJ text of a mesh, the counterpart of obj_reader.h.
#pragma once

#include <string>

#include "geometry/polygon_mesh.h"

namespace raytree {

/// The mesh as OBJ: vertices, texture coordinates, normals, faces of any size, groups, materials, subdivision tags.
/// Numbers are the shortest that read back to the same bits; positions have the origin added, in double.
std::string obj_text(const PolygonMesh& mesh);

}  // namespace raytree
