// Wrinkles on a normal (Blinn 1978): a height over the surface is felt by its light, not by its outline.
#pragma once

#include <cstdint>

#include "geometry/vec.h"
#include "renderer/noise.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Least cosine that a wrinkled normal, before it is made unit, keeps with the geometric normal and with the direction
/// to the viewer: a wrinkle that would turn its face from both is laid down until it just does not.
inline constexpr float kLeastFacing = 0.02f;

class Bump {
 public:
  /// `scene_origin`: see ShapeSet::origin.
  Bump(const BumpDescription& description, const Vec3d& scene_origin);

  /// At `position` (scene space), through a window of `width`; all in scene units.
  Height height(const Vec3f& position, double width) const;

  /// N' = unit(N - s (grad h - (grad h.N) N)): the normal of the surface that is raised by h along its outward normal,
  /// to the first order in h; s is -1 where `normal` points inward. `normal`, `side` (geometric) and `to_viewer` are
  /// unit and on one side, save that `normal` may lean away from the viewer. Continuous; on that side, by kLeastFacing.
  Vec3f bent(const Vec3f& normal, const Vec3f& side, const Vec3f& to_viewer, bool inward, const Vec3f& position,
             double width) const;

 private:
  BumpDescription::Kind kind_;
  double amplitude_, frequency_;  ///< per scene unit
  Vec3d origin_;                  ///< scene space
  Vec3d direction_;               ///< unit
  Octaves octaves_;
};

}  // namespace raytree
