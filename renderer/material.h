// Materials in tracing form: coefficients of Whitted's eq. 2, the patterns that color them and the bumps on them.
#pragma once

#include <memory>

#include "renderer/color.h"
#include "renderer/pattern.h"
#include "renderer/scene_description.h"

namespace raytree {

class Bump;

struct Material {
  Pattern diffuse;     ///< k_d
  Pattern ambient;     ///< share of the ambient light
  Rgb highlight;       ///< W
  float exponent = 1;  ///< n
  Rgb reflection;      ///< k_s
  Rgb transmission;    ///< k_t
  float index = 1;     ///< of the inside over the outside
  float inverse_index = 1;
  bool has_diffuse = false, has_highlight = false, has_reflection = false, has_transmission = false;
  bool ambient_as_diffuse = true;  ///< the ambient pattern is the diffuse one
  bool fresnel = false;            ///< k_s F and k_t (1 - F)
  bool needs_texture = false;      ///< some pattern looks at texture coordinates
  bool is_varied = false;          ///< diffuse varies or there is a bump: vary() has something to do
  std::shared_ptr<const Bump> bump;
};

/// `scene_origin`: see ShapeSet::origin. `fresnel`: the scene's switch.
Material make_material(const MaterialDescription& description, bool fresnel, const Vec3d& scene_origin);

}  // namespace raytree
