#include "renderer/radiance_bound.h"

#include <cmath>
#include <limits>

namespace raytree {
namespace {

/// Levels held one by one; deeper ones share the limit, which is no smaller.
constexpr int kTableLevels = 1024;

/// The bound is computed in float as the radiance is; this covers the rounding of both over a deep tree.
constexpr float kRounding = 1 + 0x1p-16f;

Rgb largest_recursion(const Material& material) {
  // With Fresnel the weights are k_s F and k_t (1 - F): a mean of k_s and k_t, at most the larger.
  return material.fresnel ? max(material.reflection, material.transmission)
                          : material.reflection + material.transmission;
}

float channel_limit(float background, float local, float recursion) {
  if (recursion >= 1) return local > 0 || background > 0 ? std::numeric_limits<float>::infinity() : 0.0f;
  return std::max(background, local / (1 - recursion));
}

}  // namespace

RadianceBound::RadianceBound(std::span<const Material> materials, std::span<const Light> lights,
                             const BackgroundLight& background, Rgb ambient, int depth) {
  Rgb light_sum;
  for (const Light& light : lights) light_sum += light.color;

  std::vector<Rgb> locals, recursions;
  const Rgb seen = background.largest() * kRounding;
  limit_ = seen;
  for (const Material& material : materials) {
    const Rgb local =
        (ambient * material.ambient.largest() + light_sum * (material.diffuse.largest() + material.highlight)) *
        kRounding;
    const Rgb recursion = largest_recursion(material) * kRounding;
    locals.push_back(local);
    recursions.push_back(recursion);
    limit_ = max(limit_, {channel_limit(seen.r, local.r, recursion.r), channel_limit(seen.g, local.g, recursion.g),
                          channel_limit(seen.b, local.b, recursion.b)});
  }
  Rgb below;
  for (int k = 0; k < std::min(depth, kTableLevels); ++k) {
    Rgb bound = seen;
    for (std::size_t m = 0; m < locals.size(); ++m) bound = max(bound, locals[m] + recursions[m] * below);
    table_.push_back(bound);
    below = bound;
  }
}

}  // namespace raytree
