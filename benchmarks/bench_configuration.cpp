#include "benchmarks/bench_configuration.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

using Quality = EmbreeOptions::Quality;

/// More primitives than that take the naive tracer longer to prepare than anybody waits for.
constexpr double kMostNaivePrimitives = 2e6;

/// Rays in the renderer's own packets, where the processor has them.
constexpr int kRenderersWidth = 8;

constexpr const char* kGeometryNames[kBenchGeometryCount] = {"triangles", "quads", "grids"};
constexpr const char* kCompanyNames[] = {"", "-and-quad", "-and-quad-and-sphere"};
constexpr const char* kQualityNames[] = {"low", "medium", "high"};

BenchConfiguration bare(const BenchSceneOptions& build, BenchCall call) {
  BenchConfiguration configuration;
  configuration.build = build, configuration.call = call;
  return configuration;
}

}  // namespace

std::string BenchConfiguration::scene_name() const {
  if (tracer == BenchTracer::seam) return "seam";
  if (tracer == BenchTracer::naive) return "naive";
  return fmt::format("{}{}/{}/{}{}", kGeometryNames[static_cast<std::size_t>(build.geometry)],
                     kCompanyNames[static_cast<std::size_t>(build.company)], build.robust ? "robust" : "plain",
                     kQualityNames[static_cast<std::size_t>(build.quality)], build.compact ? "-compact" : "");
}

std::string BenchConfiguration::name() const {
  std::string name = scene_name();
  if (tracer == BenchTracer::bare) name += fmt::format("/{}{}", call.width, call.coherent ? "-coherent" : "");
  if (threads > 0) name += fmt::format("/{}-thread{}", threads, threads == 1 ? "" : "s");
  return name;
}

std::vector<BenchConfiguration> bench_configurations(const BenchSubject& subject) {
  std::vector<BenchConfiguration> list;
  const BenchSceneOptions common;
  list.push_back(bare(common, {1, false}));
  for (int width = 4; width <= subject.widest_call; width *= 2)
    for (const bool coherent : {false, true}) list.push_back(bare(common, {width, coherent}));
  // What is built otherwise is asked as the renderer asks.
  const BenchCall best{std::min(subject.widest_call, kRenderersWidth), subject.coherent && subject.widest_call > 1};
  if (subject.threads > 1) {
    list.push_back(bare(common, best));
    list.back().threads = 1;
  }
  if (subject.seam) list.emplace_back().tracer = BenchTracer::seam;

  const auto with_scene = [&](const auto& change) {
    BenchSceneOptions build;
    change(build);
    list.push_back(bare(build, {1, false}));
    if (best.width > 1) list.push_back(bare(build, best));
  };
  if (subject.meshes) {
    with_scene([](BenchSceneOptions& build) { build.robust = false; });
    with_scene([](BenchSceneOptions& build) { build.company = BenchCompany::quad; });
    with_scene([](BenchSceneOptions& build) { build.company = BenchCompany::quad_and_sphere; });
    with_scene([](BenchSceneOptions& build) { build.geometry = BenchGeometry::quads; });
    with_scene([](BenchSceneOptions& build) { build.geometry = BenchGeometry::quads, build.compact = true; });
    with_scene([](BenchSceneOptions& build) { build.geometry = BenchGeometry::grids; });
  }
  with_scene([](BenchSceneOptions& build) { build.compact = true; });
  with_scene([](BenchSceneOptions& build) { build.quality = Quality::low; });
  with_scene([](BenchSceneOptions& build) { build.quality = Quality::high; });
  if (subject.primitives <= kMostNaivePrimitives) list.emplace_back().tracer = BenchTracer::naive;
  return list;
}

BenchConfiguration counterpart(const BenchConfiguration& configuration, const BenchConfiguration& baseline) {
  BenchConfiguration same = configuration;
  same.tracer = BenchTracer::bare;
  same.build = baseline.tracer == BenchTracer::bare ? baseline.build : BenchSceneOptions();
  return same;
}

NameFilter::NameFilter(const std::string& expression) : all_(expression.empty()) {
  try {
    expression_ = std::regex(expression, std::regex::ECMAScript | std::regex::optimize);
  } catch (const std::regex_error&) {
    throw Error(
        ErrorKind::bad_input, {},
        fmt::format("--filter: \"{}\" is not a regular expression; for example primary/.*/8-coherent", expression));
  }
}

bool NameFilter::takes(const std::string& name) const { return all_ || std::regex_search(name, expression_); }

}  // namespace raytree::benchmarks
