// Scenes that come with the program: the files of scenes/, compiled in, and the Standard Procedural Databases, which
// are generated; so a fresh machine has real work.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene_description.h"

namespace raytree {

struct BuiltinScene {
  std::string name;     ///< e.g. "spheres-1980"
  std::string summary;  ///< the scene's title
};

/// All of them: the files by name, then the databases ("spd-balls").
std::vector<BuiltinScene> builtin_scenes();

/// Whether `name` is one of them, or a database of another size ("spd-balls:5").
bool is_builtin_scene(std::string_view name);

/// Throws Error (bad_input) that lists the names where there is none of this name.
SceneDescription builtin_scene(std::string_view name);

/// A scene file as it was when the program was built.
struct EmbeddedScene {
  std::string_view name;
  std::string_view json;
};

/// Defined in a source made by cmake/EmbedScenes.cmake; sorted by name.
const std::vector<EmbeddedScene>& embedded_scenes();

}  // namespace raytree
