// Floats as halfs, as pictures want them: what is finite stays finite.
#pragma once

#include <Imath/half.h>

#include <cmath>
#include <cstdint>

namespace raytree::image_io {

inline constexpr float kLargestHalf = 65504;

/// The half nearest to `value`; a finite one beyond the largest half becomes that and is counted. Infinity stays
/// (depth: nothing hit), and so does NaN.
inline Imath::half clamped_half(float value, std::int64_t& clamped) {
  if (std::isfinite(value) && std::abs(value) > kLargestHalf) {
    value = std::copysign(kLargestHalf, value);
    ++clamped;
  }
  return Imath::half(value);
}

}  // namespace raytree::image_io
