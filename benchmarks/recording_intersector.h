// A tracer that notes every batch of rays on its way to another one.
#pragma once

#include <mutex>

#include "geometry/embree_replay.h"
#include "geometry/ray_intersector.h"
#include "renderer/render.h"

namespace raytree::benchmarks {

/// Batches are noted in the order in which they come, under a lock: record on one thread to have the order of tiles.
class RecordingIntersector final : public RayIntersector {
 public:
  /// `tracer` must outlive it.
  explicit RecordingIntersector(const RayIntersector& tracer) : tracer_(tracer) {}

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override { return tracer_.memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_.peak_memory_bytes(); }

  RayRecord take() { return std::move(record_); }

 private:
  void note(const RayBatch& rays, RayClass ray_class, std::uint64_t hits) const;

  const RayIntersector& tracer_;
  mutable std::mutex mutex_;
  mutable RayRecord record_;
};

/// Every ray of a render of `scene` on one thread, and what the render counted.
struct RecordedRender {
  RayRecord record;
  RenderStatistics statistics;
};
RecordedRender record_render(Scene& scene);

/// The scene's tracer, which is Embree's unless a benchmark put another in its place.
const EmbreeIntersector& embree_of(const Scene& scene);

/// Embree over the scene's shapes with all but planes in it, as anyone would build it: what bare calls are made on.
std::unique_ptr<EmbreeIntersector> plain_embree(const Scene& scene);

/// The prepared scene with a tracer built anew with other options.
Scene with_tracer(Scene scene, const EmbreeOptions& options);

}  // namespace raytree::benchmarks
