// Mesh files by their extension: .obj and .ply, read by our own parallel readers.
#pragma once

#include <string>

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Reads a mesh file. Runs on the calling task arena's threads. Every index is checked, every position finite.
/// Throws Error (bad_input) with file and line (binary data: the element's number); what is odd but valid is
/// added to `warnings`. Peak memory <= 2.5 x the arrays kept (the mapped file not counted).
PolygonMesh read_mesh_file(const std::string& path, Warnings& warnings);

/// Whether the name ends as a mesh file's does.
bool is_mesh_file_name(const std::string& path);

/// ".obj" of "a/b.OBJ": what follows the last dot of the name, with it, in small letters; empty without one.
std::string lower_extension(const std::string& path);

}  // namespace raytree
