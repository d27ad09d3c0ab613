// The scenes of Haines's Standard Procedural Databases ("A Proposal for Standard Graphics Environments", IEEE CG&A
// 7(11), 1987), generated at any size: what stands in them. What tracing them should cost is spd_counts.h's.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "renderer/scene_description.h"

namespace raytree {

enum class SpdDatabase { balls, gears, mount, rings, teapot, tetra, tree };

struct SpdEntry {
  SpdDatabase database;
  std::string_view name;     ///< "balls"; as a built-in scene "spd-balls", at another size "spd-balls:5"
  std::string_view summary;  ///< of the scene, and what its size factor counts
  int standard_size;         ///< that the published counts are of
  int largest_size;          ///< some hundred thousand exact shapes or some million polygons
};

inline constexpr std::string_view kSpdPrefix = "spd-";  ///< of built-in scenes

/// All seven, by name.
std::span<const SpdEntry> spd_databases();
const SpdEntry& spd_entry(SpdDatabase database);

/// The scene as read_nff() has it of the original programs' output: Z up, the same camera, lights, materials and
/// primitives in the same order, each within the six digits of the text. The balls are one shape, a mesh is one shape
/// for each material. Intensities are not in the file: the lights have the 1 / (2 sqrt(n)) that the author proposes,
/// and there is a little ambient light. Throws Error (bad_input) for a size that is not in [1, largest_size].
SceneDescription spd_scene(SpdDatabase database, int size);

/// Whether `name` is that of a database as built-in scene, "spd-balls" or "spd-balls:5"; what follows a colon is not
/// looked at.
bool is_spd_scene(std::string_view name);

/// That scene. Throws Error (bad_input) for a size that is none, and for a name that is no database's.
SceneDescription spd_scene(std::string_view name);

}  // namespace raytree
