// The seam: batches of rays in, nearest hits or occlusion out. One integrator serves every tracer behind it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/ray_batch.h"

namespace raytree {

/// What the caller knows of a batch. It decides the call a ray gets and, with it, the bits of its hit: so it is a
/// function of the ray's class and, for mixed batches, of the rays beside it.
enum class Coherence : std::uint8_t {
  coherent,   ///< neighbours are alike: eye rays in pixel order, shadow rays toward one light
  mixed,      ///< reflected, refracted: some neighbours are alike, some not; judged packet by packet
  incoherent  ///< neighbours have nothing in common
};

class RayIntersector {
 public:
  virtual ~RayIntersector() = default;

  /// Nearest hit of each ray into hits[0, rays.size). A ray that is not finite misses; one with a number
  /// beyond kFarthestRay may miss. hits must hold rays.size.
  virtual void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept = 0;

  /// Whether anything lies between origin and max_distance: occluded[0, rays.size) becomes 1 or 0. The array must
  /// have room for kBatchPadding more.
  virtual void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept = 0;

  /// Bytes that the tracer's own structures hold, and held at most while they were built.
  virtual std::size_t memory_bytes() const noexcept = 0;
  virtual std::size_t peak_memory_bytes() const noexcept = 0;
};

}  // namespace raytree
