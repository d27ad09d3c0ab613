// The scenes that `raytree bench standard` measures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/error.h"
#include "renderer/scene_description.h"

namespace raytree::benchmarks {

struct StandardScene {
  std::string name;
  double weight = 1;  ///< its share of the time
  /// Seconds that reading, generating and building take here, about: less time than that leaves the scene out.
  double expected_seconds = 1;
  std::function<SceneDescription(Warnings&)> make;
};

/// Balls and tree of the Standard Procedural Databases, scattered spheres, a Catmull-Clark surface, an instanced
/// forest, terrains of 0.1, 1 and 10 million triangles, and the meshes of files: those given, and the dragon where
/// `dragon_vrip.ply` lies in the working folder.
std::vector<StandardScene> standard_scenes(const std::vector<std::string>& mesh_files);
inline constexpr const char* kDragonFile = "dragon_vrip.ply";

}  // namespace raytree::benchmarks
