// Points, directions, bounds and matrices: Imath's types under the names this project uses.
// Directions and colors are different types: a color is renderer/color.h's Rgb.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

namespace raytree {

inline constexpr float kRoundoff = 0x1p-24f;  ///< half an ulp of single precision, relative

using Vec2f = Imath::V2f;
using Vec3f = Imath::V3f;
using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Bounds3d = Imath::Box3d;
/// Row vectors, as Imath has it: a transformed point is `p * m`, the translation stands in the last row.
using Matrix44d = Imath::M44d;

}  // namespace raytree
