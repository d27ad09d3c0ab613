// How a value known at the corners of a polygon varies over it: the weight of each corner at a point inside. Three
// ways: over the triangles that the polygon is cut in, over the polygon as a whole, or along a scan line as in 1971.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/vec.h"

namespace raytree {

enum class FacetInterpolation : std::uint8_t {
  barycentric,  ///< linear over each of the triangles that a polygon is cut in
  bilinear,     ///< quads by the parameters of their bilinear patch, other polygons by mean value coordinates
  scanline  ///< linear along edges, then along the scan line between them (Gouraud 1971, fig. 6; Phong 1973, fig. 1.3)
};

/// The scan plane through a point: a row of the picture for eye rays. Values are linear in the picture, as they were
/// when polygons were projected before they were shaded, where `eye` is a perspective one.
struct ScanPlane {
  Vec3f normal;  ///< of the plane, any length
  Vec3f along;   ///< the scan line's direction, any length
  bool perspective = false;
  Vec3f eye, forward;  ///< perspective: where the picture is seen from, and which way
};

/// Weights of a polygon's corners [count] at `point`, which lies on it or nearly; sum 1 but for rounding. Mean value
/// coordinates (Floater 2003); those of a triangle are barycentric. Of a concave polygon some may be negative.
void mean_value_weights(std::span<const Vec3f> corners, const Vec3f& point, std::span<float> weights);

/// The quad's bilinear patch through its four corners, taken at the parameters of `point`; mean value coordinates where
/// it has none (concave quads). None is negative.
void bilinear_weights(std::span<const Vec3f> corners, const Vec3f& point, std::span<float> weights);

/// The two edges that the scan line meets next to `point`, and the place between them. False: it meets none, as beyond
/// the polygon's first or last corner, and weights are void.
bool scanline_weights(std::span<const Vec3f> corners, const Vec3f& point, const ScanPlane& scan,
                      std::span<float> weights);

}  // namespace raytree
