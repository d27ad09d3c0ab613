// Wavefront OBJ: v, vn, vt, f, g, o, usemtl, mtllib, and OpenSubdiv's t (obj_tags.h); n-gons kept; relative indices;
// everything else skipped.
#pragma once

#include <string>
#include <string_view>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Parses OBJ text; `name` stands for the file in messages. See read_mesh_file.
PolygonMesh read_obj(std::string_view text, const std::string& name, Warnings& warnings);

}  // namespace raytree
