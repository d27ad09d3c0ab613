// Rows 24 to 26: trees that are cut too early, that grow too deep, that grow too wide.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/ray_tree_parts.h"
#include "geometry/embree_intersector.h"
#include "geometry/surface.h"
#include "renderer/optics.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

/// Two facing mirrors of reflectance k, each adding the radiance e, seen by one pixel: after D bounces
/// e (1 + k + ... + k^D), in the limit e / (1 - k).
SceneDescription facing_mirrors(double k, double e, int depth, double cutoff) {
  SceneDescription scene = dark_scene(1, front_camera(1, 0.5));
  scene.ambient = Rgb(1);
  scene.materials = {material("mirror", Rgb(static_cast<float>(e)))};
  scene.materials[0].reflection = Rgb(static_cast<float>(k));
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "mirror"),
                  shape(PlaneShape{{0, 0, 1}, {0, 0, -1}}, "mirror")};
  scene.render.depth = depth;
  scene.render.cutoff = cutoff;
  return scene;
}

double seen(const StabilityRun& run, const SceneDescription& scene) {
  return color_at(rendered_for(run, scene).film, 0, 0).g;
}

/// Of a sum of `terms` terms of the series: each is off by its power's roundings, and the sum by its own.
double series_rounding(double k, double terms) { return (terms + 2) * 0x1p-24 / (1 - k); }

/// A room between two mirrors, to look at.
SceneDescription mirror_room(int depth, double cutoff) {
  CameraDescription camera;
  camera.position = {-0.93, 0.1, 0.75};
  camera.target = {1, -0.2, 0.3};
  camera.field_of_view = 50;
  SceneDescription scene = dark_scene(160, camera);
  scene.image = {240, 160};
  CheckerPattern checker;
  checker.size = 0.25;
  scene.ambient = Rgb(0.3f);
  scene.background = GradientBackground{};
  scene.materials = {material("floor", checker), material("mirror", Rgb(0.01f)),
                     material("ball", Rgb(0.8f, 0.25f, 0.1f))};
  scene.materials[1].reflection = Rgb(0.9f, 0.93f, 0.92f);
  scene.lights = {point_light({0.2, 2, 1})};
  scene.shapes = {
      shape(PlaneShape{{0, -0.6, 0}, {0, 1, 0}}, "floor"), shape(PlaneShape{{1, 0, 0}, {-1, 0, 0}}, "mirror"),
      shape(PlaneShape{{-1, 0, 0}, {1, 0, 0}}, "mirror"), shape(SphereShape{{0.35, -0.25, 0}, 0.35}, "ball")};
  scene.render.depth = depth;
  scene.render.cutoff = cutoff;
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  return scene;
}

constexpr double kDefaultCutoff = 1.0 / 1020;

StabilityResult tree_truncation(const StabilityRun& run) {
  StabilityResult result;
  // Depth alone: what level D leaves out is k^D / (1 - k).
  constexpr double kHigh = 0.8;
  constexpr int kDepth = 8;
  const double k = static_cast<double>(static_cast<float>(kHigh)), missing = std::pow(k, kDepth) / (1 - k);
  result.figures.push_back(known_failure("depth 8 alone", "light lost between mirrors of .8, of 5",
                                         1 / (1 - k) - seen(run, facing_mirrors(kHigh, 1, kDepth, 0)),
                                         missing - series_rounding(k, kDepth), missing + series_rounding(k, kDepth),
                                         "k^D / (1 - k) = .84, not \"not noticeable\" (Whitted 1980, p. 345)"));
  struct Needed {
    double k;
    int bounces;
  };
  for (const Needed& needed : {Needed{0.5, 9}, {0.8, 35}, {0.9, 81}, {0.95, 179}}) {
    const double share = static_cast<double>(static_cast<float>(needed.k)), exact = 1 / (1 - share);
    // The first depth that suffices, by halving: the remainder falls with depth.
    int few = 0, enough = 1024;
    while (enough - few > 1) {
      const int middle = (few + enough) / 2;
      (exact - seen(run, facing_mirrors(needed.k, 1, middle + 1, 0)) < 1.0 / 510 ? enough : few) = middle;
    }
    // What the sum's rounding is worth in bounces: one more takes 1 - k of the remainder.
    const double slack = series_rounding(share, needed.bounces) / ((1 - share) / 510);
    char quantity[80];
    std::snprintf(quantity, sizeof quantity, "bounces until mirrors of %g lose less than 1/510", needed.k);
    result.figures.push_back(known_failure("depth alone", quantity, enough, needed.bounces - slack,
                                           needed.bounces + slack, "9, 35, 81, 179 from k^(D+1) / (1 - k) < 1/510"));
  }
  // The cutoff: deep trees, and a bound on what was taken.
  double worst = 0, least_spare = 1;
  for (const double reflectance : {0.5, 0.8, 0.9, 0.95}) {
    const double share = static_cast<double>(static_cast<float>(reflectance));
    const RenderResult rendered = rendered_for(run, facing_mirrors(reflectance, 1, 1000, kDefaultCutoff),
                                               {ChannelGroup::color, ChannelGroup::truncation});
    const double lost = 1 / (1 - share) - color_at(rendered.film, 0, 0).g - series_rounding(share, 200);
    worst = std::max(worst, lost);
    least_spare = std::min(least_spare, color_at(rendered.film, 0, 0, ChannelGroup::truncation).g - lost);
  }
  result.figures.push_back(held("cutoff 1/1020", "light lost between mirrors of .5 to .95", worst, 0, kDefaultCutoff,
                                "at most the cutoff, by construction (Hall and Greenberg 1983 cut by weight)"));
  result.figures.push_back(held("cutoff 1/1020", "bound in the channel `truncation` less what was lost", least_spare, 0,
                                kDefaultCutoff, "not negative: it is a bound"));
  add_picture(run, result, "Depth 4: the far mirrors are black", mirror_room(4, 0));
  add_picture(run, result, "Cutoff 1/1020: as deep as light is left", mirror_room(1000, kDefaultCutoff));
  return result;
}

/// Passes queries on and notes how far the stack had grown.
class StackProbe final : public RayIntersector {
 public:
  explicit StackProbe(std::unique_ptr<const RayIntersector> tracer) : tracer_(std::move(tracer)) {}

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override {
    note();
    tracer_->intersect(rays, coherence, hits);
  }
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override {
    note();
    tracer_->occluded(rays, coherence, occluded);
  }
  std::size_t memory_bytes() const noexcept override { return tracer_->memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_->peak_memory_bytes(); }

  /// Between the shallowest and the deepest query; of one thread.
  std::uintptr_t bytes() const { return highest_ - lowest_; }

 private:
  [[gnu::noinline]] void note() const noexcept {
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    lowest_ = std::min(lowest_, here), highest_ = std::max(highest_, here);
  }

  std::unique_ptr<const RayIntersector> tracer_;
  mutable std::uintptr_t lowest_ = UINTPTR_MAX, highest_ = 0;
};

struct DeepTree {
  double levels = 0, stack_bytes = 0;
  double light = 0;
};

/// Mirrors that lose nothing, a ray that goes between them as often as the depth allows.
DeepTree deep_tree(const StabilityRun& run, int depth) {
  Scene scene = prepared_for(run, facing_mirrors(1, 1e-3, depth, 0));
  auto probe = std::make_unique<StackProbe>(std::move(scene.intersector));
  const StackProbe& stack = *probe;
  scene.intersector = std::move(probe);
  RenderOptions options;
  options.threads = 1;
  options.stop = run.stop;
  const RenderResult rendered = render(scene, options);
  return {double(rendered.statistics.deepest_level), double(stack.bytes()), color_at(rendered.film, 0, 0).g};
}

/// The same tree as textbooks have it: a function that calls itself for the mirrored ray.
class RecursiveLight {
 public:
  RecursiveLight(const StabilityRun& run, const Scene& scene)
      : shapes_(*scene.shapes), tracer_(shapes_, run.tracer_options()), emitted_(1e-3f) {}

  /// Bytes of the thread's stack between the first call and the last of `levels`.
  double stack_bytes(int levels) {
    lowest_ = UINTPTR_MAX, highest_ = 0;
    static_cast<void>(gathered({0, 0, 0.5f}, {0, 0, -1}, levels));
    return double(highest_ - lowest_);
  }

 private:
  // NOLINTNEXTLINE(misc-no-recursion): it is what is measured.
  [[gnu::noinline]] float gathered(const Vec3f& origin, const Vec3f& direction, int levels) {
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    lowest_ = std::min(lowest_, here), highest_ = std::max(highest_, here);
    const Hit hit = tracer_.intersect_one(origin, direction, std::numeric_limits<float>::infinity());
    if (levels == 1 || hit.geometry == kNoGeometry) return 0;
    const SurfacePoint point = surface_at(shapes_, origin, direction, hit, false);
    const Vec3f normal = point.geometric_normal;
    return emitted_ + gathered(offset_origin(point, normal), reflected_direction(direction, normal), levels - 1);
  }

  const ShapeSet& shapes_;
  const EmbreeIntersector tracer_;
  const float emitted_;
  std::uintptr_t lowest_ = UINTPTR_MAX, highest_ = 0;
};

constexpr double kUsualStack = 8 << 20;  ///< bytes of a thread's stack where nobody asks for another
/// What a call keeps at least: the mirrored ray, which is passed by reference, and where to return to.
constexpr double kLeastFrame = 2 * sizeof(Vec3f) + sizeof(void*);
/// And at most, sanitizers' frames too.
constexpr double kLargestFrame = 8192;

StabilityResult deep_recursion(const StabilityRun& run) {
  const int depth = scaled(run, 100'000, 5'000);
  const DeepTree deepest = deep_tree(run, depth);
  StabilityResult result;
  constexpr int kRecursiveLevels = 500;
  const Scene mirrors = prepared_for(run, facing_mirrors(1, 1e-3, kRecursiveLevels, 0));
  RecursiveLight recursive(run, mirrors);
  const double frame = recursive.stack_bytes(kRecursiveLevels) / (kRecursiveLevels - 1);
  result.figures.push_back(known_failure("recursion", "levels that a thread's usual stack of 8 MB holds",
                                         std::floor(kUsualStack / frame), std::floor(kUsualStack / kLargestFrame),
                                         std::ceil(kUsualStack / kLeastFrame),
                                         "8 MB over the bytes of a call: it overflows (MoonRay issue 62)"));
  result.figures.push_back(
      held("stack of rays", "levels reached / levels asked for", deepest.levels / depth, 1, 1, "1"));
  result.figures.push_back(held("stack of rays", "bytes of the thread's stack that a level takes",
                                deepest.stack_bytes / depth, 0, 1,
                                "0: there is no recursion; others overflow or abort (MoonRay issue 62)"));
  // Terms of one size: each addition rounds by half an ulp of the sum, and they add up at worst.
  const double exact = depth * double(1e-3f), rounding = 0x1p-24 * depth;
  result.figures.push_back(
      held("stack of rays", "light gathered / its sum", deepest.light / exact, 1 - rounding, 1 + rounding, "1"));
  if (run.pictures) {
    StabilityGraph graph{"The thread's stack under a deep tree",
                         "levels",
                         "bytes",
                         {{"recursion", {}},
                          {"recursion, carried on", {}, true},
                          {"generations: 0 (drawn at 8)", {}},
                          {"a thread's stack, 8 MB", {}, true}}};
    for (int levels = 10; levels <= depth; levels *= 10) {
      if (levels <= kRecursiveLevels) graph.lines[0].points.emplace_back(levels, recursive.stack_bytes(levels));
      graph.lines[1].points.emplace_back(levels, frame * (levels - 1));
      // At least the word that would tell: a logarithmic axis has no 0.
      graph.lines[2].points.emplace_back(levels, std::max(8.0, deep_tree(run, levels).stack_bytes));
      graph.lines[3].points.emplace_back(levels, kUsualStack);
    }
    result.graphs.push_back(std::move(graph));
  }
  return result;
}

/// Parallel panes, each of which splits a ray in two that meet further panes: the full binary tree.
SceneDescription many_panes(int depth, double cutoff) {
  SceneDescription scene = dark_scene(1, front_camera(1, 0.5));
  scene.ambient = Rgb(1);
  scene.materials = {material("pane", Rgb(0.5f))};
  scene.materials[0].reflection = scene.materials[0].transmission = Rgb(0.25f);
  scene.materials[0].thin = true;
  for (int i = -depth; i <= depth; ++i) scene.shapes.push_back(shape(PlaneShape{{0, 0, double(i)}, {0, 0, 1}}, "pane"));
  scene.render.depth = depth;
  scene.render.cutoff = cutoff;
  return scene;
}

StabilityResult exponential_tree(const StabilityRun& run) {
  StabilityResult result;
  const int depth = run.effort < 0.5 ? 12 : 16;
  const auto rays = [](const RenderResult& rendered) { return double(rendered.statistics.total_rays()); };
  const RenderResult whole = rendered_for(run, many_panes(depth, 0)),
                     cut = rendered_for(run, many_panes(depth, kDefaultCutoff));
  const double all = std::ldexp(1.0, depth) - 1;
  result.figures.push_back(known_failure("depth alone", "rays of one sample", rays(whole), all, all,
                                         "2^D - 1 of D levels, where every hit has two children"));
  // Light from a level on is at most e (1 + rho + ...) = .5 / (1 - .5) = 1 times the weight .25^L of each of its 2^L
  // rays; an allowance shared out evenly is c 2^-L: all are cut where .5^L <= c, at the latest ten levels down.
  const double levels = std::ceil(std::log2(1 / kDefaultCutoff));
  result.figures.push_back(held("cutoff 1/1020", "rays of one sample", rays(cut), 1,
                                std::ldexp(1.0, int(levels) + 1) - 1,
                                "2^11 - 1: levels until .5^L is below the cutoff"));
  // Level L has 2^(L-1) rays of weight .25^(L-1), each of which meets the radiance .5.
  const double lost = 1 - std::ldexp(1.0, -depth) - double(color_at(cut.film, 0, 0).g), rounding = rays(cut) * 0x1p-24;
  result.figures.push_back(
      held("cutoff 1/1020", "light lost", lost, -rounding, kDefaultCutoff + rounding, "at most the cutoff"));
  if (run.pictures) {
    StabilityGraph graph{"Rays of one sample among panes",
                         "levels allowed",
                         "rays",
                         {{"depth alone", {}}, {"2^D - 1", {}, true}, {"cutoff 1/1020", {}}},
                         StabilityGraph::Scale::linear};
    for (int most = 2; most <= depth; most += 2) {
      graph.lines[0].points.emplace_back(most, rays(rendered_for(run, many_panes(most, 0))));
      graph.lines[1].points.emplace_back(most, std::ldexp(1.0, most) - 1);
      graph.lines[2].points.emplace_back(most, rays(rendered_for(run, many_panes(most, kDefaultCutoff))));
    }
    result.graphs.push_back(std::move(graph));
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> branching_cases() {
  return {
      {24, "tree-truncation", "A tree that ends too early",
       "one ray between two facing mirrors of reflectance .5 to .95, whose light is a geometric series",
       "cutting by what a branch can still bring, with a bound kept beside the picture; off: depth alone",
       "Whitted 1980, p. 345; Hall and Greenberg 1983", tree_truncation},
      {25, "deep-recursion", "A tree a hundred thousand levels deep",
       "two facing mirrors that lose nothing, depth 100000",
       "generations of rays on a stack of their own; off: recursion", "openmoonray issue 62", deep_recursion},
      {26, "exponential-tree", "A tree that doubles at every level",
       "parallel panes that reflect and transmit a quarter each, 16 levels",
       "the cutoff's allowance, divided over children; off: depth alone", "Whitted 1980, sec. 2", exponential_tree}};
}

std::vector<StabilityCase> ray_tree_cases() {
  std::vector<StabilityCase> all;
  for (const auto part : {branching_cases, rough_cases, optics_cases, media_cases})
    for (StabilityCase& one : part()) all.push_back(std::move(one));
  return all;
}

}  // namespace raytree::benchmarks
