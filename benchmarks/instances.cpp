// Row instances: ten thousand uses of a mesh of a million triangles: their memory, and what the seam adds to the Embree
// calls that trace them.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmarks/child_process.h"
#include "benchmarks/recording_intersector.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/resident_memory.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "benchmarks/seam_comparison.h"
#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

/// Throws Error where the system does not tell.
double memory_figure(const std::string& key) {
  if (const std::optional<std::uint64_t> bytes = status_bytes(key)) return static_cast<double>(*bytes);
  throw Error(ErrorKind::failure, {"/proc/self/status", 0, ""}, "no " + key);
}

/// What following packets together saves or costs the eye and shadow rays of edge^2 instances.
Figure followed_together(int edge, const MeasureContext& context) {
  context.progress(fmt::format("instances: packets at {} instances", edge * edge));
  EmbreeOptions together, apart;
  together.many_instances = std::numeric_limits<std::size_t>::max();
  apart.many_instances = 0;
  const Scene in_company = with_tracer(prepared(instances_scene(edge)), together),
              alone = with_tracer(prepared(instances_scene(edge)), apart);
  const std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(alone);
  std::uint64_t hits_together = 0, hits_apart = 0;
  const auto seconds = [&](const Scene& scene, std::uint64_t& hits) {
    double sum = hits = 0;
    for (const BenchmarkRays kind : {BenchmarkRays::primary, BenchmarkRays::shadow}) {
      const PassResult pass = batched_pass(scene, sets[static_cast<std::size_t>(kind)], 1);
      sum += pass.seconds, hits += pass.hits;
    }
    return sum;
  };
  const PairedSpread pairs = measure_pairs([&] { return seconds(in_company, hits_together); },
                                           [&] { return seconds(alone, hits_apart); }, PairLimits());
  Figure figure;
  figure.row = "instances";
  figure.what = fmt::format(
      "packets followed together / apart, time of eye and shadow rays at {} instances, 1 thread; {}", edge * edge,
      static_cast<std::size_t>(edge * edge) < kManyInstances ? "the renderer takes the first"
                                                             : "the renderer takes the second");
  figure.measured = pairs.ratio;
  // The coherent flag leaves the primitive of a ray at an edge to its company.
  const double differ = std::abs(static_cast<double>(hits_together) - static_cast<double>(hits_apart));
  if (differ > 1e-4 * static_cast<double>(hits_apart))
    figure.problem = fmt::format("{} hits together, {} apart", hits_together, hits_apart);
  return figure;
}

}  // namespace

std::string instances_memory_json() {
  SceneDescription description = instances_scene();
  const double before = memory_figure("VmRSS");
  const Scene scene = prepared(std::move(description));
  return nlohmann::json{
      {"before", before},
      {"resident", memory_figure("VmRSS")},
      {"peak", memory_figure("VmHWM")},
      {"arrays", scene.summary.array_bytes},
      {"embree", scene.summary.intersector_bytes},
      {"instances", scene.summary.instances},
      {"instanced_triangles", scene.summary.shapes.at(0).instanced_triangles * scene.summary.instances}}
      .dump();
}

std::vector<Figure> measure_instances(const MeasureContext& context) {
  context.progress("instances: memory");
  const ChildResult child = run_child({context.programs / "raytree_measure", kInstancesMemoryFlag}, context.scratch);
  require_success(child, "raytree_measure --instances-memory");
  const nlohmann::json memory = nlohmann::json::parse(child.output);
  const auto of = [&](const char* key) { return memory.at(key).get<double>(); };
  const double gibibytes = (of("peak") - of("before")) / kGibibyte;
  Figure size;
  size.row = "instances";
  size.what = fmt::format(
      "peak memory of preparing {:.0f} instances of a mesh of a million triangles, less what the "
      "program held before",
      of("instances"));
  size.unit = "GiB";
  size.measured = {gibibytes, gibibytes, gibibytes, 1};
  size.kind = BoundKind::at_most;
  size.bound = kMostInstancesGibibytes;
  size.note = fmt::format("{:.3f} GiB once prepared; arrays {:.3f} GiB, Embree's own {:.3f} GiB; {:.2e} triangles seen",
                          (of("resident") - of("before")) / kGibibyte, of("arrays") / kGibibyte,
                          of("embree") / kGibibyte, of("instanced_triangles"));
  std::vector<Figure> figures{size};

  const Scene scene = prepared(instances_scene());
  const std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(scene);
  for (const BenchmarkRays kind : {BenchmarkRays::primary, BenchmarkRays::shadow, BenchmarkRays::bounce}) {
    context.progress(fmt::format("instances: {} rays", name_of(kind)));
    const RaySet& rays = sets[static_cast<std::size_t>(kind)];
    const ReplayCalls calls = calls_of(embree_of(scene), rays.coherence);
    SeamComparison comparison(scene, embree_of(scene), rays, calls);
    const PairedSpread pairs = measure_pairs([&] { return comparison.seam_seconds(); },
                                             [&] { return comparison.bare_seconds(); }, PairLimits());
    Figure figure;
    figure.row = "instances";
    figure.what =
        fmt::format("the seam / bare Embree calls, {} {} rays at 10,000 instances, {}x{}, 1 thread", rays.size(),
                    name_of(kind), scene.description.image.width, scene.description.image.height);
    figure.measured = pairs.ratio;
    figure.kind = BoundKind::at_most;
    figure.bound = kMostOverBare;
    figure.problem = comparison.problem();
    figure.note = fmt::format("{:.4f} s by the seam, {:.4f} s bare: {}; fastest: {}", pairs.a.median, pairs.b.median,
                              calls_text(calls, comparison.record()),
                              calls_text(best_calls(comparison.replay(), 1), comparison.record()));
    figures.push_back(figure);
  }
  for (const int edge : {3, 10, 30}) figures.push_back(followed_together(edge, context));
  return figures;
}

}  // namespace raytree::benchmarks
