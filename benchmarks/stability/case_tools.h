// What the stability cases of scenes share: scenes prepared with the faults that the run
// plants, and pictures.
#pragma once

#include <string>

#include "benchmarks/stability/stability_case.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {

/// The scene behind the run's tracer: Embree without watertight edges where that is planted.
Scene prepared_for(const StabilityRun& run, SceneDescription description, const PrepareOptions& options = {});
RenderResult rendered_for(const StabilityRun& run, SceneDescription description,
                          const ChannelSet& channels = {ChannelGroup::color});

/// How pictures of the suite are shown, whatever $OCIO says.
DisplayOptions stability_display();
StabilityPicture stability_picture(std::string caption, const Film& film);

/// Adds a picture of the scene, where the run asks for pictures.
void add_picture(const StabilityRun& run, StabilityResult& result, std::string caption, SceneDescription description);

/// `full` times the effort, but at least `least`.
int scaled(const StabilityRun& run, int full, int least);

}  // namespace raytree::benchmarks
