// A reference tracer behind the seam: batches of rays, one after the other, so that whole pictures can be made with it.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "geometry/ray_intersector.h"
#include "geometry/reference_tracer.h"

namespace raytree {

/// Each ray's bits go to the tracer as they are, and its answer is rounded to single precision: a ray's hit depends on
/// that ray alone, whatever its batch and coherence. As RayIntersector's functions.
void intersect_one_by_one(const ReferenceTracer& tracer, const RayBatch& rays, HitBatch& hits) noexcept;
void occluded_one_by_one(const ReferenceTracer& tracer, const RayBatch& rays, std::uint8_t* occluded) noexcept;

/// Makes an intersector of any reference tracer.
class ReferenceIntersector final : public RayIntersector {
 public:
  explicit ReferenceIntersector(std::unique_ptr<const ReferenceTracer> tracer) : tracer_(std::move(tracer)) {}

  const ReferenceTracer& tracer() const { return *tracer_; }

  void intersect(const RayBatch& rays, Coherence, HitBatch& hits) const noexcept override {
    intersect_one_by_one(*tracer_, rays, hits);
  }
  void occluded(const RayBatch& rays, Coherence, std::uint8_t* occluded) const noexcept override {
    occluded_one_by_one(*tracer_, rays, occluded);
  }
  std::size_t memory_bytes() const noexcept override { return tracer_->memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_->peak_memory_bytes(); }

 private:
  std::unique_ptr<const ReferenceTracer> tracer_;
};

}  // namespace raytree
