// The spheres of a sphere-flake: a sphere carries nine smaller ones, each of which carries nine, in the manner of
// the "balls" scene of the Standard Procedural Databases. What the spheres are made of, and tracing them, is others'.
#pragma once

#include <cstdint>

#include "geometry/buffer.h"
#include "geometry/vec.h"

namespace raytree {

inline constexpr int kLargestSphereFlakeLevel = 7;  ///< 5 380 840 spheres, 82 MiB

struct SphereFlakeParameters {
  int levels = 4;  ///< 0: the one sphere alone
  Vec3d center{0, 0, 0};
  double radius = 1;  ///< of the largest sphere, > 0
};

/// Exact spheres: float centers about a double origin.
struct SphereArrays {
  Vec3d origin{0, 0, 0};  ///< added to every center
  Buffer<Vec3f> centers;  ///< [sphere_count], relative to origin
  Buffer<float> radii;    ///< [sphere_count]

  std::size_t sphere_count() const { return radii.size(); }
};

/// Spheres of a flake with that many levels: (9^(levels + 1) - 1) / 8. levels in [0, kLargestSphereFlakeLevel].
std::int64_t sphere_flake_count(int levels);

/// Radius, about the center, of a sphere that holds the whole flake: radius (2 - 3^-levels), the length of a chain of
/// touching spheres that grows straight outward. Never more than twice the radius.
double sphere_flake_bounding_radius(const SphereFlakeParameters& parameters);

/// The nine children of a sphere touch it at a third of its radius, so their centers lie 4/3 radius away: six on the
/// equator about the sphere's axis, at 15 and 75 degrees of azimuth and every 120 degrees on from there; three at
/// latitude asin(sqrt(2/3)) = 54.74 degrees, at azimuths 45, 165 and 285. A child's axis points away from its parent,
/// and its frame is the root's turned the shortest way onto that axis (within 0.81 degrees of the poles: not at all at
/// +y, half a turn at -y, as SPD's program has it). The root's axis is +y.
/// Depth first, parents before children: sphere 0 is the root, and order and places equal those of SPD's program after
/// (x, y, z) -> (x, z, -y), which turns its z-up into y-up.
/// Throws Error (bad_input) for levels out of range, a radius that is not positive and finite, a center that is not
/// finite, or spheres too small or large for a float. Runs on the task arena's threads; the result does not depend on
/// their number.
SphereArrays make_sphere_flake(const SphereFlakeParameters& parameters);

}  // namespace raytree
