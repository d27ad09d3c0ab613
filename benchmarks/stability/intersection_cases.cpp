#include "benchmarks/stability/intersection_cases.h"

#include <algorithm>

namespace raytree::benchmarks {

std::vector<StabilityCase> intersection_cases() {
  std::vector<StabilityCase> cases;
  for (const auto& part : {leak_cases, false_hit_cases, offset_cases, place_cases, bad_input_cases})
    for (const StabilityCase& one : part()) cases.push_back(one);
  std::sort(cases.begin(), cases.end(), [](const auto& a, const auto& b) { return a.row < b.row; });
  return cases;
}

}  // namespace raytree::benchmarks
