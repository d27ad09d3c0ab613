// A mesh's triangles as grids of up to 2 x 2 cells, the kind of geometry that is built and held for least: the same
// surface to the last triangle, and the way back from a grid's point to the triangle that has it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/lattice.h"
#include "geometry/quad_pairs.h"
#include "geometry/vec.h"

namespace raytree {

/// `height` rows of `width` points, `stride` from row to row, as Embree lays out a grid. Neighbors four by four are a
/// cell; its triangles meet along the diagonal between (1, 0) and (0, 1).
struct LatticeGrid {
  std::uint32_t first_point = 0, stride = 0;
  std::uint16_t width = 0, height = 0;
};

/// Cells along a side of a grid, at most. Two are what Embree's leaves hold; and a point's coordinates, which Embree
/// gives over the whole grid, lose no more than a rounding of 2^-24 to the cell's place in it.
inline constexpr std::uint32_t kMostGridCells = 2;

/// Grids of a mesh. Rising cells of its lattices are grids over the mesh's own positions. Cells that are halved the
/// other way are so over their mirror image: rows of the same points, last one first. Triangles of no lattice are
/// joined in pairs, each a grid of one cell with points of its own.
struct MeshGrids {
  /// What a lattice's grids are.
  struct Part {
    Lattice lattice;                              ///< without what is rising
    std::size_t first_own = 0, first_copied = 0;  ///< its first grid in `own`, in `copied`
    std::size_t first_point = 0;  ///< of its mirror image, in `points`; it has one if it has grids there
  };
  std::vector<Part> parts;
  Buffer<LatticeGrid> own;     ///< over the mesh's positions, lattice by lattice
  Buffer<LatticeGrid> copied;  ///< over `points`, lattice by lattice, then those of `pairs`
  Buffer<Vec3f> points;
  std::size_t first_pair = 0;  ///< the first grid of `copied` that is one of `pairs`
  QuadList pairs;              ///< without corners, whose points the grids have

  std::size_t size() const { return own.size() + copied.size(); }
  std::size_t memory_bytes() const {
    return array_bytes(own) + array_bytes(copied) + array_bytes(points) + pairs.memory_bytes();
  }
};

/// On all threads of the arena; the result does not depend on them. corners: [triangle][3], into positions.
/// Throws Error (failure) for more points than 32 bits count.
MeshGrids make_grids(std::span<const std::uint32_t> corners, std::span<const Vec3f> positions);

/// How many grids and copied points make_grids() would make, where may_be_lattices(); triangles of no lattice count as
/// if all had partners.
struct GridCounts {
  std::size_t grids = 0, points = 0;
  std::size_t lattice_triangles = 0;
};
GridCounts count_grids(std::span<const std::uint32_t> corners);

/// The point of a grid that Embree calls (u, v), on the triangle that the grid has there. copied: whether it is one of
/// `copied`; corners: the mesh's.
TrianglePoint triangle_point(const MeshGrids& grids, std::span<const std::uint32_t> corners, bool copied,
                             std::uint32_t grid, float u, float v);

}  // namespace raytree
