// The parts that curved_cases() is made of.
#pragma once

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> degenerate_patch_cases();  ///< rows 8-10: normals where P_u x P_v vanishes
std::vector<StabilityCase> subdivision_cases();       ///< rows 53-58: limit surfaces of cages
std::vector<StabilityCase> curved_ray_cases();        ///< rows 51 and 66: rays at curved surfaces

}  // namespace raytree::benchmarks
