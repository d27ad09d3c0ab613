// Linear Rec.709 colors and coefficients per channel. A direction is a Vec3f: the two never mix.
#pragma once

#include <algorithm>
#include <cmath>

namespace raytree {

struct Rgb {
  float r = 0, g = 0, b = 0;

  constexpr Rgb() = default;
  constexpr Rgb(float red, float green, float blue) : r(red), g(green), b(blue) {}
  constexpr explicit Rgb(float gray) : r(gray), g(gray), b(gray) {}

  constexpr Rgb& operator+=(Rgb o) { return r += o.r, g += o.g, b += o.b, *this; }
  constexpr Rgb& operator*=(Rgb o) { return r *= o.r, g *= o.g, b *= o.b, *this; }
  constexpr Rgb& operator*=(float s) { return r *= s, g *= s, b *= s, *this; }

  friend constexpr Rgb operator+(Rgb left, Rgb right) { return left += right; }
  friend constexpr Rgb operator-(Rgb left, Rgb right) { return {left.r - right.r, left.g - right.g, left.b - right.b}; }
  friend constexpr Rgb operator*(Rgb left, Rgb right) { return left *= right; }
  friend constexpr Rgb operator*(Rgb color, float factor) { return color *= factor; }
  friend constexpr Rgb operator*(float factor, Rgb color) { return color *= factor; }
  friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
};

constexpr float max_channel(Rgb c) { return std::max(c.r, std::max(c.g, c.b)); }
constexpr bool is_black(Rgb c) { return c.r == 0 && c.g == 0 && c.b == 0; }
constexpr Rgb max(Rgb a, Rgb b) { return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)}; }
constexpr Rgb mix(Rgb a, Rgb b, float t) { return a * (1 - t) + b * t; }
inline bool is_finite(Rgb c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

}  // namespace raytree
