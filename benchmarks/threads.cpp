// Row threads: how much faster two threads trace than one.
#include <fmt/format.h>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "renderer/render.h"

namespace raytree::benchmarks {

std::vector<Figure> measure_threads(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const bool with_mesh : {false, true}) {
    const Scene scene = prepared(with_mesh ? reference_scene_with_mesh() : reference_scene());
    context.progress("threads: " + scene.description.name);
    const auto traced = [&](int threads) {
      RenderOptions options;
      options.threads = threads;
      return render(scene, options).statistics.wall_seconds;
    };
    const PairedSpread pairs = measure_pairs([&] { return traced(1); }, [&] { return traced(2); }, PairLimits());
    Figure figure;
    figure.row = "threads";
    figure.what = fmt::format("one thread's time / two threads', {}, {}x{}", scene.description.name,
                              scene.description.image.width, scene.description.image.height);
    figure.measured = pairs.ratio;
    figure.kind = BoundKind::at_least;
    figure.bound = kLeastThreads;
    figure.note = fmt::format("{:.4f} s on one thread, {:.4f} s on two", pairs.a.median, pairs.b.median);
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace raytree::benchmarks
