// What of a surface a sample stands for.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace raytree {

/// The parallelogram of a surface that a sample stands for: what the sample's share of the picture covers of the plane
/// that touches the surface. Both edges 0: a point.
struct Footprint {
  Vec3f edge{0, 0, 0}, other_edge{0, 0, 0};  ///< scene units, tangent to the surface
  /// Patterns with edges are taken at a point where the footprint is smaller than a cell of theirs: adaptive sampling
  /// finds the edges by what samples beside them differ in, and a sample that blurs them hides them from it.
  bool leaves_edges = false;

  /// Of its longer edge.
  double width() const { return std::sqrt(std::max<double>(edge.dot(edge), other_edge.dot(other_edge))); }
};

}  // namespace raytree
