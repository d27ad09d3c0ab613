// Points that fill the unit square evenly, for what one sample decides at random: the first two dimensions of Sobol's
// sequence, an Owen-scrambled copy for each key. All integers up to the last division, so that every compiler gives the
// same points; keys come from places and paths, never from an order.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/angle.h"
#include "geometry/vec.h"

namespace raytree {

/// A key whose every bit depends on every bit of both arguments (the finalizer of MurmurHash3 by A. Appleby, 64 bits).
constexpr std::uint32_t mixed_key(std::uint64_t a, std::uint64_t b) {
  std::uint64_t x = a * 0x9E3779B97F4A7C15u + b;
  x ^= x >> 33;
  x *= 0xFF51AFD7ED558CCDu;
  x ^= x >> 33;
  x *= 0xC4CEB9FE1A85EC53u;
  x ^= x >> 33;
  return static_cast<std::uint32_t>(x);
}

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = x >> 16 | x << 16;
  x = (x & 0xFF00FF00u) >> 8 | (x & 0x00FF00FFu) << 8;
  x = (x & 0xF0F0F0F0u) >> 4 | (x & 0x0F0F0F0Fu) << 4;
  x = (x & 0xCCCCCCCCu) >> 2 | (x & 0x33333333u) << 2;
  return (x & 0xAAAAAAAAu) >> 1 | (x & 0x55555555u) << 1;
}

/// Sobol's dimensions 0 and 1 at `index`, as fractions of 2^32. Dimension 0 mirrors the index's bits about the binary
/// point; the generator matrix of dimension 1 is Pascal's triangle modulo 2, whose columns follow each other by
/// v ^ v / 2. Any 2^m points from a multiple of 2^m on are a (0, m, 2)-net: each of the 2^m cells of any dyadic
/// division of the square holds one.
struct SobolPoint {
  std::uint32_t x, y;
};
constexpr SobolPoint sobol_point(std::uint32_t index) {
  SobolPoint point{reversed_bits(index), 0};
  for (std::uint32_t column = 0x80000000u; index != 0; index >>= 1, column ^= column >> 1)
    if ((index & 1) != 0) point.y ^= column;
  return point;
}

/// Owen's nested uniform scramble of a binary fraction: whether a digit is turned over depends on the key and on the
/// digits before it, so nets stay nets. By arithmetic on the mirrored bits whose carries run only one way (Laine and
/// Karras 2011, "Stratified Sampling for Stochastic Transparency"; Burley 2020, "Practical Hash-based Owen
/// Scrambling"): x * even and sums hand a bit's value to higher bits only.
constexpr std::uint32_t owen_scrambled(std::uint32_t fraction, std::uint32_t key) {
  std::uint32_t x = reversed_bits(fraction);
  x ^= x * 0x7A3D92E6u;
  x += key;
  x *= key >> 15 | 1;
  x ^= x * 0x2C1B3C6Cu;
  x ^= x * 0xA64E5B92u;
  x += mixed_key(key, 1);
  x ^= x * 0x5D9F0A34u;
  return reversed_bits(x);
}

/// Point `index` of the key's own sequence, in (0, 1)^2. The order is scrambled too (the index read as a fraction, so
/// aligned blocks of 2^m indices stay such blocks): equal indices of two keys, or of two blocks of one key, have
/// nothing to do with each other, so a sample's bounces may share one index and what is refused is redrawn without a
/// bias.
inline Vec2d low_discrepancy_point(std::uint32_t index, std::uint32_t key) {
  const std::uint32_t shuffled = owen_scrambled(index, mixed_key(key, 2));
  const SobolPoint point = sobol_point(shuffled);
  const auto unit = [](std::uint32_t fraction) { return (fraction + 0.5) * 0x1p-32; };
  return {unit(owen_scrambled(point.x, mixed_key(key, 3))), unit(owen_scrambled(point.y, mixed_key(key, 4)))};
}

/// A pair of independent standard normal deviates from a point of (0, 1)^2 (Box and Muller 1958). Rings and sectors of
/// the plane are boxes of the square, so what is even there is even here.
inline Vec2d normal_deviates(const Vec2d& point) {
  const double radius = std::sqrt(-2 * std::log(point.x)), angle = 2 * kPi * point.y;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace raytree
