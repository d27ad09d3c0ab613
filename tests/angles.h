// Angles between directions of any length, for tests.
#pragma once

#include <cmath>
#include <numbers>

#include "geometry/vec.h"

namespace raytree::test {

inline double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) * 180 / std::numbers::pi;
}

}  // namespace raytree::test
