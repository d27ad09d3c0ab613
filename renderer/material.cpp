#include "renderer/material.h"

#include "renderer/bump.h"

namespace raytree {
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
  material.needs_texture =
      needs_texture(description.diffuse) || (description.ambient && needs_texture(*description.ambient));
  if (description.bump) material.bump = std::make_shared<const Bump>(*description.bump, scene_origin);
  material.is_varied = material.diffuse.varies() || (kFeatures.bumps && material.bump != nullptr);
  return material;
}

}  // namespace raytree
