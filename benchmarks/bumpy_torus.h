// A torus with small bumps around it, and cages over it: what the rows of curved surfaces measure.
#pragma once

#include <cstdint>

#include "geometry/polygon_mesh.h"

namespace raytree::benchmarks {

/// The point at shares `a` of the way around the axis (y) and `b` of that around the tube; radii 3 and 1.
Vec3f on_bumpy_torus(double a, double b);

/// A closed cage of quads or, halved, of triangles; texture coordinates with a seam where the torus closes.
PolygonMesh bumpy_torus_cage(std::uint32_t around, std::uint32_t across, bool triangles, bool textured);

/// 10,086 quads, each with one vertex of valence 3 and one of valence 6 or so: triangles, refined once. Closed.
PolygonMesh irregular_torus_cage(bool textured);

}  // namespace raytree::benchmarks
