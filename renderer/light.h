// Lights in tracing form: directional and point lights, intensities constant with distance (Whitted 1980, eq. 1).
#pragma once

#include <limits>

#include "geometry/surface.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/scene_description.h"

namespace raytree {

struct Light {
  Rgb color;
  bool directional = true;
  Vec3f place{0, 1, 0};  ///< directional: unit direction to the light; point: its position, scene space

  /// Unit direction from `point` to the light, and the distance, infinity for directional ones.
  Vec3f direction_from(const Vec3f& point, float& distance) const {
    if (directional) {
      distance = std::numeric_limits<float>::infinity();
      return place;
    }
    const Vec3f to_light = place - point;
    distance = std::sqrt(to_light.dot(to_light));
    return to_light * (1 / distance);
  }
};

inline Light make_light(const LightDescription& description, const Vec3d& scene_origin) {
  Light light;
  light.color = description.color;
  if (const auto* directional = std::get_if<DirectionalLight>(&description.kind)) {
    light.place = Vec3f(unit(-directional->direction));
  } else {
    light.directional = false;
    light.place = Vec3f(std::get<PointLight>(description.kind).position - scene_origin);
  }
  return light;
}

}  // namespace raytree
