// The curved surfaces that row curved-pictures renders at 1920x1080: each as the words of a command, as users type it,
// and as a scene in memory, on which cracks and outlines are measured.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "renderer/scene_description.h"

namespace raytree::benchmarks {

inline constexpr int kCurvedPictureWidth = 1920, kCurvedPictureHeight = 1080;

struct CurvedPicture {
  std::string name;
  std::vector<std::string> words;          ///< the scene, and how it is cut, as `raytree render` takes them
  std::function<SceneDescription()> make;  ///< the same scene; throws Error
  int rate = 0;                            ///< segments of every edge; 0: as many as the default tolerance asks for
  bool closed = false;                     ///< every edge of the cage has two faces
};

/// Spot and OpenSubdiv's car out of `data`/subdiv, the teapot, and a cage of our own cut into ten million triangles. A
/// cage of our own stands for a file of `data` that is not there, and its name says so. Our own cages are written to
/// `scratch`. Throws Error.
std::vector<CurvedPicture> curved_pictures(const std::filesystem::path& data, const std::filesystem::path& scratch);

/// The scene less what is not curved: that whose cracks and outline are measured.
SceneDescription curved_shapes_alone(SceneDescription scene);

}  // namespace raytree::benchmarks
