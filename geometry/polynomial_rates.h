// Rates of a face that is one bicubic polynomial, in closed form: its derivatives say what facets of a size miss, of
// the surface and of its normals, and nothing need be sampled.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/bezier_patch.h"
#include "geometry/parametric_surface.h"
#include "geometry/rate_demand.h"

namespace raytree {

/// Facets over which normals turn more than this, in radians, are not told by second derivatives alone.
inline constexpr double kLargestModeledTurn = 0.4;

/// The share of the tolerance in distance that these rates aim at; in normals it is kRateAim. Between the places that
/// chose them derivatives differ a little, those of normals more, and so does the view.
inline constexpr double kPolynomialAim = 0.85;

/// Whether a face is regular: one polynomial whose normal is nowhere in doubt, as far as 4 x 4 places of it tell. Its
/// normals converge with the square of a facet's size, and are held to the tolerance (see shading_bound()).
bool is_regular(const ParametricSurface& surface, std::size_t face);

enum class PolynomialDemand : std::uint8_t {
  found,
  turns_much,  ///< normals turn more than kLargestModeledTurn over a facet
  degenerate   ///< the face is not regular
};

/// The rates at which the facets of `patch` keep that share of the tolerance: at 4 x 4 places of the patch,
/// or 7 x 7 where it gets many facets, the error of linear interpolation is an eighth of the second derivatives, those
/// of the position and those of the unit normal. Any higher rates keep it too. `sides`: of the face, 4. `patch`:
/// relative to the goal's origin; its weights must all be equal. Unless they are found, `demand` says nothing.
PolynomialDemand demand_of_polynomial(const BezierPatch& patch, std::span<const FaceEdge> sides, const RateGoal& goal,
                                      RateDemand& demand);

}  // namespace raytree
