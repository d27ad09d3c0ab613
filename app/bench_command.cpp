// `raytree bench`: asks rays of a scene, of the standard set or of a file in every way that is worth comparing, side by
// side. Nothing is shaded.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/budget.h"
#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/prepared_scene.h"
#include "app/process.h"
#include "app/render_options.h"
#include "app/suggestion.h"
#include "benchmarks/bench_report.h"
#include "benchmarks/bench_standard.h"
#include "geometry/stopwatch.h"

namespace raytree::app {
namespace {

using benchmarks::BenchReport;
using benchmarks::BenchRow;

constexpr int kMostRepetitions = 10000;
constexpr const char* kStandardSet = "standard";

/// A scene that takes fewer seconds to prepare says little of the machine.
constexpr double kTelling = 0.2;

struct BenchOptions {
  SceneFlags scene;
  int threads = 0, repetitions = 9;
  double budget = 0;
  std::string filter, against = benchmarks::kBenchBaseline, before, rays, isa;
  std::vector<std::string> meshes;
  bool json = false, quiet = false, list = false;

  bool standard() const { return scene.scene == kStandardSet; }
};

std::optional<BenchOptions> parse_bench_options(const Words& words) {
  BenchOptions options;
  std::string threads, budget;
  CLI::App command(
      "Measure how fast rays are intersected: by kind of ray, by call, by what is built, beside Whitted's own tracer. "
      "Exit status 3 when a configuration's answers are others than it explains.",
      "raytree bench");
  command
      .add_option("SCENE", options.scene.scene,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt), built-in scene (raytree scenes), or "
                  "\"standard\": terrains, spheres, databases, an instanced forest, a Catmull-Clark surface")
      ->type_name("");
  command.add_flag("--json", options.json, "Print JSON");
  command.add_option("--filter", options.filter, "Measure rows whose names hold a match of a regular expression")
      ->type_name("REGEX");
  command.add_flag("--list", options.list, "Print the names of all rows and measure nothing");
  command.add_option("--against", options.against, "Configuration that ratios are taken to")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--baseline", options.before,
                  "Compare with a report that --json printed: what became faster or slower, beyond chance")
      ->type_name("FILE");
  command
      .add_option("--budget", budget, "Time for all, e.g. 60s or 5m; default: 32,768 rays of each kind, however long")
      ->type_name("TIME");
  command
      .add_option("--rays", options.rays,
                  "Ask a file's rays in place of the scene's: .npy, float32, N x 6 (origin, direction) or N x 8 (and "
                  "begin, end)")
      ->type_name("FILE");
  command.add_option("--mesh", options.meshes, "standard: measure a mesh file too; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--repetitions", options.repetitions, "Timed passes over the rays; default: 9")->type_name("N");
  add_scene_flags(command, options.scene, false);
  add_hierarchy_flags(command, options.scene);
  command
      .add_option("--isa", options.isa,
                  "Hold Embree to an instruction set: sse2, sse4.2, avx, avx2 or avx512; default: the processor's best")
      ->type_name("NAME");
  command.add_option("--threads", threads, "Threads; default: all")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  if (!options.standard()) check_scene_flags(options.scene);
  // Rays are asked again and again: what they cost is what counts, not the build.
  if (options.scene.hierarchy.empty() && options.scene.memory.empty()) options.scene.hierarchy = "balanced";
  options.threads = parse_threads(threads);
  const std::vector<std::string> isas(std::begin(kEmbreeIsas), std::end(kEmbreeIsas));
  if (!options.isa.empty() && std::find(isas.begin(), isas.end(), options.isa) == isas.end())
    throw usage_error(fmt::format("--isa: \"{}\" is none of: {}{}", options.isa, fmt::join(isas, ", "),
                                  did_you_mean(options.isa, isas)));
  if (!budget.empty()) options.budget = parse_budget(budget);
  benchmarks::NameFilter check(options.filter);
  if (options.repetitions < 1 || options.repetitions > kMostRepetitions)
    throw usage_error(fmt::format("--repetitions: {} is not within 1 and {}", options.repetitions, kMostRepetitions));
  if (options.standard() && !options.rays.empty())
    throw usage_error("--rays: a file's rays are of one scene; name it in place of \"standard\"");
  if (!options.standard() && !options.meshes.empty())
    throw usage_error("--mesh adds to the standard set; raytree bench FILE measures a mesh alone");
  return options;
}

class Bench {
 public:
  explicit Bench(const BenchOptions& options) : options_(options), start_(Clock::now()) {
    if (!options.rays.empty()) file_rays_ = benchmarks::read_rays(options.rays);
    report_.program = version(), report_.isa = options.isa;
    report_.threads = options.threads, report_.repetitions = options.repetitions, report_.seconds = options.budget;
  }

  /// Measures one scene within so many seconds; 0: any.
  int measure(const SceneRun& run, double seconds, const std::string& name) {
    const auto start = Clock::now();
    return with_prepared_scene(run, [&](Scene& scene, const Interruption& interruption) {
      preparing_ = seconds_since(start);
      if (!name.empty()) scene.description.name = name;
      const std::size_t batches = options_.list ? 1 : benchmarks::batches_for(seconds);
      const std::vector<benchmarks::BenchRays> rays = file_rays_.empty()
                                                          ? benchmarks::bench_rays(scene, batches, &interruption.stop())
                                                          : benchmarks::bench_rays(scene, file_rays_);
      if (interruption.stop()) return;
      if (options_.list) return list(benchmarks::bench_row_names(scene, rays, options_.threads, options_.isa));
      if (!name.empty() && seconds > 0 && seconds_since(start) > seconds) {
        report_.scenes_left_out.push_back(fmt::format("{}: {:.2g} s were there for it, and preparing it took {:.2g} s",
                                                      name, seconds, seconds_since(start)));
        return;
      }
      benchmarks::BenchRunOptions run_options;
      run_options.threads = options_.threads, run_options.repetitions = options_.repetitions;
      run_options.baseline = options_.against, run_options.isa = options_.isa;
      run_options.filter = benchmarks::NameFilter(options_.filter);
      run_options.stop = &interruption.stop();
      run_options.seam_watertight = options_.scene.edges != "fast";
      if (seconds > 0) run_options.seconds = std::max(0.1 * seconds, seconds - seconds_since(start));
      BenchReport report = benchmarks::run_bench(scene, rays, run_options);
      if (interruption.stop()) return;
      if (report.rows.empty() && report.left_out.empty())
        throw usage_error(fmt::format("--filter: \"{}\" matches no row; raytree bench {} --list shows them",
                                      options_.filter, options_.scene.scene));
      report_.scenes.push_back(std::move(report));
    });
  }

  int measure_standard() {
    const std::vector<benchmarks::StandardScene> scenes = benchmarks::standard_scenes(options_.meshes);
    double weights = 0;
    for (const auto& one : scenes) weights += one.weight;
    // How many times as long as foretold the last scene took to prepare: a slow machine, or a busy one.
    double slowness = 1;
    for (const auto& one : scenes) {
      const double left = options_.budget - seconds_since(start_), share = left * one.weight / weights;
      const double expected = one.expected_seconds * slowness;
      weights -= one.weight;
      if (options_.budget > 0 && expected > share) {
        report_.scenes_left_out.push_back(
            fmt::format("{}: it would take some {:.2g} s to build, and {:.2g} s were left", one.name, expected,
                        std::max(share, 0.0)));
        continue;
      }
      if (!options_.quiet) print_message("bench: " + one.name);
      SceneRun run{options_.scene, options_.threads, true, true};
      run.describe = one.make;
      const int status = measure(run, options_.budget > 0 ? share : 0, one.name);
      if (status != kSuccess) return status;
      if (options_.list) return status;
      if (one.expected_seconds >= kTelling) slowness = std::max(1.0, preparing_ / one.expected_seconds);
    }
    return kSuccess;
  }

  /// Prints what was measured.
  int finish() {
    if (options_.list) return kSuccess;
    if (!options_.before.empty()) compare_with(report_, options_.before);
    print_result(options_.json ? bench_json(report_) : bench_text(report_));
    bool suspicious = false;
    for (const BenchReport& scene : report_.scenes) {
      suspicious |= scene.suspicious();
      for (const BenchRow& row : scene.rows)
        if (!row.repeatable)
          throw Error(ErrorKind::failure, {}, row.name() + ": passes over the same rays gave different hits");
    }
    return suspicious ? kFallsShort : kSuccess;
  }

 private:
  void list(const std::vector<std::string>& names) const {
    const benchmarks::NameFilter filter(options_.filter);
    std::string text;
    for (const std::string& name : names)
      if (filter.takes(name)) text += name + "\n";
    print_result(text);
  }

  const BenchOptions& options_;
  const Clock::time_point start_;
  double preparing_ = 0;  ///< seconds that reading and building the last scene took
  std::vector<benchmarks::FileRay> file_rays_;
  benchmarks::BenchRunReport report_;
};

}  // namespace

int bench_command(const Words& words) {
  const std::optional<BenchOptions> options = parse_bench_options(words);
  if (!options) return kSuccess;
  Bench bench(*options);
  const int status = options->standard() ? bench.measure_standard()
                                         : bench.measure({options->scene, options->threads, true, options->quiet},
                                                         options->budget, std::string());
  return status != kSuccess ? status : bench.finish();
}

}  // namespace raytree::app
