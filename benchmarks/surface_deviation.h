// How far a mesh's triangles may lie off what the mesh was made of, which is where a truth that knows it finds hits:
// off the limit surface by what was asked of the tessellation, off a polygon whose corners lie in no plane by how far
// they do.
#pragma once

#include "benchmarks/surface_bounds.h"
#include "geometry/reference_tracer.h"

namespace raytree::benchmarks {

/// What facets of curved surfaces were asked for, and how finely the truth divides the surfaces.
struct FacetTolerance {
  double pixels = 0;         ///< off the limit surface in the picture; four times as far in any direction
  double sphere_pixels = 0;  ///< radius of the smallest spheres about parts of it
};

struct SurfaceDeviation {
  double distance = 0;  ///< scene units; 0: triangles are all there is
  bool curved = false;  ///< else a polygon's
};

/// About a point (scene space) of a surface. `face`: of the polygon mesh; kNoFace: that of the triangle.
SurfaceDeviation surface_deviation(const ShapeSet& shapes, const FacetTolerance& tolerance, const SurfaceId& id,
                                   std::uint32_t face, const Vec3d& point);

}  // namespace raytree::benchmarks
