#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> picture_cases() { return {}; }

}  // namespace raytree::benchmarks
