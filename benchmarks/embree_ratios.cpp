// Row ratios: what `raytree bench` says of Embree's calls, geometries and builds, beside what was known of them before
// from another machine (two Zen 3 cores, Embree 3.13.5, one thread), which the renderer's choices rest on.
#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/bench_run.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
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

/// Holds a figure to what was known of it, or says why not.
void hold_to_known(const RatioOf& ratio, Figure& figure) {
  if (ratio.known.to <= 0) return;
  figure.note = fmt::format("known as {} to {}", ratio.known.from, ratio.known.to);
  if (*ratio.reason == '\0') {
    figure.kind = BoundKind::within;
    figure.bound = ratio.known.from - ratio.known.digit, figure.upper = ratio.known.to + ratio.known.digit;
    figure.noise = kBetweenMachines;
  } else {
    figure.note += std::string("; ") + ratio.reason;
  }
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
  hold_to_known(ratio, figure);
  return figure;
}

/// What a shape of another type costs every ray, in nanoseconds: (1 - ratio) of the time that a ray takes beside it.
Figure company_cost(const BenchReport& report, const std::string& rays, const std::string& configuration) {
  Figure figure = figure_of(report, {rays, configuration, {}});
  figure.what = fmt::format("{}, a ray of {} more than of {}, {}", rays, configuration, report.baseline, report.scene);
  figure.unit = "ns";
  for (const BenchRow& row : report.rows) {
    if (row.name() != rays + "/" + configuration) continue;
    const double nanoseconds = 1e3 / row.speed.median;
    const Spread share = figure.measured;
    figure.measured.low = (1 - share.high) * nanoseconds, figure.measured.high = (1 - share.low) * nanoseconds;
    figure.measured.median = (1 - share.median) * nanoseconds;
    figure.note = fmt::format("of {:.3g} ns", nanoseconds);
  }
  return figure;
}

/// The same ratio in several scenes: from the least to the greatest of their medians, and the median of them.
Figure over_scenes(const std::vector<BenchReport>& reports, const RatioOf& ratio) {
  Figure figure;
  std::vector<double> medians;
  std::string each;
  for (const BenchReport& report : reports) {
    const Figure one = figure_of(report, ratio);
    if (figure.row.empty()) figure = one;
    if (!one.problem.empty()) {
      figure.problem = one.what + ": " + one.problem;
      continue;
    }
    medians.push_back(one.measured.median);
    each += fmt::format("{}{:.2f}", each.empty() ? "" : ", ", one.measured.median);
  }
  figure.what =
      fmt::format("{}, {} / {}, {} scenes", ratio.rays, ratio.configuration,
                  ratio.beside ? "the same call of " + std::string(reports.front().baseline) : reports.front().baseline,
                  reports.size());
  if (!medians.empty()) {
    const auto [least, most] = std::minmax_element(medians.begin(), medians.end());
    figure.measured = {*least, spread_of(medians).median, *most, static_cast<int>(medians.size())};
  }
  figure.note.clear();
  hold_to_known(ratio, figure);
  figure.note += (figure.note.empty() ? "" : "; ") + each;
  return figure;
}

/// One scene's rays in some configurations, on one thread. The first configuration is the baseline.
BenchReport measured_report(const MeasureContext& context, SceneDescription description,
                            const std::vector<BenchConfiguration>& list, const std::vector<RatioOf>& ratios) {
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
  return run_bench(scene, rays, options);
}

/// Returns the report too.
BenchReport measure_scene(const MeasureContext& context, SceneDescription description,
                          const std::vector<BenchConfiguration>& list, const std::vector<RatioOf>& ratios,
                          std::vector<Figure>& figures) {
  BenchReport report = measured_report(context, std::move(description), list, ratios);
  for (const RatioOf& ratio : ratios) figures.push_back(figure_of(report, ratio));
  return report;
}

/// Another type of shape has a hierarchy of its own, which costs every ray about as much, however long the ray takes:
/// what share that is hangs on the scene. In the terrain a ray takes three times as long as before the ball.
void measure_company(const MeasureContext& context, std::vector<Figure>& figures) {
  const char* const long_rays = "these rays take three times as long as the ball's: the same cost is a smaller share";
  const char* const robust = "known of what is not robust, where a ray takes less";
  for (const bool ball : {false, true})
    for (const BenchSceneOptions& alone : {plain(), BenchSceneOptions()}) {
      BenchSceneOptions quad = alone, quad_and_sphere = alone;
      quad.company = BenchCompany::quad, quad_and_sphere.company = BenchCompany::quad_and_sphere;
      const std::string with_quad = built(quad, {1, false}).name(),
                        with_both = built(quad_and_sphere, {1, false}).name();
      std::vector<RatioOf> ratios;
      const char* const why_not = !ball ? long_rays : alone.robust ? robust : "";
      ratios.push_back({"primary", with_quad, {0.78, 0.78, 0.005}, false, why_not});
      ratios.push_back({"primary", with_both, {0.55, 0.55, 0.005}, false, why_not});
      for (const std::string& company : {with_quad, with_both}) ratios.push_back({"shadow", company, {}});
      const BenchReport report = measure_scene(context, ball ? dented_ball(1'000'000) : bare_terrain(1'000'000),
                                               configurations({alone, quad, quad_and_sphere}), ratios, figures);
      for (const std::string& company : {with_quad, with_both})
        figures.push_back(company_cost(report, "primary", company));
    }
}

/// What meshes are handed over as. These ratios move with the number of triangles (a hierarchy has a level more, or
/// fuller leaves) and with how much of it the caches hold, so they are looked at over some meshes,
/// of which one at least has to come near what was known.
void measure_kinds(const MeasureContext& context, std::vector<Figure>& figures) {
  BenchSceneOptions compact, quads, compact_quads, grids;
  compact.compact = compact_quads.compact = true;
  quads.geometry = compact_quads.geometry = BenchGeometry::quads;
  grids.geometry = BenchGeometry::grids;
  const KnownRatio few_bytes{0.7, 0.85, 0.005}, fewest_bytes{0.65, 0.85, 0.005};
  const std::vector<RatioOf> ratios = {{"primary", "triangles/robust/medium-compact/1", {0.6, 0.6}, true},
                                       {"bounce", "triangles/robust/medium-compact/1", {0.6, 0.6}, true},
                                       {"primary", "quads/robust/medium/1", {0.97, 1.04, 0.005}, true},
                                       {"bounce", "quads/robust/medium/1", {0.97, 1.04, 0.005}, true},
                                       {"primary", "quads/robust/medium/8-coherent", {0.8, 1.0}, true},
                                       {"primary", "quads/robust/medium-compact/1", few_bytes, true},
                                       {"primary", "quads/robust/medium-compact/8-coherent", few_bytes, true},
                                       {"bounce", "quads/robust/medium-compact/1", few_bytes, true},
                                       {"primary", "grids/robust/medium/1", fewest_bytes, true},
                                       {"primary", "grids/robust/medium/8-coherent", fewest_bytes, true},
                                       {"bounce", "grids/robust/medium/1", fewest_bytes, true},
                                       {"edge", "grids/robust/medium/1", fewest_bytes, true}};
  std::vector<BenchReport> reports;
  const auto measure = [&](SceneDescription scene) {
    reports.push_back(measured_report(context, std::move(scene),
                                      configurations({BenchSceneOptions(), compact, quads, compact_quads, grids}),
                                      ratios));
  };
  for (const std::int64_t triangles : {1'000'000, 2'000'000, 5'000'000}) measure(bare_terrain(triangles));
  for (const std::int64_t triangles : {1'000'000, 5'000'000}) measure(dented_ball(triangles));
  for (const RatioOf& ratio : ratios) figures.push_back(over_scenes(reports, ratio));
}

}  // namespace

std::vector<Figure> measure_embree_ratios(const MeasureContext& context) {
  const std::string coherent = "triangles/plain/medium/8-coherent", packets = "triangles/plain/medium/8";
  const char* const smaller_gap = "what is not watertight gains more where rays take less; known at a million";
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
                {{"primary", "triangles/plain/medium-compact/1", {0.6, 0.6}},
                 {"bounce", "triangles/plain/medium-compact/1", {0.6, 0.6}},
                 {"primary", "triangles/plain/low/1", {0.65, 0.85, 0.005}},
                 {"bounce", "triangles/plain/low/1", {0.65, 0.85, 0.005}},
                 {"primary", "triangles/plain/high/1", {1.0, 1.0}}},
                figures);
  measure_company(context, figures);
  measure_kinds(context, figures);
  return figures;
}

}  // namespace raytree::benchmarks
