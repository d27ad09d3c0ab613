// Single points of a parametric surface, for tests.
#pragma once

#include "geometry/parametric_surface.h"

namespace raytree::test {

inline SurfaceSample sample_at(const ParametricSurface& surface, std::size_t face, const Vec2d& parameter) {
  const Vec2f at(parameter);
  SurfaceSample sample;
  surface.evaluate(face, {&at, 1}, {&sample, 1});
  return sample;
}

inline Vec2f texture_at(const ParametricSurface& surface, std::size_t face, const Vec2f& at) {
  Vec2f coordinates;
  surface.evaluate_texture(face, {&at, 1}, {&coordinates, 1});
  return coordinates;
}

}  // namespace raytree::test
