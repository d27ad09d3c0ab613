// Rays aimed at the edges of a scene's own triangles, where intersection tests are put to the proof.
#pragma once

#include <cstddef>
#include <cstdint>

#include "benchmarks/intersection_benchmark.h"

namespace raytree::benchmarks {

/// `count` rays, every other one from `eye` (scene space), the others from random points of the scene's bounds made
/// twice as wide, each toward a random point of a random edge of a random triangle, of instances too. The same for the
/// same seed. Empty where the scene has no triangles.
RaySet edge_aimed_rays(const ShapeSet& shapes, const Vec3f& eye, std::size_t count, std::uint64_t seed = 1980);

}  // namespace raytree::benchmarks
