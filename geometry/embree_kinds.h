// The kinds of geometry that Embree offers for a tessellated surface, built over the same surface and traced by the
// same rays by bare calls: for the benchmark that compares them. The renderer builds triangles or quads
// of pairs (quad_pairs.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"

namespace raytree {

enum class EmbreeKind : std::uint8_t { triangles, compact_triangles, quads, compact_quads, grids };
inline constexpr int kEmbreeKindCount = 5;
const char* name_of(EmbreeKind kind);

/// `rows` x `columns` points of a surface, row by row, every four neighbors a quad; columns - 1 and rows - 1 must be
/// multiples of kGridSide.
struct SurfaceGrid {
  std::size_t columns = 0, rows = 0;
  std::vector<Vec3f> points;
  std::size_t triangle_count() const { return 2 * (columns - 1) * (rows - 1); }
};
inline constexpr std::size_t kGridSide = 8;  ///< quads along a side of what goes to Embree as one grid

struct BareRay {
  Vec3f origin, direction;
};

struct EmbreeKindFigures {
  double bytes = 0;           ///< that Embree holds, less the points, which it shares
  double build_seconds = 0;   ///< one thread
  double packet_seconds = 0;  ///< coherent rays, eight at a time
  double single_seconds = 0;  ///< incoherent rays one by one
  std::uint64_t hits = 0;     ///< of all of them
};

/// Medium build quality, robust, as the renderer builds. coherent: a multiple of eight.
EmbreeKindFigures measure_kind(EmbreeKind kind, const SurfaceGrid& grid, std::span<const BareRay> coherent,
                               std::span<const BareRay> incoherent);

}  // namespace raytree
