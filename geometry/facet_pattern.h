// How one face is cut into triangles: points in the face's own parameters and facets over them, for any number of
// segments along each side. Knows no surface; the patterns are OpenSubdiv's (Bfr::Tessellation), which stays behind
// facet_pattern.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/parametric_surface.h"

namespace raytree {

/// Segments along an edge, at most. A quad of that rate has two million triangles.
inline constexpr int kLargestRate = 1024;

struct FacetPattern {
  /// Those of the boundary first, counter-clockwise: corner 0, the inner points of side 0, corner 1 ...
  std::vector<Vec2f> parameters;
  std::uint32_t boundary_count = 0;
  std::vector<std::uint32_t> facets;  ///< [facet count][3], indices into parameters, counter-clockwise

  std::size_t facet_count() const { return facets.size() / 3; }
};

/// How many rates beside those of its sides a face of that domain has: a quad's u and v, one for all else.
constexpr std::size_t inner_rate_count(FaceDomain domain) { return domain == FaceDomain::quad ? 2 : 1; }

/// rates: one a side in order, then the inner ones, each from 1 to kLargestRate. An inner rate is that of the rings of
/// points parallel to the sides: with all rates r a quad has 2 r^2 facets and (r + 1)^2 points, a triangle r^2 facets
/// and (r + 1)(r + 2) / 2 points. Throws Error (bad_input) for a face of more than 2^30 facets.
FacetPattern make_facet_pattern(FaceDomain domain, std::span<const std::uint16_t> rates);

/// What a pattern is a function of: the domain, then the rates; empty for none.
using PatternKey = std::vector<std::uint16_t>;
struct PatternKeyHash {
  std::size_t operator()(const PatternKey& key) const {
    std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, a word at a time
    for (const std::uint16_t value : key) hash = (hash ^ value) * 0x100000001b3u;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

struct FacetCounts {
  std::uint32_t boundary = 0, interior = 0;  ///< points
  std::uint32_t facets = 0;
};

/// The counts of make_facet_pattern() without the pattern. Throws as it does.
FacetCounts count_facets(FaceDomain domain, std::span<const std::uint16_t> rates);

/// Where the subface at corner `i` of an n-gon begins; it is half a unit wide.
Vec2d subface_corner(std::size_t sides, std::size_t i);

/// The face's parameters at points of a facet: weights are barycentric coordinates [count]. Where a facet lies across
/// subfaces of an n-gon the way between its corners is one over the n-gon laid out flat.
void parameters_in_facet(FaceDomain domain, std::size_t sides, const std::array<Vec2f, 3>& corners,
                         std::span<const std::array<double, 3>> weights, Vec2f* parameters);

}  // namespace raytree
