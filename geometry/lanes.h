// Loops over one register of rays: what kernels over batches read and write. Results are gathered in arrays of their
// own, which nothing else can point to, so that the loop between is vectorized.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "geometry/ray_batch.h"
#include "geometry/vec.h"

namespace raytree {

/// Rays that are looked at together: one single-precision register of them.
inline constexpr std::size_t kLanes = 8;
static_assert(kBatchPadding % kLanes == 0, "the last block of a batch reaches into the padding");

using Lanes = float[kLanes];

/// The same as one vector, for what g++ 12 does not vectorize of itself. Passed by reference: without AVX, what a
/// register does not hold has no settled way of being passed by value.
typedef float LaneVector __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::uint32_t IntegerLaneVector __attribute__((vector_size(kLanes * sizeof(std::uint32_t))));

struct Vec3Lanes {
  Lanes x, y, z;

  Vec3f operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(std::size_t lane, const Vec3f& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
  void fill(const Vec3f& v) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) set(lane, v);
  }
};

template <class Element>
void store_lanes(const Element (&values)[kLanes], Element* array) {
  std::memcpy(array, values, sizeof(values));
}

/// Vectors of a batch by component, at fixed places, so that one register reaches all of them.
struct Vec3Array {
  static constexpr std::size_t kSize = detail::padded_capacity(kBatchSize);
  alignas(kBatchAlignment) float x[kSize];
  float y[kSize], z[kSize];

  Vec3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  void store(std::size_t first, const Vec3Lanes& lanes) {
    store_lanes(lanes.x, x + first);
    store_lanes(lanes.y, y + first);
    store_lanes(lanes.z, z + first);
  }
};

/// The components of vectors wherever they stand.
template <class Float>
struct Vec3Pointers {
  Float *x, *y, *z;

  Vec3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void store(std::size_t first, const Vec3Lanes& lanes) const {
    store_lanes(lanes.x, x + first);
    store_lanes(lanes.y, y + first);
    store_lanes(lanes.z, z + first);
  }
};

}  // namespace raytree
