// The intersection benchmark: rays of five kinds that a scene gives rise to, asked of its tracer again and again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/measurement.h"
#include "geometry/embree_replay.h"
#include "geometry/ray_batch.h"
#include "geometry/ray_intersector.h"
#include "renderer/scene.h"

namespace raytree::benchmarks {

/// Where the rays of a kind come from. `mirror`, `refracted` and `bounce` leave every point that an eye ray meets,
/// whatever its material: so two scenes with one geometry trace the same rays.
enum class BenchmarkRays : std::uint8_t {
  primary,    ///< eye rays through pixel centers, in blocks of 4 x 2
  shadow,     ///< from each point to each light that shines on its side
  mirror,     ///< mirrored eye rays
  refracted,  ///< eye rays bent into a medium of index 1.5 (out of one where they hit from behind)
  bounce      ///< over the hemisphere by its cosine, at random but the same each time
};
inline constexpr std::size_t kBenchmarkRaysCount = 5;
const char* name_of(BenchmarkRays rays);

/// Rays of one kind in batches of at most kBenchmarkBatch, all of one coherence.
struct RaySet {
  Coherence coherence = Coherence::coherent;
  bool occlusion = false;
  std::vector<RayBatch> batches;

  std::size_t size() const;
};
inline constexpr std::size_t kBenchmarkBatch = 1024;

/// The rays of a prepared scene, one set a kind; a set may be empty. `stop`: ends early, with sets that are not whole.
std::array<RaySet, kBenchmarkRaysCount> benchmark_rays(const Scene& scene, const std::atomic<bool>* stop = nullptr);

/// What one pass over a set found.
struct PassResult {
  double seconds = 0;          ///< inside the tracer, the mean over the threads; rays wait in the nearest caches
  std::uint64_t hits = 0;      ///< rays that hit or are occluded
  std::uint64_t checksum = 0;  ///< of every answer in the order of the rays, whatever the threads
};

/// Asks all of a set's rays on `threads` threads: batches through the seam, or one ray a call.
PassResult batched_pass(const Scene& scene, const RaySet& rays, int threads);
PassResult single_ray_pass(const Scene& scene, const RaySet& rays, int threads);

struct IntersectionFigure {
  BenchmarkRays kind = BenchmarkRays::primary;
  std::size_t rays = 0;
  std::uint64_t hits = 0, checksum = 0;
  bool repeatable = true;      ///< all passes gave the same checksum
  Spread millions_per_second;  ///< batched
  Spread single_ratio;         ///< batched speed over that of single rays, pair by pair
};

/// Repetitions of all kinds, batched and single, interleaved so that a machine's moods meet all alike; one more comes
/// first and does not count. Kinds without rays are left out.
std::vector<IntersectionFigure> measure_intersection(const Scene& scene,
                                                     const std::array<RaySet, kBenchmarkRaysCount>& rays, int threads,
                                                     int repetitions, const std::atomic<bool>* stop = nullptr);

/// The rays as a record that can be replayed.
RayRecord record_of(const RaySet& rays);

/// The calls that the seam makes for each class of rays, but for mixed packets, which get theirs one by one.
ReplayCalls calls_of(const EmbreeIntersector& embree);

}  // namespace raytree::benchmarks
