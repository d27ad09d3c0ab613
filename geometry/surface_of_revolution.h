// Patches of revolution: a profile of cubic Bezier curves turned about the y axis, exactly, as rational bicubic
// patches.
#pragma once

#include <span>
#include <vector>

#include "geometry/bezier_patch.h"

namespace raytree {

/// Turns the profile about y in quarters, four patches a curve. Profile points are (radius, y), radius >= 0; z is not
/// looked at. u runs around, counter-clockwise seen from +y, v along the profile: the outside lies to the right of the
/// way that the profile takes, so a profile that climbs has it away from the axis. Points at radius 0 give collapsed
/// edges. A quarter circle is the rational quadratic with weights 1, 1/sqrt(2), 1, raised to a cubic.
std::vector<BezierPatch> revolve(std::span<const BezierCurve> profile);

}  // namespace raytree
