#include "benchmarks/bench_tracers.h"

#include "geometry/sphere_bounded_intersector.h"
#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

/// Builds are repeated while all of them together take less than this, up to kMostBuilds.
constexpr double kRebuildSeconds = 0.5;
constexpr int kMostBuilds = 3;

}  // namespace

BuiltTracer build_tracer(const Scene& scene, const BenchConfiguration& configuration, int threads,
                         const std::atomic<bool>* stop) {
  BuiltTracer tracer;
  tracer.build.scene = configuration.scene_name();
  std::vector<double> seconds;
  const auto start = Clock::now();
  if (configuration.tracer == BenchTracer::seam) {
    tracer.seam = scene.intersector.get();
    seconds.push_back(scene.seconds.build);
  } else if (configuration.tracer == BenchTracer::naive) {
    SphereBoundedOptions spheres;
    spheres.stop = stop;
    tracer.own = std::make_unique<SphereBoundedIntersector>(*scene.shapes, spheres);
    tracer.seam = tracer.own.get();
    seconds.push_back(seconds_since(start));
  } else {
    BenchSceneOptions options = configuration.build;
    options.threads = threads, options.stop = stop;
    do {
      tracer.bare.reset();
      tracer.bare = std::make_unique<EmbreeBenchScene>(*scene.shapes, options);
      seconds.push_back(tracer.bare->build_seconds());
      if (seconds.size() == 1) tracer.first_seconds = seconds_since(start);
    } while (seconds.size() < kMostBuilds && seconds_since(start) < kRebuildSeconds);
  }
  tracer.build.bytes = tracer.bare ? tracer.bare->memory_bytes() : tracer.seam->memory_bytes();
  tracer.build.peak_bytes = tracer.bare ? tracer.bare->peak_memory_bytes() : tracer.seam->peak_memory_bytes();
  if (tracer.bare) tracer.build.triangles_per_primitive = tracer.bare->triangles_per_primitive();
  tracer.build.seconds = spread_of(std::move(seconds));
  return tracer;
}

PassResult ask_all(const BuiltTracer& tracer, BenchCall call, const BenchRays& kind, int threads,
                   const LookAtBatch& look) {
  if (tracer.seam != nullptr)
    return timed_pass(
        kind.rays, threads,
        [&](std::size_t batch, HitBatch& hits, std::uint8_t* occluded) {
          return ask_tracer<RunningTime>(*tracer.seam, kind.rays, batch, hits, occluded);
        },
        look);
  const RaySet& rays = kind.bare();
  return timed_pass(
      rays, threads,
      [&](std::size_t batch, HitBatch& hits, std::uint8_t* occluded) {
        const RayBatch& asked = rays.batches[batch];
        const double seconds =
            rays.occlusion ? tracer.bare->occluded(asked, call, occluded) : tracer.bare->intersect(asked, call, hits);
        if (!kind.plane_distance.empty()) {
          const std::vector<float>& planes = kind.plane_distance[batch];
          for (std::size_t i = 0; i < asked.size; ++i) {
            if (planes[i] == kInfinity) continue;
            occluded[i] = 1;
            if (!rays.occlusion && hits.geometry[i] == kNoGeometry) hits.set(i, {kPlaneGeometry, 0, 0, 0, planes[i]});
          }
        }
        return seconds;
      },
      look);
}

BenchAnswers answers_of(const BuiltTracer& tracer, BenchCall call, const BenchRays& kind, int threads) {
  BenchAnswers answers;
  answers.distances.assign(kind.rays.batches.size() * kBenchmarkBatch, kInfinity);
  answers.pass =
      ask_all(tracer, call, kind, threads, [&](std::size_t batch, const HitBatch& hits, const std::uint8_t* occluded) {
        for (std::size_t i = 0; i < kind.rays.batches[batch].size; ++i) {
          float& answer = answers.distances[batch * kBenchmarkBatch + i];
          if (kind.rays.occlusion)
            answer = occluded[i] != 0 ? 0 : kInfinity;
          else if (hits.geometry[i] != kNoGeometry)
            answer = hits.distance[i];
        }
      });
  return answers;
}

}  // namespace raytree::benchmarks
