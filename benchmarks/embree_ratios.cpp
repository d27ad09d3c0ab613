// Row ratios: what `raytree bench` says of Embree's calls, geometries and builds, beside what was known of them before
// from another machine (two Zen 3 cores, Embree 3.13.5, one thread), which the renderer's choices rest on.
#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/bench_run.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "benchmarks/significance.h"
#include "geometry/embree_bench_scene.h"

namespace raytree::benchmarks {
namespace {

constexpr int kRepetitions = 9;

/// From .. to, as it was known; with what its digits leave open on either side. 0, 0: nothing was known.
struct KnownRatio {
  double from = 0, to = 0, digit = 0.05;
};

/// A row of `raytree bench` and the ratio taken of it.
struct RatioOf {
  std::string rays, configuration;
  KnownRatio known;
  bool beside = false;      ///< over the same call in the baseline's scene; else over the baseline
  const char* reason = "";  ///< why it is not held to what was known; empty: it is
};

BenchConfiguration built(BenchSceneOptions build, BenchCall call) {
  BenchConfiguration configuration;
  configuration.build = build, configuration.call = call;
  return configuration;
}

/// Each kind of scene asked by single rays and by packets of 8, followed together and not.
std::vector<BenchConfiguration> configurations(const std::vector<BenchSceneOptions>& builds) {
  std::vector<BenchConfiguration> list;
  for (const BenchSceneOptions& build : builds)
    for (const BenchCall call : {BenchCall{1, false}, {8, false}, {8, true}}) list.push_back(built(build, call));
  return list;
}

BenchSceneOptions plain() {
  BenchSceneOptions build;
  build.robust = false;
  return build;
}

Figure figure_of(const BenchReport& report, const RatioOf& ratio) {
  Figure figure;
  figure.row = "ratios";
  figure.what =
      fmt::format("{}, {} / {}, {}", ratio.rays, ratio.configuration,
                  ratio.beside ? "the same call of " + std::string(report.baseline) : report.baseline, report.scene);
  const auto row = std::find_if(report.rows.begin(), report.rows.end(), [&](const BenchRow& one) {
    return one.name() == ratio.rays + "/" + ratio.configuration;
  });
  if (row == report.rows.end()) {
    figure.problem = "the row was not measured";
    return figure;
  }
  figure.measured = ratio.beside && !row->beside.empty() ? row->beside_ratio : row->ratio;
  if (row->suspicious()) figure.problem = "wrong answers: " + row->wrong_example;
  if (ratio.known.to > 0) {
    figure.note = fmt::format("known as {} to {}", ratio.known.from, ratio.known.to);
    if (*ratio.reason == '\0') {
      figure.kind = BoundKind::within;
      figure.bound = ratio.known.from - ratio.known.digit, figure.upper = ratio.known.to + ratio.known.digit;
      figure.noise = kBetweenProcesses;
    } else {
      figure.note += std::string("; ") + ratio.reason;
    }
  }
  return figure;
}

/// One scene's rays in some configurations, on one thread.
/// The first configuration is the baseline.
void measure_scene(const MeasureContext& context, SceneDescription description,
                   const std::vector<BenchConfiguration>& list, const std::vector<RatioOf>& ratios,
                   std::vector<Figure>& figures) {
  context.progress("ratios: " + description.name);
  const Scene scene = prepared(std::move(description));
  std::vector<BenchRays> rays = bench_rays(scene, kBenchBatches, nullptr);
  std::erase_if(rays, [&](const BenchRays& kind) {
    return std::none_of(ratios.begin(), ratios.end(), [&](const RatioOf& ratio) { return ratio.rays == kind.name; });
  });
  BenchRunOptions options;
  options.repetitions = kRepetitions;
  options.baseline = list.front().name();
  options.configurations = list;
  const BenchReport report = run_bench(scene, rays, options);
  for (const RatioOf& ratio : ratios) figures.push_back(figure_of(report, ratio));
}

}  // namespace

std::vector<Figure> measure_embree_ratios(const MeasureContext& context) {
  const std::string coherent = "triangles/plain/medium/8-coherent", packets = "triangles/plain/medium/8";
  const char* const smaller_gap = "what is not watertight gains more where rays take less; known at a million";
  const char* const company = "not reproduced: another hierarchy costs a ray less here; why is not known";
  const char* const faster = "not reproduced: fewer bytes cost less here; why is not known";
  const char* const more_scattered = "these rays run even less alike";
  const char* const smooth = "the rays of a smooth surface run alike; see the scattered triangles";
  std::vector<Figure> figures;
  struct Size {
    std::int64_t triangles;
    KnownRatio primary, shadow;
  };
  const BenchSceneOptions robust;
  for (const Size& size : {Size{100'000, {2.0, 2.2}, {1.7, 2.2}}, Size{1'000'000, {1.5, 1.7}, {1.2, 1.3}},
                           Size{10'000'000, {1.2, 1.3}, {0.9, 1.0}}}) {
    std::vector<RatioOf> ratios = {{"primary", coherent, size.primary},
                                   {"primary", packets, {1.0, 1.1}},
                                   {"shadow", coherent, size.shadow},
                                   {"mirror", packets, {1.0, 1.1}},
                                   {"refracted", packets, {1.0, 1.1}},
                                   {"bounce", packets, {1.0, 1.1}},
                                   {"mirror", coherent, {0.5, 0.65}, false, smooth},
                                   {"refracted", coherent, {0.5, 0.65}, false, smooth},
                                   {"bounce", coherent, {0.5, 0.65}},
                                   {"primary",
                                    "triangles/robust/medium/1",
                                    {0.85, 0.91, 0.005},
                                    false,
                                    size.triangles < 1'000'000 ? smaller_gap : ""}};
    std::vector<BenchConfiguration> list = configurations({plain()});
    list.push_back(built(robust, {1, false}));
    if (EmbreeBenchScene::widest_call() >= 16)
      for (const bool together : {false, true}) {
        list.push_back(built(plain(), {16, together}));
        for (const char* rays : {"primary", "shadow", "mirror", "refracted", "bounce"})
          ratios.push_back({rays, list.back().name(), {}});
      }
    measure_scene(context, bare_terrain(size.triangles), list, ratios, figures);
  }
  measure_scene(context, scattered_triangles(1'000'000), configurations({plain()}),
                {{"mirror", coherent, {0.5, 0.65}},
                 {"refracted", coherent, {0.5, 0.65}, false, more_scattered},
                 {"bounce", coherent, {0.5, 0.65}, false, more_scattered}},
                figures);

  BenchSceneOptions compact = plain(), low = plain(), high = plain();
  compact.compact = true;
  low.quality = EmbreeOptions::Quality::low, high.quality = EmbreeOptions::Quality::high;
  measure_scene(context, bare_terrain(1'000'000), configurations({plain(), compact, low, high}),
                {{"primary", "triangles/plain/medium-compact/1", {0.6, 0.6}, false, faster},
                 {"bounce", "triangles/plain/medium-compact/1", {0.6, 0.6}},
                 {"primary", "triangles/plain/low/1", {0.65, 0.85, 0.005}},
                 {"bounce", "triangles/plain/low/1", {0.65, 0.85, 0.005}},
                 {"primary", "triangles/plain/high/1", {1.0, 1.0}}},
                figures);
  for (const BenchSceneOptions& alone : {plain(), robust}) {
    BenchSceneOptions quad = alone, quad_and_sphere = alone;
    quad.company = BenchCompany::quad, quad_and_sphere.company = BenchCompany::quad_and_sphere;
    std::vector<RatioOf> ratios;
    for (const char* rays : {"primary", "shadow"}) {
      ratios.push_back({rays, built(quad, {1, false}).name(), {0.78, 0.78, 0.005}, false, company});
      ratios.push_back({rays, built(quad_and_sphere, {1, false}).name(), {0.55, 0.55, 0.005}, false, company});
    }
    measure_scene(context, bare_terrain(1'000'000), configurations({alone, quad, quad_and_sphere}), ratios, figures);
  }

  BenchSceneOptions quads, compact_quads, grids;
  quads.geometry = compact_quads.geometry = BenchGeometry::quads, compact_quads.compact = true;
  grids.geometry = BenchGeometry::grids;
  measure_scene(context, bare_terrain(5'000'000), configurations({robust, quads, compact_quads, grids}),
                {{"primary", "quads/robust/medium/1", {0.97, 1.04, 0.005}, true, faster},
                 {"primary", "quads/robust/medium/8-coherent", {0.8, 1.0}, true, faster},
                 {"bounce", "quads/robust/medium/1", {0.97, 1.04, 0.005}, true, faster},
                 {"primary", "quads/robust/medium-compact/1", {0.7, 0.85, 0.005}, true},
                 {"bounce", "quads/robust/medium-compact/1", {0.7, 0.85, 0.005}, true},
                 {"primary", "grids/robust/medium/1", {0.65, 0.85, 0.005}, true, faster},
                 {"bounce", "grids/robust/medium/1", {0.65, 0.85, 0.005}, true, faster}},
                figures);
  return figures;
}

}  // namespace raytree::benchmarks
