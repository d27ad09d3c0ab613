// Row naive: what acceleration buys over Whitted's tracer of 1980, by the size of the scene, and where that tracer's
// time goes: he reports 75 percent in intersection for simple scenes and over 95 for complex ones (1980, sec. 4).
#include <fmt/format.h>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "renderer/builtin_scenes.h"
#include "renderer/render.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

using Search = SphereBoundedOptions::Search;

constexpr int kNaiveWidth = 160, kNaiveHeight = 120;
constexpr double kSimpleShare = 75, kComplexShare = 95;  // percent

struct NaiveScene {
  std::string text;
  SceneDescription description;
  bool linear = true;      ///< the search of one object after the other ends within a minute
  double least_share = 0;  ///< of intersection, in percent; 0: nothing is asked
};

SceneDescription small(SceneDescription scene) {
  scene.image = {kNaiveWidth, kNaiveHeight};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

std::vector<NaiveScene> naive_scenes() {
  std::vector<NaiveScene> scenes;
  scenes.push_back({"spheres-1980 (3 objects)", small(builtin_scene("spheres-1980"))});
  const int spheres[] = {1, 10, 91, 820, 7381};
  for (int level = 1; level <= 4; ++level) {
    SceneDescription flake = builtin_scene("sphere-flake");
    set_scene_value(flake, "shapes.flake.levels", std::to_string(level));
    scenes.push_back({fmt::format("sphere-flake of {} spheres", spheres[level]), small(std::move(flake)), true,
                      level >= 3 ? kComplexShare : kSimpleShare});
  }
  for (const int triangles : {10'000, 100'000, 1'000'000})
    scenes.push_back({fmt::format("terrain of {} triangles", triangles), small(terrain_scene(triangles)),
                      triangles <= 10'000, kComplexShare});
  return scenes;
}

Scene prepared_with(SceneDescription description, Tracer tracer, Search search) {
  PrepareOptions options;
  options.tracer = tracer;
  options.spheres.search = search;
  Warnings warnings;
  return prepare(std::move(description), options, warnings);
}

RenderStatistics traced(const Scene& scene) {
  RenderOptions options;
  options.threads = 1;
  return render(scene, options).statistics;
}

/// Of the rays that a picture's tree holds, a second of tracing.
std::string speed_text(const RenderStatistics& statistics) {
  double rays = 0;
  for (const std::uint64_t count : statistics.rays) rays += static_cast<double>(count);
  return fmt::format("{:.3g}", rays / statistics.thread_seconds);
}

}  // namespace

std::vector<Figure> measure_naive(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const NaiveScene& one : naive_scenes()) {
    context.progress("naive: " + one.text);
    const Scene fast = prepared_with(one.description, Tracer::embree, Search::automatic);
    for (const Search search : {Search::linear, Search::hierarchy}) {
      const bool linear = search == Search::linear;
      if (linear && !one.linear) continue;
      const Scene naive = prepared_with(one.description, Tracer::spheres, search);
      PairLimits limits;
      limits.least = 3, limits.most = 5;
      RenderStatistics fast_statistics, naive_statistics;
      std::vector<double> shares;
      const PairedSpread pairs = measure_pairs(
          [&] {
            naive_statistics = traced(naive);
            shares.push_back(100 * naive_statistics.intersection_seconds / naive_statistics.thread_seconds);
            return naive_statistics.thread_seconds;
          },
          [&] {
            fast_statistics = traced(fast);
            return fast_statistics.thread_seconds;
          },
          limits);
      Figure ratio;
      ratio.row = "naive";
      ratio.what = fmt::format("time of bounding spheres{} / Embree's, {}, {}x{}, 1 thread",
                               linear ? " tried one by one" : " in a hierarchy", one.text, kNaiveWidth, kNaiveHeight);
      ratio.measured = pairs.ratio;
      ratio.note =
          fmt::format("{} rays a second against {}", speed_text(naive_statistics), speed_text(fast_statistics));
      figures.push_back(ratio);
      if (!linear) continue;
      Figure share;
      share.row = "naive";
      share.what = fmt::format("share of intersection in the time of spheres tried one by one, {}", one.text);
      share.unit = "%";
      share.measured = spread_of(shares);
      share.kind = one.least_share > 0 ? BoundKind::at_least : BoundKind::none;
      share.bound = one.least_share;
      figures.push_back(share);
    }
  }
  return figures;
}

}  // namespace raytree::benchmarks
