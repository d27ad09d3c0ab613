// Eye rays: from a point of the image plane to a ray in scene space.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "geometry/lanes.h"
#include "geometry/vec.h"
#include "renderer/scene_description.h"

namespace raytree {

/// The camera of that name, or the first one; a default camera where the scene has none. Throws Error (bad_input) with
/// the names there are.
const CameraDescription& chosen_camera(const SceneDescription& scene, const std::string& name);

class Camera {
 public:
  Camera() = default;
  /// For a frame of width x height square pixels. `scene_origin`: see ShapeSet::origin. Throws Error (bad_input) when
  /// position, target and up do not span a view.
  Camera(const CameraDescription& description, int width, int height, const Vec3d& scene_origin,
         const SourceLocation& where);

  /// The ray through image position (x, y) in pixels: (0, 0) is the frame's upper left corner, y downwards; pixel
  /// centers lie at halves. Direction is unit.
  void ray(float x, float y, Vec3f& origin, Vec3f& direction) const {
    const Eye found = perspective_ ? eye<true>(x, y) : eye<false>(x, y);
    origin = found.origin;
    direction = found.direction;
  }

  /// The same of many positions: into [0, positions.size()), and as far behind as batches are padded.
  void rays(std::span<const Vec2f> positions, const Vec3Pointers<float>& origins,
            const Vec3Pointers<float>& directions) const;

  /// How far the rays one pixel to the right and one pixel up are from this one, of unit `direction`, at `distance`
  /// along it: exact to the first order but for a part along the ray itself.
  void pixel_edges(const Vec3f& direction, float distance, Vec3f& right, Vec3f& up) const {
    const float scale = perspective_ ? distance * direction.dot(forward_) : 1;
    right = right_ * scale;
    up = up_ * scale;
  }

  /// Where a point of scene space is seen: ray()'s inverse. False: at or behind the plane of a perspective eye.
  bool project(const Vec3d& point, Vec2d& image) const;

  bool is_perspective() const { return perspective_; }
  const Vec3f& position() const { return position_; }  ///< scene space
  const Vec3f& forward() const { return forward_; }    ///< unit

 private:
  struct Eye {
    Vec3f origin, direction;
  };
  template <bool perspective>
  Eye eye(float x, float y) const {
    const Vec3f across = right_ * (x - center_x_), upward = up_ * (center_y_ - y);
    if constexpr (!perspective) return {position_ + across + upward, forward_};
    const Vec3f through = forward_ + across + upward;
    return {position_, through * (1 / std::sqrt(through.dot(through)))};
  }

  bool perspective_ = true;
  Vec3f position_{0, 0, 0};             ///< scene space
  Vec3f forward_{0, 0, -1};             ///< unit
  Vec3f right_{1, 0, 0}, up_{0, 1, 0};  ///< per pixel
  float center_x_ = 0, center_y_ = 0;
};

}  // namespace raytree
