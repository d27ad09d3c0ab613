// What a ray sees that leaves the scene.
#pragma once

#include <variant>

#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/scene_description.h"

namespace raytree {

struct BackgroundLight {
  Rgb bottom, horizon, top;  ///< equal when constant
  bool varies = false;

  BackgroundLight() = default;
  explicit BackgroundLight(const Background& description) {
    if (const auto* constant = std::get_if<ConstantBackground>(&description)) {
      bottom = horizon = top = constant->color;
    } else {
      const auto& gradient = std::get<GradientBackground>(description);
      bottom = gradient.bottom, horizon = gradient.horizon, top = gradient.top;
      varies = true;
    }
  }

  /// Radiance along a unit direction; world axes, Y up.
  Rgb along(const Vec3f& direction) const {
    if (!kFeatures.gradient_background || !varies) return horizon;
    const float height = std::min(1.0f, std::max(-1.0f, direction.y));
    return height >= 0 ? mix(horizon, top, height) : mix(horizon, bottom, -height);
  }
  Rgb largest() const { return max(bottom, max(horizon, top)); }
};

}  // namespace raytree
