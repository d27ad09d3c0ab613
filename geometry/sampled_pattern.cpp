#include "geometry/sampled_pattern.h"

#include <algorithm>
#include <utility>

namespace raytree {
namespace {

constexpr std::size_t kKeptBytes = std::size_t(32) << 20;  ///< of patterns; beyond, all are dropped

/// All facets, or those at the boundary and some in between; those at the corners first.
std::vector<std::uint32_t> measured_facets(FaceDomain domain, const SampledPattern& sampled, MeasuredFacets measured,
                                           std::size_t& corner_facets) {
  const FacetPattern& pattern = sampled.pattern;
  const std::size_t count = pattern.facet_count();
  const double share = domain == FaceDomain::quad_subfaces || measured == MeasuredFacets::all
                           ? 1
                           : std::max(double(kMeasuredFacets) / double(count), 1.0 / kMeasuredShare);
  const auto is_chosen = [&](std::size_t f) {
    // Multiples of the golden ratio are spread evenly, and in step with no rows of the pattern.
    constexpr std::uint32_t kGoldenRatio = 0x9e3779b9u;
    return share >= 1 || static_cast<std::uint32_t>(f) * kGoldenRatio < share * 4294967296.0;
  };
  std::vector<std::uint32_t> facets, others;
  for (std::size_t f = 0; f < count; ++f) {
    const std::uint32_t* c = &pattern.facets[3 * f];
    const bool on_boundary =
        c[0] < pattern.boundary_count || c[1] < pattern.boundary_count || c[2] < pattern.boundary_count;
    if (sampled.is_corner(c[0]) || sampled.is_corner(c[1]) || sampled.is_corner(c[2]))
      facets.push_back(static_cast<std::uint32_t>(f));
    else if (on_boundary || is_chosen(f))
      others.push_back(static_cast<std::uint32_t>(f));
  }
  corner_facets = facets.size();
  facets.insert(facets.end(), others.begin(), others.end());
  return facets;
}

}  // namespace

SampledPattern make_sampled_pattern(FaceDomain domain, std::span<const std::uint16_t> rates, MeasuredFacets measured) {
  SampledPattern sampled;
  sampled.pattern = make_facet_pattern(domain, rates);
  const FacetPattern& pattern = sampled.pattern;
  const std::size_t sides = rates.size() - inner_rate_count(domain);
  for (std::size_t i = 0; i < sides; ++i)
    sampled.side_of.insert(sampled.side_of.end(), rates[i], static_cast<std::uint32_t>(i));

  constexpr std::uint32_t kNotSampled = 0xffffffffu;
  std::vector<std::uint32_t> sample_of(pattern.parameters.size(), kNotSampled);
  std::unordered_map<std::uint64_t, std::uint32_t> edges;  // of two points to the sample at its middle
  const auto add = [&](const Vec2f& parameter) {
    sampled.parameters.push_back(parameter);
    return static_cast<std::uint32_t>(sampled.parameters.size() - 1);
  };
  for (const std::uint32_t number : measured_facets(domain, sampled, measured, sampled.corner_facets)) {
    const std::uint32_t* c = &pattern.facets[3 * std::size_t(number)];
    SampledPattern::Facet& facet = sampled.facets.emplace_back();
    facet.number = number;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& sample = sample_of[c[k]];
      if (sample == kNotSampled) sample = add(pattern.parameters[c[k]]);
      facet.corners[k] = sample;
    }
    std::array<Vec2f, kFacetMiddles.size()> middles;
    parameters_in_facet(domain, sides, {pattern.parameters[c[0]], pattern.parameters[c[1]], pattern.parameters[c[2]]},
                        kFacetMiddles, middles.data());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(c[k], c[(k + 1) % 3]);
      const auto [found, fresh] = edges.try_emplace(std::uint64_t(low) << 32 | high, 0);
      if (fresh) found->second = add(middles[k]);
      facet.middles[k] = found->second;
    }
    facet.middles[3] = add(middles[3]);
    if (sampled.facets.size() == sampled.corner_facets) sampled.corner_parameters = sampled.parameters.size();
  }
  return sampled;
}

const SampledPattern& SampledPatternCache::find(FaceDomain domain, std::span<const std::uint16_t> rates,
                                                MeasuredFacets measured) {
  key_.assign({static_cast<std::uint16_t>(domain), static_cast<std::uint16_t>(measured)});
  key_.insert(key_.end(), rates.begin(), rates.end());
  if (const auto found = patterns_.find(key_); found != patterns_.end()) return found->second;
  if (bytes_ > kKeptBytes) {
    patterns_.clear();
    bytes_ = 0;
  }
  SampledPattern made = make_sampled_pattern(domain, rates, measured);
  bytes_ += (made.pattern.parameters.size() + made.parameters.size()) * sizeof(Vec2f) +
            (made.pattern.facets.size() + made.side_of.size()) * sizeof(std::uint32_t) +
            made.facets.size() * sizeof(SampledPattern::Facet);
  return patterns_.emplace(key_, std::move(made)).first->second;
}

}  // namespace raytree
