#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> intersection_cases() { return {}; }

}  // namespace raytree::benchmarks
