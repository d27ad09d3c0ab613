#include "benchmarks/stability/case_tools.h"

#include <algorithm>
#include <utility>

namespace raytree::benchmarks {

Scene prepared_for(const StabilityRun& run, SceneDescription description, const PrepareOptions& options) {
  Warnings warnings;
  PrepareOptions preparing = options;
  preparing.stop = run.stop;
  Scene scene = prepare(std::move(description), preparing, warnings);
  if (run.faults.not_robust && options.build)
    scene.intersector = std::make_unique<EmbreeIntersector>(*scene.shapes, run.tracer_options());
  return scene;
}

RenderResult rendered_for(const StabilityRun& run, SceneDescription description, const ChannelSet& channels) {
  const Scene scene = prepared_for(run, std::move(description));
  RenderOptions options;
  options.channels = channels;
  options.stop = run.stop;
  return render(scene, options);
}

DisplayOptions stability_display() {
  DisplayOptions options;
  options.ocio_config = "builtin";
  options.display = "sRGB";
  options.view = "Standard";
  return options;
}

StabilityPicture stability_picture(std::string caption, const Film& film) {
  return {std::move(caption), display_image(film, DisplayTransform(stability_display()))};
}

void add_picture(const StabilityRun& run, StabilityResult& result, std::string caption, SceneDescription description) {
  if (run.pictures)
    result.pictures.push_back(stability_picture(std::move(caption), rendered_for(run, std::move(description)).film));
}

int scaled(const StabilityRun& run, int full, int least) {
  return std::max(least, static_cast<int>(full * run.effort));
}

}  // namespace raytree::benchmarks
