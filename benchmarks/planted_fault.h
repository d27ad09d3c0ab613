// Faults planted in the fast tracer, to see that what compares it notices them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/ray_intersector.h"
#include "geometry/shape_set.h"

namespace raytree::benchmarks {

/// A tracer that alters what another one says of a ray.
class FaultyTracer final : public RayIntersector {
 public:
  /// What it says of a ray that hits: given the sound tracer, origin, direction, end and the sound hit. Must not throw.
  using Fault = std::function<Hit(const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end,
                                  const Hit& hit)>;
  FaultyTracer(std::unique_ptr<const RayIntersector> tracer, Fault fault)
      : tracer_(std::move(tracer)), fault_(std::move(fault)) {}

  /// What lies behind a distance on a ray.
  static Hit behind(const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, float from);

  void intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept override;
  void occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept override;
  std::size_t memory_bytes() const noexcept override { return tracer_->memory_bytes(); }
  std::size_t peak_memory_bytes() const noexcept override { return tracer_->peak_memory_bytes(); }

 private:
  std::unique_ptr<const RayIntersector> tracer_;
  Fault fault_;
};

struct PlantedFault {
  const char* name;         ///< on the command line
  const char* description;  ///< one line
  /// Over the shapes of the tracer, which must outlive it.
  FaultyTracer::Fault (*make)(const ShapeSet& shapes);
};
/// All that work on any scene: those that concern triangles do nothing where a scene has none.
const std::vector<PlantedFault>& planted_faults();

}  // namespace raytree::benchmarks
