// Material libraries of OBJ files (.mtl), in Whitted's terms: docs/mesh-materials.md has the table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/error.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Parses a material library; `name` stands for the file in messages. Colors are taken as linear Rec.709. Of materials
/// with one name the last counts. Throws Error (bad_input) with file and line where a statement that is used lacks its
/// numbers; what is dropped (textures, emission, statements unknown) and what is out of range, and so taken as the
/// nearest that means something, is counted in `warnings`.
std::vector<MaterialDescription> read_mtl(std::string_view text, const std::string& name, Warnings& warnings);

/// The same of a file.
std::vector<MaterialDescription> read_mtl_file(const std::string& path, Warnings& warnings);

}  // namespace raytree
