#include "geometry/ray_batch.h"

#include <algorithm>
#include <cstring>

namespace raytree {
namespace detail {

std::unique_ptr<std::byte[], AlignedDelete> batch_storage(std::size_t arrays, std::size_t padded) {
  const std::size_t bytes = arrays * padded * 4;
  auto* block = static_cast<std::byte*>(::operator new[](bytes, std::align_val_t(kBatchAlignment)));
  std::memset(block, 0, bytes);
  return std::unique_ptr<std::byte[], AlignedDelete>(block);
}

}  // namespace detail

RayBatch::RayBatch(std::size_t capacity)
    : capacity_(capacity), storage_(detail::batch_storage(7, detail::padded_capacity(capacity))) {
  auto* next = reinterpret_cast<float*>(storage_.get());
  for (float** array : {&origin_x, &origin_y, &origin_z, &direction_x, &direction_y, &direction_z, &max_distance}) {
    *array = next;
    next += detail::padded_capacity(capacity);
  }
}

RayBatch::RayBatch(std::size_t capacity, float* const (&origins)[3], float* const (&directions)[3])
    : origin_x(origins[0]),
      origin_y(origins[1]),
      origin_z(origins[2]),
      direction_x(directions[0]),
      direction_y(directions[1]),
      direction_z(directions[2]),
      capacity_(capacity),
      storage_(detail::batch_storage(1, detail::padded_capacity(capacity))) {
  max_distance = reinterpret_cast<float*>(storage_.get());
  std::fill_n(max_distance, detail::padded_capacity(capacity), kInfinity);
}

HitBatch::HitBatch(std::size_t capacity)
    : capacity_(capacity), storage_(detail::batch_storage(6, detail::padded_capacity(capacity))) {
  const std::size_t padded = detail::padded_capacity(capacity);
  auto* block = reinterpret_cast<std::uint32_t*>(storage_.get());
  geometry = block;
  primitive = block + padded;
  u = reinterpret_cast<float*>(block + 2 * padded);
  v = reinterpret_cast<float*>(block + 3 * padded);
  distance = reinterpret_cast<float*>(block + 4 * padded);
  instance = block + 5 * padded;
  std::fill_n(instance, padded, kNoInstance);
}

}  // namespace raytree
