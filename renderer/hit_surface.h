// The surface at one hit of a scene's tracer, wherever that tracer says that it lies.
#pragma once

#include "geometry/surface.h"
#include "geometry/true_surfaces.h"
#include "renderer/scene.h"

namespace raytree {

inline SurfacePoint hit_surface(const Scene& scene, const Vec3f& origin, const Vec3f& direction, const Hit& hit) {
  SurfacePoint point = surface_at(*scene.shapes, origin, direction, hit, false);
  if (scene.sphere_pixels > 0) move_to_true_surface(*scene.shapes, scene.sphere_pixels, origin, direction, hit, point);
  return point;
}

}  // namespace raytree
