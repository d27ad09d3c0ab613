// Solid gradient noise and sums of its octaves, with exact gradients: what noise patterns and bumps are made of.
// Values depend on integer arithmetic and on sums and products of doubles alone, so every compiler makes the same bits.
#pragma once

#include <cstdint>

#include "geometry/vec.h"

namespace raytree {

/// A height over space and how it rises.
struct Height {
  double value = 0;
  Vec3d gradient{0, 0, 0};
};

/// Standard deviation of gradient_noise() over space and seeds. With the fade w(t) = 1 - t^3 (t (6 t - 15) + 10), eight
/// corners and gradients of 2/3 variance a component it is 4 I0 sqrt(I2), I0 and I2 the integrals of w^2 and w^2 t^2
/// over [0, 1] (tests/renderer/noise_test.cpp does the integrals).
inline constexpr double kNoiseDeviation = 0.270035;

/// No value is larger in size; the largest lies in a cell whose corners all point to one spot.
inline constexpr double kLargestNoise = 1.04;

/// Noise over the lattice of whole numbers: 0 at each of them, continuous to the second derivative. Its mean is 0;
/// points more than 2 apart along some axis are independent; it repeats after 2^32 along each axis. What is not finite
/// or beyond 2^52, where a double has no digits after the point, counts as 0.
Height gradient_noise(const Vec3d& point, std::uint32_t seed);

inline constexpr int kMaxOctaves = 16;

/// Octaves of noise, each twice as fine as the one before and `gain` times as high, scaled to the deviation of a single
/// octave. Amplitudes fall as frequency^log2(gain): gain 1/2 is a 1 / f spectrum, from frequencies of about 1/2 to
/// about 2^(octaves - 1).
struct Octaves {
  int count = 1;  ///< 1 to kMaxOctaves
  double gain = 0.5;
  std::uint32_t seed = 0;

  double first_amplitude() const;  ///< so that the sum has one octave's deviation
  double largest() const;          ///< bound on the sum's size
};

/// `width`: of the window that the sum is seen through, in cells of the first octave; octaves too fine for it fade out.
Height octave_noise(const Octaves& octaves, const Vec3d& point, double width);

/// The same octaves, each folded at 0 with its crease rounded over kCreaseWidth: -sqrt(n^2 + kCreaseWidth^2), so that
/// ridges run where the noise is 0. Blinn's wrinkles in the round.
inline constexpr double kCreaseWidth = 0.04;
Height ridged_noise(const Octaves& octaves, const Vec3d& point, double width);

/// What is left of a wave's height, seen through a window: 1 up to windows of half of `cell`, 0 from twice of it on.
double octave_weight(double width, double cell);

}  // namespace raytree
