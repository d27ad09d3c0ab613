#include "renderer/ray_queue.h"

#include <utility>

namespace raytree {
namespace {

/// Calls visit(array of a, array of b) for each array.
template <class A, class B, class Visit>
void for_each_array(A& a, B& b, Visit&& visit) {
  visit(a.origin_x, b.origin_x), visit(a.origin_y, b.origin_y), visit(a.origin_z, b.origin_z);
  visit(a.direction_x, b.direction_x), visit(a.direction_y, b.direction_y), visit(a.direction_z, b.direction_z);
  visit(a.weight_r, b.weight_r), visit(a.weight_g, b.weight_g), visit(a.weight_b, b.weight_b);
  visit(a.allowance, b.allowance), visit(a.level, b.level);
  visit(a.sample, b.sample), visit(a.media, b.media);
}

}  // namespace

RayBatch RayArrays::as_batch() {
  RayBatch rays(kBatchSize, {origin_x, origin_y, origin_z}, {direction_x, direction_y, direction_z});
  rays.sample = sample;
  return rays;
}

void RayQueue::reserve(std::size_t capacity) {
  // Eleven arrays of four bytes and two of two.
  constexpr std::size_t kArrays = 12;
  const std::size_t padded = detail::padded_capacity(capacity);
  auto storage = detail::batch_storage(kArrays, padded);
  std::byte* next = storage.get();
  Arrays moved;
  for_each_array(moved, arrays_, [&]<class Element>(Element*& array, const Element* from) {
    array = reinterpret_cast<Element*>(next);
    next += padded * sizeof(Element);
    std::copy_n(from, size_, array);
  });
  arrays_ = moved;
  storage_ = std::move(storage);
  capacity_ = capacity;
}

template <class Added>
void RayQueue::append(const Added& added, std::size_t count) {
  if (size_ + count > capacity_) reserve(std::max(size_ + count, 2 * capacity_));
  for_each_array(arrays_, added,
                 [&]<class Element>(Element* array, const Element* from) { std::copy_n(from, count, array + size_); });
  size_ += count;
}

void RayQueue::take(RayArrays& added) {
  append(added, added.size);
  added.size = 0;
}

void RayQueue::take(RayQueue& added) {
  append(added.arrays_, added.size_);
  added.size_ = 0;
}

void RayQueue::pop(RayArrays& newest) {
  newest.size = std::min(size_, kBatchSize);
  size_ -= newest.size;
  for_each_array(arrays_, newest, [&]<class Element>(const Element* array, Element* to) {
    std::copy_n(array + size_, newest.size, to);
  });
}

}  // namespace raytree
