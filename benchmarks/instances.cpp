// Row instances: ten thousand uses of a mesh of a million triangles: their memory, and what the seam adds to the Embree
// calls that trace them.
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmarks/child_process.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "benchmarks/seam_comparison.h"
#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

constexpr double kMostGibibytes = 0.3, kMostOverBare = 1.1;
constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;

/// A figure of /proc/self/status, bytes.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  throw Error(ErrorKind::failure, {"/proc/self/status", 0, ""}, "no " + key);
}

}  // namespace

std::string instances_memory_json() {
  SceneDescription description = instances_scene();
  const double before = status_bytes("VmRSS");
  const Scene scene = prepared(std::move(description));
  return nlohmann::json{
      {"before", before},
      {"resident", status_bytes("VmRSS")},
      {"peak", status_bytes("VmHWM")},
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
  size.bound = kMostGibibytes;
  size.note = fmt::format("{:.3f} GiB once prepared; arrays {:.3f} GiB, Embree's own {:.3f} GiB; {:.2e} triangles seen",
                          (of("resident") - of("before")) / kGibibyte, of("arrays") / kGibibyte,
                          of("embree") / kGibibyte, of("instanced_triangles"));
  std::vector<Figure> figures{size};

  const Scene scene = prepared(instances_scene());
  const std::array<RaySet, kBenchmarkRaysCount> sets = benchmark_rays(scene);
  for (const BenchmarkRays kind : {BenchmarkRays::primary, BenchmarkRays::shadow, BenchmarkRays::bounce}) {
    context.progress(fmt::format("instances: {} rays", name_of(kind)));
    const RaySet& rays = sets[static_cast<std::size_t>(kind)];
    const ReplayCalls calls = calls_of(embree_of(scene));
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
  return figures;
}

}  // namespace raytree::benchmarks
