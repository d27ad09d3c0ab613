#include "geometry/facet_pattern.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/angle.h"
#include "geometry/error.h"

namespace raytree {
namespace {

namespace Bfr = OpenSubdiv::Bfr;

/// OpenSubdiv counts in int.
constexpr std::uint64_t kMostFacets = std::uint64_t(1) << 30;

Bfr::Parameterization parameterization(FaceDomain domain, std::size_t sides) {
  return domain == FaceDomain::triangle
             ? Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_LOOP, 3)
             : Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, static_cast<int>(sides));
}

/// Calls function(Bfr::Tessellation).
template <class Function>
auto with_tessellation(FaceDomain domain, std::span<const std::uint16_t> rates, Function&& function) {
  const std::size_t sides = rates.size() - inner_rate_count(domain);
  const std::uint64_t largest = *std::max_element(rates.begin(), rates.end());
  if (sides * largest * largest > kMostFacets)
    throw Error(ErrorKind::bad_input, {},
                fmt::format("a face of {} sides cannot be cut into {} segments a side", sides, largest));
  std::array<int, 16> few;
  std::vector<int> many;
  int* numbers = few.data();
  if (rates.size() > few.size()) {
    many.resize(rates.size());
    numbers = many.data();
  }
  std::copy(rates.begin(), rates.end(), numbers);
  const Bfr::Tessellation tessellation(parameterization(domain, sides), static_cast<int>(rates.size()), numbers);
  if (!tessellation.IsValid()) throw Error(ErrorKind::failure, {}, "OpenSubdiv refuses the rates of a face");
  return function(tessellation);
}

/// A point of an n-gon: coordinates in the unit square of one of its subfaces, whose corner (0, 0) is the n-gon's and
/// whose corner (1, 1) its center.
struct SubfacePoint {
  int subface = 0;
  Vec2d at;
};

/// The same point as seen from `subface`, if it lies on it: next to each other subfaces share the side from the middle
/// of the n-gon's side to its center, where one has (t, 1) and the one before it (1, t).
std::optional<Vec2d> seen_from(const SubfacePoint& point, int subface, int count) {
  if (point.subface == subface) return point.at;
  if (point.at == Vec2d(1, 1)) return point.at;
  if (point.subface == (subface + 1) % count && point.at.y == 1) return Vec2d(1, point.at.x);
  if (subface == (point.subface + 1) % count && point.at.x == 1) return Vec2d(point.at.y, 1);
  return std::nullopt;
}

/// An n-gon laid out as a regular polygon about 0, bilinear within each subface.
class FlatPolygon {
 public:
  explicit FlatPolygon(int count) : count_(count), step_(2 * kPi / count) {}

  Vec2d place(const SubfacePoint& p) const {
    const double u = p.at.x, v = p.at.y;
    return here(p.subface) * ((1 - u) * (1 - v)) + middle(p.subface) * (u * (1 - v)) +
           middle(p.subface - 1) * ((1 - u) * v);
  }
  SubfacePoint at(const Vec2d& place_sought) const {
    SubfacePoint p;
    const double angle = std::atan2(place_sought.y, place_sought.x);
    p.subface = (static_cast<int>(std::lround(angle / step_)) + count_) % count_;
    p.at = {0.5, 0.5};
    const Vec2d a = here(p.subface), b = middle(p.subface), c = middle(p.subface - 1);
    constexpr int kSteps = 12;  // Newton's; the kite is convex and its map without folds
    for (int i = 0; i < kSteps; ++i) {
      const double u = p.at.x, v = p.at.y;
      const Vec2d miss = place(p) - place_sought;
      const Vec2d du = (b - a) * (1 - v) - c * v, dv = (c - a) * (1 - u) - b * u;
      const double determinant = du.x * dv.y - du.y * dv.x;
      if (std::abs(determinant) < 1e-12) break;
      p.at.x = std::clamp(u - (miss.x * dv.y - miss.y * dv.x) / determinant, 0.0, 1.0);
      p.at.y = std::clamp(v - (du.x * miss.y - du.y * miss.x) / determinant, 0.0, 1.0);
    }
    return p;
  }

 private:
  Vec2d here(int i) const { return {std::cos(step_ * i), std::sin(step_ * i)}; }
  Vec2d middle(int i) const { return (here(i) + here(i + 1)) * 0.5; }

  int count_;
  double step_;
};

}  // namespace

Vec2d subface_corner(std::size_t sides, std::size_t i) {
  double corner[2];
  parameterization(FaceDomain::quad_subfaces, sides).GetVertexCoord(static_cast<int>(i), corner);
  return {corner[0], corner[1]};
}

void parameters_in_facet(FaceDomain domain, std::size_t sides, const std::array<Vec2f, 3>& corners,
                         std::span<const std::array<double, 3>> weights, Vec2f* parameters) {
  const auto blend = [](const Vec2d& a, const Vec2d& b, const Vec2d& c, const std::array<double, 3>& w) {
    return a * w[0] + b * w[1] + c * w[2];
  };
  if (domain != FaceDomain::quad_subfaces) {
    for (const auto& w : weights)
      *parameters++ = Vec2f(blend(Vec2d(corners[0]), Vec2d(corners[1]), Vec2d(corners[2]), w));
    return;
  }
  const Bfr::Parameterization layout = parameterization(domain, sides);
  const auto count = static_cast<int>(sides);
  std::array<SubfacePoint, 3> points;
  for (std::size_t i = 0; i < 3; ++i) {
    const double from[2] = {corners[i].x, corners[i].y};
    double to[2];
    points[i].subface = layout.ConvertCoordToNormalizedSubFace(from, to);
    points[i].at = {to[0], to[1]};
  }
  const auto write = [&](const SubfacePoint& point) {
    const double from[2] = {point.at.x, point.at.y};
    double to[2];
    layout.ConvertNormalizedSubFaceToCoord(point.subface, from, to);
    *parameters++ = {static_cast<float>(to[0]), static_cast<float>(to[1])};
  };
  for (const SubfacePoint& candidate : points) {
    std::array<Vec2d, 3> seen;
    bool all = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<Vec2d> at = seen_from(points[i], candidate.subface, count);
      all = all && at;
      if (at) seen[i] = *at;
    }
    if (!all) continue;
    for (const auto& w : weights) write({candidate.subface, blend(seen[0], seen[1], seen[2], w)});
    return;
  }
  const FlatPolygon flat(count);
  const Vec2d a = flat.place(points[0]), b = flat.place(points[1]), c = flat.place(points[2]);
  for (const auto& w : weights) write(flat.at(blend(a, b, c, w)));
}

FacetPattern make_facet_pattern(FaceDomain domain, std::span<const std::uint16_t> rates) {
  return with_tessellation(domain, rates, [](const Bfr::Tessellation& tessellation) {
    FacetPattern pattern;
    // In double: OpenSubdiv adds up steps along a side.
    std::vector<double> coordinates(2 * static_cast<std::size_t>(tessellation.GetNumCoords()));
    tessellation.GetCoords(coordinates.data());
    pattern.parameters.reserve(coordinates.size() / 2);
    for (std::size_t i = 0; i < coordinates.size(); i += 2)
      pattern.parameters.emplace_back(static_cast<float>(coordinates[i]), static_cast<float>(coordinates[i + 1]));
    pattern.boundary_count = static_cast<std::uint32_t>(tessellation.GetNumBoundaryCoords());
    std::vector<int> facets(3 * static_cast<std::size_t>(tessellation.GetNumFacets()));
    tessellation.GetFacets(facets.data());
    pattern.facets.assign(facets.begin(), facets.end());
    return pattern;
  });
}

FacetCounts count_facets(FaceDomain domain, std::span<const std::uint16_t> rates) {
  return with_tessellation(domain, rates, [](const Bfr::Tessellation& tessellation) {
    return FacetCounts{static_cast<std::uint32_t>(tessellation.GetNumBoundaryCoords()),
                       static_cast<std::uint32_t>(tessellation.GetNumInteriorCoords()),
                       static_cast<std::uint32_t>(tessellation.GetNumFacets())};
  });
}

}  // namespace raytree
