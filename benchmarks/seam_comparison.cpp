#include "benchmarks/seam_comparison.h"

#include <fmt/format.h>

namespace raytree::benchmarks {

SeamComparison::SeamComparison(const Scene& scene, const EmbreeIntersector& embree, const RaySet& rays,
                               const ReplayCalls& calls)
    : scene_(scene), rays_(rays), calls_(calls), record_(record_of(rays)), replay_(embree, record_) {}

double SeamComparison::seam_seconds() {
  const PassResult pass = batched_pass(scene_, rays_, 1);
  seam_hits_ = pass.hits;
  return pass.seconds;
}

double SeamComparison::bare_seconds() {
  const ReplayTally tally = replay_pass(replay_, calls_, 1);
  bare_hits_ = tally.hits[static_cast<std::size_t>(record_.batches.front().ray_class)];
  return tally.total_seconds();
}

std::string SeamComparison::problem() const {
  if (bare_hits_ == seam_hits_) return {};
  return fmt::format("the bare calls hit {} times, the seam {}", bare_hits_, seam_hits_);
}

}  // namespace raytree::benchmarks
