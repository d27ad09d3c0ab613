// The facet patterns of all faces of a surface, each made once for all faces with the same rates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/facet_pattern.h"
#include "geometry/parametric_surface.h"
#include "geometry/tessellation.h"

namespace raytree {

class FacetPatternSet {
 public:
  /// Patterns are kept in the order of the faces that use them first, until they take `most_bytes`. Runs on the task
  /// arena's threads. The rates must be valid. Throws Error (bad_input) for a face of too many facets.
  FacetPatternSet(const ParametricSurface& surface, const TessellationRates& rates,
                  std::size_t most_bytes = std::size_t(256) << 20);

  /// The counts of a face's pattern; of a hole all 0.
  const FacetCounts& counts(std::size_t face) const { return counts_[numbers_[face]]; }

  /// The face's pattern; null when it is not kept, and for holes.
  const FacetPattern* kept(std::size_t face) const {
    const std::uint32_t number = numbers_[face];
    return number < patterns_.size() && !patterns_[number].facets.empty() ? &patterns_[number] : nullptr;
  }

  std::size_t pattern_count() const { return counts_.size() - 1; }

 private:
  Buffer<std::uint32_t> numbers_;       ///< [face] of its pattern; 0 for holes
  std::vector<FacetCounts> counts_;     ///< [pattern]
  std::vector<FacetPattern> patterns_;  ///< [pattern], empty where it is not kept
};

}  // namespace raytree
