#include "renderer/builtin_scenes.h"

#include <algorithm>

#include "renderer/json_document.h"
#include "renderer/scene_reader.h"
#include "renderer/suggestion.h"

namespace raytree {

std::vector<BuiltinScene> builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  for (const EmbeddedScene& scene : embedded_scenes()) {
    const std::string name(scene.name);
    scenes.push_back({name, read_scene(scene.json, name, "").title});
  }
  return scenes;
}

bool is_builtin_scene(std::string_view name) {
  return std::any_of(embedded_scenes().begin(), embedded_scenes().end(),
                     [&](const EmbeddedScene& scene) { return scene.name == name; });
}

SceneDescription builtin_scene(std::string_view name) {
  std::vector<std::string> names;
  for (const EmbeddedScene& scene : embedded_scenes()) {
    if (scene.name == name) return read_scene(scene.json, std::string(name), "");
    names.emplace_back(scene.name);
  }
  throw Error(ErrorKind::bad_input, {},
              "no built-in scene " + in_quotes(name) + "; " + choices_text("built-in scenes", name, names));
}

}  // namespace raytree
