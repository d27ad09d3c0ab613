// Materials that a scene file can name by the key "from": those that Phong 1973 gives numbers for.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene_description.h"

namespace raytree {

struct BuiltinMaterial {
  MaterialDescription description;  ///< with its name
  std::string_view text;            ///< what it is and where its numbers come from; a sentence without its period
};

/// In the order of the thesis.
std::span<const BuiltinMaterial> builtin_materials();

/// Null: none of that name.
const MaterialDescription* builtin_material(std::string_view name);

std::vector<std::string> builtin_material_names();

/// All of `from` but its name.
void take_values(const MaterialDescription& from, MaterialDescription& to);

}  // namespace raytree
