// The parts of intersection_cases(), and how their figures are made.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> leak_cases();       ///< rows 36-38 and 50: edges and corners of closed meshes
std::vector<StabilityCase> false_hit_cases();  ///< rows 39-41: thin triangles, huge boxes, scales
std::vector<StabilityCase> offset_cases();     ///< rows 42 and 43: leaving a surface
std::vector<StabilityCase> place_cases();      ///< rows 44 and 45: far spheres, far cameras
std::vector<StabilityCase> bad_input_cases();  ///< rows 46-49: what is no triangle and no ray

/// Of the renderer's own method.
inline StabilityFigure of_renderer(std::string method, std::string quantity, double measured, double low, double high,
                                   std::string known) {
  return {std::move(method), std::move(quantity), measured, low, high, std::move(known), StabilityExpectation::holds};
}

/// Of a method that is kept to be compared with.
inline StabilityFigure of_comparison(std::string method, std::string quantity, double measured, double low, double high,
                                     std::string known) {
  return {std::move(method),
          std::move(quantity),
          measured,
          low,
          high,
          std::move(known),
          StabilityExpectation::fails_as_known};
}

}  // namespace raytree::benchmarks
