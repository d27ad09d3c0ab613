// Looks that tests of tessellation take at surfaces.
#pragma once

#include <cmath>

#include "geometry/angle.h"
#include "geometry/tessellation_view.h"

namespace raytree::test {

/// The same pixel everywhere.
inline TessellationView everywhere(double pixel) {
  TessellationView view;
  view.pixel = pixel;
  return view;
}

/// From `eye` to the origin, up is y; `width` x `height` pixels over a vertical field of view of 40 degrees.
inline TessellationView perspective(const Vec3d& eye, double width, double height) {
  TessellationView view;
  view.projection = TessellationView::Projection::perspective;
  view.eye = eye;
  view.forward = (-eye).normalized();
  view.right = view.forward.cross(Vec3d(0, 1, 0)).normalized();
  view.up = view.right.cross(view.forward);
  view.pixel = 2 * std::tan(20 * kDegree) / height;
  view.half_width = width / 2;
  view.half_height = height / 2;
  return view;
}

}  // namespace raytree::test
