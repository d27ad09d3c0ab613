// What a render cost, as the JSON of --stats and as the lines of --verbose. docs/command-line.md describes every key.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/render_options.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree::app {

/// What stands in the scene by the time it is rendered, kept after the scene itself is gone.
struct RenderReport {
  std::string scene;
  ImageDescription image;
  PixelWindow window;
  RenderSettings settings;
  std::string camera;
  int threads = 0;
  RenderStatistics trace;
  double read_seconds = 0;  ///< the scene's own file, and a bare mesh
  PhaseSeconds prepare;
  double display_seconds = 0;       ///< display transform, all files
  double write_seconds = 0;         ///< encoding and writing, all files
  double before_trace_seconds = 0;  ///< from launch to the start of tracing
  double first_ray_clock = 0;       ///< reading of the steady clock at the start of tracing, seconds
  std::uint64_t film_bytes = 0, array_bytes = 0, intersector_bytes = 0;
  std::string hierarchy;                ///< what the tracer built, and why
  std::int64_t display_not_finite = 0;  ///< channel values that the display transform had to make finite
  std::vector<std::string> files;
  Warnings warnings;
};

/// Ends in a newline.
std::string statistics_json(const RenderReport& report);
/// One fact a line, without a newline at the end.
std::string statistics_text(const RenderReport& report);

/// Render settings, image and camera as the JSON of a scene file, one line: what the metadata of a picture carries. The
/// shapes, which may be large, and whatever does not change the pixels are left out.
std::string settings_metadata(const SceneDescription& scene, const std::string& camera);

}  // namespace raytree::app
