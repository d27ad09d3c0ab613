#include "benchmarks/bare_trace.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>

#include "renderer/float_mode.h"

namespace raytree::benchmarks {
namespace {

constexpr const char* kClassNames[kRayClassCount] = {"eye rays", "reflected and refracted rays", "shadow rays",
                                                     "incoherent shadow rays"};
constexpr const char* kCallNames[kReplayCallCount] = {"coherent packets", "incoherent packets",
                                                      "packets told by their rays", "single rays"};
constexpr double kHitTolerance = 1e-4;  ///< of a class's rays
constexpr int kTrialPasses = 3;

}  // namespace

ReplayTally replay_pass(const BareReplay& replay, const ReplayCalls& calls, int threads) {
  tbb::task_arena arena(threads);
  tbb::enumerable_thread_specific<ReplayTally> tallies;
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, replay.chunk_count(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const FlushDenormals flush;
          ReplayTally& tally = tallies.local();
          for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk) replay.replay(chunk, calls, tally);
        },
        tbb::simple_partitioner());
  });
  ReplayTally sum;
  for (const ReplayTally& tally : tallies) sum += tally;
  return sum;
}

ReplayCalls best_calls(const BareReplay& replay, int threads) {
  ReplayCalls best{};
  std::array<double, kRayClassCount> least;
  least.fill(std::numeric_limits<double>::infinity());
  for (int pass = 0; pass < kTrialPasses; ++pass)
    for (std::size_t call = 0; call < kReplayCallCount; ++call) {
      ReplayCalls calls;
      calls.fill(static_cast<ReplayCall>(call));
      const ReplayTally tally = replay_pass(replay, calls, threads);
      for (std::size_t c = 0; c < kRayClassCount; ++c)
        if (tally.seconds[c] < least[c]) least[c] = tally.seconds[c], best[c] = calls[c];
    }
  return best;
}

std::string calls_text(const ReplayCalls& calls, const RayRecord& record) {
  std::string text;
  const auto counts = record.ray_counts();
  for (std::size_t c = 0; c < kRayClassCount; ++c) {
    if (counts[c] == 0) continue;
    text += fmt::format("{}{} {} by {}", text.empty() ? "" : ", ", counts[c], kClassNames[c],
                        kCallNames[static_cast<std::size_t>(calls[c])]);
  }
  return text;
}

std::string hit_mismatch(const ReplayTally& tally, const RayRecord& record) {
  const auto counts = record.ray_counts();
  for (std::size_t c = 0; c < kRayClassCount; ++c) {
    const double difference = std::abs(static_cast<double>(tally.hits[c]) - static_cast<double>(record.hits[c]));
    if (difference > kHitTolerance * static_cast<double>(counts[c]))
      return fmt::format("the replay's {} hit {} times, the render's {}", kClassNames[c], tally.hits[c],
                         record.hits[c]);
  }
  return {};
}

}  // namespace raytree::benchmarks
