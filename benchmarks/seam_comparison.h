// The same rays twice: through the seam, as `raytree bench` times them, and by bare Embree calls.
#pragma once

#include <cstdint>
#include <string>

#include "benchmarks/bare_trace.h"
#include "benchmarks/intersection_benchmark.h"
#include "benchmarks/recording_intersector.h"

namespace raytree::benchmarks {

/// On one thread. `scene`, `embree` (the scene that the bare calls trace) and `rays` must outlive it.
class SeamComparison {
 public:
  SeamComparison(const Scene& scene, const EmbreeIntersector& embree, const RaySet& rays, const ReplayCalls& calls);

  double seam_seconds();
  double bare_seconds();
  /// What is wrong with a comparison of which both sides have run: other hits. Empty: nothing.
  std::string problem() const;

  const RayRecord& record() const { return record_; }
  const BareReplay& replay() const { return replay_; }

 private:
  const Scene& scene_;
  const RaySet& rays_;
  const ReplayCalls calls_;
  const RayRecord record_;
  const BareReplay replay_;
  std::uint64_t seam_hits_ = 0, bare_hits_ = 0;
};

}  // namespace raytree::benchmarks
