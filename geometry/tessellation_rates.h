// How finely a surface must be cut so that no picture from a given view tells it from its limit.
#pragma once

#include <cstddef>

#include "geometry/parametric_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_view.h"

namespace raytree {

/// No view asks for more segments than these.
inline constexpr int kLargestViewRate = 512;

struct ViewRates {
  TessellationRates rates;
  /// Faces that may still be off by more than the tolerance: they would need more than kLargestViewRate segments, or
  /// were not found good within the rounds allowed.
  std::size_t coarse_faces = 0;
};

/// Rates for which the tessellation lies at most `tolerance` pixels (> 0) off the limit surface, FacetDeviation's
/// `pixels`, and whose normals keep their bounds: FacetDeviation's `shading` of facets of kShortestShadedEdge pixels
/// and more is at most the tolerance on regular faces (is_regular()), of all others kLooseShading times as much.
/// Regular faces get them in closed form, polynomial_rates.h; all others are estimated and measured: facets are
/// sampled, and where they fail the rates of their face and of its sides rise, in at most kMostRounds rounds. An edge
/// takes the larger demand of its faces. Time in proportion to the number of faces and the triangles that come out.
/// Runs on the task arena's threads; the result does not depend on their number.
ViewRates rates_for_view(const ParametricSurface& surface, const TessellationView& view, double tolerance);

inline constexpr int kMostRounds = 16;

/// The same where nobody looks: at most `distance` (> 0) of the surface's own units off, and shaded as a picture is in
/// which that distance is a quarter of a pixel.
ViewRates rates_for_distance(const ParametricSurface& surface, double distance);

}  // namespace raytree
