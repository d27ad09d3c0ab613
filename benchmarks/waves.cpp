// Row waves: the same picture by single-ray recursion, over the time that generations of rays take.
#include <fmt/format.h>

#include "benchmarks/recording_intersector.h"
#include "benchmarks/recursive_tracer.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {

std::vector<Figure> measure_waves(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const bool with_mesh : {false, true}) {
    const Scene scene = prepared(with_mesh ? reference_scene_with_mesh() : reference_scene());
    const EmbreeIntersector& embree = embree_of(scene);
    for (const int threads : {1, 2}) {
      context.progress(fmt::format("waves: {}, threads {}", scene.description.name, threads));
      RenderOptions options;
      options.threads = threads;
      const PairedSpread pairs =
          measure_pairs([&] { return render_recursively(scene, embree, threads).wall_seconds; },
                        [&] { return render(scene, options).statistics.wall_seconds; }, PairLimits());
      Figure figure;
      figure.row = "waves";
      figure.what = "single-ray recursion / generations, " + picture_text(scene, threads);
      figure.measured = pairs.ratio;
      figure.kind = BoundKind::at_least;
      figure.bound = threads == 1 ? kLeastWaves : kLeastWavesOfTwo;
      figure.problem = picture_mismatch(render_recursively(scene, embree, threads), render(scene, options));
      figure.note = fmt::format("{:.4f} s by recursion, {:.4f} s by generations", pairs.a.median, pairs.b.median);
      figures.push_back(figure);
    }
  }
  return figures;
}

}  // namespace raytree::benchmarks
