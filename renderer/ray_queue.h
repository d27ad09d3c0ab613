// Rays of the tree that wait for their turn, structure of arrays, so that batches of them move as whole arrays.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "geometry/ray_batch.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/media.h"

namespace raytree {

/// What a ray of the tree carries beside its origin and direction.
struct RayContext {
  Rgb weight;            ///< of what the ray brings in its sample
  float allowance;       ///< what may still be cut off below it, radiance
  std::uint32_t level;   ///< an eye ray's is 1
  std::uint16_t sample;  ///< in the chunk
  MediaId media;         ///< that it is in, where media are tracked
};

/// Up to kBatchSize rays. Its arrays lie at fixed places, so that one register reaches all of them.
struct RayArrays {
  static constexpr std::size_t kSize = detail::padded_capacity(kBatchSize);

  std::size_t size = 0;
  alignas(kBatchAlignment) float origin_x[kSize];
  float origin_y[kSize], origin_z[kSize];
  float direction_x[kSize], direction_y[kSize], direction_z[kSize];
  float weight_r[kSize], weight_g[kSize], weight_b[kSize];
  float allowance[kSize];
  std::uint32_t level[kSize];
  std::uint16_t sample[kSize];
  MediaId media[kSize];

  void push(const Vec3f& origin, const Vec3f& direction, const RayContext& context) {
    const std::size_t i = size++;
    origin_x[i] = origin.x, origin_y[i] = origin.y, origin_z[i] = origin.z;
    direction_x[i] = direction.x, direction_y[i] = direction.y, direction_z[i] = direction.z;
    set_weight(i, context.weight);
    allowance[i] = context.allowance, level[i] = context.level, sample[i] = context.sample, media[i] = context.media;
  }
  Vec3f origin(std::size_t i) const { return {origin_x[i], origin_y[i], origin_z[i]}; }
  Vec3f direction(std::size_t i) const { return {direction_x[i], direction_y[i], direction_z[i]}; }
  Rgb weight(std::size_t i) const { return {weight_r[i], weight_g[i], weight_b[i]}; }
  void set_weight(std::size_t i, const Rgb& weight) {
    weight_r[i] = weight.r, weight_g[i] = weight.g, weight_b[i] = weight.b;
  }
  /// These arrays as a tracer takes them: rays that end nowhere. What it lacks is `size`, which goes by each batch.
  RayBatch as_batch();
};

/// A stack of any size: the newest rays lie at the end.
class RayQueue {
 public:
  explicit RayQueue(std::size_t capacity = 0) { reserve(std::max(capacity, kBatchSize)); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t capacity() const { return capacity_; }
  void clear() { size_ = 0; }

  /// Moves all of `added` to the end, in its order.
  void take(RayArrays& added);
  void take(RayQueue& added);
  /// Moves the newest rays, at most kBatchSize, to `newest`, in their order.
  void pop(RayArrays& newest);

 private:
  struct Arrays {
    float *origin_x, *origin_y, *origin_z;
    float *direction_x, *direction_y, *direction_z;
    float *weight_r, *weight_g, *weight_b;
    float* allowance;
    std::uint32_t* level;
    std::uint16_t* sample;
    MediaId* media;
  };
  void reserve(std::size_t capacity);
  template <class Added>
  void append(const Added& added, std::size_t count);

  Arrays arrays_ = {};
  std::size_t size_ = 0, capacity_ = 0;
  std::unique_ptr<std::byte[], detail::AlignedDelete> storage_;
};

/// Rays that a batch spawns: most batches spawn no more than they hold, those of rough surfaces any number.
class SpawnedRays {
 public:
  std::size_t size() const { return older_.size() + newest_->size; }
  bool empty() const { return size() == 0; }
  void push(const Vec3f& origin, const Vec3f& direction, const RayContext& context) {
    if (newest_->size == kBatchSize) older_.take(*newest_);
    newest_->push(origin, direction, context);
  }
  /// Moves all of them to the end of `queue`, in their order.
  void move_to(RayQueue& queue) {
    if (!older_.empty()) queue.take(older_);
    queue.take(*newest_);
  }

 private:
  RayQueue older_;
  std::unique_ptr<RayArrays> newest_ = std::make_unique<RayArrays>();
};

}  // namespace raytree
