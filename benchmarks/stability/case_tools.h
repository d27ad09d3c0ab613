// What the stability cases of scenes share: figures in a line each, scenes prepared with the faults that the run
// plants, and pictures.
#pragma once

#include <string>

#include "benchmarks/stability/stability_case.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {

/// Of the renderer's own method: inside [low, high], or it is a defect.
StabilityFigure held(std::string method, std::string quantity, double measured, double low, double high,
                     std::string known);

/// Of a method that fails, inside [low, high] as it is known to.
StabilityFigure known_failure(std::string method, std::string quantity, double measured, double low, double high,
                              std::string known);

/// The scene behind the run's tracer: Embree without watertight edges where that is planted.
Scene prepared_for(const StabilityRun& run, SceneDescription description, const PrepareOptions& options = {});
RenderResult rendered_for(const StabilityRun& run, SceneDescription description,
                          const ChannelSet& channels = {ChannelGroup::color});

/// As an sRGB display shows it.
StabilityPicture stability_picture(std::string caption, const Film& film);

/// Adds a picture of the scene, where the run asks for pictures.
void add_picture(const StabilityRun& run, StabilityResult& result, std::string caption, SceneDescription description);

/// `full` times the effort, but at least `least`.
int scaled(const StabilityRun& run, int full, int least);

}  // namespace raytree::benchmarks
