// The array type of large geometry: a std::vector whose new elements are not zeroed and whose storage ends
// with 16 readable bytes more, since Embree reads a vertex with one 16-byte load.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace raytree {

inline constexpr std::size_t kBufferPadding = 16;  ///< readable bytes after the last element

/// Allocator that default-initialises (resize() touches no page) and pads every block by kBufferPadding bytes.
template <class T>
class PaddedAllocator {
 public:
  using value_type = T;

  PaddedAllocator() = default;
  template <class U>
  PaddedAllocator(const PaddedAllocator<U>&) noexcept {}  // NOLINT: converting by design of allocators

  T* allocate(std::size_t count) {
    if (count > (std::size_t(-1) / 2 - kBufferPadding) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(::operator new(count * sizeof(T) + kBufferPadding, std::align_val_t(64)));
  }
  void deallocate(T* block, std::size_t) noexcept { ::operator delete(block, std::align_val_t(64)); }

  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0)
      ::new (static_cast<void*>(place)) U;
    else
      ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const PaddedAllocator&, const PaddedAllocator&) { return true; }
};

template <class T>
using Buffer = std::vector<T, PaddedAllocator<T>>;

/// Bytes of an array's elements.
template <class Array>
std::size_t array_bytes(const Array& array) {
  return array.size() * sizeof(array[0]);
}

}  // namespace raytree
