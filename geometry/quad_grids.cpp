#include "geometry/quad_grids.h"

#include <algorithm>
#include <limits>

namespace raytree {
namespace {

constexpr std::uint32_t kNoNeighbor = std::numeric_limits<std::uint32_t>::max();

/// A quad as it stands in a grid: corner `turn` lies toward the grid's (0, 0).
struct Placed {
  std::uint32_t quad = 0, turn = 0;
};

/// Who lies behind each side of each quad. Side k goes from corner k to k + 1.
class Neighbors {
 public:
  explicit Neighbors(const QuadList& quads) : across_(quads.corners.size(), kNoNeighbor) {
    struct Side {
      std::uint64_t edge;
      std::uint32_t side;
    };
    std::vector<Side> sides;
    sides.reserve(across_.size());
    for (std::uint32_t s = 0; s < across_.size(); ++s) {
      const std::uint32_t a = quads.corners[s], b = quads.corners[s / 4 * 4 + (s + 1) % 4];
      if (quads.corners[s / 4 * 4 + 2] == quads.corners[s / 4 * 4 + 3]) continue;  // a triangle
      sides.push_back({(std::uint64_t(std::min(a, b)) << 32) | std::max(a, b), s});
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return a.edge != b.edge ? a.edge < b.edge : a.side < b.side; });
    for (std::size_t i = 0; i + 1 < sides.size();) {
      std::size_t end = i + 1;
      while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
      const std::uint32_t a = sides[i].side, b = sides[i + 1].side;
      // Wound alike, the two run along their edge in opposite directions.
      if (end - i == 2 && quads.corners[a] != quads.corners[b]) across_[a] = b, across_[b] = a;
      i = end;
    }
  }

  /// The quad across side `side` of a placed one, placed so that it meets that with its side `meeting`; false: none.
  bool across(const Placed& from, std::uint32_t side, std::uint32_t meeting, Placed& to) const {
    const std::uint32_t found = across_[from.quad * 4 + (side + from.turn) % 4];
    if (found == kNoNeighbor) return false;
    to = {found / 4, (found % 4 + 4 - meeting) % 4};
    return true;
  }

 private:
  std::vector<std::uint32_t> across_;  ///< [quad][4] side of the neighbor, or kNoNeighbor
};

}  // namespace

GridList joined_grids(const QuadList& quads, std::span<const Vec3f> positions) {
  const Neighbors neighbors(quads);
  const auto corner = [&](const Placed& placed, std::uint32_t k) {
    return positions[quads.corners[placed.quad * 4 + (k + placed.turn) % 4]];
  };
  constexpr std::uint32_t kRight = 1, kUp = 2, kLeft = 3, kDown = 0;
  GridList grids;
  grids.quads = quads.size();
  std::vector<bool> taken(quads.size(), false);
  std::vector<Placed> cells, row;
  // The row of free quads across side `side` of one that lies there, if it is whole and a row itself.
  const auto next_row = [&](const Placed* beside, std::size_t across, std::uint32_t side, std::uint32_t meeting) {
    row.clear();
    Placed next, neighbor;
    for (std::size_t i = 0; i < across; ++i) {
      if (!neighbors.across(beside[i], side, meeting, next) || taken[next.quad]) return false;
      if (i > 0 && (!neighbors.across(row.back(), kRight, kLeft, neighbor) || neighbor.quad != next.quad)) return false;
      row.push_back(next);
    }
    // A narrow band that closes on itself would come twice.
    for (std::size_t i = 0; i < across; ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (row[i].quad == row[k].quad) return false;
    for (const Placed& placed : row) taken[placed.quad] = true;
    return true;
  };
  for (std::uint32_t first = 0; first < quads.size(); ++first) {
    if (taken[first]) continue;
    cells.assign(1, {first, 0});
    taken[first] = true;
    Placed next;
    while (cells.size() < kMostGridQuads && neighbors.across(cells.back(), kRight, kLeft, next) && !taken[next.quad])
      taken[next.quad] = true, cells.push_back(next);
    while (cells.size() < kMostGridQuads && neighbors.across(cells.front(), kLeft, kRight, next) && !taken[next.quad])
      taken[next.quad] = true, cells.insert(cells.begin(), next);
    const std::size_t across = cells.size();
    std::uint32_t along = 1;
    for (; along < kMostGridQuads && next_row(&cells[cells.size() - across], across, kUp, kDown); ++along)
      cells.insert(cells.end(), row.begin(), row.end());
    for (; along < kMostGridQuads && next_row(cells.data(), across, kDown, kUp); ++along)
      cells.insert(cells.begin(), row.begin(), row.end());
    const auto width = static_cast<std::uint32_t>(across) + 1;
    grids.tiles.push_back({static_cast<std::uint32_t>(grids.points.size()), width, along + 1});
    for (std::uint32_t j = 0; j <= along; ++j) {
      const bool top = j == along;
      const Placed* line = cells.data() + (top ? j - 1 : j) * across;
      for (std::size_t i = 0; i < across; ++i) grids.points.push_back(corner(line[i], top ? 3 : 0));
      grids.points.push_back(corner(line[across - 1], top ? 2 : 1));
    }
  }
  return grids;
}

TriangleMesh halved_grids(const GridList& grids) {
  TriangleMesh mesh;
  mesh.positions = grids.points;
  mesh.corners.reserve(grids.quads * 6);
  for (const GridTile& tile : grids.tiles)
    for (std::uint32_t j = 0; j + 1 < tile.height; ++j)
      for (std::uint32_t i = 0; i + 1 < tile.width; ++i) {
        const std::uint32_t at = tile.first_point + j * tile.width + i;
        const std::uint32_t corner[4] = {at, at + 1, at + tile.width + 1, at + tile.width};
        for (const int c : {0, 1, 3, 2, 3, 1}) mesh.corners.push_back(corner[c]);
      }
  return mesh;
}

}  // namespace raytree
