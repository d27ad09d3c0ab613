// A piece of a curved surface as one bicubic Bezier patch: what the reference tracer divides until it finds the ray.
// Made of patches (patch_surface.h) and of subdivision cages (subdivision_patches.h).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/parametric_surface.h"

namespace raytree {

struct LimitPatch {
  BezierPatch patch;
  std::uint32_t face = 0;                ///< of the surface that it is a piece of
  FaceDomain domain = FaceDomain::quad;  ///< of that face
  /// The face's parameters at (s, t) of the patch: corner + s along_u + t along_v. Right-handed: the outside of the
  /// patch is that of the surface.
  Vec2d corner{0, 0}, along_u{1, 0}, along_v{0, 1};

  Vec2d face_parameters(double s, double t) const { return corner + along_u * s + along_v * t; }
};

}  // namespace raytree
