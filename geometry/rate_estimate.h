// A first guess at the rates of any face: first derivatives over a coarse grid of it are compared.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/parametric_surface.h"
#include "geometry/rate_demand.h"

namespace raytree {

/// What estimates keep from face to face.
struct EstimateScratch {
  std::vector<Vec2f> parameters;
  std::vector<SurfaceSample> samples;
};

/// Rates at which the facets of `face` lie about kRateAim of the tolerance off, as far as first derivatives on a grid
/// of 2 x 2 to 16 x 16 cells tell; for normals they do not ask. The face must have a surface.
void estimate_demand(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, EstimateScratch& scratch,
                     RateDemand& demand);

}  // namespace raytree
