// The angle between two directions, exact for small ones.
#pragma once

#include <cmath>

#include "geometry/angle.h"
#include "geometry/vec.h"

namespace raytree::test {

/// Degrees; the vectors may have any length.
inline double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) / kDegree;
}

}  // namespace raytree::test
