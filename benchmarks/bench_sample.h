// As many of a kind's rays as there is time for.
#pragma once

#include <cstddef>
#include <functional>

#include "benchmarks/bench_run.h"

namespace raytree::benchmarks {

/// Up to `batches` batches spread over a kind's rays, of each up to `most_of_batch` rays in a row, from a packet on
/// that is another one in each batch.
BenchRays part_of(const BenchRays& kind, std::size_t batches, std::size_t most_of_batch);

struct RayBudget {
  double seconds = 0;   ///< 0: kBenchBatches batches, or kNaiveRays rays
  int repetitions = 1;  ///< that are timed; one more is not
  bool naive = false;   ///< the naive tracer is among those asked: a few rays of many batches
};

/// Powers of two of batches, or of rays of one batch, so that two runs with about the same time take the same rays.
/// `ask_once`: every tracer about the rays given.
BenchRays fitting_part(const BenchRays& kind, const RayBudget& budget,
                       const std::function<void(const BenchRays&)>& ask_once);

}  // namespace raytree::benchmarks
