// Blocks of faces number their own rates side by side; what the blocks found is then numbered as a whole.
#include "geometry/facet_pattern_set.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <unordered_map>

namespace raytree {
namespace {

using Numbers = std::unordered_map<PatternKey, std::uint32_t, PatternKeyHash>;

constexpr std::size_t kBlockFaces = 8192;  // faces

FaceDomain domain_of(const PatternKey& key) { return static_cast<FaceDomain>(key[0]); }
std::span<const std::uint16_t> rates_of(const PatternKey& key) { return std::span(key).subspan(1); }

}  // namespace

FacetPatternSet::FacetPatternSet(const ParametricSurface& surface, const TessellationRates& rates,
                                 std::size_t most_bytes)
    : numbers_(surface.face_count()) {
  const std::size_t blocks = (numbers_.size() + kBlockFaces - 1) / kBlockFaces;
  const auto block_end = [&](std::size_t block) { return std::min(numbers_.size(), (block + 1) * kBlockFaces); };
  std::vector<std::vector<PatternKey>> found(blocks);  // in the order of faces
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    Numbers known;
    PatternKey key, last;
    std::vector<std::uint16_t> face_rates;
    std::uint32_t number = 0;
    for (std::size_t face = block * kBlockFaces; face < block_end(block); ++face) {
      key.clear();
      if (!surface.sides(face).empty()) {
        rates_of_face(surface, rates, face, face_rates);
        key.push_back(static_cast<std::uint16_t>(surface.domain(face)));
        key.insert(key.end(), face_rates.begin(), face_rates.end());
      }
      if (key != last || known.empty()) {
        const auto [place, added] = known.try_emplace(key, static_cast<std::uint32_t>(known.size()));
        if (added) found[block].push_back(key);
        number = place->second;
        last = key;
      }
      numbers_[face] = number;
    }
  });

  Numbers numbers{{PatternKey(), 0}};
  std::vector<const PatternKey*> keys{&numbers.begin()->first};
  std::vector<std::vector<std::uint32_t>> whole(blocks);  // [block][number within it]
  for (std::size_t block = 0; block < blocks; ++block)
    for (const PatternKey& key : found[block]) {
      const auto [place, added] = numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size()));
      if (added) keys.push_back(&place->first);
      whole[block].push_back(place->second);
    }
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    for (std::size_t face = block * kBlockFaces; face < block_end(block); ++face)
      numbers_[face] = whole[block][numbers_[face]];
  });

  counts_.resize(keys.size());
  const tbb::blocked_range<std::size_t> patterns(1, std::max<std::size_t>(1, keys.size()), 16);
  tbb::parallel_for(patterns, [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      counts_[i] = count_facets(domain_of(*keys[i]), rates_of(*keys[i]));
  });
  std::size_t bytes = 0;
  while (patterns_.size() < keys.size() && bytes < most_bytes) {
    const FacetCounts& counts = counts_[patterns_.size()];
    bytes += std::size_t(counts.boundary + counts.interior) * sizeof(Vec2f) + counts.facets * 3 * sizeof(std::uint32_t);
    patterns_.emplace_back();
  }
  tbb::parallel_for(std::size_t(1), std::max<std::size_t>(1, patterns_.size()),
                    [&](std::size_t i) { patterns_[i] = make_facet_pattern(domain_of(*keys[i]), rates_of(*keys[i])); });
}

}  // namespace raytree
