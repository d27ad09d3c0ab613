#include "renderer/radiance_bound.h"

#include <cmath>
#include <limits>

namespace raytree {
namespace {

/// Levels held one by one; deeper ones share the limit, which is no smaller.
constexpr int kTableLevels = 1024;

/// The bound is computed in float as the radiance is; this covers the rounding of both over a deep tree.
constexpr float kRounding = 1 + 0x1p-16f;

/// Stands for "no bound": infinity times the black channel of a weight would be NaN.
constexpr float kLargest = std::numeric_limits<float>::max();

Rgb at_most_largest(Rgb c) { return {std::min(c.r, kLargest), std::min(c.g, kLargest), std::min(c.b, kLargest)}; }

Rgb largest_recursion(const Material& material) {
  // Schlick's formula rises to 1; a conductor transmits nothing.
  if (material.conductor) return max(material.reflection, Rgb(1));
  // With Fresnel the weights are k_s F and k_t (1 - F), F in [0, 1], of a thin sheet too: a mean, at most the larger.
  return material.fresnel ? max(material.reflection, material.transmission)
                          : material.reflection + material.transmission;
}

/// Limit of the recurrence that one material gives: the fixed point of E + rho B, none where rho >= 1.
float channel_limit(float local, float recursion) {
  return recursion < 1 ? std::min(kLargest, local / (1 - recursion)) : kLargest;
}

}  // namespace

RadianceBound::RadianceBound(std::span<const Material> materials, std::span<const Light> lights,
                             const BackgroundLight& background, Rgb ambient, int depth) {
  Rgb light_sum;
  for (const Light& light : lights) light_sum += light.color * light.largest_strength();

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
    limit_ = max(limit_, {channel_limit(local.r, recursion.r), channel_limit(local.g, recursion.g),
                          channel_limit(local.b, recursion.b)});
  }
  Rgb below;
  for (int k = 0; k < std::min(depth, kTableLevels); ++k) {
    Rgb bound = seen;
    for (std::size_t m = 0; m < locals.size(); ++m)
      bound = max(bound, at_most_largest(locals[m] + recursions[m] * below));
    table_.push_back(bound);
    below = bound;
  }
}

}  // namespace raytree
