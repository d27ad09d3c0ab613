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

/// Whether a mesh's triangle and what it stands for lie as near each other as the deviation allows, at the point of
/// weights (1 - u - v, u, v): across the surface by `deviation`, and along it by the triangle's own size besides, since
/// pieces of a limit surface have parameters that slide. `place`: the surface there (scene space), where it is known;
/// else it is evaluated, or, on n-gons of cages, asked of the truth along the triangle's normal.
bool facet_stands_for_surface(const ShapeSet& shapes, const ReferenceTracer& truth, const SurfaceId& id, double u,
                              double v, double deviation, const Vec3d* place);

}  // namespace raytree::benchmarks
