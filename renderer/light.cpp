#include "renderer/light.h"

#include "geometry/angle.h"

namespace raytree {
namespace {

/// Cosines nearer than this cannot be told apart in float: such a cone has a hard border.
constexpr double kLeastCosineSpan = 1e-6;

void place_light(const DirectionalLight& kind, const Vec3d&, Light& light) {
  light.place = Vec3f(unit(-kind.direction));
}

void place_light(const PointLight& kind, const Vec3d& scene_origin, Light& light) {
  light.directional = false;
  light.place = Vec3f(kind.position - scene_origin);
  light.falloff = kind.falloff;
  light.least_distance = static_cast<float>(kind.least_distance);
  light.even = kind.falloff == Falloff::none;
}

void place_light(const SpotLight& kind, const Vec3d& scene_origin, Light& light) {
  place_light(PointLight{kind.position, kind.falloff, kind.least_distance}, scene_origin, light);
  light.even = false;
  light.has_cone = true;
  light.axis = Vec3f(unit(kind.direction));
  const double border = std::cos(kind.angle * kDegree), full = std::cos(kind.inner_angle * kDegree);
  light.border_cosine = static_cast<float>(border);
  light.inverse_cosine_span = static_cast<float>(1 / std::max(full - border, kLeastCosineSpan));
}

}  // namespace

Light make_light(const LightDescription& description, const Vec3d& scene_origin) {
  Light light;
  light.color = description.color;
  std::visit([&](const auto& kind) { place_light(kind, scene_origin, light); }, description.kind);
  return light;
}

}  // namespace raytree
