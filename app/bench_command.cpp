// `raytree bench`: builds a scene's tracer and asks it rays of five kinds again and again. Nothing is shaded.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/prepared_scene.h"
#include "app/process.h"
#include "app/render_options.h"
#include "benchmarks/intersection_benchmark.h"
#include "geometry/embree_intersector.h"
#include "renderer/machine.h"

namespace raytree::app {
namespace {

using Json = nlohmann::ordered_json;
using benchmarks::IntersectionFigure;
using benchmarks::Spread;

constexpr int kMostRepetitions = 10000;

struct BenchOptions {
  SceneFlags scene;
  int threads = 0, repetitions = 9;
  bool json = false, quiet = false;
};

std::optional<BenchOptions> parse_bench_options(const Words& words) {
  BenchOptions options;
  std::string threads;
  CLI::App command("Measure how fast a scene's rays are intersected: batches against single rays.", "raytree bench");
  command
      .add_option("SCENE", options.scene.scene,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes)")
      ->type_name("");
  command.add_flag("--json", options.json, "Print JSON");
  command.add_option("--repetitions", options.repetitions, "Timed passes over each kind of ray; default: 9")
      ->type_name("N");
  add_scene_flags(command, options.scene, false);
  add_hierarchy_flags(command, options.scene);
  command.add_option("--threads", threads, "Threads; default: all")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  check_scene_flags(options.scene);
  // Rays are asked again and again: what they cost is what counts, not the build.
  if (options.scene.hierarchy.empty() && options.scene.memory.empty()) options.scene.hierarchy = "balanced";
  options.threads = parse_threads(threads);
  if (options.repetitions < 1 || options.repetitions > kMostRepetitions)
    throw usage_error(fmt::format("--repetitions: {} is not within 1 and {}", options.repetitions, kMostRepetitions));
  return options;
}

struct Report {
  std::string scene;
  int width = 0, height = 0, threads = 0;
  std::uint64_t triangles = 0, spheres = 0, tracer_bytes = 0;
  double build_seconds = 0;
  std::vector<IntersectionFigure> figures;

  std::uint64_t primitives() const { return triangles + spheres; }
  double bytes_per_primitive() const {
    return primitives() > 0 ? static_cast<double>(tracer_bytes) / static_cast<double>(primitives()) : 0;
  }
};

Json json_of(const Spread& spread) {
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}, {"count", spread.count}};
}

std::string report_json(const Report& report) {
  const Machine here = machine();
  Json json;
  json["raytree"] = version();
  json["tracer"] = EmbreeIntersector::version();
  json["machine"] = {{"processor", here.processor}, {"compiler", here.compiler}, {"build_type", here.build_type}};
  json["scene"] = report.scene;
  json["image"] = {{"width", report.width}, {"height", report.height}};
  json["threads"] = report.threads;
  json["build"] = {{"seconds", report.build_seconds},
                   {"triangles", report.triangles},
                   {"spheres", report.spheres},
                   {"bytes", report.tracer_bytes},
                   {"bytes_per_primitive", report.bytes_per_primitive()}};
  json["rays"] = Json::array();
  for (const IntersectionFigure& figure : report.figures)
    json["rays"].push_back({{"kind", benchmarks::name_of(figure.kind)},
                            {"rays", figure.rays},
                            {"hits", figure.hits},
                            {"checksum", fmt::format("{:016x}", figure.checksum)},
                            {"repeatable", figure.repeatable},
                            {"millions_per_second", json_of(figure.millions_per_second)},
                            {"over_single_rays", json_of(figure.single_ratio)}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_text(const Report& report) {
  const Machine here = machine();
  std::string text = fmt::format("scene    {}, {} x {} eye rays\n", report.scene, report.width, report.height);
  text += fmt::format("tracer   {}, {} thread{}, {}\n", EmbreeIntersector::version(), report.threads,
                      report.threads == 1 ? "" : "s", here.processor);
  text += fmt::format("build    {:.3f} s, {} triangles, {} spheres, {:.1f} bytes each\n", report.build_seconds,
                      grouped(report.triangles), grouped(report.spheres), report.bytes_per_primitive());
  text += fmt::format("{:<10} {:>12} {:>12} {:>9} {:>17} {:>14}  {}\n", "rays", "traced", "hit", "Mrays/s", "quartiles",
                      "/ single rays", "checksum");
  for (const IntersectionFigure& figure : report.figures) {
    const Spread& speed = figure.millions_per_second;
    text += fmt::format("{:<10} {:>12} {:>12} {:>9.2f} {:>17} {:>14.2f}  {:016x}{}\n", benchmarks::name_of(figure.kind),
                        grouped(figure.rays), grouped(figure.hits), speed.median,
                        fmt::format("{:.2f}-{:.2f}", speed.low, speed.high), figure.single_ratio.median,
                        figure.checksum, figure.repeatable ? "" : " NOT THE SAME EACH TIME");
  }
  return text;
}

Report measured(const BenchOptions& options, const Scene& scene, const Interruption& interruption) {
  Report report;
  report.scene = scene.description.name;
  report.width = scene.description.image.width, report.height = scene.description.image.height;
  report.threads = options.threads;
  for (const ShapeSummary& shape : scene.summary.shapes)
    report.triangles += shape.triangles, report.spheres += shape.spheres;
  report.tracer_bytes = scene.intersector->memory_bytes();
  report.build_seconds = scene.seconds.build;
  const auto rays = benchmarks::benchmark_rays(scene, &interruption.stop());
  report.figures =
      benchmarks::measure_intersection(scene, rays, options.threads, options.repetitions, &interruption.stop());
  return report;
}

}  // namespace

int bench_command(const Words& words) {
  const std::optional<BenchOptions> options = parse_bench_options(words);
  if (!options) return kSuccess;
  return with_prepared_scene({options->scene, options->threads, true, options->quiet},
                             [&](const Scene& scene, const Interruption& interruption) {
                               const Report report = measured(*options, scene, interruption);
                               if (interruption.stop()) return;
                               print_result(options->json ? report_json(report) : report_text(report));
                               for (const IntersectionFigure& figure : report.figures)
                                 if (!figure.repeatable)
                                   throw Error(ErrorKind::failure, {}, "passes over the same rays gave different hits");
                             });
}

}  // namespace raytree::app
