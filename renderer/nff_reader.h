// Scenes in Haines's Neutral File Format (.nff, version 3): the databases of his Standard Procedural Databases.
#pragma once

#include <string>
#include <string_view>

#include "geometry/error.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Parses an NFF scene; `name` stands for the file in messages. docs/nff.md says what becomes of each entity. Throws
/// Error (bad_input) with file and line; what is dropped is counted in `warnings`.
SceneDescription read_nff(std::string_view text, const std::string& name, Warnings& warnings);

/// The same of a file.
SceneDescription read_nff_file(const std::string& path, Warnings& warnings);

}  // namespace raytree
