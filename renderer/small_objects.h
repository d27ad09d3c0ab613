// Objects that samples may miss: what the picture shows of shapes that are narrow, found when the scene is prepared, so
// that the adaptive sampler can look closer around them. An object is a shape or an instance; triangles are none.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/shape_set.h"
#include "geometry/vec.h"
#include "renderer/camera.h"

namespace raytree {

/// Objects at least so wide (pixels, in their narrowest direction) are found by the corners of pixels alone: a disc of
/// this diameter covers at least 4 of them, and all but its margins.
inline constexpr double kSmallWidth = 4;

/// A rectangle of the image that stands at any angle, pixels.
struct ImageRectangle {
  Vec2d center;
  Vec2d along;         ///< unit, of its length
  double half_length;  ///< >= half_width
  double half_width;

  /// Whether it meets the square of half edge `half` about `middle`: no axis of the two keeps them apart.
  bool overlaps(const Vec2d& middle, double half) const {
    const Vec2d d = middle - center;
    const double cosine = std::abs(along.x), sine = std::abs(along.y);
    const double reach = half * (cosine + sine);
    return std::abs(d.x) <= half + half_length * cosine + half_width * sine &&
           std::abs(d.y) <= half + half_length * sine + half_width * cosine &&
           std::abs(d.x * along.x + d.y * along.y) <= reach + half_length &&
           std::abs(d.y * along.x - d.x * along.y) <= reach + half_width;
  }
};

struct SmallObject {
  std::vector<Vec2d> outline;  ///< convex, counter-clockwise as x and y have it, pixels
  ImageRectangle box;          ///< the narrowest that holds the outline
  std::uint32_t shape = 0;     ///< index among the scene's objects: of a shape, or Instance::object

  double width() const { return 2 * box.half_width; }
};

/// Area of what a convex polygon (counter-clockwise) shares with [x0, x0 + size] x [y0, y0 + size], and the centroid of
/// that part.
double area_in_square(std::span<const Vec2d> polygon, double x0, double y0, double size, Vec2d& centroid);

/// The convex hull of `points`, counter-clockwise; fewer than three points where they lie on a line. Sorts `points`.
std::vector<Vec2d> convex_hull(std::vector<Vec2d>& points);

/// The narrowest rectangle that holds a convex polygon of at least three corners.
ImageRectangle narrowest_rectangle(std::span<const Vec2d> polygon);

class SmallObjects {
 public:
  SmallObjects() = default;
  /// The shapes that `camera` shows narrower than kSmallWidth, whole or in part in the frame of width x height pixels.
  SmallObjects(const ShapeSet& shapes, const Camera& camera, int width, int height);

  std::size_t size() const { return objects_.size(); }
  const SmallObject& operator[](std::uint32_t i) const { return objects_[i]; }
  /// Those whose box meets the tile at (x0, y0), ascending.
  std::span<const std::uint32_t> of_tile(int x0, int y0) const;

 private:
  void sort_into_tiles(int width, int height);

  std::vector<SmallObject> objects_;
  int tile_columns_ = 0;
  std::vector<std::uint32_t> tile_begin_;    ///< [tiles + 1] into tile_objects_
  std::vector<std::uint32_t> tile_objects_;  ///< tile after tile
};

}  // namespace raytree
