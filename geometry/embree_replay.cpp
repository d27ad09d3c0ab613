#include "geometry/embree_replay.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "geometry/embree_packets.h"
#include "geometry/embree_state.h"
#include "geometry/few_shapes.h"
#include "geometry/stopwatch.h"

namespace raytree {
namespace {

using embree::PacketTypes;
using embree::Query;
using Ray = RayRecord::Ray;

/// Rays per look at the clock: their packets stay in the first-level cache, and a look (some 25 ns) is under 1 % of
/// what tracing them takes.
constexpr std::size_t kReplayBlock = 256;

/// Rays that make a chunk: a few tiles' work.
constexpr std::size_t kChunk = 16384;

/// Room for one block's packets of any kind.
template <int Width>
struct Workspace {
  static constexpr std::size_t kPackets = kReplayBlock / Width;
  alignas(64) int valid[kPackets][Width];
  bool alike[kPackets];  ///< of told_packets
  alignas(64) typename PacketTypes<Width>::RayHit ray_hits[kPackets];
  alignas(64) typename PacketTypes<Width>::Ray rays[kPackets];
  alignas(64) RTCRayHit single_ray_hits[kReplayBlock];
  alignas(64) RTCRay single_rays[kReplayBlock];
};

template <int Width>
class Replayer {
 public:
  Replayer(RTCScene scene, Workspace<Width>& work) : scene_(scene), work_(work) {}

  double nearest(const Ray* rays, const std::uint8_t* stopped_before, std::size_t size, ReplayCall call,
                 std::uint64_t& hits) {
    Query query(call == ReplayCall::coherent_packets);
    double seconds = 0;
    const auto stopped = [&](std::size_t i) { return stopped_before != nullptr && stopped_before[i] != 0; };
    if (call == ReplayCall::single_rays) {
      for (std::size_t i = 0; i < size; ++i)
        work_.single_ray_hits[i] = embree::single_ray_hit(rays[i].origin, rays[i].direction, rays[i].max_distance);
      const auto start = Clock::now();
      for (std::size_t i = 0; i < size; ++i) query.intersect(scene_, work_.single_ray_hits[i]);
      seconds = seconds_since(start);
      for (std::size_t i = 0; i < size; ++i)
        hits += work_.single_ray_hits[i].hit.geomID != RTC_INVALID_GEOMETRY_ID || stopped(i);
      return seconds;
    }
    const std::size_t packets = fill(rays, size, [&](std::size_t packet, int lane, const Ray& ray) {
      embree::set_lane(work_.ray_hits[packet].ray, lane, ray.origin, ray.direction, ray.max_distance);
      embree::clear_hit(work_.ray_hits[packet].hit, lane);
    });
    seconds = timed(
        packets, call, query, [&](std::size_t p) -> auto& { return work_.ray_hits[p].ray; },
        [&](std::size_t p) { query.intersect(scene_, work_.valid[p], work_.ray_hits[p]); });
    for (std::size_t i = 0; i < size; ++i)
      hits += work_.ray_hits[i / Width].hit.geomID[i % Width] != RTC_INVALID_GEOMETRY_ID || stopped(i);
    return seconds;
  }

  double occlusion(const Ray* rays, const std::uint8_t* stopped_before, std::size_t size, ReplayCall call,
                   std::uint64_t& hits) {
    Query query(call == ReplayCall::coherent_packets);
    double seconds = 0;
    const auto stopped = [&](std::size_t i) { return stopped_before != nullptr && stopped_before[i] != 0; };
    if (call == ReplayCall::single_rays) {
      for (std::size_t i = 0; i < size; ++i)
        work_.single_rays[i] = embree::single_ray(rays[i].origin, rays[i].direction, rays[i].max_distance);
      const auto start = Clock::now();
      for (std::size_t i = 0; i < size; ++i) query.occluded(scene_, work_.single_rays[i]);
      seconds = seconds_since(start);
      for (std::size_t i = 0; i < size; ++i) hits += work_.single_rays[i].tfar < 0 || stopped(i);
      return seconds;
    }
    const std::size_t packets = fill(rays, size, [&](std::size_t packet, int lane, const Ray& ray) {
      embree::set_lane(work_.rays[packet], lane, ray.origin, ray.direction, ray.max_distance);
    });
    seconds = timed(
        packets, call, query, [&](std::size_t p) -> auto& { return work_.rays[p]; },
        [&](std::size_t p) { query.occluded(scene_, work_.valid[p], work_.rays[p]); });
    for (std::size_t i = 0; i < size; ++i) hits += work_.rays[i / Width].tfar[i % Width] < 0 || stopped(i);
    return seconds;
  }

 private:
  /// Seconds of asking for packets [0, packets).
  template <class RaysOf, class Ask>
  double timed(std::size_t packets, ReplayCall call, Query& query, const RaysOf& rays_of, const Ask& ask) {
    if (call != ReplayCall::told_packets) {
      const auto start = Clock::now();
      for (std::size_t p = 0; p < packets; ++p) ask(p);
      return seconds_since(start);
    }
    for (std::size_t p = 0; p < packets; ++p) work_.alike[p] = embree::runs_alike<Width>(rays_of(p), Width);
    const auto start = Clock::now();
    for (std::size_t p = 0; p < packets; ++p) {
      query.set_coherent(work_.alike[p]);
      ask(p);
    }
    return seconds_since(start);
  }

  template <class SetLane>
  std::size_t fill(const Ray* rays, std::size_t size, SetLane&& set) {
    const std::size_t packets = (size + Width - 1) / Width;
    for (std::size_t i = 0; i < packets * Width; ++i) {
      set(i / Width, static_cast<int>(i % Width), rays[std::min(i, size - 1)]);
      work_.valid[i / Width][i % Width] = i < size ? -1 : 0;
    }
    return packets;
  }

  RTCScene scene_;
  Workspace<Width>& work_;
};

template <int Width>
double replay_block(RTCScene scene, const Ray* rays, const std::uint8_t* stopped_before, std::size_t size,
                    RayClass ray_class, ReplayCall call, std::uint64_t& hits) {
  thread_local Workspace<Width> work;
  Replayer<Width> replayer(scene, work);
  return is_occlusion(ray_class) ? replayer.occlusion(rays, stopped_before, size, call, hits)
                                 : replayer.nearest(rays, stopped_before, size, call, hits);
}

}  // namespace

std::array<std::uint64_t, kRayClassCount> RayRecord::ray_counts() const {
  std::array<std::uint64_t, kRayClassCount> counts{};
  for (const Batch& batch : batches) counts[static_cast<std::size_t>(batch.ray_class)] += batch.size;
  return counts;
}

double ReplayTally::total_seconds() const { return std::accumulate(seconds.begin(), seconds.end(), 0.0); }

ReplayTally& ReplayTally::operator+=(const ReplayTally& other) {
  for (std::size_t i = 0; i < kRayClassCount; ++i) seconds[i] += other.seconds[i], hits[i] += other.hits[i];
  return *this;
}

BareReplay::BareReplay(const EmbreeIntersector& intersector, const RayRecord& record) : intersector_(intersector) {
  rays_.reserve(record.rays.size());
  std::size_t first = 0, size = 0;
  for (std::size_t i = 0; i < record.batches.size(); ++i) {
    const RayRecord::Batch& batch = record.batches[i];
    if (size >= kChunk && batch.ray_class == RayClass::coherent_nearest) {
      add_chunk(record, first, i);
      first = i, size = 0;
    }
    size += batch.size;
  }
  if (first < record.batches.size()) add_chunk(record, first, record.batches.size());
}

void BareReplay::add_chunk(const RayRecord& record, std::size_t first_batch, std::size_t last_batch) {
  Chunk chunk{segments_.size(), 0};
  for (std::size_t c = 0; c < kRayClassCount; ++c) {
    const auto ray_class = static_cast<RayClass>(c);
    // Eye rays come in blocks of pixels that fill packets: joining batches would shift them out of their packets.
    const bool joins = ray_class != RayClass::coherent_nearest;
    for (std::size_t i = first_batch; i < last_batch; ++i) {
      const RayRecord::Batch& batch = record.batches[i];
      if (batch.ray_class != ray_class) continue;
      const bool continues = joins && segments_.size() > chunk.first_segment && segments_.back().ray_class == ray_class;
      if (!continues) segments_.push_back({ray_class, rays_.size(), 0});
      append(record, batch);
      segments_.back().size = rays_.size() - segments_.back().first;
    }
  }
  chunk.segment_count = segments_.size() - chunk.first_segment;
  chunks_.push_back(chunk);
}

void BareReplay::append(const RayRecord& record, const RayRecord::Batch& batch) {
  const FewShapes& few = intersector_.state_->few;
  for (std::size_t i = batch.first; i < batch.first + batch.size; ++i) {
    Ray ray = record.rays[i];
    if (!embree::traceable(ray.origin, ray.direction, ray.max_distance)) continue;
    const Hit nearest = intersect_few(few, ray.origin, ray.direction, ray.max_distance);
    // The intersector shortens rays that look for the nearest hit, and asks for the whole of a shadow ray.
    if (!is_occlusion(batch.ray_class)) ray.max_distance = nearest.distance;
    rays_.push_back(ray);
    if (few.any()) stopped_.push_back(nearest.geometry != kNoGeometry);
  }
}

void BareReplay::replay(std::size_t chunk, const ReplayCalls& calls, ReplayTally& tally) const noexcept {
  const EmbreeIntersector::State& state = *intersector_.state_;
  const Segment* segment = segments_.data() + chunks_[chunk].first_segment;
  for (std::size_t s = 0; s < chunks_[chunk].segment_count; ++s, ++segment) {
    const auto c = static_cast<std::size_t>(segment->ray_class);
    for (std::size_t done = 0; done < segment->size; done += kReplayBlock) {
      const std::size_t at = segment->first + done, size = std::min(kReplayBlock, segment->size - done);
      const std::uint8_t* stopped = stopped_.empty() ? nullptr : stopped_.data() + at;
      const auto run = state.wide ? replay_block<8> : replay_block<4>;
      tally.seconds[c] +=
          run(state.scene.get(), rays_.data() + at, stopped, size, segment->ray_class, calls[c], tally.hits[c]);
    }
  }
}

int BareReplay::packet_width() const { return intersector_.state_->wide ? 8 : 4; }

}  // namespace raytree
