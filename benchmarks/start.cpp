// Row start: from launch to the first ray, and from launch to a written PNG, of a scene that is next to nothing.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmarks/child_process.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "geometry/error.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

constexpr int kLaunches = 21;

nlohmann::json statistics_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

/// Seconds from the child's launch to its first ray, by the steady clock, which all processes share.
double first_ray_seconds(const ChildResult& child, const nlohmann::json& statistics) {
  return statistics.at("clock").at("first_ray").get<double>() - child.start_clock;
}

Figure first_ray_figure(const MeasureContext& context, const std::string& scene) {
  const std::filesystem::path statistics = context.scratch / "start.json", picture = context.scratch / "start.exr";
  std::vector<double> samples;
  for (int launch = 0; launch <= kLaunches; ++launch) {
    const ChildResult child = run_child({context.programs / "raytree", "render", scene, "-o", picture, "--stats",
                                         statistics, "--quiet", "--progress", "none"},
                                        context.scratch);
    require_success(child, "raytree render");
    if (launch > 0) samples.push_back(1000 * first_ray_seconds(child, statistics_of(statistics)));
  }
  Figure figure;
  figure.row = "start";
  figure.what = "launch to the first ray, one sphere, 64x64";
  figure.unit = "ms";
  figure.measured = spread_of(samples);
  figure.kind = BoundKind::at_most;
  figure.bound = 1000 * kMostFirstRaySeconds;
  return figure;
}

Figure file_figure(const MeasureContext& context, const std::string& scene) {
  const auto render_to_file = [&] {
    const ChildResult child = run_child({context.programs / "raytree", "render", scene, "-o",
                                         context.scratch / "start.png", "--quiet", "--progress", "none"},
                                        context.scratch);
    require_success(child, "raytree render");
    return child.wall_seconds;
  };
  const auto load_only = [&] {
    const ChildResult child = run_child({context.programs / "oiio_load_probe"}, context.scratch);
    require_success(child, "oiio_load_probe");
    return child.wall_seconds;
  };
  PairLimits limits;
  limits.least = 11;
  const PairedSpread pairs = measure_pairs(render_to_file, load_only, limits);
  Figure figure;
  figure.row = "start";
  figure.what = "launch to a written PNG / loading OpenImageIO alone, one sphere, 64x64";
  figure.measured = pairs.ratio;
  figure.kind = BoundKind::at_most;
  figure.bound = kMostFileRatio;
  figure.note = fmt::format("{:.3f} s to the file, {:.3f} s to load OpenImageIO", pairs.a.median, pairs.b.median);
  return figure;
}

}  // namespace

std::vector<Figure> measure_start(const MeasureContext& context) {
  const std::filesystem::path scene = context.scratch / "trivial.json";
  std::ofstream(scene) << write_scene(trivial_scene());
  context.progress("start: launch to the first ray");
  std::vector<Figure> figures = {first_ray_figure(context, scene)};
  context.progress("start: launch to a written file");
  figures.push_back(file_figure(context, scene));
  return figures;
}

}  // namespace raytree::benchmarks
