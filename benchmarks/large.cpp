// Row large: a terrain of ten million triangles from launch to an EXR, over what generating it, Embree's own build and
// the bare calls for its rays take; and its memory over what its arrays and Embree need.
#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmarks/bare_trace.h"
#include "benchmarks/child_process.h"
#include "benchmarks/recording_intersector.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "geometry/error.h"
#include "geometry/stopwatch.h"
#include "geometry/terrain.h"
#include "renderer/tracer_choice.h"

namespace raytree::benchmarks {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;
constexpr double kRoomForTheRest = 160 * kMebibyte;  ///< libraries and what is not the scene
constexpr int kThreads = 2;
constexpr std::int64_t kTriangles = 10'000'000;

}  // namespace

std::string bare_large_json(const std::string& hierarchy) {
  SceneDescription description = terrain_scene(kTriangles);
  const auto start = Clock::now();
  for (const ShapeDescription& shape : description.shapes)
    if (const auto* terrain = std::get_if<TerrainShape>(&shape.kind))
      make_terrain({terrain->triangles, terrain->size, terrain->height, terrain->roughness, terrain->seed});
  const double generate = seconds_since(start);

  PrepareOptions options;
  options.build = false;
  Warnings warnings;
  Scene scene = prepare(std::move(description), options, warnings);
  EmbreeOptions embree_options;
  embree_options.threads = kThreads;
  embree_options.primitives = hierarchy_named(hierarchy).chosen->primitives;
  const auto build_start = Clock::now();
  auto embree = std::make_unique<EmbreeIntersector>(*scene.shapes, embree_options);
  const double build = seconds_since(build_start);
  const std::size_t embree_peak = embree->peak_memory_bytes();
  scene.intersector = std::move(embree);

  const RecordedRender recorded = record_render(scene);
  const BareReplay replay(embree_of(scene), recorded.record);
  const ReplayCalls calls = best_calls(replay, kThreads);
  const ReplayTally tally = replay_pass(replay, calls, kThreads);
  const double trace = tally.total_seconds() / kThreads;
  return nlohmann::json{{"generate_seconds", generate},
                        {"build_seconds", build},
                        {"trace_seconds", trace},
                        {"array_bytes", scene.summary.array_bytes},
                        {"embree_peak_bytes", embree_peak},
                        {"triangles", scene.summary.shapes.empty() ? 0 : scene.summary.shapes.front().triangles},
                        {"calls", calls_text(calls, recorded.record)},
                        {"problem", hit_mismatch(tally, recorded.record)}}
      .dump();
}

std::vector<Figure> measure_large(const MeasureContext& context) {
  context.progress("large: this takes a minute or two");
  const SceneDescription scene = terrain_scene(kTriangles);
  const std::filesystem::path picture = context.scratch / "large.exr", statistics = context.scratch / "large.json";
  const std::string self = context.programs / "raytree_measure";

  const auto rendered = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {context.programs / "raytree",
                                      "render",
                                      kTerrainSceneName,
                                      "--set",
                                      fmt::format("{}={}", kTerrainCountPath, kTriangles),
                                      "--size",
                                      fmt::format("{}x{}", scene.image.width, scene.image.height),
                                      "--threads",
                                      std::to_string(kThreads),
                                      "-o",
                                      picture,
                                      "--stats",
                                      statistics,
                                      "--quiet",
                                      "--progress",
                                      "none"};
    words.insert(words.end(), more.begin(), more.end());
    const ChildResult child = run_child_apart(self, words, context.scratch);
    require_success(child, "raytree render");
    return child;
  };
  const auto bare_steps = [&](const char* hierarchy, nlohmann::json& bare) {
    const ChildResult child = run_child({self, kBareLargeFlag, hierarchy}, context.scratch);
    require_success(child, "raytree_measure --bare-large");
    bare = nlohmann::json::parse(child.output);
    return bare.at("generate_seconds").get<double>() + bare.at("build_seconds").get<double>() +
           bare.at("trace_seconds").get<double>();
  };
  PairLimits limits;
  limits.most = 11;
  const auto time_figure = [&](const std::vector<std::string>& flags, const char* hierarchy, const std::string& kinds,
                               std::vector<double>& peaks, nlohmann::json& bare) {
    const PairedSpread pairs = measure_pairs(
        [&] {
          const ChildResult child = rendered(flags);
          peaks.push_back(static_cast<double>(child.peak_bytes));
          return child.wall_seconds;
        },
        [&] { return bare_steps(hierarchy, bare); }, limits);
    Figure time;
    time.row = "large";
    time.what = fmt::format(
        "launch to EXR / (generate + Embree's build + bare trace), terrain of {} triangles, {}x{}, 2 threads; {}",
        bare.at("triangles").get<std::uint64_t>(), scene.image.width, scene.image.height, kinds);
    time.measured = pairs.ratio;
    time.problem = bare.at("problem").get<std::string>();
    time.note =
        fmt::format("{:.2f} s to the file; {:.2f} s generate, {:.2f} s build, {:.2f} s trace; {}", pairs.a.median,
                    bare.at("generate_seconds").get<double>(), bare.at("build_seconds").get<double>(),
                    bare.at("trace_seconds").get<double>(), bare.at("calls").get<std::string>());
    return time;
  };
  const auto bounded = [](Figure figure, double bound) {
    figure.kind = BoundKind::at_most;
    figure.bound = bound;
    return figure;
  };

  // The product as it is, against Embree as it is: triangles and its usual build.
  std::vector<double> peaks, other_peaks;
  nlohmann::json bare, other;
  const Figure time = bounded(
      time_figure({}, "balanced", "the renderer's kind, grids / Embree's of triangles", peaks, bare), kMostLargeTime);
  // What the renderer adds to the same build, whatever it builds.
  const Figure of_quads =
      bounded(time_figure({"--hierarchy", "quads"}, "quads", "both as quads", other_peaks, other), kMostLargeTime);
  nlohmann::json grids;
  const Figure of_grids = time_figure({"--hierarchy", "grids"}, "grids", "both as grids", other_peaks, grids);

  std::ifstream file(statistics);
  const double film = nlohmann::json::parse(file).at("memory_bytes").at("film").get<double>();
  const double arrays = bare.at("array_bytes").get<double>(), embree = grids.at("embree_peak_bytes").get<double>();
  Figure memory;
  memory.row = "large";
  memory.what = "the renderer's kind: peak memory, less film and 160 MiB, / (arrays + Embree's own peak over grids)";
  for (double& peak : peaks) peak = (peak - film - kRoomForTheRest) / (arrays + embree);
  memory.measured = spread_of(peaks);
  memory.kind = BoundKind::at_most;
  memory.bound = kMostLargeMemory;
  memory.note = fmt::format("{:.0f} MiB peak; {:.0f} MiB arrays, {:.0f} MiB Embree, {:.0f} MiB film",
                            (memory.measured.median * (arrays + embree) + film + kRoomForTheRest) / kMebibyte,
                            arrays / kMebibyte, embree / kMebibyte, film / kMebibyte);
  return {time, of_quads, of_grids, memory};
}

}  // namespace raytree::benchmarks
