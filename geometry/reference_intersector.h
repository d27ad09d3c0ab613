// A reference tracer behind the seam: batches of rays, one after the other, so that whole pictures can be made with it.
#pragma once

#include <memory>

#include "geometry/ray_intersector.h"
#include "geometry/reference_tracer.h"

namespace raytree {

/// Each ray's bits go to the tracer as they are, and its answer is rounded to single precision: a ray's hit depends on
/// that ray alone, whatever its batch and coherence.
class ReferenceIntersector final : public RayIntersector {
 public:
  explicit ReferenceIntersector(std::unique_ptr<const ReferenceTracer> tracer) : tracer_(std::move(tracer)) {}

  const ReferenceTracer& tracer() const { return *tracer_; }

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override { return tracer_->memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_->peak_memory_bytes(); }

 private:
  std::unique_ptr<const ReferenceTracer> tracer_;
};

}  // namespace raytree
