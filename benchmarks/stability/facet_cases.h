// The parts that facet_cases() is put together from.
#pragma once

#include <vector>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks::facets {

std::vector<StabilityCase> highlight_cases();       ///< rows 1, 2, 3, 6
std::vector<StabilityCase> temporal_cases();        ///< row 3, over 90 frames
std::vector<StabilityCase> mach_band_cases();       ///< rows 4, 5
std::vector<StabilityCase> facet_geometry_cases();  ///< rows 7, 15, 16
std::vector<StabilityCase> vertex_normal_cases();   ///< rows 11 to 14
std::vector<StabilityCase> facet_remedy_cases();    ///< rows 17 to 19

}  // namespace raytree::benchmarks::facets
