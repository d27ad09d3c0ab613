#include "renderer/builtin_scenes.h"

#include <algorithm>

#include "renderer/json_document.h"
#include "renderer/scene_reader.h"
#include "renderer/spd_scenes.h"
#include "renderer/suggestion.h"

namespace raytree {

std::vector<BuiltinScene> builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  for (const EmbeddedScene& scene : embedded_scenes()) {
    const std::string name(scene.name);
    scenes.push_back({name, read_scene(scene.json, name, "").title});
  }
  for (const SpdEntry& entry : spd_databases())
    scenes.push_back({std::string(kSpdPrefix) + std::string(entry.name), std::string(entry.summary)});
  return scenes;
}

bool is_builtin_scene(std::string_view name) {
  if (is_spd_scene(name)) return true;
  return std::any_of(embedded_scenes().begin(), embedded_scenes().end(),
                     [&](const EmbeddedScene& scene) { return scene.name == name; });
}

SceneDescription builtin_scene(std::string_view name) {
  if (is_spd_scene(name)) return spd_scene(name);
  std::vector<std::string> names;
  for (const EmbeddedScene& scene : embedded_scenes()) {
    if (scene.name == name) return read_scene(scene.json, std::string(name), "");
    names.emplace_back(scene.name);
  }
  for (const SpdEntry& entry : spd_databases()) names.push_back(std::string(kSpdPrefix) + std::string(entry.name));
  throw Error(ErrorKind::bad_input, {},
              "no built-in scene " + in_quotes(name) + "; " + choices_text("built-in scenes", name, names));
}

}  // namespace raytree
