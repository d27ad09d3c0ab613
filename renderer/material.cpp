#include "renderer/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/angle.h"
#include "renderer/bump.h"

namespace raytree {
namespace {

/// See Material::least_highlight. What is under 2^-150, half of the least float, is 0; a factor of 2 is left for the
/// rounding of the power.
float vanishing_cosine(float exponent) {
  if (!(exponent > 0)) return 0;
  const double cosine = std::exp2(-151.0 / exponent);
  const auto rounded = static_cast<float>(cosine);
  return rounded <= cosine ? rounded : std::nextafter(rounded, 0.0f);
}

}  // namespace

std::string material_problem(const MaterialDescription& description) {
  if (description.conductor && !is_black(description.transmission))
    return "a conductor transmits nothing: transmission must be 0";
  if (description.thin && !is_black(description.absorption))
    return "a thin sheet has no inside that could absorb: put its color into transmission";
  if (description.one_sided && !is_black(description.transmission))
    return "what transmits is seen from both sides: one_sided or transmission, not both";
  const std::vector<AngleWeight>& table = description.highlight.weight_by_angle;
  for (std::size_t i = 1; i < table.size(); ++i)
    if (!(table[i].angle > table[i - 1].angle))
      return fmt::format("weight_by_angle: angle {} does not lie above the one before it, {}", table[i].angle,
                         table[i - 1].angle);
  return {};
}

Material make_material(const MaterialDescription& description, bool fresnel, const Vec3d& scene_origin) {
  Material material;
  material.diffuse = make_pattern(description.diffuse, scene_origin);
  material.ambient = description.ambient ? make_pattern(*description.ambient, scene_origin) : material.diffuse;
  material.highlight = description.highlight.weight;
  if (const auto& table = description.highlight.weight_by_angle; !table.empty()) {
    material.tabled_highlight = true;
    material.highlight = Rgb();
    for (const AngleWeight& point : table) {
      material.highlight_table.points.push_back({static_cast<float>(point.angle * kDegree), point.weight});
      material.highlight = max(material.highlight, point.weight);
    }
  }
  material.exponent = static_cast<float>(description.highlight.exponent);
  material.least_highlight = vanishing_cosine(material.exponent);
  material.reflection = description.reflection;
  material.transmission = description.transmission;
  material.ambient_as_diffuse = !description.ambient.has_value();
  material.index = static_cast<float>(description.index_of_refraction);
  material.inverse_index = static_cast<float>(1 / description.index_of_refraction);
  material.has_diffuse = !is_black(material.diffuse.largest());
  material.has_highlight = !is_black(material.highlight);
  material.has_reflection = !is_black(material.reflection);
  material.has_transmission = !is_black(material.transmission);
  material.conductor = description.conductor;
  material.thin = description.thin && material.has_transmission;
  material.one_sided = kFeatures.one_sided_surfaces && description.one_sided;
  material.special_optics = material.conductor || material.thin;
  material.has_reflection |= material.conductor;  // (1 - cos)^5 is left of a black k_s
  material.roughness = static_cast<float>(description.roughness);
  material.rough =
      kFeatures.rough_surfaces && material.roughness > 0 && (material.has_reflection || material.has_transmission);
  material.fresnel = fresnel && !material.conductor;
  material.has_inside = material.has_transmission && !material.thin;
  material.absorption = description.absorption;
  material.absorbs = material.has_inside && !is_black(material.absorption);
  material.priority = description.priority;
  const Rgb& k_t = material.transmission;
  material.shadow_transmission = {std::min(k_t.r, 1.0f), std::min(k_t.g, 1.0f), std::min(k_t.b, 1.0f)};
  material.needs_texture =
      needs_texture(description.diffuse) || (description.ambient && needs_texture(*description.ambient));
  if (description.bump) material.bump = std::make_shared<const Bump>(*description.bump, scene_origin);
  material.is_varied = material.diffuse.varies() || (kFeatures.bumps && material.bump != nullptr);
  material.follows_objects = material.diffuse.follows_object() || material.ambient.follows_object() ||
                             (kFeatures.bumps && material.bump != nullptr && material.bump->follows_object());
  return material;
}

Rgb HighlightTable::at(float cosine) const {
  const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const auto above = std::upper_bound(points.begin(), points.end(), angle,
                                      [](float value, const Point& point) { return value < point.angle; });
  if (above == points.begin()) return points.front().weight;
  if (above == points.end()) return points.back().weight;
  const Point& below = *(above - 1);
  return mix(below.weight, above->weight, (angle - below.angle) / (above->angle - below.angle));
}

Rgb transmitted_share(const Rgb& absorption, float distance) {
  return {std::exp(-absorption.r * distance), std::exp(-absorption.g * distance), std::exp(-absorption.b * distance)};
}

}  // namespace raytree
