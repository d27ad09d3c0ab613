// Lattices in a mesh's triangles: rows of cells of two triangles each over rows of vertices, as terrains and height
// fields are stored. They are found by indices alone; what is made of them is lattice_grids.h's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/buffer.h"

namespace raytree {

/// `rows` x `columns` cells. Cell (i, j) has corners a = first_vertex + j * stride + i, b = a + 1, c = a + stride and
/// d = c + 1; its two triangles, in any order, wound and turned in any way, are triangles
/// first_triangle + 2 (j * columns + i) and the next one. They meet along b c (the cell is *rising*) or along a d.
struct Lattice {
  std::size_t first_triangle = 0;
  std::uint32_t first_vertex = 0, stride = 0, columns = 0, rows = 0;
  Buffer<std::uint8_t> rising;  ///< [row][column] 1 or 0

  std::size_t cell_count() const { return std::size_t(columns) * rows; }
  std::size_t triangle_count() const { return 2 * cell_count(); }
  std::uint32_t vertex(std::size_t i, std::size_t j) const {
    return first_vertex + static_cast<std::uint32_t>(j * stride + i);
  }
  std::size_t triangle(std::size_t i, std::size_t j) const { return first_triangle + 2 * (j * columns + i); }
};

/// Smaller lattices are not looked for.
inline constexpr std::size_t kLeastLatticeCells = 64;

/// The lattices among the triangles in their order, none with a triangle of another; every triangle of each has been
/// looked at. On all threads of the arena; the result does not depend on them. corners: [triangle][3].
std::vector<Lattice> find_lattices(std::span<const std::uint32_t> corners);

/// Whether it may be worth the time to look for lattices: most of a few triangles here and there begin a row of cells.
bool may_be_lattices(std::span<const std::uint32_t> corners);

}  // namespace raytree
