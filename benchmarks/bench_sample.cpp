#include "benchmarks/bench_sample.h"

#include <algorithm>
#include <cmath>

#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

/// Rays of each batch where all of them together are fewer than one batch: a packet.
constexpr std::size_t kFewOfBatch = 8;

/// Batches that a few thousand rays are taken from.
constexpr std::size_t kPartsOfPicture = 16;

/// Where `most` rays of a batch begin: at a packet, not at the same one of each batch.
std::size_t first_of_part(std::size_t k, std::size_t size, std::size_t most) {
  if (size <= most) return 0;
  const std::size_t places = (size - most) / kFewOfBatch + 1;
  // Multiples of the square root of 2, so that it hangs not together with which batch it is.
  const std::uint64_t part = (std::uint64_t(k) * 0x6a09e667f3bcc908u) >> 32;  // of 2^32
  return kFewOfBatch * static_cast<std::size_t>((part * places) >> 32);
}

}  // namespace

BenchRays part_of(const BenchRays& kind, std::size_t batches, std::size_t most_of_batch) {
  BenchRays part;
  part.name = kind.name;
  const auto take = [&](const RaySet& from, RaySet& to) {
    to.coherence = from.coherence, to.occlusion = from.occlusion;
    const std::size_t count = from.batches.size(), taken = std::min(count, batches);
    for (std::size_t k = 0; k < taken; ++k) {
      const RayBatch& batch = from.batches[spread_place(k, taken, count)];
      RayBatch& copy = to.batches.emplace_back(kBenchmarkBatch);
      const std::size_t first = first_of_part(k, batch.size, most_of_batch);
      for (std::size_t i = first; i < std::min(batch.size, first + most_of_batch); ++i)
        copy.push(batch.origin(i), batch.direction(i), batch.max_distance[i]);
    }
  };
  take(kind.rays, part.rays);
  if (!kind.plane_distance.empty()) {
    take(kind.without_planes, part.without_planes);
    const std::size_t count = kind.plane_distance.size(), taken = std::min(count, batches);
    for (std::size_t k = 0; k < taken; ++k) {
      const std::size_t from = spread_place(k, taken, count);
      const std::vector<float>& planes = kind.plane_distance[from];
      const std::size_t first = first_of_part(k, planes.size(), most_of_batch);
      part.plane_distance.emplace_back(
          planes.begin() + static_cast<std::ptrdiff_t>(first),
          planes.begin() + static_cast<std::ptrdiff_t>(std::min(planes.size(), first + most_of_batch)));
    }
  }
  return part;
}

BenchRays fitting_part(const BenchRays& kind, const RayBudget& budget,
                       const std::function<void(const BenchRays&)>& ask_once) {
  // Few rays are a few of many batches, so that they are the picture's, not a corner's.
  const auto few = [&](std::size_t rays) { return part_of(kind, rays / kFewOfBatch, kFewOfBatch); };
  if (budget.seconds <= 0) return budget.naive ? few(kNaiveRays) : part_of(kind, kBenchBatches, kBenchmarkBatch);
  const BenchRays trial = budget.naive ? few(2 * kFewOfBatch) : part_of(kind, 2, kBenchmarkBatch);
  double round = 0;
  for (int i = 0; i < 2; ++i) {  // the second counts: the first finds cold caches
    const auto start = Clock::now();
    ask_once(trial);
    round = seconds_since(start);
  }
  double rays = budget.seconds / ((budget.repetitions + 1) * round / static_cast<double>(trial.rays.size()));
  rays = std::exp2(std::floor(std::log2(std::max(rays, 16.0))));
  if (rays < double(kBenchmarkBatch)) return few(static_cast<std::size_t>(rays));
  // A batch or two of the naive tracer's are a corner of the picture, too.
  const std::size_t parts = std::min(kPartsOfPicture, kind.rays.batches.size());
  if (budget.naive && rays < static_cast<double>(parts * kBenchmarkBatch))
    return part_of(kind, parts, static_cast<std::size_t>(rays) / parts / kFewOfBatch * kFewOfBatch);
  return part_of(kind, static_cast<std::size_t>(std::min(rays, 1e9)) / kBenchmarkBatch, kBenchmarkBatch);
}

}  // namespace raytree::benchmarks
