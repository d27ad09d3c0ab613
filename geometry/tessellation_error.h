// What a tessellation claims, measured: the largest distance between its facets and the limit surface, found by
// sampling all of them densely.
#pragma once

#include <cstdint>

#include "geometry/facet_deviation.h"
#include "geometry/parametric_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_view.h"

namespace raytree {

struct TessellationError {
  std::uint64_t faces = 0;      ///< of the surface, without holes
  std::uint64_t triangles = 0;  ///< of the tessellation
  std::uint64_t samples = 0;    ///< points of the limit surface compared
  FacetDeviation largest;
};

/// Compares each facet of `mesh`, which tessellate(surface, rates) has made, with the limit surface at kSamplesPerFacet
/// points. Runs on the task arena's threads; the result does not depend on their number.
TessellationError measure_tessellation(const ParametricSurface& surface, const TessellationRates& rates,
                                       const TriangleMesh& mesh, const TessellationView& view);

inline constexpr int kSamplesPerFacet = 12;

}  // namespace raytree
