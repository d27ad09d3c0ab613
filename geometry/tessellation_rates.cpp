// Faces that are one polynomial get their rates in closed form. All others are estimated over a coarse grid, and then
// rounds of measuring correct what was estimated. Demands on an edge only ever rise and are merged by maximum, so that
// no order of faces shows.
#include "geometry/tessellation_rates.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/facet_deviation.h"
#include "geometry/polynomial_rates.h"
#include "geometry/rate_estimate.h"
#include "geometry/rate_measurement.h"

namespace raytree {
namespace {

/// Where normals are off by less than their bound, faces are cut for them into no more than so many times the segments
/// that distance alone asks for.
constexpr double kMostForShading = 1.5;
constexpr std::size_t kFacesAtOnce = 16;

class RateFinder {
 public:
  RateFinder(const ParametricSurface& surface, const TessellationView& view, double tolerance)
      : surface_(surface), goal_{view, surface.origin(), tolerance} {
    edges_.assign(surface.edge_count(), 1);
    inner_.assign(surface.face_count(), {1, 1});
    states_.assign(surface.face_count(), State::settled);
    regular_.assign(surface.face_count(), 0);
  }

  ViewRates find();

 private:
  /// Settled faces are good at any higher rates, coarse ones would need more than there are; good and failed ones are
  /// measured again when rates change.
  enum class State : std::uint8_t { settled, coarse, good, failed, pending };

  struct Scratch {
    EstimateScratch estimate;
    MeasurementScratch measurement;
    RateDemand demand;
    std::vector<std::uint16_t> rates;
    std::vector<double> shading;
  };

  template <class Function>
  void for_each_face(const Function& function);
  void start(std::size_t face, Scratch& scratch);
  bool measure(std::size_t face, Scratch& scratch) const;
  void take(std::size_t face, const RateDemand& demand);
  void settle();
  void settle_inner(std::size_t face);
  void limit_shading();
  ViewRates result() const;

  const ParametricSurface& surface_;
  RateGoal goal_;
  tbb::enumerable_thread_specific<Scratch> scratches_;
  Buffer<std::uint32_t> edges_;
  Buffer<std::array<std::uint32_t, 2>> inner_;
  /// Rates that normals alone may ask for.
  Buffer<double> shading_edges_;
  Buffer<std::array<double, 2>> shading_inner_;
  Buffer<State> states_;
  Buffer<std::uint8_t> regular_;
};

std::uint32_t whole(double rate) {
  // NaN, of a surface that is not finite, becomes 1.
  if (!(rate > 1)) return 1;
  return static_cast<std::uint32_t>(std::ceil(std::min<double>(rate, kLargestViewRate + 1)));
}

void raise(std::uint32_t& value, std::uint32_t candidate) {
  std::atomic_ref<std::uint32_t> shared(value);
  std::uint32_t current = shared.load(std::memory_order_relaxed);
  while (candidate > current && !shared.compare_exchange_weak(current, candidate, std::memory_order_relaxed)) {
  }
}

void RateFinder::take(std::size_t face, const RateDemand& demand) {
  const std::span<const FaceEdge> sides = surface_.sides(face);
  for (std::size_t i = 0; i < sides.size(); ++i) raise(edges_[sides[i].edge], whole(demand.sides[i]));
  for (std::size_t i = 0; i < 2; ++i) inner_[face][i] = std::max(inner_[face][i], whole(demand.inner[i]));
}

/// Facets between unequal rates join an inner grid to the boundary; where that grid is one segment wide they become a
/// fan about the middle instead, whose facets reach through half the face. So a quad gets a plain grid where its sides
/// allow it and that costs little, and at least two segments each way where not.
void RateFinder::settle_inner(std::size_t face) {
  std::uint32_t &u = inner_[face][0], &v = inner_[face][1];
  u = std::min<std::uint32_t>(u, kLargestViewRate);
  v = std::min<std::uint32_t>(v, kLargestViewRate);
  const std::span<const FaceEdge> sides = surface_.sides(face);
  if (surface_.domain(face) != FaceDomain::quad) {
    u = v = std::max(u, v);
    return;
  }
  constexpr double kLittle = 1.25;
  const std::uint32_t grid_u = edges_[sides[0].edge], grid_v = edges_[sides[1].edge];
  const bool grid = grid_u == edges_[sides[2].edge] && grid_v == edges_[sides[3].edge] && u <= grid_u && v <= grid_v;
  const std::uint32_t joined_u = std::max(u, 2u), joined_v = std::max(v, 2u);
  if (grid && grid_u * grid_v <= kLittle * joined_u * joined_v) {
    u = grid_u, v = grid_v;
  } else if (std::max(u, v) > 1) {
    u = joined_u, v = joined_v;
  }
}

/// From the rates that distance was estimated to need.
void RateFinder::limit_shading() {
  const auto limit = [](std::uint32_t rate) { return std::min<double>(rate * kMostForShading, kLargestViewRate); };
  for (const std::uint32_t rate : edges_) shading_edges_.push_back(limit(rate));
  for (const auto& rates : inner_) shading_inner_.push_back({limit(rates[0]), limit(rates[1])});
}

template <class Function>
void RateFinder::for_each_face(const Function& function) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surface_.face_count(), kFacesAtOnce), [&](const auto& range) {
    Scratch& scratch = scratches_.local();
    for (std::size_t face = range.begin(); face != range.end(); ++face)
      if (!surface_.sides(face).empty()) function(face, scratch);
  });
}

void RateFinder::settle() {
  for (std::uint32_t& rate : edges_) rate = std::min<std::uint32_t>(rate, kLargestViewRate);
  for_each_face([&](std::size_t face, Scratch&) { settle_inner(face); });
}

/// The rates to begin with.
void RateFinder::start(std::size_t face, Scratch& scratch) {
  BezierPatch patch;
  if (surface_.polynomial_patch(face, patch)) {
    switch (demand_of_polynomial(patch, surface_.sides(face), goal_, scratch.demand)) {
      case PolynomialDemand::found:
        states_[face] = scratch.demand.largest() > kLargestViewRate ? State::coarse : State::settled;
        take(face, scratch.demand);
        return;
      case PolynomialDemand::turns_much:
        regular_[face] = 1;
        break;
      case PolynomialDemand::degenerate:
        break;
    }
  }
  states_[face] = State::pending;
  estimate_demand(surface_, face, goal_, scratch.estimate, scratch.demand);
  take(face, scratch.demand);
}

bool RateFinder::measure(std::size_t face, Scratch& scratch) const {
  scratch.rates.clear();
  scratch.shading.clear();
  for (const FaceEdge& side : surface_.sides(face)) {
    scratch.rates.push_back(static_cast<std::uint16_t>(edges_[side.edge]));
    scratch.shading.push_back(shading_edges_[side.edge]);
  }
  for (std::size_t i = 0; i < inner_rate_count(surface_.domain(face)); ++i) {
    scratch.rates.push_back(static_cast<std::uint16_t>(inner_[face][i]));
    scratch.shading.push_back(shading_inner_[face][i]);
  }
  return measure_demand(surface_, face, goal_, {scratch.rates, scratch.shading, regular_[face] != 0},
                        scratch.measurement, scratch.demand);
}

ViewRates RateFinder::find() {
  for_each_face([&](std::size_t face, Scratch& scratch) { start(face, scratch); });
  settle();
  limit_shading();
  for (int round = 0; round < kMostRounds; ++round) {
    const Buffer<std::uint32_t> edges_before = edges_;
    const Buffer<std::array<std::uint32_t, 2>> inner_before = inner_;
    // Rates are read as they were when the round began; what it demands is merged when it is over.
    std::vector<RateDemand> demands(surface_.face_count());
    for_each_face([&](std::size_t face, Scratch& scratch) {
      if (states_[face] != State::pending) return;
      states_[face] = measure(face, scratch) ? State::good : State::failed;
      if (states_[face] == State::failed) demands[face] = scratch.demand;
    });
    if (round + 1 == kMostRounds) break;
    for (std::size_t face = 0; face < demands.size(); ++face)
      if (!demands[face].sides.empty()) take(face, demands[face]);
    settle();
    // A face is looked at again when its own rates or those of its sides have changed.
    bool any = false;
    for (std::size_t face = 0; face < demands.size(); ++face) {
      if (states_[face] == State::settled || states_[face] == State::coarse) continue;
      bool changed = inner_[face] != inner_before[face];
      for (const FaceEdge& side : surface_.sides(face)) changed |= edges_[side.edge] != edges_before[side.edge];
      if (changed) states_[face] = State::pending;
      any |= changed;
    }
    if (!any) break;
  }
  return result();
}

ViewRates RateFinder::result() const {
  ViewRates result;
  result.coarse_faces = static_cast<std::size_t>(std::count_if(
      states_.begin(), states_.end(), [](State state) { return state == State::coarse || state == State::failed; }));
  result.rates.edges.resize(edges_.size());
  std::transform(edges_.begin(), edges_.end(), result.rates.edges.begin(),
                 [](std::uint32_t rate) { return static_cast<std::uint16_t>(rate); });
  result.rates.inner.resize(inner_.size());
  std::transform(inner_.begin(), inner_.end(), result.rates.inner.begin(), [](const auto& rates) {
    return std::array<std::uint16_t, 2>{static_cast<std::uint16_t>(rates[0]), static_cast<std::uint16_t>(rates[1])};
  });
  return result;
}

}  // namespace

ViewRates rates_for_view(const ParametricSurface& surface, const TessellationView& view, double tolerance) {
  return RateFinder(surface, view, tolerance).find();
}

ViewRates rates_for_distance(const ParametricSurface& surface, double distance) {
  constexpr double kPixels = 0.25;
  TessellationView view;  // from everywhere
  view.pixel = distance / kPixels;
  return rates_for_view(surface, view, kPixels);
}

}  // namespace raytree
