// The surfaces at the hits of a batch, structure of arrays. Most hits lie on spheres and triangles: these are solved a
// register of them at a time.
#pragma once

#include <cstddef>

#include "geometry/lanes.h"
#include "geometry/ray_batch.h"
#include "geometry/shape_set.h"
#include "geometry/surface.h"

namespace raytree {

/// SurfacePoints, at the indices of the rays that hit; of up to kBatchSize rays.
struct SurfaceBatch {
  Vec3Array position, geometric_normal, shading_normal;
  float clearance[Vec3Array::kSize], distance[Vec3Array::kSize];
  float texture_x[Vec3Array::kSize], texture_y[Vec3Array::kSize];

  SurfacePoint operator[](std::size_t i) const {
    return {position[i],  geometric_normal[i], shading_normal[i],
            clearance[i], distance[i],         {texture_x[i], texture_y[i]}};
  }
  void set(std::size_t i, const SurfacePoint& point) {
    position.set(i, point.position);
    geometric_normal.set(i, point.geometric_normal);
    shading_normal.set(i, point.shading_normal);
    clearance[i] = point.clearance, distance[i] = point.distance;
    texture_x[i] = point.texture.x, texture_y[i] = point.texture.y;
  }
};

/// Finds the surface at each hit: bit for bit surface_at(). Where a ray missed, nothing is defined. `texture`: whether
/// texture coordinates are wanted. rays.size is at most kBatchSize.
void find_surfaces(const ShapeSet& shapes, const RayBatch& rays, const HitBatch& hits, bool texture,
                   SurfaceBatch& surfaces);

}  // namespace raytree
