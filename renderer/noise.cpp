#include "renderer/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace raytree {
namespace {

/// Spreads every bit of a word over all of it.
std::uint32_t mixed(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

/// The twelve midpoints of a cube's edges: no axis is favored among them, and products with them are sums.
constexpr std::array<std::array<signed char, 3>, 12> kDirections{{{1, 1, 0},
                                                                  {-1, 1, 0},
                                                                  {1, -1, 0},
                                                                  {-1, -1, 0},
                                                                  {1, 0, 1},
                                                                  {-1, 0, 1},
                                                                  {1, 0, -1},
                                                                  {-1, 0, -1},
                                                                  {0, 1, 1},
                                                                  {0, -1, 1},
                                                                  {0, 1, -1},
                                                                  {0, -1, -1}}};

/// The lattice cell that a coordinate lies in, modulo 2^32, and how far into it.
std::uint32_t cell_of(double x, double& inside) {
  if (!(std::abs(x) < 0x1p52)) x = 0;
  const double floor = std::floor(x);
  inside = x - floor;
  // Through a signed word, whose overflow to 32 bits is defined.
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(floor));
}

}  // namespace

Height gradient_noise(const Vec3d& point, std::uint32_t seed) {
  std::uint32_t cell[3];
  double t[3], fade[3], slope[3];
  for (int i = 0; i < 3; ++i) {
    cell[i] = cell_of(point[i], t[i]);
    fade[i] = t[i] * t[i] * t[i] * (t[i] * (t[i] * 6 - 15) + 10);
    slope[i] = 30 * t[i] * t[i] * (t[i] - 1) * (t[i] - 1);
  }
  const std::uint32_t start = mixed(seed ^ 0x9e3779b9u);
  Height sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int at[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
    std::uint32_t h = start;
    double offset[3], weight[3], rise[3];
    for (int i = 0; i < 3; ++i) {
      h = mixed(h + cell[i] + static_cast<std::uint32_t>(at[i]));
      offset[i] = t[i] - at[i];
      weight[i] = at[i] != 0 ? fade[i] : 1 - fade[i];
      rise[i] = at[i] != 0 ? slope[i] : -slope[i];
    }
    const auto& d = kDirections[static_cast<std::size_t>(std::uint64_t{h} * kDirections.size() >> 32)];
    const double height = d[0] * offset[0] + d[1] * offset[1] + d[2] * offset[2];
    const double all = weight[0] * weight[1] * weight[2];
    sum.value += all * height;
    sum.gradient += Vec3d(all * d[0] + rise[0] * weight[1] * weight[2] * height,
                          all * d[1] + weight[0] * rise[1] * weight[2] * height,
                          all * d[2] + weight[0] * weight[1] * rise[2] * height);
  }
  return sum;
}

double Octaves::first_amplitude() const {
  double squares = 0, amplitude = 1;
  for (int i = 0; i < count; ++i) squares += amplitude * amplitude, amplitude *= gain;
  return 1 / std::sqrt(squares);
}

double Octaves::largest() const {
  double sum = 0, amplitude = first_amplitude();
  for (int i = 0; i < count; ++i) sum += amplitude, amplitude *= gain;
  return sum * kLargestNoise;
}

double octave_weight(double width, double cell) {
  // Written so that a width that is not finite leaves nothing.
  return width < 2 * cell ? std::min(1.0, (2 - width / cell) / 1.5) : 0;
}

namespace {

template <class Fold>
Height folded_octaves(const Octaves& octaves, const Vec3d& point, double width, const Fold& fold) {
  Height sum;
  double frequency = 1, amplitude = octaves.first_amplitude();
  for (int i = 0; i < octaves.count; ++i) {
    const double weight = octave_weight(width, 1 / frequency) * amplitude;
    if (weight == 0) break;
    // Lattices of two octaves would share points, where both are 0: each is moved by a part of its own.
    const double shift = 0.3819660112501051 * i;
    const Height height = fold(gradient_noise(point * frequency + Vec3d(shift, 0.7 * shift, 0.4 * shift),
                                              octaves.seed + 0x85ebca6bu * static_cast<std::uint32_t>(i)));
    sum.value += height.value * weight;
    sum.gradient += height.gradient * (weight * frequency);
    frequency *= 2;
    amplitude *= octaves.gain;
  }
  return sum;
}

}  // namespace

Height octave_noise(const Octaves& octaves, const Vec3d& point, double width) {
  return folded_octaves(octaves, point, width, [](const Height& height) { return height; });
}

Height ridged_noise(const Octaves& octaves, const Vec3d& point, double width) {
  return folded_octaves(octaves, point, width, [](const Height& height) {
    const double fold = std::sqrt(height.value * height.value + kCreaseWidth * kCreaseWidth);
    return Height{-fold, height.gradient * (-height.value / fold)};
  });
}

}  // namespace raytree
