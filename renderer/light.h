// Lights in tracing form: directional, point and spot lights, as strong at every distance (Whitted 1980, eq. 1) or with
// falloff.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Unit direction from `point` to `place`, and the distance.
inline Vec3f direction_to(const Vec3f& place, const Vec3f& point, float& distance) {
  const Vec3f to_place = place - point;
  distance = std::sqrt(to_place.dot(to_place));
  return to_place * (1 / distance);
}

struct Light {
  Rgb color;
  bool directional = true;
  bool even = true;                 ///< neither falloff nor cone: strength() is 1
  Vec3f place{0, 1, 0};             ///< directional: unit direction to the light; else its position, scene space
  Falloff falloff = Falloff::none;  ///< never of directional lights
  float least_distance = 1;
  bool has_cone = false;
  Vec3f axis{0, -1, 0};  ///< unit, the way the light travels
  float border_cosine = -1, inverse_cosine_span = 0;

  /// Unit direction from `point` to the light, and the distance, infinity for directional ones.
  Vec3f direction_from(const Vec3f& point, float& distance) const {
    if (directional) {
      distance = std::numeric_limits<float>::infinity();
      return place;
    }
    return direction_to(place, point, distance);
  }

  /// Share of `color` that arrives over `distance` from unit `direction` (to the light): in [0, largest_strength()].
  float strength(const Vec3f& direction, float distance) const {
    if (!kFeatures.uneven_lights || even) return 1;
    float share = 1;
    if (has_cone) {
      const float t = std::clamp((-axis.dot(direction) - border_cosine) * inverse_cosine_span, 0.0f, 1.0f);
      share = t * t * (3 - 2 * t);
    }
    if (falloff != Falloff::none) {
      const float weakened = 1 / std::max(distance, least_distance);
      share *= falloff == Falloff::linear ? weakened : weakened * weakened;
    }
    return share;
  }
  float largest_strength() const {
    if (falloff == Falloff::none) return 1;
    return falloff == Falloff::linear ? 1 / least_distance : 1 / least_distance / least_distance;
  }
};

/// `scene_origin`: see ShapeSet::origin. Directions must not be zero.
Light make_light(const LightDescription& description, const Vec3d& scene_origin);

}  // namespace raytree
