// Where a hit of the reference tracer lies, which need not be on the triangle that stands for it: on the curved surface
// that the triangle approximates, or on an n-gon that is not flat.
#pragma once

#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"
#include "geometry/surface.h"
#include "geometry/surface_batch.h"

namespace raytree {

/// Moves `point`, the surface at the hit as its triangle has it, to where the ray meets the true surface. On a curved
/// one normals stay, and new rays clear the parts that it was divided in, of `sphere_pixels`, also. On the plane of an
/// n-gon that is not flat the geometric normal is the plane's. Without effect where the mesh keeps no source.
void move_to_true_surface(const ShapeSet& shapes, double sphere_pixels, const Vec3f& origin, const Vec3f& direction,
                          const Hit& hit, SurfacePoint& point);

/// The same for a batch.
void move_to_true_surfaces(const ShapeSet& shapes, double sphere_pixels, const RayBatch& rays, const HitBatch& hits,
                           SurfaceBatch& surfaces);

}  // namespace raytree
