// What answers a configuration's rays in `raytree bench`: builds it, and asks it about all rays of a kind.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "benchmarks/bench_run.h"
#include "geometry/embree_bench_scene.h"

namespace raytree::benchmarks {

/// A configuration's tracer. The scene that it was built over must outlive it.
struct BuiltTracer {
  std::unique_ptr<const EmbreeBenchScene> bare;  ///< of `bare`
  std::unique_ptr<const RayIntersector> own;     ///< of `naive`
  const RayIntersector* seam = nullptr;          ///< of `seam` and `naive`
  BenchBuild build;                              ///< what building took
  double first_seconds = 0;                      ///< of one build with all that prepares it

  explicit operator bool() const { return bare != nullptr || seam != nullptr; }
};

/// Builds what a configuration asks on so many threads, up to three times where that takes little. Throws Error as
/// EmbreeIntersector does.
BuiltTracer build_tracer(const Scene& scene, const BenchConfiguration& configuration, int threads,
                         const std::atomic<bool>* stop);

/// Asks about all of a kind's rays once. `call`: of bare tracers. `look`: see timed_pass().
PassResult ask_all(const BuiltTracer& tracer, BenchCall call, const BenchRays& kind, int threads,
                   const LookAtBatch& look = {});

/// [batch * kBenchmarkBatch + ray] distances of the hits, infinite for misses, 0 for occluded rays.
struct BenchAnswers {
  std::vector<float> distances;
  PassResult pass;
};
BenchAnswers answers_of(const BuiltTracer& tracer, BenchCall call, const BenchRays& kind, int threads);

}  // namespace raytree::benchmarks
