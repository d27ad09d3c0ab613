// Batches of rays and of hits, structure of arrays: what flows through the seam (ray_intersector.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>

#include "geometry/vec.h"

namespace raytree {

inline constexpr std::size_t kBatchAlignment = 64;  ///< bytes; every array of a batch begins on such a border
inline constexpr std::size_t kBatchPadding = 16;    ///< a batch may be read in full packets of up to so many rays

inline constexpr std::size_t kBatchSize = 1024;  ///< rays that the ray tree has in flight at once

/// Pixels whose eye rays fill a packet of eight: batches of eye rays come block by block.
inline constexpr int kBlockWidth = 4, kBlockHeight = 2;

namespace detail {
struct AlignedDelete {
  void operator()(std::byte* block) const { ::operator delete[](block, std::align_val_t(kBatchAlignment)); }
};
/// Elements of an array that holds `capacity` and the padding behind them.
constexpr std::size_t padded_capacity(std::size_t capacity) { return (capacity / kBatchPadding + 1) * kBatchPadding; }
/// Zeroed storage of `arrays` arrays of `padded` 4-byte elements.
std::unique_ptr<std::byte[], AlignedDelete> batch_storage(std::size_t arrays, std::size_t padded);
}  // namespace detail

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();  ///< end of a ray that nothing ends

/// Largest coordinate of a ray's origin and direction that tracers need take; Embree is not asked about larger ones.
/// Beyond it squares leave single precision, and Embree built with its assertions ends the process at 1.844e18. Scenes
/// are refused beyond it too (renderer/scene_fields.h); rays get there from planes, which have no end.
inline constexpr float kFarthestRay = 1e18f;

/// Rays, scene space (world relative to the scene's origin). Each starts at its origin (no least distance: origins are
/// offset from the surface they leave) and ends at max_distance, infinity for none. Directions are unit.
class RayBatch {
 public:
  explicit RayBatch(std::size_t capacity);
  /// Up to `capacity` rays that end nowhere, whose origins and directions (x, y, z) are the caller's: arrays as long as
  /// capacity and the padding, which must outlive it.
  RayBatch(std::size_t capacity, float* const (&origins)[3], float* const (&directions)[3]);

  std::size_t capacity() const { return capacity_; }

  std::size_t size = 0;
  float *origin_x, *origin_y, *origin_z;
  float *direction_x, *direction_y, *direction_z;
  float* max_distance;
  /// [size] Which of the samples under way each ray is traced for; null: none. Tracers answer without it: it is for
  /// those that keep account of rays.
  const std::uint16_t* sample = nullptr;

  void set(std::size_t i, const Vec3f& origin, const Vec3f& direction, float end) {
    origin_x[i] = origin.x, origin_y[i] = origin.y, origin_z[i] = origin.z;
    direction_x[i] = direction.x, direction_y[i] = direction.y, direction_z[i] = direction.z;
    max_distance[i] = end;
  }
  void push(const Vec3f& origin, const Vec3f& direction, float end) { set(size++, origin, direction, end); }
  Vec3f origin(std::size_t i) const { return {origin_x[i], origin_y[i], origin_z[i]}; }
  Vec3f direction(std::size_t i) const { return {direction_x[i], direction_y[i], direction_z[i]}; }

 private:
  std::size_t capacity_;
  std::unique_ptr<std::byte[], detail::AlignedDelete> storage_;
};

/// Which geometry a hit lies on. Spheres, discs, planes and cones of a scene form one geometry each; meshes follow.
using GeometryId = std::uint32_t;
inline constexpr GeometryId kSphereGeometry = 0;
inline constexpr GeometryId kDiscGeometry = 1;
inline constexpr GeometryId kPlaneGeometry = 2;
inline constexpr GeometryId kConeGeometry = 3;
inline constexpr GeometryId kFirstMeshGeometry = 4;
inline constexpr GeometryId kNoGeometry = std::numeric_limits<GeometryId>::max();

/// Which use of a group a hit lies on: an index into ShapeSet::instances. Geometry and primitive are then the group's.
using InstanceId = std::uint32_t;
inline constexpr InstanceId kNoInstance = std::numeric_limits<InstanceId>::max();

struct Hit {
  GeometryId geometry = kNoGeometry;
  std::uint32_t primitive = 0;  ///< triangle, sphere, disc, plane or cone of the geometry
  float u = 0, v = 0;           ///< triangles: weights of corner 1 and corner 2; slightly outside [0, 1] at edges
  float distance = 0;
  InstanceId instance = kNoInstance;
};

/// Nearest hits, one per ray of the batch asked about. A miss has geometry kNoGeometry.
class HitBatch {
 public:
  explicit HitBatch(std::size_t capacity);

  std::size_t capacity() const { return capacity_; }

  GeometryId* geometry;
  std::uint32_t* primitive;
  float *u, *v;
  float* distance;
  InstanceId* instance;  ///< kNoInstance where a hit lies on no instance

  /// Tracers of scenes with instances write every ray's and say so; others leave them at kNoInstance, which costs
  /// nothing unless the batch came from a scene with instances.
  void begin_instances() { has_instances_ = true; }
  void clear_instances() {
    if (has_instances_) std::fill_n(instance, capacity_, kNoInstance);
    has_instances_ = false;
  }

  Hit operator[](std::size_t i) const { return {geometry[i], primitive[i], u[i], v[i], distance[i], instance[i]}; }
  void set(std::size_t i, const Hit& hit) {
    geometry[i] = hit.geometry, primitive[i] = hit.primitive, u[i] = hit.u, v[i] = hit.v, distance[i] = hit.distance;
    instance[i] = hit.instance;
  }

 private:
  std::size_t capacity_;
  bool has_instances_ = false;
  std::unique_ptr<std::byte[], detail::AlignedDelete> storage_;
};

}  // namespace raytree
