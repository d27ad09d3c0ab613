// Which facets of a face are looked at when its rates are judged, and where: a function of domain and rates, made once
// for all faces that have the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/facet_pattern.h"

namespace raytree {

/// Where facets are sampled: the middles of their edges, from each corner to the next, and their own.
inline constexpr std::array<std::array<double, 3>, 4> kFacetMiddles = {
    {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1.0 / 3, 1.0 / 3, 1.0 / 3}}};

/// Facets inside one face that are looked at: so many, or one in so many if that is more. Those that touch its boundary
/// all are: at semi-sharp creases and extraordinary vertices deviations change most. So are those of n-gons, whose
/// subfaces meet inside, and less smoothly than they are, and of faces whose normals are held to the tolerance.
inline constexpr std::size_t kMeasuredFacets = 16, kMeasuredShare = 32;

struct SampledPattern {
  struct Facet {
    std::uint32_t number;                  ///< in the pattern
    std::array<std::uint32_t, 3> corners;  ///< parameters
    std::array<std::uint32_t, 4> middles;  ///< parameters, as kFacetMiddles has them
  };
  FacetPattern pattern;
  std::vector<std::uint32_t> side_of;  ///< [boundary points] the side that a point of the boundary lies on
  std::vector<Facet> facets;           ///< those at the corners first
  std::vector<Vec2f> parameters;       ///< each once, in the order of the facets
  /// Of these, facets at the corners and what they need: where a face is not good enough, they mostly tell.
  std::size_t corner_facets = 0, corner_parameters = 0;

  bool is_corner(std::uint32_t point) const {
    return point < pattern.boundary_count && (point == 0 || side_of[point] != side_of[point - 1]);
  }
};

enum class MeasuredFacets : std::uint8_t { some, all };

/// rates: as make_facet_pattern() takes them.
SampledPattern make_sampled_pattern(FaceDomain domain, std::span<const std::uint16_t> rates, MeasuredFacets measured);

/// Keeps what was made lately. One thread's.
class SampledPatternCache {
 public:
  /// Holds until the next call.
  const SampledPattern& find(FaceDomain domain, std::span<const std::uint16_t> rates, MeasuredFacets measured);

 private:
  PatternKey key_;
  std::unordered_map<PatternKey, SampledPattern, PatternKeyHash> patterns_;
  std::size_t bytes_ = 0;
};

}  // namespace raytree
