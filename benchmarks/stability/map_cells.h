// The cells of the stability maps: what is traced in each, and its counts.
#pragma once

#include <cstddef>

#include "benchmarks/stability/ray_probes.h"
#include "benchmarks/stability/stability_maps.h"

namespace raytree::benchmarks {

struct CellCounts {
  std::size_t asked = 0, misses = 0, false_hits = 0;
  std::size_t left = 0, self_hits = 0;  ///< rays that left a surface found; those that met it again

  double rate_of(std::size_t part, std::size_t of) const {
    return of == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / static_cast<double>(of);
  }
};

/// Rays from 3 sizes away at the faces of a ball of triangles, `offset` sizes from the origin.
CellCounts scale_cell(const StabilityRun& run, double size, double offset, std::size_t rays, std::uint64_t seed);

/// Rays from `distance` sizes away at a tilted quad, `angle` (radians) over it; they leave as low as they came.
CellCounts grazing_cell(const StabilityRun& run, double angle, double distance, std::size_t rays, std::uint64_t seed);

/// Rays through two parallel sheets `thickness` sizes apart, `offset` sizes from the origin. A miss: the second sheet
/// is not found behind the first; a false hit: a ray mirrored by the first meets either.
CellCounts slab_cell(const StabilityRun& run, double thickness, double offset, std::size_t rays, std::uint64_t seed);

/// Rays inside a medium of that index at its tilted border, within `distance` (radians) of the critical angle on either
/// side. A miss: a ray that ought to pass is reflected totally; a false hit: the reverse.
CellCounts critical_cell(const StabilityRun& run, double index, double distance, std::size_t rays, std::uint64_t seed);

enum class MapAim : std::uint8_t { faces, near_edges, edges, near_corners, corners };

/// Rays from inside a ball of sides * (sides - 2) triangles; those that are near pass an edge or a corner by up to 1e-4
/// of its radius.
CellCounts aimed_cell(const StabilityRun& run, MapAim aim, int sides, std::size_t rays, std::uint64_t seed);

}  // namespace raytree::benchmarks
