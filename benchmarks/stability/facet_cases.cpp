#include "benchmarks/stability/facet_cases.h"

#include <algorithm>

namespace raytree::benchmarks {

std::vector<StabilityCase> facet_cases() {
  std::vector<StabilityCase> cases;
  for (const auto part : {facets::highlight_cases, facets::temporal_cases, facets::mach_band_cases,
                          facets::facet_geometry_cases, facets::vertex_normal_cases, facets::facet_remedy_cases}) {
    const std::vector<StabilityCase> some = part();
    cases.insert(cases.end(), some.begin(), some.end());
  }
  std::stable_sort(cases.begin(), cases.end(),
                   [](const StabilityCase& a, const StabilityCase& b) { return a.row < b.row; });
  return cases;
}

}  // namespace raytree::benchmarks
