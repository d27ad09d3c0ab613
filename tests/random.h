// Random numbers and vectors of tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "geometry/vec.h"

namespace raytree::test {

/// Numbers without a pattern, the same in every run.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }
  Vec3d in_cube(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }
  Vec3d direction() {
    std::normal_distribution<double> gauss;
    const double x = gauss(engine_), y = gauss(engine_), z = gauss(engine_);
    return Vec3d(x, y, z).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace raytree::test
