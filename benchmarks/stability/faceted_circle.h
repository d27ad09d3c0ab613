// A cylinder of facets in double, straight from the papers' formulas: what the cases on shading predict their figures
// with. The renderer has no part in it.
#pragma once

#include <vector>

#include "renderer/scene_description.h"

namespace raytree::benchmarks::facets {

/// The unit circle about the origin in the x, z plane, cut in equal sides, seen from infinity along -z, with a lamp at
/// the viewer. A point or direction at the angle a is (sin a, cos a).
class FacetedCircle {
 public:
  /// Places corners as faceted_cylinder() (faceted_scenes.h) does: one at 90 degrees, then turned. 0 sides: exact.
  FacetedCircle(int sides, double turned_degrees);

  /// (N.L)^exponent as seen at x, by the method's rule; 0 beside the circle.
  ///   flat: of the facet's normal; gouraud: linear between the corners' (Gouraud 1971, p. 19);
  ///   phong, limit: of the unit mean of the corners' normals (Phong 1973, eq. 4.4), here the radius through the hit.
  double light(ShadingMethod method, double x, double exponent) const;

 private:
  struct Corner {
    double x, z;
  };
  std::vector<Corner> corners_;  ///< in the order of their angles
};

/// x at the centers of a row of pixels of this size about the middle.
std::vector<double> pixel_centers(int width, double pixel);

}  // namespace raytree::benchmarks::facets
