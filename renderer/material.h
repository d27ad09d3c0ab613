// Materials in tracing form: coefficients of Whitted's eq. 2, the patterns that color them and the bumps on them.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/color.h"
#include "renderer/pattern.h"
#include "renderer/scene_description.h"

namespace raytree {

class Bump;

/// W of eq. 4.5 over the angle of incidence.
struct HighlightTable {
  struct Point {
    float angle;  ///< radians
    Rgb weight;
  };
  std::vector<Point> points;  ///< by rising angle

  /// Linear between the points, constant beyond them.
  Rgb at(float cosine) const;
};

struct Material {
  Pattern diffuse;            ///< k_d
  Pattern ambient;            ///< share of the ambient light
  Rgb highlight;              ///< W; of a table, the largest
  float exponent = 1;         ///< n
  float least_highlight = 0;  ///< a cosine whose n-th power, as that of any below it, is 0 in single precision
  Rgb reflection;             ///< k_s
  Rgb transmission;           ///< k_t
  float index = 1;            ///< of the inside over the outside
  float inverse_index = 1;
  bool has_diffuse = false, has_highlight = false, has_reflection = false, has_transmission = false;
  bool ambient_as_diffuse = true;  ///< the ambient pattern is the diffuse one
  bool fresnel = false;            ///< k_s F and k_t (1 - F)
  bool needs_texture = false;      ///< some pattern looks at texture coordinates

  bool special_optics = false;    ///< thin, a conductor, or in a scene that tracks media or has rough surfaces
  bool conductor = false;         ///< k_s rises to 1 by Schlick's formula
  bool free_reflections = false;  ///< mirrored directions are followed below their facet: FacetReflections::classic
  bool thin = false;              ///< a sheet without an inside
  bool has_inside = false;        ///< transmits and is not thin
  bool absorbs = false;           ///< has an inside that is not clear
  bool one_sided = false;         ///< not there for rays that come from behind
  bool takes_on_the_way =
      false;  ///< absorbs, is one-sided, or the scene tracks media or has rough surfaces: see passes()
  bool tabled_highlight = false;  ///< W by highlight_table
  bool rough = false;             ///< has children, and facets that perturb them
  float roughness = 0;            ///< standard deviation of the facets' slopes
  int priority = 0;               ///< among overlapping media
  Rgb absorption;                 ///< a of exp(-a t) inside
  Rgb shadow_transmission;        ///< of one crossing by a shadow ray: k_t, at most 1
  HighlightTable highlight_table;

  bool is_plain = true;    ///< of a prepared scene: neither varied, its ambient neither, nor takes_on_the_way
  bool is_varied = false;  ///< diffuse varies or there is a bump: vary() has something to do
  bool in_cells = false;   ///< of a prepared scene: the diffuse pattern is all that varies, and may be asked for cells
  /// Diffuse, ambient or bump lies in the own space of the shape that is hit; of a prepared scene: and some shape's is
  /// not the world.
  bool follows_objects = false;
  std::shared_ptr<const Bump> bump;
};

/// exp(-a t): what of light is left after `distance` (finite) in a medium (Beer and Lambert).
Rgb transmitted_share(const Rgb& absorption, float distance);

/// What is wrong with a material as a whole, for the message of an Error; empty: nothing.
std::string material_problem(const MaterialDescription& description);

/// `scene_origin`: see ShapeSet::origin. `fresnel`: the scene's switch.
Material make_material(const MaterialDescription& description, bool fresnel, const Vec3d& scene_origin);

}  // namespace raytree
