#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

std::vector<StabilityCase> ray_tree_cases() { return {}; }

}  // namespace raytree::benchmarks
