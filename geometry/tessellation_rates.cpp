// First an estimate from the differences of first derivatives over a coarse grid of each face, then rounds of measuring
// that correct it. Demands on an edge only ever rise and are merged by maximum, so that no order of faces shows.
#include "geometry/tessellation_rates.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "geometry/facet_deviation.h"
#include "geometry/facet_pattern.h"

namespace raytree {
namespace {

/// The share of the tolerance that rates aim at, since they are judged between the samples that chose them.
constexpr double kAim = 0.75;
/// A face is good where samples find at most this share of the tolerances; where they find more, rates rise until it is
/// kAim of them.
constexpr double kGoodShare = 0.85;
/// Facets all of whose edges look shorter than this, in pixels, are not cut for the sake of their normals, nor faces in
/// more than so many times the segments that distance alone asks for: near extraordinary vertices and semi-sharp
/// creases normals converge so slowly that whole faces would become millions of triangles for the shade of a few
/// pixels.
constexpr double kShortestCutForShading = 6, kMostForShading = 1.5;
/// Normals are off most elsewhere than at the middles of edges and facets, where they are sampled.
constexpr double kShadingBetweenSamples = 1.5;
constexpr int kFirstGrid = 2;        ///< cells along a side
constexpr int kLargestGrid = 16;     ///< of faces that turn out to need many segments
constexpr int kSegmentsPerCell = 4;  ///< of those: one cell for so many
constexpr double kLargestRise = 2;   ///< of a rate in one round
/// Facets inside one face that are measured in one round: so many, or one in so many if that is more. Those along its
/// boundary all are: at semi-sharp creases and extraordinary vertices deviations change most.
constexpr std::size_t kMeasuredFacets = 96, kMeasuredShare = 8;
constexpr double kTurnsMuch = 0.5;  ///< cosine of 60 degrees
constexpr std::size_t kFacesAtOnce = 16;

/// Rates of one face as they are asked for, before rounding.
struct Demand {
  std::vector<double> sides;
  std::array<double, 2> inner{1, 1};

  void reset(std::size_t count) {
    sides.assign(count, 1);
    inner = {1, 1};
  }
  void raise_side(std::size_t i, double rate) { sides[i] = std::max(sides[i], rate); }
  double largest() const {
    double most = std::max(inner[0], inner[1]);
    for (const double rate : sides) most = std::max(most, rate);
    return most;
  }
};

/// Smallest rates u and v, about, for which a / u^2 + 2 b / (u v) + c / v^2 <= 1: the error of linear interpolation
/// over a right triangle is that of its diagonal, where a, b and c are an eighth of the second derivatives in units of
/// the tolerance. (2 b / (u v) <= b / u^2 + b / v^2; the two halves then share the tolerance, unless one needs less.)
std::array<double, 2> segments(double a, double b, double c) {
  a += b;
  c += b;
  if (2 * c <= 1) return {std::sqrt(a / (1 - c)), 1};
  if (2 * a <= 1) return {1, std::sqrt(c / (1 - a))};
  return {std::sqrt(2 * a), std::sqrt(2 * c)};
}

class RateFinder {
 public:
  RateFinder(const ParametricSurface& surface, const TessellationView& view, double tolerance)
      : surface_(surface), view_(view), tolerance_(tolerance), origin_(surface.origin()) {
    edges_.assign(surface.edge_count(), 1);
    inner_.assign(surface.face_count(), {1, 1});
    pending_.assign(surface.face_count(), 1);
    failed_.assign(surface.face_count(), 0);
  }

  ViewRates find();

 private:
  struct Scratch {
    Demand demand;
    std::vector<Vec2f> parameters;
    std::vector<SurfaceSample> samples;
    std::vector<std::uint16_t> rates;
    std::vector<std::uint32_t> facets;
    std::vector<std::uint32_t> sample_of;  ///< [pattern's points]
    std::vector<std::uint64_t> points;     ///< as identify_boundary() says
    std::vector<std::uint8_t> hard;        ///< as find_hard_pieces() says
    std::vector<std::uint32_t> side_of;    ///< [boundary points] the side that a point of the boundary lies on
  };

  void estimate(std::size_t face, Scratch& scratch) const;
  void estimate_cells(std::size_t face, const Vec2d& corner, double extent, int cells, Scratch& scratch,
                      const std::array<std::size_t, 4>& sides, bool together) const;
  void estimate_triangle(std::size_t face, int cells, Scratch& scratch) const;
  bool measure(std::size_t face, Scratch& scratch) const;
  void take(std::size_t face, const Demand& demand);
  void settle_inner(std::size_t face);
  void limit_shading();

  /// What of the displacement `d` takes the surface away from its facets: what is along the surface does not, unless
  /// the surface ends there, at a hard edge that runs along `edge` (zero: there is none).
  static Vec3d away(const SurfaceSample& at, const Vec3d& d, const Vec3d& edge) {
    const double square = edge.dot(edge);
    if (square > 0) return d - edge * (edge.dot(d) / square);
    const Vec3d normal(at.normal);
    return normal * normal.dot(d);
  }
  /// An eighth of a second derivative, in units of the tolerance aimed at; the larger of what it is at its two ends.
  double size(const SurfaceSample& a, const SurfaceSample& b, const Vec3d& second,
              const Vec3d& edge = Vec3d(0, 0, 0)) const {
    const auto at = [&](const SurfaceSample& s) {
      return view_.pixels(origin_ + Vec3d(s.position), away(s, second * 0.125, edge));
    };
    // Where normals turn this much from one sample to the next, neither says what is along the surface between.
    if (Vec3d(a.normal).dot(Vec3d(b.normal)) < kTurnsMuch)
      return view_.pixels(origin_ + Vec3d(a.position), second * 0.125) / (tolerance_ * kAim);
    return std::max(at(a), at(b)) / (tolerance_ * kAim);
  }

  const ParametricSurface& surface_;
  const TessellationView& view_;
  double tolerance_;
  Vec3d origin_;
  Buffer<std::uint32_t> edges_;
  Buffer<std::array<std::uint32_t, 2>> inner_;
  /// Rates that normals alone may ask for.
  Buffer<double> shading_edges_;
  Buffer<std::array<double, 2>> shading_inner_;
  Buffer<std::uint8_t> pending_;  ///< to be measured in the next round
  Buffer<std::uint8_t> failed_;   ///< when it was last measured
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

void RateFinder::take(std::size_t face, const Demand& demand) {
  const std::span<const FaceEdge> sides = surface_.sides(face);
  for (std::size_t i = 0; i < sides.size(); ++i) raise(edges_[sides[i].edge], whole(demand.sides[i]));
  for (std::size_t i = 0; i < 2; ++i) inner_[face][i] = std::max(inner_[face][i], whole(demand.inner[i]));
}

/// The square of parameters from `corner` on, `extent` wide. sides: those along its bottom, right, top and left;
/// kNoFaceSide for none. together: both directions take the larger rate.
constexpr std::size_t kNoFaceSide = std::size_t(-1);
void RateFinder::estimate_cells(std::size_t face, const Vec2d& corner, double extent, int cells, Scratch& scratch,
                                const std::array<std::size_t, 4>& sides, bool together) const {
  const auto points = static_cast<std::size_t>(cells) + 1;
  const double step = extent / cells;
  scratch.parameters.clear();
  for (std::size_t j = 0; j < points; ++j)
    for (std::size_t i = 0; i < points; ++i)
      scratch.parameters.emplace_back(static_cast<float>(corner.x + step * double(i)),
                                      static_cast<float>(corner.y + step * double(j)));
  scratch.samples.resize(scratch.parameters.size());
  surface_.evaluate(face, scratch.parameters, scratch.samples);
  Demand& demand = scratch.demand;
  std::array<bool, 4> hard{};
  for (std::size_t i = 0; i < 4; ++i) hard[i] = sides[i] != kNoFaceSide && surface_.sides(face)[sides[i]].sharp_edge;
  for (std::size_t j = 0; j + 1 < points; ++j)
    for (std::size_t i = 0; i + 1 < points; ++i) {
      const SurfaceSample& p00 = scratch.samples[j * points + i];
      const SurfaceSample& p10 = scratch.samples[j * points + i + 1];
      const SurfaceSample& p01 = scratch.samples[(j + 1) * points + i];
      const SurfaceSample& p11 = scratch.samples[(j + 1) * points + i + 1];
      const auto second_u = [&](const SurfaceSample& a, const SurfaceSample& b) {
        return (Vec3d(b.du) - Vec3d(a.du)) / step;
      };
      const auto second_v = [&](const SurfaceSample& a, const SurfaceSample& b) {
        return (Vec3d(b.dv) - Vec3d(a.dv)) / step;
      };
      auto [u, v] = segments(std::max(size(p00, p10, second_u(p00, p10)), size(p01, p11, second_u(p01, p11))),
                             std::max(size(p00, p01, second_u(p00, p01)), size(p10, p11, second_u(p10, p11))),
                             std::max(size(p00, p01, second_v(p00, p01)), size(p10, p11, second_v(p10, p11))));
      if (together) u = v = std::max(u, v);
      demand.inner[0] = std::max(demand.inner[0], u);
      demand.inner[1] = std::max(demand.inner[1], v);
      // A side takes the rate along it of the cells there; a hard one also that of its own outline.
      const auto raise_side = [&](bool there, std::size_t side, double rate, const SurfaceSample& a,
                                  const SurfaceSample& b, const Vec3d& along, const Vec3d& second) {
        if (!there || sides[side] == kNoFaceSide) return;
        demand.raise_side(sides[side], rate);
        if (hard[side]) demand.raise_side(sides[side], std::sqrt(size(a, b, second, along)));
      };
      raise_side(j == 0, 0, u, p00, p10, Vec3d(p00.du), second_u(p00, p10));
      raise_side(i + 2 == points, 1, v, p10, p11, Vec3d(p10.dv), second_v(p10, p11));
      raise_side(j + 2 == points, 2, u, p01, p11, Vec3d(p01.du), second_u(p01, p11));
      raise_side(i == 0, 3, v, p00, p01, Vec3d(p00.dv), second_v(p00, p01));
    }
}

/// The interpolation error at barycentric (l, m, n) is half of the sum of l m D over the edges, D the second derivative
/// along each: at most a sixth of the largest D, where that of one edge alone is an eighth.
void RateFinder::estimate_triangle(std::size_t face, int cells, Scratch& scratch) const {
  scratch.parameters.clear();
  std::vector<std::array<int, 2>> places;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i + j <= cells; ++i) {
      scratch.parameters.emplace_back(float(i) / float(cells), float(j) / float(cells));
      places.push_back({i, j});
    }
  scratch.samples.resize(scratch.parameters.size());
  surface_.evaluate(face, scratch.parameters, scratch.samples);
  const auto index = [&](int i, int j) { return static_cast<std::size_t>(j * (cells + 1) - j * (j - 1) / 2 + i); };
  const auto look = [&](std::size_t a, std::size_t b, double along_u, double along_v) {
    const SurfaceSample &p = scratch.samples[a], &q = scratch.samples[b];
    const auto along = [&](const SurfaceSample& s) { return Vec3d(s.du) * along_u + Vec3d(s.dv) * along_v; };
    const auto on = [&](const std::array<int, 2>& place, std::size_t side) {
      return side == 0 ? place[1] == 0 : side == 1 ? place[0] + place[1] == cells : place[0] == 0;
    };
    const Vec3d second = (along(q) - along(p)) * double(cells);
    const double rate = std::sqrt(size(p, q, second) * (4.0 / 3));
    for (std::size_t side = 0; side < 3; ++side) {
      const bool a_on = on(places[a], side), b_on = on(places[b], side);
      if (a_on || b_on) scratch.demand.raise_side(side, rate);
      if (a_on && b_on && surface_.sides(face)[side].sharp_edge)
        scratch.demand.raise_side(side, std::sqrt(size(p, q, second, along(p))));
    }
    for (double& inner : scratch.demand.inner) inner = std::max(inner, rate);
  };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i + j < cells; ++i) {
      look(index(i, j), index(i + 1, j), 1, 0);
      look(index(j, i), index(j, i + 1), 0, 1);
      look(index(i + 1, j), index(i, j + 1), -1, 1);
    }
}

void RateFinder::estimate(std::size_t face, Scratch& scratch) const {
  const std::size_t sides = surface_.sides(face).size();
  const auto run = [&](int cells) {
    scratch.demand.reset(sides);
    switch (surface_.domain(face)) {
      case FaceDomain::quad:
        estimate_cells(face, {0, 0}, 1, cells, scratch, {0, 1, 2, 3}, false);
        break;
      case FaceDomain::triangle:
        estimate_triangle(face, cells, scratch);
        break;
      case FaceDomain::quad_subfaces:
        for (std::size_t i = 0; i < sides; ++i)
          estimate_cells(face, subface_corner(sides, i), 0.5, (cells + 1) / 2, scratch,
                         {i, kNoFaceSide, kNoFaceSide, (i + sides - 1) % sides}, true);
        break;
    }
  };
  run(kFirstGrid);
  const double most = scratch.demand.largest();
  if (most > kFirstGrid * kSegmentsPerCell)
    run(std::clamp(static_cast<int>(std::min<double>(most, kLargestViewRate)) / kSegmentsPerCell, kFirstGrid,
                   kLargestGrid));
}

/// Samples facets of the face at its present rates. Whether all are good; if not, scratch.demand holds higher rates.
bool RateFinder::measure(std::size_t face, Scratch& scratch) const {
  const std::span<const FaceEdge> sides = surface_.sides(face);
  const FaceDomain domain = surface_.domain(face);
  scratch.rates.clear();
  scratch.side_of.clear();
  for (std::size_t i = 0; i < sides.size(); ++i) {
    scratch.rates.push_back(static_cast<std::uint16_t>(edges_[sides[i].edge]));
    scratch.side_of.insert(scratch.side_of.end(), scratch.rates.back(), static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = 0; i < inner_rate_count(domain); ++i)
    scratch.rates.push_back(static_cast<std::uint16_t>(inner_[face][i]));
  const FacetPattern pattern = make_facet_pattern(domain, scratch.rates);
  find_hard_pieces(sides, scratch.rates, scratch.hard);
  identify_boundary(sides, scratch.rates, scratch.points);

  // All facets, or those at the corners and some in between.
  scratch.facets.clear();
  const std::size_t count = pattern.facet_count();
  // The subfaces of an n-gon meet inside it, and less smoothly than they are: there all count.
  const double share =
      domain == FaceDomain::quad_subfaces ? 1 : std::max(double(kMeasuredFacets) / double(count), 1.0 / kMeasuredShare);
  const auto is_chosen = [&](std::size_t f) {
    // Multiples of the golden ratio are spread evenly, and in step with no rows of the pattern.
    constexpr std::uint32_t kGoldenRatio = 0x9e3779b9u;
    return share >= 1 || static_cast<std::uint32_t>(f) * kGoldenRatio < share * 4294967296.0;
  };
  const auto is_corner = [&](std::uint32_t point) {
    return point < pattern.boundary_count && (point == 0 || scratch.side_of[point] != scratch.side_of[point - 1]);
  };
  for (std::size_t f = 0; f < count; ++f) {
    const std::uint32_t* c = &pattern.facets[3 * f];
    if (has_no_area(c, scratch.points)) continue;
    const int on_boundary =
        (c[0] < pattern.boundary_count) + (c[1] < pattern.boundary_count) + (c[2] < pattern.boundary_count);
    if (on_boundary > 1 || is_chosen(f) || is_corner(c[0]) || is_corner(c[1]) || is_corner(c[2]))
      scratch.facets.push_back(static_cast<std::uint32_t>(f));
  }

  // The points of those facets, then the middles of their edges, each once, and of themselves.
  scratch.parameters.clear();
  constexpr std::uint32_t kNotSampled = 0xffffffffu;
  scratch.sample_of.assign(pattern.parameters.size(), kNotSampled);
  for (const std::uint32_t f : scratch.facets)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::uint32_t& sample = scratch.sample_of[pattern.facets[3 * f + k]]; sample == kNotSampled) {
        sample = static_cast<std::uint32_t>(scratch.parameters.size());
        scratch.parameters.push_back(pattern.parameters[pattern.facets[3 * f + k]]);
      }
  static constexpr std::array<std::array<double, 3>, 4> kMiddles = {
      {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1.0 / 3, 1.0 / 3, 1.0 / 3}}};
  const std::size_t first = scratch.parameters.size();
  scratch.parameters.resize(first + 4 * scratch.facets.size());
  for (std::size_t i = 0; i < scratch.facets.size(); ++i) {
    const std::uint32_t* c = &pattern.facets[3 * scratch.facets[i]];
    parameters_in_facet(domain, sides.size(),
                        {pattern.parameters[c[0]], pattern.parameters[c[1]], pattern.parameters[c[2]]}, kMiddles,
                        &scratch.parameters[first + 4 * i]);
  }
  scratch.samples.resize(scratch.parameters.size());
  surface_.evaluate(face, scratch.parameters, scratch.samples);

  Demand& demand = scratch.demand;
  demand.reset(sides.size());
  bool good = true;
  for (std::size_t i = 0; i < scratch.facets.size(); ++i) {
    const std::uint32_t* c = &pattern.facets[3 * scratch.facets[i]];
    std::array<FacetCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const SurfaceSample& sample = scratch.samples[scratch.sample_of[c[k]]];
      corners[k] = {Vec3d(sample.position), Vec3d(sample.normal)};
    }
    const SampledFacet facet(view_, origin_, corners, hard_edges(c, scratch.hard));
    const bool cut_for_shading = facet.longest() >= kShortestCutForShading;
    for (std::size_t m = 0; m < 4; ++m) {
      const FacetDeviation deviation = facet.at(scratch.samples[first + 4 * i + m], kMiddles[m]);
      const double shading = cut_for_shading ? deviation.shading * kShadingBetweenSamples : 0;
      const double excess = std::max(deviation.pixels, shading) / tolerance_;
      if (!(excess > kGoodShare)) continue;
      // For the sake of normals alone rates rise to a limit.
      const bool for_shading = !(deviation.pixels / tolerance_ > kGoodShare);
      const double rise = std::min(std::sqrt(excess / kAim), kLargestRise);
      const auto raised = [&](double rate, double limit) {
        const double wanted = for_shading ? std::max(rate, std::min(rate * rise, limit)) : rate * rise;
        good = good && wanted == rate;
        return wanted;
      };
      std::array<bool, 2> along{true, true};
      if (m < 3 && domain == FaceDomain::quad) {
        const Vec2f d = pattern.parameters[c[(m + 1) % 3]] - pattern.parameters[c[m]];
        along = {2 * std::abs(d.x) > std::abs(d.y), 2 * std::abs(d.y) > std::abs(d.x)};
      }
      for (std::size_t k = 0; k < 2; ++k)
        if (along[k]) demand.inner[k] = std::max(demand.inner[k], raised(inner_[face][k], shading_inner_[face][k]));
      for (std::size_t k = 0; k < 3; ++k)
        if (c[k] < pattern.boundary_count) {
          const std::size_t side = scratch.side_of[c[k]];
          if (domain != FaceDomain::quad || along[side % 2])
            demand.raise_side(side, raised(scratch.rates[side], shading_edges_[sides[side].edge]));
          const std::size_t before = (side + sides.size() - 1) % sides.size();
          if (is_corner(c[k]) && (domain != FaceDomain::quad || along[before % 2]))
            demand.raise_side(before, raised(scratch.rates[before], shading_edges_[sides[before].edge]));
        }
    }
  }
  return good;
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

ViewRates RateFinder::find() {
  const auto for_each_face = [&](const auto& function) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, surface_.face_count(), kFacesAtOnce), [&](const auto& range) {
      Scratch scratch;
      for (std::size_t face = range.begin(); face != range.end(); ++face)
        if (!surface_.sides(face).empty()) function(face, scratch);
    });
  };
  const auto settle = [&] {
    for (std::uint32_t& rate : edges_) rate = std::min<std::uint32_t>(rate, kLargestViewRate);
    for_each_face([&](std::size_t face, Scratch&) { settle_inner(face); });
  };
  for_each_face([&](std::size_t face, Scratch& scratch) {
    estimate(face, scratch);
    take(face, scratch.demand);
  });
  for (int round = 0; round < kMostRounds; ++round) {
    settle();
    if (round == 0) limit_shading();
    const Buffer<std::uint32_t> edges_before = edges_;
    const Buffer<std::array<std::uint32_t, 2>> inner_before = inner_;
    // Rates are read as they were when the round began; what it demands is merged when it is over.
    std::vector<Demand> demands(surface_.face_count());
    for_each_face([&](std::size_t face, Scratch& scratch) {
      if (!pending_[face]) return;
      failed_[face] = measure(face, scratch) ? 0 : 1;
      if (failed_[face]) demands[face] = scratch.demand;
    });
    if (round + 1 == kMostRounds) break;
    for (std::size_t face = 0; face < demands.size(); ++face)
      if (pending_[face] && failed_[face]) take(face, demands[face]);
    settle();
    // A face is looked at again when its own rates or those of its sides have changed.
    bool any = false;
    for (std::size_t face = 0; face < demands.size(); ++face) {
      bool changed = inner_[face] != inner_before[face];
      for (const FaceEdge& side : surface_.sides(face)) changed |= edges_[side.edge] != edges_before[side.edge];
      pending_[face] = changed;
      any |= changed;
    }
    if (!any) break;
  }
  ViewRates result;
  result.coarse_faces = static_cast<std::size_t>(std::count(failed_.begin(), failed_.end(), 1));
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
