// Materials in tracing form: coefficients of Whitted's eq. 2 and the patterns that color them.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/surface.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/scene_description.h"

namespace raytree {

/// A color that may vary over the surface.
struct Pattern {
  Rgb even, odd;  ///< equal when constant
  bool varies = false;
  bool over_texture = false;  ///< texture coordinates in place of position
  int axis[2] = {0, 2};       ///< components of the position
  double corner[2] = {0, 0};  ///< scene space: where a corner of an even square lies
  double squares_per_unit = 1;

  Rgb at(const SurfacePoint& point) const { return kFeatures.patterns && varies ? square_at(point) : even; }
  Rgb largest() const { return max(even, odd); }

 private:
  Rgb square_at(const SurfacePoint& point) const {
    const double a = over_texture ? point.texture.x : point.position[axis[0]];
    const double b = over_texture ? point.texture.y : point.position[axis[1]];
    const double column = std::floor((a - corner[0]) * squares_per_unit);
    const double row = std::floor((b - corner[1]) * squares_per_unit);
    const double sum = column + row;
    return sum - 2 * std::floor(sum * 0.5) == 0 ? even : odd;
  }
};

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
};

/// `scene_origin`: see ShapeSet::origin. `fresnel`: the scene's switch.
Material make_material(const MaterialDescription& description, bool fresnel, const Vec3d& scene_origin);

}  // namespace raytree
