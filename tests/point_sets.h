// How far two sets of points lie apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/buffer.h"
#include "geometry/vec.h"

namespace raytree::test {

/// The largest distance from a point of one set to the nearest of the other, both ways.
inline double set_distance(const Buffer<Vec3f>& a, const Buffer<Vec3f>& b) {
  const auto one_way = [](const Buffer<Vec3f>& from, const Buffer<Vec3f>& to) {
    double worst = 0;
    for (const Vec3f& p : from) {
      float best = std::numeric_limits<float>::max();
      for (const Vec3f& q : to) best = std::min(best, (p - q).length2());
      worst = std::max(worst, std::sqrt(double(best)));
    }
    return worst;
  };
  return std::max(one_way(a, b), one_way(b, a));
}

}  // namespace raytree::test
