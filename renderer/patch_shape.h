// Patches as scene files give them, to the patches that make a surface.
#pragma once

#include <string>
#include <vector>

#include "geometry/error.h"
#include "geometry/patch_surface.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Reads the file, or puts control points to the lists of indices; `folder` is what the file is relative to. Throws
/// Error (bad_input), at `where` unless it is the file that is wrong.
std::vector<SurfacePatch> surface_patches(const PatchesShape& shape, const std::string& folder,
                                          const SourceLocation& where, Warnings& warnings);

/// How the surface of these patches is made.
PatchSurfaceOptions surface_options(const PatchesShape& shape);

}  // namespace raytree
