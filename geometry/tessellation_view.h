// How large a displacement of a surface looks: what a tolerance in pixels is measured by. Plain numbers of a camera;
// the renderer fills them in.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vec.h"

namespace raytree {

/// Along the line of sight a displacement counts a quarter: it moves shadows and what is mirrored, not what is seen
/// straight.
inline constexpr double kDepthSlack = 4;
/// Outside the frame, in any direction, a displacement counts a quarter of what it would look like from the eye. A flat
/// mirror shows things from farther away than they are from the eye (the way by the mirror is the longer side of a
/// triangle), so what is seen in one is off by at most so many times the tolerance. A concave mirror or a lens may
/// magnify it without bound.
inline constexpr double kUnseenSlack = 4;
/// What lies so far beside the frame, as a share of it, still counts as seen: a facet may reach in where its samples do
/// not.
inline constexpr double kFrameMargin = 0.1;

/// The look at a surface: camera in world space, and the way there from the surface's own space.
struct TessellationView {
  enum class Projection {
    perspective,
    orthographic,
    any_direction  ///< from everywhere at the same distance: `pixel` holds at every point, for every direction
  };
  Projection projection = Projection::any_direction;
  Vec3d eye{0, 0, 0};
  Vec3d right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< unit, at right angles
  double pixel = 1;  ///< world units a pixel; perspective: at distance 1 along `forward`
  double half_width = std::numeric_limits<double>::infinity(), half_height = half_width;  ///< of the frame, pixels
  Matrix44d to_world;  ///< from the surface's space, its origin() added

  /// How far `displacement` (surface's space, small) moves `point` in the picture, in pixels, weighed as the constants
  /// above say.
  double pixels(const Vec3d& point, const Vec3d& displacement) const {
    Vec3d d;
    to_world.multDirMatrix(displacement, d);
    const double length = d.length();
    if (projection == Projection::any_direction) return length / pixel;
    Vec3d p;
    to_world.multDirMatrix(point, p);
    p += to_world.translation() - eye;
    const double x = p.dot(right), y = p.dot(up), z = p.dot(forward);
    const double scale = projection == Projection::perspective ? pixel * z : pixel;
    const double margin = (1 + kFrameMargin) * scale;
    if (scale > 0 && std::abs(x) <= half_width * margin && std::abs(y) <= half_height * margin) {
      double across = d.dot(right), upwards = d.dot(up);
      if (projection == Projection::perspective) {
        const double ahead = d.dot(forward) / z;
        across -= x * ahead;
        upwards -= y * ahead;
      }
      return std::max(std::sqrt(across * across + upwards * upwards), length / kDepthSlack) / scale;
    }
    const double unseen = projection == Projection::perspective ? pixel * p.length() : pixel;
    return length / (kUnseenSlack * std::max(unseen, std::numeric_limits<double>::min()));
  }
};

}  // namespace raytree
