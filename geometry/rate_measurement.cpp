#include "geometry/rate_measurement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/facet_deviation.h"
#include "geometry/tessellation.h"

namespace raytree {
namespace {

/// A face is good where samples find at most this share of the tolerances; where they find more, rates rise until it is
/// kRateAim of them.
constexpr double kGoodShare = 0.85;
/// Normals are off most elsewhere than at the middles of edges and facets, where they are sampled.
constexpr double kShadingBetweenSamples = 1.5;
constexpr double kLargestRise = 2, kLargestRiseForNormals = 4;  ///< of a rate in one round
/// Where normals turn along one parameter less than so much of what they do along the other, more segments along it
/// would not help.
constexpr double kLeastTurnShare = 0.25;

/// Chord between unit normals. Over facets whose normals turn more, or are off by more, the surface may bend at once:
/// how far it is off between middles, these do not tell.
constexpr double kKink = 0.7;

/// What one sample asks for.
struct Rise {
  double factor = 1;     ///< of the rates
  bool limited = false;  ///< up to FaceRates::shading
  bool normals = false;  ///< not for distance
};

Rise rise_for(const FacetDeviation& deviation, const SampledFacet& facet, double tolerance, bool regular) {
  const double off = deviation.pixels / tolerance;
  if (off > kGoodShare) return {std::min(std::sqrt(off / kRateAim), kLargestRise)};
  const double aim = deviation.shading * kShadingBetweenSamples / tolerance;
  const double bound = aim / shading_bound(facet, regular);
  // At irregular places normals converge with little more than the first power of a facet's size.
  if (bound > kGoodShare) {
    const double rise = regular ? std::sqrt(bound / kRateAim) : bound / kRateAim;
    return {std::min(rise, kLargestRiseForNormals), false, true};
  }
  if (aim > kGoodShare && !facet.is_small()) return {std::min(std::sqrt(aim / kRateAim), kLargestRise), true, true};
  return {};
}

/// Along which parameters of a quad a facet's normals turn; both, where they turn less than they are off.
std::array<bool, 2> turning(const std::array<FacetCorner, 3>& corners, const std::array<Vec2f, 3>& parameters,
                            double angle) {
  const Vec2d a = Vec2d(parameters[1]) - Vec2d(parameters[0]), b = Vec2d(parameters[2]) - Vec2d(parameters[0]);
  const double area = a.x * b.y - a.y * b.x;
  const Vec3d along_a = corners[1].normal - corners[0].normal, along_b = corners[2].normal - corners[0].normal;
  const auto extent = [](double x, double y) { return std::max({x, y, 0.0}) - std::min({x, y, 0.0}); };
  const double u = ((along_a * b.y - along_b * a.y) / area).length() * extent(a.x, b.x);
  const double v = ((along_b * a.x - along_a * b.x) / area).length() * extent(a.y, b.y);
  const double most = std::max(u, v);
  if (!(most > angle)) return {true, true};
  return {u >= kLeastTurnShare * most, v >= kLeastTurnShare * most};
}

/// Along the facet's edge that a sample lies on; nothing for one inside.
std::optional<Vec2f> edge_through(const std::array<double, 3>& weights, const std::array<Vec2f, 3>& corners) {
  for (std::size_t k = 0; k < 3; ++k)
    if (weights[k] == 0) return corners[(k + 2) % 3] - corners[(k + 1) % 3];
  return std::nullopt;
}

class FaceMeasurement {
 public:
  FaceMeasurement(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, const FaceRates& rates,
                  MeasurementScratch& scratch, RateDemand& demand)
      : surface_(surface),
        face_(face),
        sides_(surface.sides(face)),
        quad_(surface.domain(face) == FaceDomain::quad),
        goal_(goal),
        rates_(rates),
        scratch_(scratch),
        sampled_(scratch.patterns.find(surface.domain(face), rates.rates,
                                       rates.regular ? MeasuredFacets::all : MeasuredFacets::some)),
        demand_(demand) {
    find_hard_pieces(sides_, rates.rates, scratch.hard);
    identify_boundary(sides_, rates.rates, scratch.points);
    scratch.samples.resize(sampled_.parameters.size());
    demand.reset(sides_.size());
  }

  /// A face that fails at its corners is measured again anyway.
  bool is_good() {
    look(0, sampled_.corner_facets, 0, sampled_.corner_parameters);
    if (good_)
      look(sampled_.corner_facets, sampled_.facets.size(), sampled_.corner_parameters, sampled_.parameters.size());
    return good_;
  }

 private:
  /// Facets [begin, end), which need parameters up to last; those before first are evaluated.
  void look(std::size_t begin, std::size_t end, std::size_t first, std::size_t last) {
    surface_.evaluate(face_, std::span(sampled_.parameters).subspan(first, last - first),
                      std::span(scratch_.samples).subspan(first, last - first));
    for (std::size_t i = begin; i < end; ++i) look_at(sampled_.facets[i]);
  }
  void look_at(const SampledPattern::Facet& sample);
  void raise(const std::uint32_t* facet, const Rise& rise, const std::array<bool, 2>& along);
  double raised(std::size_t number, const Rise& rise) {
    const double rate = rates_.rates[number], wanted = rate * rise.factor;
    const double result = rise.limited ? std::max(rate, std::min(wanted, rates_.shading[number])) : wanted;
    good_ = good_ && result == rate;
    return result;
  }

  const ParametricSurface& surface_;
  std::size_t face_;
  std::span<const FaceEdge> sides_;
  bool quad_;
  const RateGoal& goal_;
  const FaceRates& rates_;
  MeasurementScratch& scratch_;
  const SampledPattern& sampled_;
  RateDemand& demand_;
  bool good_ = true;
};

void FaceMeasurement::look_at(const SampledPattern::Facet& sample) {
  const FacetPattern& pattern = sampled_.pattern;
  const std::uint32_t* c = &pattern.facets[3 * std::size_t(sample.number)];
  if (has_no_area(c, scratch_.points)) return;
  std::array<FacetCorner, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const SurfaceSample& corner = scratch_.samples[sample.corners[k]];
    corners[k] = {Vec3d(corner.position), Vec3d(corner.normal)};
  }
  const std::array<bool, 3> hard = hard_edges(c, scratch_.hard);
  const SampledFacet facet(goal_.view, goal_.origin, corners, hard);
  const std::array<Vec2f, 3> at{pattern.parameters[c[0]], pattern.parameters[c[1]], pattern.parameters[c[2]]};
  bool kinked = hard[0] || hard[1] || hard[2] || facet.bend() > kKink;
  const auto judge = [&](const SurfaceSample& truth, const std::array<double, 3>& weights) {
    const FacetDeviation deviation = facet.at(truth, weights);
    kinked = kinked || deviation.angle > kKink;
    const Rise rise = rise_for(deviation, facet, goal_.tolerance, rates_.regular);
    if (!(rise.factor > 1)) return;
    std::array<bool, 2> along{true, true};
    if (quad_) {
      if (const std::optional<Vec2f> edge = edge_through(weights, at))
        along = {2 * std::abs(edge->x) > std::abs(edge->y), 2 * std::abs(edge->y) > std::abs(edge->x)};
      if (rise.normals) {
        const std::array<bool, 2> turns = turning(corners, at, deviation.angle);
        if ((along[0] && turns[0]) || (along[1] && turns[1])) along = {along[0] && turns[0], along[1] && turns[1]};
      }
    }
    raise(c, rise, along);
  };
  for (std::size_t m = 0; m < kFacetMiddles.size(); ++m) judge(scratch_.samples[sample.middles[m]], kFacetMiddles[m]);
  if (!good_ || !kinked) return;
  std::array<Vec2f, kSamplesPerFacet> parameters;
  std::array<SurfaceSample, kSamplesPerFacet> truth;
  parameters_in_facet(surface_.domain(face_), sides_.size(), at, kDenseSamples, parameters.data());
  surface_.evaluate(face_, parameters, truth);
  for (std::size_t i = 0; i < kSamplesPerFacet; ++i) judge(truth[i], kDenseSamples[i]);
}

/// The rates of the face's inside and, where the facet is at the boundary, those of its sides.
void FaceMeasurement::raise(const std::uint32_t* facet, const Rise& rise, const std::array<bool, 2>& along) {
  const std::size_t last_inner = inner_rate_count(surface_.domain(face_)) - 1;
  for (std::size_t k = 0; k < 2; ++k)
    if (along[k]) demand_.inner[k] = std::max(demand_.inner[k], raised(sides_.size() + std::min(k, last_inner), rise));
  for (std::size_t k = 0; k < 3; ++k)
    if (const std::uint32_t point = facet[k]; point < sampled_.pattern.boundary_count) {
      const std::size_t side = sampled_.side_of[point];
      if (!quad_ || along[side % 2]) demand_.raise_side(side, raised(side, rise));
      const std::size_t before = (side + sides_.size() - 1) % sides_.size();
      if (sampled_.is_corner(point) && (!quad_ || along[before % 2])) demand_.raise_side(before, raised(before, rise));
    }
}

}  // namespace

bool measure_demand(const ParametricSurface& surface, std::size_t face, const RateGoal& goal, const FaceRates& rates,
                    MeasurementScratch& scratch, RateDemand& demand) {
  return FaceMeasurement(surface, face, goal, rates, scratch, demand).is_good();
}

}  // namespace raytree
