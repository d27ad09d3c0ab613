// The parts that picture_cases() is made of.
#pragma once

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> number_cases();  ///< rows 59-62: values on their way to a file and a display
std::vector<StabilityCase>
determinism_cases();  ///< rows 63-65: the same picture whoever makes it, and whatever it takes

}  // namespace raytree::benchmarks
