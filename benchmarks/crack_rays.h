// Cracks in triangle meshes, closed or not: rays at edges that two triangles share, and at nothing else.
#pragma once

#include <cstddef>
#include <cstdint>

#include "geometry/ray_intersector.h"
#include "geometry/shape_set.h"

namespace raytree::benchmarks {

struct CrackCount {
  std::size_t rays = 0;    ///< asked
  std::size_t cracks = 0;  ///< that met nothing at the edge or before it
};

/// Aims about `rays` rays at random edges of random triangles of the scene's own meshes (not those of groups), half of
/// them from `eye` (scene space), half from random points of the scene's bounds made twice as wide. Only edges count
/// whose two triangles both turn the same side to the ray's origin, by more than a grazing angle: there the one
/// triangle or the other covers the edge, however the ray is rounded. Of an edge the inner 7/8 are aimed at: what slips
/// through at corners exactly is another matter (docs/stability.md). The same for the same seed.
CrackCount count_cracks(const ShapeSet& shapes, const RayIntersector& tracer, const Vec3f& eye, std::size_t rays,
                        std::uint64_t seed = 1980);

/// Edges of all triangles of the scene's own meshes that no other triangle shares by the indices of its corners: of a
/// closed surface none.
std::int64_t open_edges(const ShapeSet& shapes);

}  // namespace raytree::benchmarks
