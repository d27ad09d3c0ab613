// The parts of intersection_cases().
#pragma once

#include <vector>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> leak_cases();       ///< rows 36-38 and 50: edges and corners of closed meshes
std::vector<StabilityCase> false_hit_cases();  ///< rows 39-41: thin triangles, huge boxes, scales
std::vector<StabilityCase> offset_cases();     ///< rows 42 and 43: leaving a surface
std::vector<StabilityCase> place_cases();      ///< rows 44 and 45: far spheres, far cameras
std::vector<StabilityCase> bad_input_cases();  ///< rows 46-49: what is no triangle and no ray

}  // namespace raytree::benchmarks
