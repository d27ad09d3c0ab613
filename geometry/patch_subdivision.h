// Where a ray meets a Bezier patch, as Whitted 1980, sec. 3 finds it: a sphere about the patch; if the ray pierces it
// the patch is divided in four, with spheres about the parts, until no sphere is pierced or one is small enough.
#pragma once

#include "geometry/bezier_patch.h"
#include "geometry/bounding_sphere.h"
#include "geometry/mesh_source.h"

namespace raytree {

/// A part that small must also be this flat, its control points off their middle plane by no more than this share of
/// the least radius, or be divided on (kMostFlatteningLevels times). So rays that leave a surface may start this close.
inline constexpr double kFlatShare = 1.0 / 32;
inline constexpr int kMostFlatteningLevels = 6;
/// Beyond it parameters of single precision tell no parts apart.
inline constexpr int kMostPatchLevels = 24;

struct PatchHit {
  double distance = 0;  ///< in lengths of the ray's direction
  double u = 0, v = 0;  ///< of the patch
  int level = 0;        ///< divisions that the part has come from
};

/// Spheres are small enough from `pixels` pixels of radius down.
struct LeastRadius {
  const PixelSize& pixel;
  double pixels;

  double operator()(const Vec3d& place) const { return pixels * pixel(place); }
};

/// About the control points, and so about the patch.
BoundingSphere sphere_about(const BezierPatch& patch);

/// Nearest hit within [0, limit] and `within`, where the ray lies in the patch's sphere. A pierced part that is small
/// enough counts as hit where the ray passes between the two planes that hold its control points: so nothing that the
/// ray meets is ever missed, and what is reported lies within two least radii of the patch. Where Newton's iteration
/// finds the ray's crossing with the patch in that part, that is what is reported. False: none.
bool intersect_patch(const BezierPatch& patch, const SphereRay& ray, const RayInterval& within, double limit,
                     const LeastRadius& least_radius, PatchHit& hit);

}  // namespace raytree
