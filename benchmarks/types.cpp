// Row types: what the spheres of spheres-1980 cost the rays of a mesh of a million triangles that lies behind them.
#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/intersection_benchmark.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {
namespace {

constexpr double kLeastShare = 0.9;

SceneDescription without_spheres(SceneDescription scene) {
  std::erase_if(scene.shapes, [](const ShapeDescription& shape) {
    return !std::holds_alternative<MeshShape>(shape.kind) && !std::holds_alternative<TerrainShape>(shape.kind);
  });
  scene.name += ", triangles alone";
  return scene;
}

/// The rays that get the same answer in both scenes, in their order.
RaySet unstopped(const RaySet& rays, const Scene& a, const Scene& b) {
  RaySet kept;
  kept.occlusion = rays.occlusion, kept.coherence = rays.coherence;
  HitBatch hits_a(kBenchmarkBatch), hits_b(kBenchmarkBatch);
  std::vector<std::uint8_t> occluded_a(kBenchmarkBatch + kBatchPadding), occluded_b(kBenchmarkBatch + kBatchPadding);
  for (const RayBatch& batch : rays.batches) {
    if (rays.occlusion) {
      a.intersector->occluded(batch, rays.coherence, occluded_a.data());
      b.intersector->occluded(batch, rays.coherence, occluded_b.data());
    } else {
      a.intersector->intersect(batch, rays.coherence, hits_a);
      b.intersector->intersect(batch, rays.coherence, hits_b);
    }
    for (std::size_t i = 0; i < batch.size; ++i) {
      const bool same = rays.occlusion ? occluded_a[i] == occluded_b[i] : hits_b.geometry[i] != kSphereGeometry;
      if (!same) continue;
      if (kept.batches.empty() || kept.batches.back().size == kBenchmarkBatch)
        kept.batches.emplace_back(kBenchmarkBatch);
      kept.batches.back().push(batch.origin(i), batch.direction(i), batch.max_distance[i]);
    }
  }
  return kept;
}

}  // namespace

std::vector<Figure> measure_types(const MeasureContext& context) {
  const Scene whole = prepared(reference_scene_with_mesh());
  const Scene alone = prepared(without_spheres(reference_scene_with_mesh()));
  // The rays of the triangles alone that no sphere stops: they find the same in both scenes, by the same way.
  std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(alone);
  for (RaySet& rays : sets) rays = unstopped(rays, alone, whole);
  std::vector<Figure> figures;
  for (const RaySet& rays : sets) {
    const char* name = name_of(static_cast<BenchmarkRays>(&rays - sets.data()));
    context.progress(fmt::format("types: {} rays", name));
    std::uint64_t hits_alone = 0, hits_whole = 0;
    const auto pass_in = [&](const Scene& scene, std::uint64_t& hits) {
      const PassResult pass = batched_pass(scene, rays, 1);
      hits = pass.hits;
      return pass.seconds;
    };
    const PairedSpread pairs = measure_pairs([&] { return pass_in(alone, hits_alone); },
                                             [&] { return pass_in(whole, hits_whole); }, PairLimits());
    Figure figure;
    figure.row = "types";
    figure.what = fmt::format(
        "triangles alone / with spheres, time of the same {} {} rays, spheres-1980 with a terrain "
        "of 1M triangles, 1 thread",
        rays.size(), name);
    figure.measured = pairs.ratio;
    figure.kind = BoundKind::at_least;
    figure.bound = kLeastShare;
    if (hits_whole != hits_alone)
      figure.problem = fmt::format("{} hits with the spheres, {} without", hits_whole, hits_alone);
    figure.note = fmt::format("{:.1f} ns a ray alone, {:.1f} ns with spheres",
                              1e9 * pairs.a.median / static_cast<double>(rays.size()),
                              1e9 * pairs.b.median / static_cast<double>(rays.size()));
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace raytree::benchmarks
