#include "geometry/facet_pattern.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <array>

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

}  // namespace

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

std::size_t FacetPatternSet::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, a word at a time
  for (const std::uint16_t value : key) hash = (hash ^ value) * 0x100000001b3u;
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

std::uint32_t FacetPatternSet::find(FaceDomain domain, std::span<const std::uint16_t> rates) {
  key_.assign(1, static_cast<std::uint16_t>(domain));
  key_.insert(key_.end(), rates.begin(), rates.end());
  if (key_ == last_key_) return last_;
  const auto found = numbers_.find(key_);
  if (found != numbers_.end()) {
    last_ = found->second;
  } else if (bytes_ < most_bytes_) {
    patterns_.push_back(make_facet_pattern(domain, rates));
    const FacetPattern& made = patterns_.back();
    bytes_ += made.parameters.size() * sizeof(Vec2f) + made.facets.size() * sizeof(std::uint32_t);
    last_ = static_cast<std::uint32_t>(patterns_.size() - 1);
    numbers_.emplace(key_, last_);
  } else {
    last_ = kNotKept;
  }
  last_key_ = key_;
  return last_;
}

}  // namespace raytree
