// Rates judged by what they make of a face: facets are sampled, and where they are off by more than they may be, higher
// rates follow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/parametric_surface.h"
#include "geometry/rate_demand.h"
#include "geometry/sampled_pattern.h"

namespace raytree {

/// The rates of a face as they are, and those that normals may ask for where they are no further off than their bound.
struct FaceRates {
  std::span<const std::uint16_t> rates;  ///< as make_facet_pattern() takes them
  std::span<const double> shading;       ///< the same places
  bool regular;                          ///< see shading_bound()
};

/// What measurements keep from face to face. One thread's.
struct MeasurementScratch {
  SampledPatternCache patterns;
  std::vector<SurfaceSample> samples;
  std::vector<std::uint64_t> points;  ///< as identify_boundary() says
  std::vector<std::uint8_t> hard;     ///< as find_hard_pieces() says
};

/// Samples facets of the face. Whether all are good; if not, `demand` holds higher rates.
bool measure_demand(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, const FaceRates& rates,
                    MeasurementScratch& scratch, RateDemand& demand);

}  // namespace raytree
