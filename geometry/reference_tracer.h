// The truth that fast tracers are compared with: one ray at a time, in double, slowly and plainly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "geometry/ray_batch.h"
#include "geometry/vec.h"

namespace raytree {

inline constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

/// Nearest hit of a ray, scene space. geometry, primitive and instance are numbered as those of Hit (ray_batch.h), so
/// that hits of fast tracers can be compared with it one by one.
struct ReferenceHit {
  GeometryId geometry = kNoGeometry;  ///< kNoGeometry: a miss
  std::uint32_t primitive = 0;  ///< sphere, disc, plane, cone; of meshes the triangle (facet) that stands for the point
  std::uint32_t face =
      kNoFace;          ///< of meshes: n-gon, or face of the curved surface; kNoFace where triangles are the truth
  double u = 0, v = 0;  ///< of meshes: weights of the triangle's corner 1 and corner 2
  double distance = std::numeric_limits<double>::infinity();
  Vec3d normal{0, 0, 0};  ///< unit, of the true surface (not shading's), to the outside
  InstanceId instance = kNoInstance;

  bool hit() const { return geometry != kNoGeometry; }
};

class ReferenceTracer {
 public:
  virtual ~ReferenceTracer() = default;

  /// Nearest hit within [0, max_distance]. The direction need not be unit; distances are in its lengths.
  virtual ReferenceHit nearest(const Vec3d& origin, const Vec3d& direction, double max_distance) const = 0;

  /// Whether there is any hit within [0, max_distance]: as nearest(), for tracers that find that sooner.
  virtual bool is_occluded(const Vec3d& origin, const Vec3d& direction, double max_distance) const {
    return nearest(origin, direction, max_distance).hit();
  }

  /// Bytes of the tracer's own structures, and of all that it held while it built them; 0: it has none.
  virtual std::size_t memory_bytes() const noexcept { return 0; }
  virtual std::size_t peak_memory_bytes() const noexcept { return memory_bytes(); }
};

}  // namespace raytree
