#include "app/prepared_scene.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "app/exit_status.h"
#include "app/messages.h"

namespace raytree::app {

int with_prepared_scene(const SceneRun& run, const std::function<void(Scene&, const Interruption&)>& use) {
  const Interruption interruption(nullptr);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(run.threads));
  tbb::task_arena arena(run.threads);
  try {
    arena.execute([&] {
      Warnings warnings;
      SceneDescription description = run.describe ? run.describe(warnings) : load_scene(run.scene, warnings);
      PrepareOptions options;
      options.camera = run.scene.camera;
      options.threads = run.threads;
      options.stop = &interruption.stop();
      options.build = run.build;
      apply_tracer_flags(run.scene, options);
      options.measure_tessellation = run.measure_tessellation;
      options.keep_sources = run.keep_sources;
      Scene scene = prepare(std::move(description), options, warnings);
      if (!run.quiet) print_warnings(warnings, true);
      use(scene, interruption);
    });
  } catch (const Error&) {
    if (!interruption.stop()) throw;
  }
  return interruption.stop() ? kSignalBase + interruption.signal() : kSuccess;
}

}  // namespace raytree::app
