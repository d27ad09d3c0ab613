#include "renderer/camera.h"

#include <algorithm>
#include <cmath>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "geometry/surface.h"

namespace raytree {

const CameraDescription& chosen_camera(const SceneDescription& scene, const std::string& name) {
  static const CameraDescription fallback;
  if (name.empty()) return scene.cameras.empty() ? fallback : scene.cameras.front();
  std::string choices;
  for (const CameraDescription& camera : scene.cameras) {
    if (camera.name == name) return camera;
    choices += (choices.empty() ? "" : ", ") + camera.name;
  }
  throw Error(ErrorKind::bad_input, {scene.name, 0, "cameras"}, "no camera \"" + name + "\"; cameras: " + choices);
}

Camera::Camera(const CameraDescription& description, int width, int height, const Vec3d& scene_origin,
               const SourceLocation& where) {
  const Vec3d view = description.target - description.position;
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(description.position[i] + description.target[i] + description.up[i]))
      throw Error(ErrorKind::bad_input, where, "camera position, target and up must be finite");
  if (!(view.dot(view) > 0)) throw Error(ErrorKind::bad_input, where, "camera target and position are the same point");
  const Vec3d forward = unit(view);
  const Vec3d side = forward.cross(description.up);
  if (!(side.dot(side) > 1e-24 * description.up.dot(description.up)))
    throw Error(ErrorKind::bad_input, where, "camera looks along its up direction");
  const Vec3d right = unit(side);
  const Vec3d up = right.cross(forward);

  perspective_ = description.projection == CameraDescription::Projection::perspective;
  if (perspective_ && !(description.field_of_view > 0 && description.field_of_view < 180))
    throw Error(ErrorKind::bad_input, where, "camera field of view must lie between 0 and 180 degrees");
  if (!perspective_ && !(description.height > 0 && std::isfinite(description.height)))
    throw Error(ErrorKind::bad_input, where, "camera window height must be larger than 0");
  const double window_height = perspective_ ? 2 * std::tan(description.field_of_view * kPi / 360) : description.height;
  const double pixel = window_height / height;
  position_ = Vec3f(description.position - scene_origin);
  forward_ = Vec3f(forward);
  right_ = Vec3f(right * pixel);
  up_ = Vec3f(up * pixel);
  center_x_ = static_cast<float>(width) / 2;
  center_y_ = static_cast<float>(height) / 2;
}

void Camera::rays(std::span<const Vec2f> positions, const Vec3Pointers<float>& origins,
                  const Vec3Pointers<float>& directions) const {
  const Camera camera = *this;  // which nothing that is written can change
  for (std::size_t first = 0; first < positions.size(); first += kLanes) {
    Lanes x = {}, y = {};
    for (std::size_t i = 0; i < std::min(kLanes, positions.size() - first); ++i)
      x[i] = positions[first + i].x, y[i] = positions[first + i].y;
    Vec3Lanes origin, direction;
    const auto find = [&]<bool perspective>() {
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Eye eye = camera.eye<perspective>(x[i], y[i]);
        origin.set(i, eye.origin);
        direction.set(i, eye.direction);
      }
    };
    if (perspective_)
      find.operator()<true>();
    else
      find.operator()<false>();
    origins.store(first, origin);
    directions.store(first, direction);
  }
}

bool Camera::project(const Vec3d& point, Vec2d& image) const {
  const Vec3d from_eye = point - Vec3d(position_), right(right_), up(up_);
  const double depth = perspective_ ? from_eye.dot(Vec3d(forward_)) : 1;
  if (!(depth > 0)) return false;
  image.x = center_x_ + from_eye.dot(right) / (right.dot(right) * depth);
  image.y = center_y_ - from_eye.dot(up) / (up.dot(up) * depth);
  return true;
}

}  // namespace raytree
