// PLY: ascii, binary little- and big-endian; n-gons kept; unknown elements and properties skipped.
#pragma once

#include <string>
#include <string_view>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Parses the bytes of a PLY file; `name` stands for the file in messages. See read_mesh_file.
PolygonMesh read_ply(std::string_view bytes, const std::string& name, Warnings& warnings);

}  // namespace raytree
