#include "geometry/lattice_grids.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "geometry/error.h"

namespace raytree {
namespace {

/// Rows of cells that one task makes grids of; even, so that pairs of rows do not depend on tasks.
constexpr std::size_t kRowsOfBand = 16;

std::size_t band_count(const Lattice& lattice) { return (lattice.rows + kRowsOfBand - 1) / kRowsOfBand; }

/// Calls found(i, j, width, height, rising) for the grids of a band of rows: cells [i, i + width) x [j, j + height),
/// all halved alike. Two rows at a time, from left to right: two by two cells where they are alike, else as few as
/// the next column allows.
template <class Found>
void tile_band(const Lattice& lattice, std::size_t band, Found&& found) {
  const std::size_t columns = lattice.columns;
  const std::size_t end = std::min<std::size_t>(lattice.rows, (band + 1) * kRowsOfBand);
  for (std::size_t j = band * kRowsOfBand; j < end; j += 2) {
    const bool single = j + 1 == end;
    const std::uint8_t *lower = &lattice.rising[j * columns], *upper = single ? lower : lower + columns;
    for (std::size_t i = 0; i < columns;) {
      const bool alike = single || lower[i] == upper[i];
      const bool goes_on = i + 1 < columns && lower[i + 1] == lower[i] && (single || upper[i + 1] == upper[i]);
      const std::size_t width = goes_on ? 2 : 1;
      found(i, j, width, alike && !single ? 2 : 1, lower[i] != 0);
      if (!alike) found(i, j + 1, width, 1, upper[i] != 0);
      i += width;
    }
  }
}

/// Grids of each band: rising ones, and others.
struct BandCounts {
  std::size_t own = 0, copied = 0;
};

std::vector<BandCounts> count_bands(const Lattice& lattice) {
  std::vector<BandCounts> counts(band_count(lattice));
  tbb::parallel_for(std::size_t(0), counts.size(), [&](std::size_t band) {
    BandCounts count;
    tile_band(lattice, band, [&](std::size_t, std::size_t, std::size_t, std::size_t, bool rising) {
      ++(rising ? count.own : count.copied);
    });
    counts[band] = count;
  });
  return counts;
}

/// Calls rest(begin, end) for the triangles [begin, end) between lattices.
template <class Rest>
void between(const std::vector<Lattice>& lattices, std::size_t triangles, Rest&& rest) {
  std::size_t begin = 0;
  for (const Lattice& lattice : lattices) {
    if (begin < lattice.first_triangle) rest(begin, lattice.first_triangle);
    begin = lattice.first_triangle + lattice.triangle_count();
  }
  if (begin < triangles) rest(begin, triangles);
}

std::size_t mirrored_points(const Lattice& lattice) {
  return (std::size_t(lattice.columns) + 1) * (std::size_t(lattice.rows) + 1);
}

void require_room(std::size_t points) {
  if (points > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::failure, {}, "a mesh has too many triangles to be handed over as grids");
}

/// Appends a lattice's grids, and its mirror image if any of them needs it.
void add_lattice(std::span<const Vec3f> positions, Lattice& lattice, MeshGrids& grids) {
  std::vector<BandCounts> begins = count_bands(lattice);
  MeshGrids::Part part{{}, grids.own.size(), grids.copied.size(), grids.points.size()};
  BandCounts sum{part.first_own, part.first_copied};
  for (BandCounts& begin : begins) {
    const BandCounts count = begin;
    begin = sum;
    sum = {sum.own + count.own, sum.copied + count.copied};
  }
  grids.own.resize(sum.own);
  grids.copied.resize(sum.copied);
  const bool mirrored = sum.copied > part.first_copied;
  const std::size_t columns = lattice.columns, width = columns + 1;
  if (mirrored) {
    require_room(part.first_point + mirrored_points(lattice));
    grids.points.resize(part.first_point + mirrored_points(lattice));
  }
  tbb::parallel_for(std::size_t(0), begins.size(), [&](std::size_t band) {
    BandCounts at = begins[band];
    tile_band(lattice, band, [&](std::size_t i, std::size_t j, std::size_t across, std::size_t along, bool rising) {
      const auto points_across = static_cast<std::uint16_t>(across + 1);
      const auto points_along = static_cast<std::uint16_t>(along + 1);
      if (rising)
        grids.own[at.own++] = {lattice.vertex(i, j), lattice.stride, points_across, points_along};
      else
        grids.copied[at.copied++] = {static_cast<std::uint32_t>(part.first_point + j * width + (columns - i - across)),
                                     static_cast<std::uint32_t>(width), points_across, points_along};
    });
    if (!mirrored) return;
    const std::size_t first = band * kRowsOfBand;
    const std::size_t last = std::min<std::size_t>(lattice.rows, first + kRowsOfBand);
    // The last band has the last row of points too.
    for (std::size_t j = first; j < last + (last == lattice.rows); ++j) {
      const Vec3f* row = &positions[lattice.vertex(0, j)];
      std::reverse_copy(row, row + width, &grids.points[part.first_point + j * width]);
    }
  });
  lattice.rising = {};  // seen in what became of it
  part.lattice = lattice;
  grids.parts.push_back(std::move(part));
}

/// Appends triangles [begin, end), in pairs.
void add_pairs(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions, std::size_t begin,
               std::size_t end, MeshGrids& grids) {
  const QuadList quads = joined_quads(corners.subspan(3 * begin, 3 * (end - begin)));
  const std::size_t first_point = grids.points.size(), first_grid = grids.copied.size(), first = grids.pairs.size();
  require_room(first_point + 4 * quads.size());
  grids.points.resize(first_point + 4 * quads.size());
  grids.copied.resize(first_grid + quads.size());
  grids.pairs.first.resize(first + quads.size());
  grids.pairs.halves.resize(first + quads.size());
  tbb::parallel_for(std::size_t(0), quads.size(), [&](std::size_t quad) {
    const std::uint32_t* corner = &quads.corners[4 * quad];
    Vec3f* point = &grids.points[first_point + 4 * quad];
    point[0] = positions[corner[0]], point[1] = positions[corner[1]];
    point[2] = positions[corner[3]], point[3] = positions[corner[2]];
    grids.copied[first_grid + quad] = {static_cast<std::uint32_t>(first_point + 4 * quad), 2, 2, 2};
    grids.pairs.first[first + quad] =
        static_cast<std::uint32_t>(begin + quads.first_triangle(static_cast<std::uint32_t>(quad)));
    grids.pairs.halves[first + quad] = quads.halves[quad];
  });
}

/// Which cell along a side of `cells` a coordinate over all of them lies in, and where in it.
struct CellPlace {
  std::uint32_t cell;
  float at;
};
CellPlace cell_place(float coordinate, std::uint32_t cells) {
  const float scaled = coordinate * static_cast<float>(cells);
  const std::uint32_t cell = scaled >= 1 ? std::min(static_cast<std::uint32_t>(scaled), cells - 1) : 0;
  return {cell, std::clamp(scaled - static_cast<float>(cell), 0.0f, 1.0f)};
}

}  // namespace

MeshGrids make_grids(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions) {
  MeshGrids grids;
  std::vector<Lattice> lattices = find_lattices(corners);
  for (Lattice& lattice : lattices) add_lattice(positions, lattice, grids);
  grids.first_pair = grids.copied.size();
  between(lattices, corners.size() / 3,
          [&](std::size_t begin, std::size_t end) { add_pairs(corners, positions, begin, end, grids); });
  return grids;
}

GridCounts count_grids(std::span<const std::uint32_t> corners) {
  GridCounts counts;
  std::vector<Lattice> lattices;
  if (may_be_lattices(corners)) lattices = find_lattices(corners);
  for (const Lattice& lattice : lattices) {
    BandCounts sum;
    for (const BandCounts& band : count_bands(lattice)) sum.own += band.own, sum.copied += band.copied;
    counts.grids += sum.own + sum.copied;
    counts.lattice_triangles += lattice.triangle_count();
    if (sum.copied > 0) counts.points += mirrored_points(lattice);
  }
  between(lattices, corners.size() / 3, [&](std::size_t begin, std::size_t end) {
    counts.grids += (end - begin + 1) / 2;
    counts.points += 4 * ((end - begin + 1) / 2);
  });
  return counts;
}

TrianglePoint triangle_point(const MeshGrids& grids, std::span<const std::uint32_t> corners, bool copied,
                             std::uint32_t grid, float u, float v) {
  if (copied && grid >= grids.first_pair)
    return triangle_point(grids.pairs, static_cast<std::uint32_t>(grid - grids.first_pair), u, v);
  const LatticeGrid& tile = (copied ? grids.copied : grids.own)[grid];
  // The last lattice that begins at or before the grid: one without grids begins where the next does.
  const auto after = std::upper_bound(grids.parts.begin(), grids.parts.end(), grid,
                                      [&](std::uint32_t at, const MeshGrids::Part& part) {
                                        return at < (copied ? part.first_copied : part.first_own);
                                      });
  const MeshGrids::Part& part = *(after - 1);
  const Lattice& lattice = part.lattice;
  const CellPlace along_u = cell_place(u, tile.width - 1u), along_v = cell_place(v, tile.height - 1u);
  const auto offset = static_cast<std::uint32_t>(tile.first_point - (copied ? part.first_point : lattice.first_vertex));
  const std::uint32_t row = offset / tile.stride + along_v.cell;
  std::uint32_t column = offset % tile.stride + along_u.cell;
  if (copied) column = lattice.columns - 1 - column;

  // The cell's corners as the grid has them: (0, 0), (1, 0), (0, 1), (1, 1).
  const std::uint32_t a = lattice.vertex(column, row), c = a + lattice.stride;
  const std::uint32_t at[4] = {copied ? a + 1 : a, copied ? a : a + 1, copied ? c + 1 : c, copied ? c : c + 1};
  const float rest = (1 - along_u.at) - along_v.at;
  const bool second = rest < 0;
  const std::uint32_t apex = second ? at[3] : at[0], beside = second ? at[2] : at[1];
  const float of_apex = second ? -rest : rest, of_beside = second ? 1 - along_u.at : along_u.at,
              of_third = second ? 1 - along_v.at : along_v.at;
  std::size_t triangle = lattice.triangle(column, row);
  const std::uint32_t* corner = &corners[3 * triangle];
  // One of the two has the apex.
  if ((corner[0] != apex) & (corner[1] != apex) & (corner[2] != apex)) ++triangle, corner += 3;
  const auto weight = [&](std::uint32_t vertex) {
    return vertex == apex ? of_apex : vertex == beside ? of_beside : of_third;
  };
  return {static_cast<std::uint32_t>(triangle), weight(corner[1]), weight(corner[2])};
}

}  // namespace raytree
