// Newell's sum: the normal of a polygon that need not be flat.
#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/vec.h"

namespace raytree {

/// Normal of the polygon corners[0..count), not unit: its length is twice the polygon's area (Phong 1973, eq. 4.2, the
/// corners taken from the first one, which keeps the sum accurate far from the origin). Counter-clockwise seen from
/// where it points; zero for a polygon without area.
inline Vec3d newell_normal(const Vec3f* positions, const std::uint32_t* corners, std::size_t count) {
  Vec3d sum(0, 0, 0);
  if (count < 3) return sum;
  const Vec3d first(positions[corners[0]]);
  Vec3d previous = Vec3d(positions[corners[1]]) - first;
  for (std::size_t i = 2; i < count; ++i) {
    const Vec3d current = Vec3d(positions[corners[i]]) - first;
    sum += previous.cross(current);
    previous = current;
  }
  return sum;
}

}  // namespace raytree
