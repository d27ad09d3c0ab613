// Row types: what the spheres of spheres-1980 cost the rays of a mesh of a million triangles that lies behind them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "benchmarks/intersection_benchmark.h"
#include "benchmarks/recording_intersector.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {
namespace {

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

/// The triangles of the reference scene under a flock of small spheres.
SceneDescription with_flock(int count) {
  SceneDescription scene = reference_mesh_alone();
  std::mt19937 random(1980);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int i = 0; i < count; ++i) {
    ShapeDescription sphere;
    sphere.name = fmt::format("sphere {}", i);
    sphere.kind = SphereShape{{4 * place(random), 2 + place(random), 4 * place(random) - 2}, 0.25};
    scene.shapes.push_back(sphere);
  }
  scene.name = fmt::format("{} spheres beside 1M triangles", count);
  return scene;
}

/// What a hierarchy of the spheres' own costs all kinds of rays, beside testing them one by one.
Figure tested_one_by_one(int count, const MeasureContext& context) {
  context.progress(fmt::format("types: {} spheres", count));
  EmbreeOptions hierarchy, one_by_one;
  hierarchy.most_few_shapes = 0;
  one_by_one.most_few_shapes = std::numeric_limits<std::size_t>::max();
  const Scene built = with_tracer(prepared(with_flock(count)), hierarchy),
              tested = with_tracer(prepared(with_flock(count)), one_by_one);
  const std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(tested);
  std::uint64_t hits_built = 0, hits_tested = 0;
  const auto seconds = [&](const Scene& scene, std::uint64_t& hits) {
    double sum = hits = 0;
    for (const RaySet& rays : sets) {
      const PassResult pass = batched_pass(scene, rays, 1);
      sum += pass.seconds, hits += pass.hits;
    }
    return sum;
  };
  const PairedSpread pairs = measure_pairs([&] { return seconds(built, hits_built); },
                                           [&] { return seconds(tested, hits_tested); }, PairLimits());
  Figure figure;
  figure.row = "types";
  figure.what =
      fmt::format("a hierarchy of the spheres' own / testing them one by one, time of all rays, {}, 1 thread; {}",
                  built.description.name,
                  static_cast<std::size_t>(count) <= kMostFewShapes ? "the renderer takes the second"
                                                                    : "the renderer takes the first");
  figure.measured = pairs.ratio;
  // Rays at a sphere's outline may differ by rounding.
  const double differ = std::abs(static_cast<double>(hits_built) - static_cast<double>(hits_tested));
  if (differ > 1e-4 * static_cast<double>(hits_tested))
    figure.problem = fmt::format("{} hits in the hierarchy, {} one by one", hits_built, hits_tested);
  return figure;
}

}  // namespace

std::vector<Figure> measure_types(const MeasureContext& context) {
  const Scene whole = prepared(reference_scene_with_mesh());
  const Scene alone = prepared(reference_mesh_alone());
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
    figure.bound = kLeastTypesShare;
    if (hits_whole != hits_alone)
      figure.problem = fmt::format("{} hits with the spheres, {} without", hits_whole, hits_alone);
    figure.note = fmt::format("{:.1f} ns a ray alone, {:.1f} ns with spheres",
                              1e9 * pairs.a.median / static_cast<double>(rays.size()),
                              1e9 * pairs.b.median / static_cast<double>(rays.size()));
    figures.push_back(figure);
  }
  for (const int count : {2, 8, 16, 32}) figures.push_back(tested_one_by_one(count, context));
  return figures;
}

}  // namespace raytree::benchmarks
