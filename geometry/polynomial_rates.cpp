// At each place the surface is its Taylor series of second order, and so is the field of its unit normals. An edge
// takes the rates of the places that its facets reach.
#include "geometry/polynomial_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/facet_deviation.h"

namespace raytree {
namespace {

/// Places each way: 0, 1/3, 2/3, 1; and twice as close, where a face gets more facets than would lie between these.
constexpr std::size_t kPlaces = 4, kMorePlaces = 7;
constexpr double kFewFacets = 24;  ///< pairs of facets

/// Bernstein's polynomials and their first three derivatives at the places: [order][place][control point].
template <std::size_t Count>
struct PlaceWeights {
  std::array<std::array<std::array<double, 4>, Count>, 4> order{};

  constexpr PlaceWeights() {
    for (std::size_t place = 0; place < Count; ++place) {
      const double t = double(place) / (Count - 1), s = 1 - t;
      order[0][place] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
      order[1][place] = {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
      order[2][place] = {6 * s, 6 * t - 12 * s, 6 * s - 12 * t, 6 * t};
      order[3][place] = {-6, 18, -18, 6};
    }
  }
};
template <std::size_t Count>
constexpr PlaceWeights<Count> kWeights;

/// The surface at one place, relative to its origin, and its derivatives.
struct PlaceDerivatives {
  Vec3d at, u, v, uu, uv, vv, uuu, uuv, uvv, vvv;
};

template <std::size_t Count>
using Places = std::array<PlaceDerivatives, Count * Count>;  ///< [v][u]

Vec3d weighted(const std::array<Vec3d, 4>& points, const std::array<double, 4>& weights) {
  return points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2] + points[3] * weights[3];
}

template <std::size_t Count>
void evaluate_places(const BezierPatch& patch, Places<Count>& places) {
  for (std::size_t i = 0; i < Count; ++i) {
    std::array<std::array<Vec3d, 4>, 4> rows;  // [order along u][row of control points]
    for (std::size_t j = 0; j < 4; ++j) {
      const std::array<Vec3d, 4> row{patch.points[4 * j], patch.points[4 * j + 1], patch.points[4 * j + 2],
                                     patch.points[4 * j + 3]};
      for (std::size_t k = 0; k < 4; ++k) rows[k][j] = weighted(row, kWeights<Count>.order[k][i]);
    }
    for (std::size_t j = 0; j < Count; ++j) {
      const auto derivative = [&](std::size_t along_u, std::size_t along_v) {
        return weighted(rows[along_u], kWeights<Count>.order[along_v][j]);
      };
      places[j * Count + i] = {derivative(0, 0), derivative(1, 0), derivative(0, 1), derivative(2, 0),
                               derivative(1, 1), derivative(0, 2), derivative(3, 0), derivative(2, 1),
                               derivative(1, 2), derivative(0, 3)};
    }
  }
}

/// First derivatives of the unit normal, and second ones less what is along it, which turns nothing.
struct NormalDerivatives {
  Vec3d normal, u, v, uu, uv, vv;
};

/// The normal's N = P_u x P_v = r n: n_a = N_a / r - n r_a / r, and across n, n_ab = N_ab / r - n_a r_b / r - n_b r_a /
/// r. Nothing where the parameters have next to no area.
std::optional<NormalDerivatives> normal_derivatives(const PlaceDerivatives& d) {
  constexpr double kLeastSine = 1e-3;  // of the angle between the tangents
  const Vec3d cross = d.u.cross(d.v);
  const double r = cross.length();
  if (!(r > kLeastSine * d.u.length() * d.v.length())) return std::nullopt;
  NormalDerivatives result;
  const Vec3d n = cross / r;
  const auto across = [&](const Vec3d& x) { return x - n * n.dot(x); };
  const Vec3d cross_u = (d.uu.cross(d.v) + d.u.cross(d.uv)) / r, cross_v = (d.uv.cross(d.v) + d.u.cross(d.vv)) / r;
  const double r_u = n.dot(cross_u), r_v = n.dot(cross_v);
  result.normal = n;
  result.u = across(cross_u);
  result.v = across(cross_v);
  result.uu = across(d.uuu.cross(d.v) + d.uu.cross(d.uv) * 2.0 + d.u.cross(d.uuv)) / r - result.u * (2 * r_u);
  result.uv = across(d.uuv.cross(d.v) + d.uu.cross(d.vv) + d.u.cross(d.uvv)) / r - result.u * r_v - result.v * r_u;
  result.vv = across(d.uvv.cross(d.v) + d.uv.cross(d.vv) * 2.0 + d.u.cross(d.vvv)) / r - result.v * (2 * r_v);
  return result;
}

struct PlaceRates {
  double u, v;
  double turn_u, turn_v;  ///< of the normal, radians a unit of the parameter
};

class PlaceJudge {
 public:
  PlaceJudge(const PlaceDerivatives& d, const NormalDerivatives& normals, const RateGoal& goal,
             const std::array<double, 2>& longest)
      : d_(d), normals_(normals), goal_(goal), at_(goal.origin + d.at), longest_(longest) {}

  PlaceRates rates() const {
    const double pixels_n = pixels(normals_.normal), pixels_u = pixels(d_.u), pixels_v = pixels(d_.v);
    const double turn_u = normals_.u.length(), turn_v = normals_.v.length();
    // An eighth, in units of the tolerance aimed at.
    const double unit = 0.125 / (goal_.tolerance * kPolynomialAim);
    const auto off = [&](const Vec3d& second) { return std::abs(normals_.normal.dot(second)) * pixels_n * unit; };
    const double a = off(d_.uu), b = off(d_.uv), c = off(d_.vv);
    std::array<double, 2> result = at_least_one(segments(a, b, c));
    // Along the surface a displacement counts as much as facets turn against each other: see SampledFacet.
    const double widest = std::max({pixels_n, pixels_u / d_.u.length(), pixels_v / d_.v.length()});
    const double bend = std::min(1.0, turn_u / result[0] + turn_v / result[1]) * widest * unit;
    const auto along = [&](const Vec3d& second) {
      return (second - normals_.normal * normals_.normal.dot(second)).length() * bend;
    };
    result = at_least_one(segments(a + along(d_.uu), b + along(d_.uv), c + along(d_.vv)));

    const double turn_a_pixel = std::max({kTurnPerPixel, turn_u / pixels_u, turn_v / pixels_v});
    const double turned = 0.125 / (goal_.tolerance * kRateAim * turn_a_pixel);
    const std::array<double, 2> shaded =
        segments(normals_.uu.length() * turned, normals_.uv.length() * turned, normals_.vv.length() * turned);
    // Facets of any size keep the loose bound.
    const double loose = 1 / std::sqrt(kLooseShading);
    result = {std::max(result[0], shaded[0] * loose), std::max(result[1], shaded[1] * loose)};
    if (shaded[0] > result[0] || shaded[1] > result[1]) result = cut_for_shading(result, shaded);
    return {result[0], result[1], turn_u, turn_v};
  }

  /// For the outline of a side along which the surface ends: along u, or v.
  double outline_rate(bool along_u) const {
    const Vec3d &edge = along_u ? d_.u : d_.v, &second = along_u ? d_.uu : d_.vv;
    const Vec3d off = second - edge * (edge.dot(second) / edge.dot(edge));
    return std::sqrt(pixels(off) * 0.125 / (goal_.tolerance * kPolynomialAim));
  }

 private:
  double pixels(const Vec3d& displacement) const { return goal_.view.pixels(at_, displacement); }
  static std::array<double, 2> at_least_one(const std::array<double, 2>& rates) {
    return {std::max(rates[0], 1.0), std::max(rates[1], 1.0)};
  }
  /// Of the facets' edges, their diagonals at most.
  double longest(const std::array<double, 2>& rates) const { return longest_[0] / rates[0] + longest_[1] / rates[1]; }
  /// From the rates of distance to those of shading, but no further than to where facets are small.
  std::array<double, 2> cut_for_shading(const std::array<double, 2>& from, const std::array<double, 2>& shaded) const {
    constexpr double kShort = kShortestShadedEdge;
    constexpr int kSteps = 6;
    const auto between = [&](double t) {
      return std::array<double, 2>{from[0] + t * std::max(0.0, shaded[0] - from[0]),
                                   from[1] + t * std::max(0.0, shaded[1] - from[1])};
    };
    if (longest(from) < kShort) return from;
    if (longest(between(1)) >= kShort) return between(1);
    double low = 0, high = 1;
    for (int i = 0; i < kSteps; ++i) {
      const double middle = (low + high) / 2;
      (longest(between(middle)) < kShort ? high : low) = middle;
    }
    return between(high);
  }

  const PlaceDerivatives& d_;
  const NormalDerivatives& normals_;
  const RateGoal& goal_;
  Vec3d at_;
  std::array<double, 2> longest_;
};

/// Pixels that a unit of each parameter looks long at a place or one beside it, at most.
template <std::size_t Count>
class PlaceLengths {
 public:
  PlaceLengths(const Places<Count>& places, const RateGoal& goal) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const PlaceDerivatives& d = places[i];
      at_[i] = {goal.view.pixels(goal.origin + d.at, d.u), goal.view.pixels(goal.origin + d.at, d.v)};
    }
  }
  std::array<double, 2> longest_about(std::size_t i, std::size_t j) const {
    std::array<double, 2> longest{0, 0};
    for (std::size_t b = j - std::min<std::size_t>(j, 1); b <= std::min(j + 1, Count - 1); ++b)
      for (std::size_t a = i - std::min<std::size_t>(i, 1); a <= std::min(i + 1, Count - 1); ++a)
        for (std::size_t k = 0; k < 2; ++k) longest[k] = std::max(longest[k], at_[b * Count + a][k]);
    return longest;
  }

 private:
  std::array<std::array<double, 2>, Count * Count> at_{};
};

template <std::size_t Count>
PolynomialDemand demand_at_places(const BezierPatch& patch, std::span<const FaceEdge> sides, const RateGoal& goal,
                                  RateDemand& demand) {
  demand.reset(4);
  Places<Count> places;
  evaluate_places<Count>(patch, places);
  const PlaceLengths<Count> lengths(places, goal);
  std::array<PlaceRates, Count * Count> rates;
  for (std::size_t j = 0; j < Count; ++j)
    for (std::size_t i = 0; i < Count; ++i) {
      const PlaceDerivatives& place = places[j * Count + i];
      const std::optional<NormalDerivatives> normals = normal_derivatives(place);
      if (!normals) return PolynomialDemand::degenerate;
      const PlaceJudge judge(place, *normals, goal, lengths.longest_about(i, j));
      PlaceRates& found = rates[j * Count + i];
      found = judge.rates();
      demand.inner[0] = std::max(demand.inner[0], found.u);
      demand.inner[1] = std::max(demand.inner[1], found.v);
      const std::array<bool, 4> on_side{j == 0, i + 1 == Count, j + 1 == Count, i == 0};
      for (std::size_t side = 0; side < 4; ++side)
        if (on_side[side] && sides[side].sharp_edge) demand.raise_side(side, judge.outline_rate(side % 2 == 0));
    }
  double turn = 0;
  for (const PlaceRates& place : rates)
    turn = std::max(turn, place.turn_u / demand.inner[0] + place.turn_v / demand.inner[1]);
  if (!(turn <= kLargestModeledTurn)) return PolynomialDemand::turns_much;
  // Facets at a side reach one segment deep.
  const std::array<double, 2> deep{1 / demand.inner[0], 1 / demand.inner[1]};
  for (std::size_t j = 0; j < Count; ++j)
    for (std::size_t i = 0; i < Count; ++i) {
      const PlaceRates& place = rates[j * Count + i];
      const double u = double(i) / (Count - 1), v = double(j) / (Count - 1);
      if (v <= deep[1]) demand.raise_side(0, place.u);
      if (1 - u <= deep[0]) demand.raise_side(1, place.v);
      if (1 - v <= deep[1]) demand.raise_side(2, place.u);
      if (u <= deep[0]) demand.raise_side(3, place.v);
    }
  return PolynomialDemand::found;
}

}  // namespace

bool is_regular(const ParametricSurface& surface, std::size_t face) {
  BezierPatch patch;
  if (!surface.polynomial_patch(face, patch)) return false;
  Places<kPlaces> places;
  evaluate_places<kPlaces>(patch, places);
  return std::all_of(places.begin(), places.end(),
                     [](const PlaceDerivatives& place) { return normal_derivatives(place).has_value(); });
}

PolynomialDemand demand_of_polynomial(const BezierPatch& patch, std::span<const FaceEdge> sides, const RateGoal& goal,
                                      RateDemand& demand) {
  const PolynomialDemand result = demand_at_places<kPlaces>(patch, sides, goal, demand);
  if (result != PolynomialDemand::found || demand.inner[0] * demand.inner[1] <= kFewFacets) return result;
  return demand_at_places<kMorePlaces>(patch, sides, goal, demand);
}

}  // namespace raytree
