// Row bench: what `raytree bench` adds to the Embree calls that it times.
#include <fmt/format.h>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "benchmarks/seam_comparison.h"

namespace raytree::benchmarks {
std::vector<Figure> measure_intersection_overhead(const MeasureContext& context) {
  const Scene scene = prepared(reference_mesh_alone());
  const std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(scene);
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < kBenchmarkRaysCount; ++i) {
    const auto kind = static_cast<BenchmarkRays>(i);
    context.progress(fmt::format("bench: {} rays", name_of(kind)));
    const RaySet& rays = sets[i];
    SeamComparison comparison(scene, embree_of(scene), rays, calls_of(embree_of(scene), rays.coherence));
    const PairedSpread pairs = measure_pairs([&] { return comparison.bare_seconds(); },
                                             [&] { return comparison.seam_seconds(); }, PairLimits());
    Figure figure;
    figure.row = "bench";
    figure.what = fmt::format("bare Embree calls / raytree bench, {} {} rays, {}, 1 thread", rays.size(), name_of(kind),
                              scene.description.name);
    figure.measured = pairs.ratio;
    figure.kind = BoundKind::at_least;
    figure.bound = kLeastBenchShare;
    figure.problem = comparison.problem();
    figure.note = fmt::format("{:.4f} s bare, {:.4f} s by the benchmark", pairs.a.median, pairs.b.median);
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace raytree::benchmarks
