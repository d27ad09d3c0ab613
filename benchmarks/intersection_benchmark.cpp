#include "benchmarks/intersection_benchmark.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "benchmarks/recording_intersector.h"
#include "geometry/stopwatch.h"
#include "geometry/surface.h"
#include "renderer/float_mode.h"
#include "renderer/optics.h"

namespace raytree::benchmarks {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();
constexpr float kGlassIndex = 1.5f;

bool stopped(const std::atomic<bool>* stop) { return stop != nullptr && stop->load(std::memory_order_relaxed); }

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Over the hemisphere about `normal`, by its cosine: the normal plus a point of the unit sphere. `key` decides.
Vec3f bounced(const Vec3f& normal, std::uint64_t key) {
  const std::uint64_t bits = mixed(key + 0x9e3779b97f4a7c15u);
  const float height = 1 - 2 * (static_cast<float>(bits >> 40) * 0x1p-24f);
  const float angle = 6.2831853f * (static_cast<float>((bits >> 16) & 0xffffff) * 0x1p-24f);
  const float ring = std::sqrt(std::max(0.0f, 1 - height * height));
  const Vec3f sum = normal + Vec3f(ring * std::cos(angle), ring * std::sin(angle), height);
  return sum.dot(sum) > 1e-6f ? unit(sum) : normal;
}

/// Folds one answer into a checksum.
std::uint64_t folded(std::uint64_t sum, std::uint64_t word) { return (std::rotl(sum, 5) ^ word) * 0x9e3779b97f4a7c15u; }

void look_at_hits(const RayBatch& batch, const HitBatch& hits, PassResult& result) {
  for (std::size_t i = 0; i < batch.size; ++i) {
    if (hits.geometry[i] == kNoGeometry) continue;
    ++result.hits;
    const std::uint64_t surface = (std::uint64_t(hits.geometry[i]) << 32) | hits.primitive[i];
    const std::uint64_t distance = std::bit_cast<std::uint32_t>(hits.distance[i]);
    result.checksum = folded(folded(result.checksum, surface), (distance << 32) | i);
  }
}

void look_at_occlusion(const RayBatch& batch, const std::uint8_t* occluded, PassResult& result) {
  for (std::size_t i = 0; i < batch.size; ++i) {
    result.hits += occluded[i];
    result.checksum = folded(result.checksum, occluded[i]);
  }
}

}  // namespace

void add_ray(RaySet& set, const Vec3f& origin, const Vec3f& direction, float end) {
  if (set.batches.empty() || set.batches.back().size == kBenchmarkBatch) set.batches.emplace_back(kBenchmarkBatch);
  set.batches.back().push(origin, direction, end);
}

const RayBatch& warmed(const RayBatch& batch) {
  thread_local RayBatch copy(kBenchmarkBatch);
  copy.size = batch.size;
  const auto copy_array = [&](float* to, const float* from) { std::copy(from, from + batch.size, to); };
  copy_array(copy.origin_x, batch.origin_x);
  copy_array(copy.origin_y, batch.origin_y);
  copy_array(copy.origin_z, batch.origin_z);
  copy_array(copy.direction_x, batch.direction_x);
  copy_array(copy.direction_y, batch.direction_y);
  copy_array(copy.direction_z, batch.direction_z);
  copy_array(copy.max_distance, batch.max_distance);
  return copy;
}

std::size_t spread_place(std::size_t k, std::size_t taken, std::size_t count) {
  // Multiples of the golden ratio keep away from each other, whatever the length of a row.
  const std::size_t begin = k * count / taken, end = (k + 1) * count / taken;
  const std::uint64_t part = (std::uint64_t(k) * 0x9e3779b97f4a7c15u) >> 32;  // of 2^32
  return begin + static_cast<std::size_t>((part * (end - begin)) >> 32);
}

RaySet thinned(RaySet rays, std::size_t most) {
  const std::size_t count = rays.batches.size(), taken = std::max<std::size_t>(most, 1);
  if (count <= taken) return rays;
  std::vector<RayBatch> kept;
  for (std::size_t k = 0; k < taken; ++k) kept.push_back(std::move(rays.batches[spread_place(k, taken, count)]));
  rays.batches = std::move(kept);
  return rays;
}

const char* name_of(BenchmarkRays rays) {
  constexpr const char* kNames[kBenchmarkRaysCount] = {"primary", "shadow", "mirror", "refracted", "bounce"};
  return kNames[static_cast<std::size_t>(rays)];
}

std::size_t RaySet::size() const {
  return std::accumulate(batches.begin(), batches.end(), std::size_t(0),
                         [](std::size_t sum, const RayBatch& batch) { return sum + batch.size; });
}

std::array<RaySet, kBenchmarkRaysCount> benchmark_rays(const Scene& scene, const std::atomic<bool>* stop,
                                                       std::size_t most_batches) {
  std::array<RaySet, kBenchmarkRaysCount> sets;
  const auto set = [&](BenchmarkRays kind) -> RaySet& { return sets[static_cast<std::size_t>(kind)]; };
  set(BenchmarkRays::shadow).occlusion = true;
  set(BenchmarkRays::mirror).coherence = set(BenchmarkRays::refracted).coherence = Coherence::mixed;
  set(BenchmarkRays::bounce).coherence = Coherence::incoherent;

  RaySet& primary = set(BenchmarkRays::primary);
  const auto [width, height] = scene.description.image;
  // A batch is a run of blocks along rows of blocks.
  const std::size_t blocks_across = static_cast<std::size_t>((width + kBlockWidth - 1) / kBlockWidth),
                    blocks = blocks_across * static_cast<std::size_t>((height + kBlockHeight - 1) / kBlockHeight);
  constexpr std::size_t kBlocksOfBatch = kBenchmarkBatch / (kBlockWidth * kBlockHeight);
  const std::size_t runs = (blocks + kBlocksOfBatch - 1) / kBlocksOfBatch, taken = std::min(runs, most_batches);
  for (std::size_t take = 0; take < taken && !stopped(stop); ++take) {
    const std::size_t first = spread_place(take, taken, runs) * kBlocksOfBatch;
    for (std::size_t block = first; block < std::min(first + kBlocksOfBatch, blocks); ++block) {
      const int left = static_cast<int>(block % blocks_across) * kBlockWidth,
                top = static_cast<int>(block / blocks_across) * kBlockHeight;
      for (int y = top; y < std::min(top + kBlockHeight, height); ++y)
        for (int x = left; x < std::min(left + kBlockWidth, width); ++x) {
          Vec3f origin, direction;
          scene.camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, origin, direction);
          add_ray(primary, origin, direction, kForever);
        }
    }
  }

  // Shadow rays toward one light stand together, as the renderer queues them.
  std::vector<RaySet> toward_light(scene.lights.size());
  HitBatch hits(kBenchmarkBatch);
  std::uint64_t point_index = 0;
  for (const RayBatch& rays : primary.batches) {
    if (stopped(stop)) break;
    scene.intersector->intersect(rays, Coherence::coherent, hits);
    for (std::size_t i = 0; i < rays.size; ++i) {
      if (hits.geometry[i] == kNoGeometry) continue;
      const Vec3f direction = rays.direction(i);
      SurfacePoint point = surface_at(*scene.shapes, rays.origin(i), direction, hits[i], false);
      const bool leaving = direction.dot(point.geometric_normal) > 0;
      const Vec3f side = leaving ? -point.geometric_normal : point.geometric_normal;
      const Vec3f outside = offset_origin(point, side);
      for (std::size_t light = 0; light < scene.lights.size(); ++light) {
        float distance;
        const Vec3f to_light = scene.lights[light].direction_from(point.position, distance);
        if (to_light.dot(side) > 0) add_ray(toward_light[light], outside, to_light, distance);
      }
      add_ray(set(BenchmarkRays::mirror), outside, reflected_direction(direction, side), kForever);
      if (const auto refracted = refracted_direction(direction, side, leaving ? kGlassIndex : 1 / kGlassIndex))
        add_ray(set(BenchmarkRays::refracted), offset_origin(point, -side), *refracted, kForever);
      add_ray(set(BenchmarkRays::bounce), outside, bounced(side, point_index++), kForever);
    }
  }
  for (RaySet& light : toward_light)
    std::move(light.batches.begin(), light.batches.end(), std::back_inserter(set(BenchmarkRays::shadow).batches));
  return sets;
}

RayRecord record_of(const RaySet& rays) {
  const bool coherent = rays.coherence == Coherence::coherent;
  const RayClass ray_class = rays.occlusion ? (coherent ? RayClass::coherent_occlusion : RayClass::incoherent_occlusion)
                                            : (coherent ? RayClass::coherent_nearest : RayClass::incoherent_nearest);
  RayRecord record;
  for (const RayBatch& batch : rays.batches) {
    record.batches.push_back({ray_class, record.rays.size(), batch.size});
    for (std::size_t i = 0; i < batch.size; ++i)
      record.rays.push_back({batch.origin(i), batch.direction(i), batch.max_distance[i]});
  }
  return record;
}

ReplayCalls calls_of(const EmbreeIntersector& embree, Coherence coherence) {
  ReplayCalls calls;
  const bool together = embree.follows_packets_together();
  calls.fill(together && coherence == Coherence::mixed ? ReplayCall::told_packets : ReplayCall::incoherent_packets);
  if (together)
    for (const RayClass coherent : {RayClass::coherent_nearest, RayClass::coherent_occlusion})
      calls[static_cast<std::size_t>(coherent)] = ReplayCall::coherent_packets;
  return calls;
}

PassResult timed_pass(const RaySet& rays, int threads, const AskBatch& ask, const LookAtBatch& look) {
  std::vector<PassResult> results(rays.batches.size());
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.batches.size(), 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        thread_local HitBatch hits(kBenchmarkBatch);
                        thread_local std::vector<std::uint8_t> occluded(kBenchmarkBatch + kBatchPadding);
                        const FlushDenormals flush;
                        for (std::size_t i = range.begin(); i != range.end(); ++i) {
                          results[i].seconds = ask(i, hits, occluded.data());
                          if (rays.occlusion)
                            look_at_occlusion(rays.batches[i], occluded.data(), results[i]);
                          else
                            look_at_hits(rays.batches[i], hits, results[i]);
                          if (look) look(i, hits, occluded.data());
                        }
                      });
  });
  // In the order of the batches, whatever the threads.
  PassResult sum;
  for (const PassResult& result : results) {
    sum.seconds += result.seconds / threads;
    sum.hits += result.hits;
    sum.checksum = mixed(sum.checksum ^ result.checksum);
  }
  return sum;
}

PassResult batched_pass(const Scene& scene, const RaySet& rays, int threads) {
  return timed_pass(rays, threads, [&](std::size_t batch, HitBatch& hits, std::uint8_t* occluded) {
    return ask_tracer<WallTime>(*scene.intersector, rays, batch, hits, occluded);
  });
}

}  // namespace raytree::benchmarks
