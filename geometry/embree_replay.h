// Rays that were recorded, asked again of Embree alone: packets are filled outside the clock, so what is timed is
// Embree's calls and nothing of ours. The floor that the benchmark `floor` holds the renderer to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/embree_intersector.h"
#include "geometry/vec.h"

namespace raytree {

/// What a batch asks and what its caller knows of it: the class that decides the call a ray gets.
enum class RayClass : std::uint8_t { coherent_nearest, incoherent_nearest, coherent_occlusion, incoherent_occlusion };
inline constexpr std::size_t kRayClassCount = 4;

constexpr bool is_occlusion(RayClass c) {
  return c == RayClass::coherent_occlusion || c == RayClass::incoherent_occlusion;
}

/// Every ray that went through a seam, batch by batch in the order of the calls.
struct RayRecord {
  struct Ray {
    Vec3f origin, direction;  ///< scene space; direction unit
    float max_distance;
  };
  struct Batch {
    RayClass ray_class;
    std::size_t first, size;  ///< of rays
  };
  std::vector<Ray> rays;
  std::vector<Batch> batches;
  std::array<std::uint64_t, kRayClassCount> hits{};  ///< nearest hits; occluded rays

  std::array<std::uint64_t, kRayClassCount> ray_counts() const;
};

/// The ways to ask Embree for a class of rays; told_packets: coherent where a packet's rays run alike, as the
/// intersector tells packets of Coherence::mixed, looked at outside the clock.
enum class ReplayCall : std::uint8_t { coherent_packets, incoherent_packets, told_packets, single_rays };
inline constexpr std::size_t kReplayCallCount = 4;
using ReplayCalls = std::array<ReplayCall, kRayClassCount>;

struct ReplayTally {
  std::array<double, kRayClassCount> seconds{};  ///< inside Embree's calls
  std::array<std::uint64_t, kRayClassCount> hits{};

  double total_seconds() const;
  ReplayTally& operator+=(const ReplayTally& other);
};

/// Replays a record on the scene of an intersector, which must outlive it.
///
/// Packets are never smaller than those of the recorded run: eye rays keep the packets of their batches, all other
/// classes are joined over the work of a few tiles, which fills packets that the run had to leave part empty. Rays
/// that are not finite are left out, since the intersector asks Embree for none of them; planes and other shapes that
/// Embree does not hold shorten the rays outside the clock as the intersector shortens them inside its own.
class BareReplay {
 public:
  BareReplay(const EmbreeIntersector& intersector, const RayRecord& record);

  /// Pieces of the record, each about the work of a few tiles: the unit that threads share out.
  std::size_t chunk_count() const { return chunks_.size(); }

  /// Asks one chunk's rays again, each class by its call, and adds time and hits to `tally`. Denormals should be
  /// flushed on the calling thread, as they are while rendering.
  void replay(std::size_t chunk, const ReplayCalls& calls, ReplayTally& tally) const noexcept;

  /// Rays in a packet: 8, or 4 where the processor has no more.
  int packet_width() const;

 private:
  struct Segment {
    RayClass ray_class;
    std::size_t first, size;
  };
  struct Chunk {
    std::size_t first_segment, segment_count;
  };
  void add_chunk(const RayRecord& record, std::size_t first_batch, std::size_t last_batch);
  void append(const RayRecord& record, const RayRecord::Batch& batch);

  const EmbreeIntersector& intersector_;
  std::vector<RayRecord::Ray> rays_;
  std::vector<std::uint8_t> stopped_;  ///< rays that a shape outside Embree stops; [rays_] where there are such
  std::vector<Segment> segments_;
  std::vector<Chunk> chunks_;
};

}  // namespace raytree
