#include "renderer/scene_reader.h"
#include "renderer/scene_values.h"

namespace raytree {

std::string write_scene(const SceneDescription& scene) {
  JsonWriter out;
  SceneValueWriter(out).write(scene);
  return out.text();
}

}  // namespace raytree
