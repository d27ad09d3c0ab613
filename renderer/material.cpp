#include "renderer/material.h"

namespace raytree {
namespace {

Pattern make_pattern(const ColorPattern& description, const Vec3d& scene_origin) {
  Pattern pattern;
  if (const auto* color = std::get_if<Rgb>(&description)) {
    pattern.even = pattern.odd = *color;
    return pattern;
  }
  const auto& checker = std::get<CheckerPattern>(description);
  pattern.even = checker.even;
  pattern.odd = checker.odd;
  pattern.varies = true;
  pattern.squares_per_unit = 1 / checker.size;
  pattern.over_texture = checker.plane == CheckerPattern::Plane::uv;
  switch (checker.plane) {
    case CheckerPattern::Plane::xz:
      pattern.axis[0] = 0, pattern.axis[1] = 2;
      break;
    case CheckerPattern::Plane::xy:
      pattern.axis[0] = 0, pattern.axis[1] = 1;
      break;
    case CheckerPattern::Plane::yz:
      pattern.axis[0] = 1, pattern.axis[1] = 2;
      break;
    case CheckerPattern::Plane::uv:
      break;
  }
  for (int i = 0; i < 2; ++i) {
    const double offset = i == 0 ? checker.offset.x : checker.offset.y;
    pattern.corner[i] = pattern.over_texture ? offset : offset - scene_origin[pattern.axis[i]];
  }
  return pattern;
}

}  // namespace

Material make_material(const MaterialDescription& description, bool fresnel, const Vec3d& scene_origin) {
  Material material;
  material.diffuse = make_pattern(description.diffuse, scene_origin);
  material.ambient = description.ambient ? make_pattern(*description.ambient, scene_origin) : material.diffuse;
  material.highlight = description.highlight.weight;
  material.exponent = static_cast<float>(description.highlight.exponent);
  material.reflection = description.reflection;
  material.transmission = description.transmission;
  material.ambient_as_diffuse = !description.ambient.has_value();
  material.index = static_cast<float>(description.index_of_refraction);
  material.inverse_index = static_cast<float>(1 / description.index_of_refraction);
  material.has_diffuse = !is_black(material.diffuse.largest());
  material.has_highlight = !is_black(material.highlight);
  material.has_reflection = !is_black(material.reflection);
  material.has_transmission = !is_black(material.transmission);
  material.fresnel = fresnel;
  material.needs_texture = (material.diffuse.varies && material.diffuse.over_texture) ||
                           (material.ambient.varies && material.ambient.over_texture);
  return material;
}

}  // namespace raytree
