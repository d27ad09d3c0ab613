// Quads joined into grids, a form that Embree also takes: for benchmarks that compare it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/quad_pairs.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"

namespace raytree {

inline constexpr std::uint32_t kMostGridQuads = 8;  ///< along a side of a grid

/// `width` x `height` points, row by row, neighbors four by four a quad in the order (0, 0), (1, 0), (1, 1), (0, 1).
struct GridTile {
  std::uint32_t first_point = 0, width = 0, height = 0;
};
struct GridList {
  Buffer<Vec3f> points;  ///< each grid's own
  std::vector<GridTile> tiles;
  std::size_t quads = 0;
};

/// Joins quads across edges that two of them share into grids of up to kMostGridQuads x kMostGridQuads. Every quad goes
/// into one; those without fitting neighbors are grids of their own. Where quads are halved along one diagonal or the
/// other, as suits each, grids are not: Embree halves all of a grid alike, and the surface differs by as much.
GridList joined_grids(const QuadList& quads, std::span<const Vec3f> positions);

/// The triangles that Embree makes of grids: of each quad, counted as above, its corners (0, 1, 3) and (2, 3, 1).
TriangleMesh halved_grids(const GridList& grids);

}  // namespace raytree
