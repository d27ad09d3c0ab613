// Row naive: what acceleration buys over Whitted's tracer of 1980, by the number of objects, and where that tracer's
// time goes: he reports 75 percent in intersection for simple scenes and over 95 for complex ones (1980, sec. 4).
#include "benchmarks/naive.h"

#include <fmt/format.h>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "geometry/sphere_bounded_intersector.h"
#include "renderer/builtin_scenes.h"
#include "renderer/render.h"
#include "renderer/scene_reader.h"
#include "renderer/spd_counts.h"
#include "renderer/spd_scenes.h"

namespace raytree::benchmarks {
namespace {

using Search = SphereBoundedOptions::Search;

constexpr int kNaiveWidth = 160, kNaiveHeight = 120;
/// Whitted's pictures (1980, sec. 4).
constexpr int kPaperWidth = 640, kPaperHeight = 480;
/// Trying so many objects one by one ends within a minute.
constexpr int kMostLinearSpheres = 7381, kMostLinearTriangles = 10'000;

struct NaiveScene {
  std::string text;
  SceneDescription description;
  std::string series;      ///< of a chart's line
  bool linear = true;      ///< tried one by one, too
  bool hierarchy = true;   ///< in a hierarchy, too
  double least_share = 0;  ///< of intersection, in percent; 0: nothing is asked
};

SceneDescription small(SceneDescription scene) {
  scene.image = {kNaiveWidth, kNaiveHeight};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

/// As the paper has it: 480 lines of 640 pixels, between four samples each, divided where they differ.
SceneDescription as_in_paper(SceneDescription scene) {
  scene.image = {kPaperWidth, kPaperHeight};
  return scene;
}

SceneDescription without_bumps(SceneDescription scene) {
  for (MaterialDescription& material : scene.materials) material.bump.reset();
  return scene;
}

/// One scene of spheres and one of triangles at many sizes; the pictures of the paper; Haines's databases.
std::vector<NaiveScene> naive_scenes() {
  std::vector<NaiveScene> scenes;
  scenes.push_back({"spheres-1980", small(builtin_scene("spheres-1980")), ""});
  for (const char* name : {"whitted-fig6", "whitted-fig7"})
    scenes.push_back(
        {fmt::format("{} as the paper has it", name), as_in_paper(builtin_scene(name)), kWhittedFigures, true, false});
  scenes.push_back({"whitted-fig6 without its wrinkles", without_bumps(as_in_paper(builtin_scene("whitted-fig6"))), "",
                    true, false});
  int spheres = 1;
  for (int level = 1; level <= 6; ++level) {
    SceneDescription flake = builtin_scene("sphere-flake");
    set_scene_value(flake, "shapes.flake.levels", std::to_string(level));
    spheres = 9 * spheres + 1;
    scenes.push_back({fmt::format("sphere-flake of {} spheres", spheres), small(std::move(flake)), "spheres",
                      spheres <= kMostLinearSpheres, true,
                      spheres >= 820  ? kComplexShare
                      : spheres >= 10 ? kSimpleShare
                                      : 0});
  }
  for (const int triangles : {100, 1000, 10'000, 100'000, 1'000'000})
    scenes.push_back({fmt::format("terrain of {} triangles", triangles), small(terrain_scene(triangles)), "triangles",
                      triangles <= kMostLinearTriangles, true, triangles >= 1000 ? kComplexShare : kSimpleShare});
  for (const SpdEntry& entry : spd_databases()) {
    SceneDescription description = spd_scene(entry.database, entry.standard_size);
    set_standard_spd_render(description);
    scenes.push_back({fmt::format("{}{}, standard render", kSpdPrefix, entry.name), small(std::move(description)),
                      kDatabases, true, false, kComplexShare});
  }
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

/// Of the rays that a picture's tree holds.
double ray_count(const RenderStatistics& statistics) {
  double rays = 0;
  for (const std::uint64_t count : statistics.rays) rays += static_cast<double>(count);
  return rays;
}

/// Time per ray in the three parts that Whitted reports.
std::string split_text(const RenderStatistics& statistics) {
  const double nanoseconds = 1e9 / ray_count(statistics);
  return fmt::format("{:.0f} ns a ray in intersection, {:.0f} in shading, {:.0f} in overhead",
                     nanoseconds * statistics.intersection_seconds, nanoseconds * statistics.shading_seconds,
                     nanoseconds * statistics.overhead_seconds());
}

/// One scene searched in one way, beside Embree.
class NaiveComparison {
 public:
  NaiveComparison(const NaiveScene& scene, Search search, const Scene& fast)
      : scene_(scene), linear_(search == Search::linear), fast_(fast) {
    const Scene naive = prepared_with(scene.description, Tracer::spheres, search);
    objects_ = static_cast<double>(dynamic_cast<const SphereBoundedIntersector&>(*naive.intersector).object_count() +
                                   naive.shapes->planes.size());
    PairLimits limits;
    limits.least = 3, limits.most = 5;
    ratio_ = measure_pairs(
                 [&] {
                   naive_statistics_ = traced(naive);
                   shares_.push_back(100 * naive_statistics_.intersection_seconds / naive_statistics_.thread_seconds);
                   return naive_statistics_.thread_seconds;
                 },
                 [&] {
                   fast_statistics_ = traced(fast_);
                   return fast_statistics_.thread_seconds;
                 },
                 limits)
                 .ratio;
    shares_.erase(shares_.begin());  // the run that does not count
  }

  Figure ratio() const {
    Figure figure;
    figure.row = "naive";
    const ImageDescription& image = scene_.description.image;
    figure.what = fmt::format("time of bounding spheres{} / Embree's, {} ({:.0f} objects), {}x{}, 1 thread",
                              linear_ ? " tried one by one" : " in a hierarchy", scene_.text, objects_, image.width,
                              image.height);
    figure.measured = ratio_;
    figure.note = fmt::format("{:.3g} rays a second against {:.3g}", speed(naive_statistics_), speed(fast_statistics_));
    figure.place = {kRatioPlot, line(), objects_};
    return figure;
  }

  Figure share() const {
    Figure figure;
    figure.row = "naive";
    figure.what =
        fmt::format("share of intersection in the time of bounding spheres tried one by one, {} ({:.0f} objects)",
                    scene_.text, objects_);
    figure.unit = "%";
    figure.measured = spread_of(shares_);
    figure.kind = scene_.least_share > 0 ? BoundKind::at_least : BoundKind::none;
    figure.bound = scene_.least_share;
    figure.note = split_text(naive_statistics_);
    figure.place = {kSharePlot, line(), objects_};
    return figure;
  }

 private:
  std::string line() const {
    if (scene_.series.empty() || !scene_.hierarchy) return scene_.series;
    return scene_.series + (linear_ ? ", one by one" : ", in a hierarchy");
  }
  static double speed(const RenderStatistics& statistics) { return ray_count(statistics) / statistics.thread_seconds; }

  const NaiveScene& scene_;
  bool linear_;
  const Scene& fast_;
  double objects_ = 0;
  Spread ratio_;
  std::vector<double> shares_;
  RenderStatistics naive_statistics_, fast_statistics_;
};

}  // namespace

std::vector<Figure> measure_naive(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const NaiveScene& scene : naive_scenes()) {
    context.progress("naive: " + scene.text);
    const Scene fast = prepared_with(scene.description, Tracer::embree, Search::automatic);
    if (scene.linear) {
      const NaiveComparison one_by_one(scene, Search::linear, fast);
      figures.push_back(one_by_one.ratio());
      figures.push_back(one_by_one.share());
    }
    if (scene.hierarchy) figures.push_back(NaiveComparison(scene, Search::hierarchy, fast).ratio());
  }
  return figures;
}

}  // namespace raytree::benchmarks
