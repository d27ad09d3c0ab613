// The standard render of the Standard Procedural Databases: which rays a classical ray tracer of 1987 traces for a
// scene, and how many of them its author published. The scenes are spd_scenes.h's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "renderer/render.h"
#include "renderer/scene_description.h"

namespace raytree {

struct SpdCounts {
  std::uint64_t eye_hits = 0;  ///< eye rays that hit something
  std::uint64_t reflected = 0, refracted = 0, shadow = 0;
};
inline constexpr int kSpdCountKinds = 4;
/// "eye hits" and so on, and their values, in the order of the members.
struct SpdCountKind {
  const char* name;
  std::uint64_t SpdCounts::*value;
};
inline constexpr SpdCountKind kSpdCounts[kSpdCountKinds] = {{"eye hits", &SpdCounts::eye_hits},
                                                            {"reflected", &SpdCounts::reflected},
                                                            {"refracted", &SpdCounts::refracted},
                                                            {"shadow", &SpdCounts::shadow}};

inline constexpr double kSpdTolerance = 0.1;  ///< share by which ray tracers may differ, the author says

/// What the author published of a scene (SPD 3.14, "Database Analysis"), 512 x 512 pixels at its standard size. None:
/// the scene is none of the seven at that size, as built-in scene or as NFF file of that name (balls.nff).
std::optional<SpdCounts> published_spd_counts(const SceneDescription& scene);

/// Changes a scene to the standard render ("Testing Procedures"): one eye ray through each corner of a pixel, each a
/// pixel of its own, so the image becomes one larger each way; trees of 5 levels, none cut; shadows go to every light
/// that the normal faces, and nothing shines through them. Opaque surfaces are one-sided, but those with vertex
/// normals (of the databases the teapot's alone, whose inside is seen); what transmits also reflects, as Haines has it,
/// if not by its own k_s then by a millionth.
void set_standard_spd_render(SceneDescription& scene);

SpdCounts spd_counts(const RenderStatistics& statistics);

/// Of a count over what was published, less 1; 0 where both are 0, infinity where 0 was published.
double relative_difference(std::uint64_t count, std::uint64_t published);

}  // namespace raytree
