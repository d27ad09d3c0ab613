// Planes of pixels to the interleaved rows that file formats store.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "renderer/image_io/image_io.h"

namespace raytree::image_io {

/// Bytes of a value of this RaytreePixelType; 0 for what is none.
inline std::size_t pixel_size(int type) {
  switch (type) {
    case kRaytreeUint8:
      return 1;
    case kRaytreeUint16:
    case kRaytreeHalf:
      return 2;
    case kRaytreeFloat32:
    case kRaytreeUint32:
      return 4;
    default:
      return 0;
  }
}

/// Copies pixels [begin, begin + count) of a plane to every `stride`th byte of `target`, in the file's type: as they
/// are, or from float in [0, 1] to 8 or 16 bits, rounded. Throws std::runtime_error where the types do not fit.
inline void convert_row(const RaytreePlane& plane, std::size_t begin, std::size_t count, std::byte* target,
                        std::size_t stride) {
  const auto store = [&](auto value, std::size_t i) { std::memcpy(target + i * stride, &value, sizeof value); };
  if (plane.type == plane.source_type) {
    const std::size_t size = pixel_size(plane.type);
    const auto* source = static_cast<const std::byte*>(plane.pixels) + begin * size;
    const auto copy = [&](auto width) {
      for (std::size_t i = 0; i < count; ++i) std::memcpy(target + i * stride, source + i * width(), width());
    };
    // Constant widths, so that each copy is one move.
    if (size == 4)
      copy([] { return std::integral_constant<std::size_t, 4>::value; });
    else if (size == 2)
      copy([] { return std::integral_constant<std::size_t, 2>::value; });
    else
      copy([] { return std::integral_constant<std::size_t, 1>::value; });
    return;
  }
  if (plane.source_type == kRaytreeFloat32 && (plane.type == kRaytreeUint8 || plane.type == kRaytreeUint16)) {
    const auto* source = static_cast<const float*>(plane.pixels) + begin;
    const float scale = plane.type == kRaytreeUint8 ? 255.0f : 65535.0f;
    for (std::size_t i = 0; i < count; ++i) {
      const float value = source[i] > 0 ? std::min(source[i], 1.0f) : 0.0f;  // NaN: 0
      const auto level = static_cast<std::uint16_t>(value * scale + 0.5f);
      if (plane.type == kRaytreeUint8)
        store(static_cast<std::uint8_t>(level), i);
      else
        store(level, i);
    }
    return;
  }
  throw std::runtime_error(std::string("channel ") + plane.name +
                           ": its pixels cannot be stored as the type asked for");
}

}  // namespace raytree::image_io
