// Shapes of patches whose surface is known.
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/scene_description.h"
#include "tests/patch_samples.h"

namespace raytree::test {

/// The unit sphere of rational patches.
inline PatchesShape round_patches() {
  PatchesShape kind;
  for (const BezierPatch& patch : sphere_patches()) {
    auto& indices = kind.bezier.emplace_back();
    for (std::size_t i = 0; i < 16; ++i) {
      indices[i] = static_cast<std::uint32_t>(kind.positions.size());
      kind.positions.push_back(patch.points[i]);
      kind.weights.push_back(patch.weights[i]);
    }
  }
  return kind;
}

}  // namespace raytree::test
