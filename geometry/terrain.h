// A fractal terrain of any triangle count: mountains with sharp ridges and eroded flanks, so that a fresh machine has
// a large scene without any file. Materials, lights and tracing are others'.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace raytree {

inline constexpr std::int64_t kLeastTerrainTriangles = 2;
inline constexpr std::int64_t kMostTerrainTriangles = 50'000'000;

/// A height field y(x, z) over the square [-size/2, size/2]^2.
struct TerrainParameters {
  std::int64_t triangles = 1'000'000;  ///< asked for; terrain_grid() says what is made
  double size = 10;                    ///< edge of the square, scene units, > 0
  double height = 2.2;     ///< of the highest point over the lowest, about; >= 0. The lowest lies at y = 0, about
  double roughness = 0.5;  ///< amplitude ratio of successive octaves, in (0, 1)
  std::uint32_t seed = 1980;
};

/// Cells of the grid along x and z; each cell is two triangles.
struct TerrainGrid {
  std::int64_t columns = 1, rows = 1;
  std::int64_t triangle_count() const { return 2 * columns * rows; }
  std::int64_t vertex_count() const { return (columns + 1) * (rows + 1); }
};

/// The grid for a count: of all with rows <= columns <= max(rows + 1, 1.05 rows), the one whose triangle count is
/// nearest to the count asked for; of several, the squarest, then the one with fewer triangles. A count of a
/// million or more is missed by less than 0.05 %.
/// Throws Error (bad_input) outside [kLeastTerrainTriangles, kMostTerrainTriangles].
TerrainGrid terrain_grid(std::int64_t triangles);

/// Positions row by row (x runs fastest), about origin 0; a unit normal per position, of the surface's central
/// differences over one cell, also at the border; corners wound so that faces look up (+y), two triangles a cell,
/// split along the diagonal whose ends differ less in height, so that ridges and valleys are not cut across.
///
/// The surface is one function of (x, z), seed and roughness; more triangles show more octaves of it, a new octave
/// growing in smoothly. It is a sum of octaves of ridged gradient noise (Perlin 1985; ridges after Musgrave, in Ebert
/// et al., Texturing and Modeling, 1994): every octave is strong near the ridges of the one before, weak in its valleys
/// and on steep flanks, and its lattice is shifted downhill, which draws furrows down the flanks.
///
/// Throws Error (bad_input) for parameters out of range. Runs on the task arena's threads; the result does not depend
/// on their number.
TriangleMesh make_terrain(const TerrainParameters& parameters);

}  // namespace raytree
