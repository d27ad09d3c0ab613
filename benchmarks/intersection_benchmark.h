// The intersection benchmark: rays of five kinds that a scene gives rise to, asked of its tracer again and again.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/measurement.h"
#include "geometry/embree_replay.h"
#include "geometry/ray_batch.h"
#include "geometry/ray_intersector.h"
#include "geometry/stopwatch.h"
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

/// Adds a ray to a set's last batch, or to a new one.
void add_ray(RaySet& set, const Vec3f& origin, const Vec3f& direction, float end);

/// Place `k` of `taken` in a row of `count`, 0 < taken <= count: one in each of as many equal parts, not at the same
/// place of each, since what stands in rows (blocks of pixels) would be met in the same few columns.
std::size_t spread_place(std::size_t k, std::size_t taken, std::size_t count);

/// Batches spread over the set by spread_place(), no more than `most` (at least one).
RaySet thinned(RaySet rays, std::size_t most);

/// The rays of a prepared scene, one set a kind; a set may be empty. Eye rays are those of the whole picture, or no
/// more than `most_batches` batches spread over it by spread_place(). `stop`: ends early, with sets that are not whole.
std::array<RaySet, kBenchmarkRaysCount> benchmark_rays(const Scene& scene, const std::atomic<bool>* stop = nullptr,
                                                       std::size_t most_batches = std::size_t(-1));

/// What one pass over a set found.
struct PassResult {
  double seconds = 0;          ///< inside the tracer, the mean over the threads; rays wait in the nearest caches
  std::uint64_t hits = 0;      ///< rays that hit or are occluded
  std::uint64_t checksum = 0;  ///< of every answer in the order of the rays, whatever the threads
};

/// Asks all of a set's rays through the seam on `threads` threads, batch by batch.
PassResult batched_pass(const Scene& scene, const RaySet& rays, int threads);

/// One pass over batches [0, count) on `threads` threads: `ask(i, hits, occluded)` answers batch i and returns the
/// seconds that count; look(i, hits, occluded), if there is one, is shown the answers.
using AskBatch = std::function<double(std::size_t batch, HitBatch& hits, std::uint8_t* occluded)>;
using LookAtBatch = std::function<void(std::size_t batch, const HitBatch& hits, const std::uint8_t* occluded)>;
PassResult timed_pass(const RaySet& rays, int threads, const AskBatch& ask, const LookAtBatch& look = {});

/// A copy of a batch that the calling thread has just written: rays where a render has them when it asks, in the
/// nearest caches, not in main memory. Holds until the next call.
const RayBatch& warmed(const RayBatch& batch);

/// Asks a tracer behind the seam about one batch; returns the seconds by a Stopwatch of stopwatch.h.
template <class Stopwatch>
double ask_tracer(const RayIntersector& tracer, const RaySet& rays, std::size_t batch, HitBatch& hits,
                  std::uint8_t* occluded) {
  const RayBatch& warm = warmed(rays.batches[batch]);
  const Stopwatch time;
  if (rays.occlusion)
    tracer.occluded(warm, rays.coherence, occluded);
  else
    tracer.intersect(warm, rays.coherence, hits);
  return time.seconds();
}

/// The rays as a record that can be replayed.
RayRecord record_of(const RaySet& rays);

/// The calls that the seam makes for each class of rays, in batches of this coherence.
ReplayCalls calls_of(const EmbreeIntersector& embree, Coherence coherence);

}  // namespace raytree::benchmarks
