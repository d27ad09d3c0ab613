// The scene that tests of the program render, and how to do it quickly.
#pragma once

#include <string>
#include <vector>

namespace raytree::test {

inline const char* const kScene = "spheres-1980";

/// A small render of a built-in scene into `file`.
inline std::vector<std::string> small_render(const std::string& file) {
  return {"render", kScene, "-o", file, "--size", "64x48"};
}

}  // namespace raytree::test
