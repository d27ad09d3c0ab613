// What refers to what among shapes and groups: names that must exist, chains that must end. Checked when a scene file
// is read and again when a scene is prepared, since scenes are also made by programs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "renderer/scene_description.h"

namespace raytree {

inline constexpr int kMostGroupLevels = 64;                  ///< groups within groups
inline constexpr std::uint64_t kMostInstances = 50'000'000;  ///< of a scene, nesting resolved; some 20 GB

/// The group that a shape uses; empty: it uses none.
const std::string& group_used_by(const ShapeDescription& shape);

/// Told of a shape that refers to what is not there: `group` is null for the scene's own shapes. Must throw.
using RefuseShape =
    std::function<void(const GroupDescription* group, const ShapeDescription& shape, const std::string& message)>;

/// Groups and terrains that shapes name must exist; no group may hold itself, directly or through others; and nesting
/// must end within kMostGroupLevels.
void check_groups(const SceneDescription& scene, const RefuseShape& refuse);

/// Index of the group of that name, which must exist.
std::uint32_t group_index(const SceneDescription& scene, const std::string& name);

}  // namespace raytree
