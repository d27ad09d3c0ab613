// A scene of ours in POV-Ray's language, as equal as the two programs' models allow: geometry, camera, lights,
// materials, background and depth of the tree.
#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene.h"

namespace raytree::benchmarks {

/// What POV-Ray is to show.
enum class PovrayPicture {
  shaded,
  /// 1 - d / `reach` for a first hit at distance d from the eye, 0 where nothing is hit: no lights, no reflection.
  nearness,
  /// White where the scene's first light reaches the side that is seen, by N.L; black in its shadow and where nothing
  /// is: flat facets, one light, no ambient light, everything opaque.
  lit
};

/// Writes the scene to `path`. Colors stay linear (assumed_gamma 1). `reach`: for PovrayPicture::nearness, scene units.
/// Throws Error (failure) where the scene holds what has no counterpart: textured checkers, falloff, spot lights,
/// highlight colors, thin or absorbing materials, orthographic cameras, instances.
void write_povray_scene(const std::filesystem::path& path, const Scene& scene, PovrayPicture picture, double reach = 0);

/// What POV-Ray reports of a run.
struct PovrayStatistics {
  double trace_cpu_seconds = 0;
  double rays = 0;  ///< eye rays, reflected and refracted ones; no shadow rays
};

/// Reads the report that POV-Ray writes to stderr. Throws Error (failure) where it lacks a figure.
PovrayStatistics parse_povray_statistics(const std::string& report);

}  // namespace raytree::benchmarks
