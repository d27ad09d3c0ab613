// What commands that look at a prepared scene have in common: threads, signals, loading, warnings.
#pragma once

#include <functional>

#include "app/interruption.h"
#include "app/scene_argument.h"
#include "renderer/scene.h"

namespace raytree::app {

struct SceneRun {
  SceneFlags scene;
  int threads = 1;
  bool build = true;   ///< with its tracer
  bool quiet = false;  ///< no warnings
  bool measure_tessellation = false;
  bool keep_sources = false;  ///< see PrepareOptions
  /// Makes the scene; no function: it is loaded as `scene` says.
  std::function<SceneDescription(Warnings&)> describe = {};
};

/// Loads and prepares the scene and hands it to `use`, all on that many threads. Returns the exit status: success, or
/// the one that says which signal came, whose consequences are then not reported as errors. Throws Error.
int with_prepared_scene(const SceneRun& run, const std::function<void(Scene&, const Interruption&)>& use);

}  // namespace raytree::app
