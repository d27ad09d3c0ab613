#include "geometry/lattice.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace raytree {
namespace {

/// Cells that one task looks at; also what is looked at by one thread alone.
constexpr std::size_t kCellsOfTask = 16384;

/// Which of a cell's corners a triangle has: bits 0 to 3 for a to d, bit 4 for another vertex.
unsigned corners_met(const std::uint32_t* triangle, std::uint32_t a, std::uint32_t stride) {
  unsigned met = 0;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t offset = triangle[k] - a;
    met |= offset == 0 ? 1u : offset == 1 ? 2u : offset == stride ? 4u : offset == stride + 1 ? 8u : 16u;
  }
  return met;
}

/// How two triangles are a cell.
enum class Cell : std::uint8_t { falling = 0, rising = 1, none = 2 };

/// rising: a b c and d c b; falling: a b d and d c a, in either order.
Cell cell_of(const std::uint32_t* triangles, std::uint32_t a, std::uint32_t stride) {
  const unsigned first = corners_met(triangles, a, stride), second = corners_met(triangles + 3, a, stride);
  const unsigned least = std::min(first, second), most = std::max(first, second);
  if (least == 0b0111 && most == 0b1110) return Cell::rising;
  return least == 0b1011 && most == 0b1101 ? Cell::falling : Cell::none;
}

/// Tells cells of a lattice. Whoever wrote the triangles wrote most cells in one of two ways, which are learned and
/// compared with at once: without branches, since which way a cell is halved is hard to foretell.
class CellReader {
 public:
  explicit CellReader(std::uint32_t stride) : stride_(stride) {}

  Cell operator()(const std::uint32_t* triangles, std::uint32_t a) {
    const std::uint64_t twice = (std::uint64_t(a) << 32) | a;
    std::uint64_t other[2] = {~std::uint64_t(0) * !known_, ~std::uint64_t(0) * !known_};
    for (int k = 0; k < 3; ++k) {
      std::uint64_t pair;
      std::memcpy(&pair, triangles + 2 * k, sizeof(pair));
      for (int way = 0; way < 2; ++way) other[way] |= pair ^ (ways_[way].offsets[k] + twice);
    }
    if ((other[0] != 0) & (other[1] != 0)) return learned(triangles, a);
    return other[0] == 0 ? ways_[0].cell : ways_[1].cell;
  }

 private:
  /// Corners of both triangles, less the cell's first one, two by two.
  struct Way {
    std::uint64_t offsets[3] = {};
    Cell cell = Cell::none;
  };

  Cell learned(const std::uint32_t* triangles, std::uint32_t a) {
    Way way;
    way.cell = cell_of(triangles, a, stride_);
    if (way.cell == Cell::none) return way.cell;
    std::uint32_t offsets[6];
    for (int k = 0; k < 6; ++k) offsets[k] = triangles[k] - a;
    std::memcpy(way.offsets, offsets, sizeof(offsets));
    if (!known_) ways_[0] = way;
    ways_[1] = way;
    known_ = true;
    return way.cell;
  }

  std::uint32_t stride_;
  Way ways_[2];
  bool known_ = false;
};

/// The first row in [begin, end) that is not one of the lattice; `end`: none. Says which cells are rising.
std::size_t first_other_row(std::span<const std::uint32_t> corners, Lattice& lattice, std::size_t begin,
                            std::size_t end) {
  const auto look = [&](std::size_t first, std::size_t last) {
    CellReader read(lattice.stride);
    for (std::size_t j = first; j < last; ++j) {
      const std::uint32_t* triangles = &corners[3 * lattice.triangle(0, j)];
      std::uint8_t* rising = &lattice.rising[j * lattice.columns];
      const std::uint32_t a = lattice.vertex(0, j);
      for (std::uint32_t i = 0; i < lattice.columns; ++i) {
        const Cell cell = read(triangles + 6 * std::size_t(i), a + i);
        if (cell == Cell::none) return j;
        rising[i] = cell == Cell::rising;
      }
    }
    return end;
  };
  const std::size_t rows_of_task = std::max<std::size_t>(1, kCellsOfTask / lattice.columns);
  if (end - begin <= rows_of_task) return look(begin, end);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(begin, end, rows_of_task), end,
      [&](const auto& range, std::size_t found) { return std::min(found, look(range.begin(), range.end())); },
      [](std::size_t x, std::size_t y) { return std::min(x, y); });
}

/// The longest row of cells that begins with triangles `first` and the next one. Says nothing of what is rising.
Lattice row_at(std::span<const std::uint32_t> corners, std::size_t first) {
  const std::uint32_t* triangles = &corners[3 * first];
  const auto [least, most] = std::minmax_element(triangles, triangles + 6);
  Lattice lattice{first, *least, 0, 0, 0, {}};
  if (*most - *least < 3) return lattice;  // a + stride and a + 1 must differ
  lattice.stride = *most - *least - 1;
  const std::size_t cells_left = (corners.size() / 3 - first) / 2;
  const std::size_t most_columns = std::min<std::size_t>(cells_left, lattice.stride - 1);
  CellReader read(lattice.stride);
  while (lattice.columns < most_columns &&
         read(triangles + 6 * std::size_t(lattice.columns), *least + lattice.columns) != Cell::none)
    ++lattice.columns;
  lattice.rows = lattice.columns > 0;
  return lattice;
}

/// The largest lattice whose cell (0, 0) is triangles `first` and the next one, as far as rows are as long as the first
/// one; without cells: none.
Lattice lattice_at(std::span<const std::uint32_t> corners, std::size_t first) {
  Lattice lattice = row_at(corners, first);
  if (lattice.columns == 0) return lattice;
  const std::size_t most_rows = (corners.size() / 3 - first) / 2 / lattice.columns;
  // Twice as many rows at a time, so that short lattices cost little and long ones keep all threads busy.
  for (std::size_t begin = 0, end = 1;;) {
    lattice.rising.resize(end * lattice.columns);
    const std::size_t other = first_other_row(corners, lattice, begin, end);
    lattice.rows = static_cast<std::uint32_t>(other);
    if (other < end || end == most_rows) break;
    begin = end;
    end = std::min(most_rows, 2 * end);
  }
  lattice.rising.resize(lattice.cell_count());
  return lattice;
}

}  // namespace

std::vector<Lattice> find_lattices(std::span<const std::uint32_t> corners) {
  std::vector<Lattice> lattices;
  const std::size_t triangles = corners.size() / 3;
  for (std::size_t i = 0; i + 2 <= triangles;) {
    Lattice lattice = lattice_at(corners, i);
    i += std::max<std::size_t>(1, lattice.triangle_count());
    if (lattice.cell_count() >= kLeastLatticeCells) lattices.push_back(std::move(lattice));
  }
  return lattices;
}

bool may_be_lattices(std::span<const std::uint32_t> corners) {
  constexpr std::size_t kProbes = 64, kCellsOfProbe = 4;
  const std::size_t triangles = corners.size() / 3;
  if (triangles < 2 * kLeastLatticeCells) return false;
  std::size_t rows = 0;
  for (std::size_t probe = 0; probe < kProbes; ++probe) {
    // Where a row ends no cells follow, and a lattice may begin at an odd triangle: a few places are tried.
    const std::size_t begin = probe * (triangles - 2 * kLeastLatticeCells) / kProbes;
    bool found = false;
    for (std::size_t i = begin; i <= begin + 2 * kCellsOfProbe && !found; ++i) {
      const auto some = corners.subspan(3 * i, 3 * 2 * kCellsOfProbe);
      found = row_at(some, 0).columns == kCellsOfProbe;
    }
    rows += found;
  }
  return 2 * rows > kProbes;
}

}  // namespace raytree
