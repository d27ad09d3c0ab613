// The parts that ray_tree_cases() is made of.
#pragma once

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> branching_cases();  ///< rows 24-26: how deep the tree grows and how wide
std::vector<StabilityCase> rough_cases();      ///< rows 27 and 28: facets that perturb the normal
std::vector<StabilityCase> optics_cases();     ///< rows 29-31: directions of R and P where they are ill-conditioned
std::vector<StabilityCase> media_cases();      ///< rows 32-35: which medium a ray is in, distance, light at the eye

}  // namespace raytree::benchmarks
