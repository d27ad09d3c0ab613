// The table of `raytree render --counts spd`.
#pragma once

#include <string>

#include "renderer/render.h"
#include "renderer/scene_description.h"

namespace raytree::app {

/// Counts of rays, beside the published ones where there are any for the scene. Ends in a newline.
std::string spd_counts_text(const SceneDescription& scene, const RenderStatistics& statistics);

}  // namespace raytree::app
