// Angles are radians everywhere but in files and flags, which give degrees.
#pragma once

#include <numbers>

namespace raytree {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;  ///< in radians

}  // namespace raytree
