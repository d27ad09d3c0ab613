// How two tracers' outlines of the same thing lie to each other in a picture: by what each covers of the pixels along
// them.
#pragma once

#include <cstdint>

#include "geometry/ray_intersector.h"
#include "renderer/camera.h"

namespace raytree::benchmarks {

inline constexpr int kOutlineGrid = 16;  ///< samples of a pixel along the outline, each way

struct OutlineDifference {
  std::uint64_t pixels = 0;  ///< that either covers in part
  double largest = 0;        ///< of the share of one pixel that they cover
  double mean = 0;           ///< over those pixels: pixels that the outlines lie apart
  std::uint64_t over = 0;    ///< pixels where the share differs by more than `bound`
};

/// Where eye rays at pixel centers, of a frame of width x height, say that an outline passes a pixel or one beside it,
/// both tracers are asked with kOutlineGrid^2 rays a pixel. What is narrower than a pixel and meets no center is not
/// seen. Runs on the task arena's threads; the result does not depend on their number.
OutlineDifference outline_difference(const RayIntersector& a, const RayIntersector& b, const Camera& camera, int width,
                                     int height, double bound);

/// What the share of a pixel may differ by where outlines lie at most `distance` pixels apart: a straight one that is
/// moved by d sweeps at most sqrt(2) d of a pixel; either is known to the distance between two samples.
double outline_bound(double distance);

}  // namespace raytree::benchmarks
