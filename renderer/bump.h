// Wrinkles on a normal (Blinn 1978): a height over the surface is felt by its light, not by its outline.
#pragma once

#include <cstdint>

#include "geometry/vec.h"
#include "renderer/footprint.h"
#include "renderer/noise.h"
#include "renderer/object_space.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Least cosine that a wrinkled normal, before it is made unit, keeps with the geometric normal and with the direction
/// to the viewer: a wrinkle that would turn its face from both is laid down until it just does not.
inline constexpr float kLeastFacing = 0.02f;

class Bump {
 public:
  /// `scene_origin`: see ShapeSet::origin.
  Bump(const BumpDescription& description, const Vec3d& scene_origin);

  /// It lies in the shape's own space.
  bool follows_object() const { return origin_.follows_object(); }

  /// At a place that is measured from where the bump begins, through a window of `width`; all in units of its space.
  Height height(const Vec3d& place, double width) const;

  /// N' = unit(N - s (grad h - (grad h.N) N)): the normal of the surface that is raised by h along its outward normal,
  /// to the first order in h; s is -1 where `normal` points inward. `normal`, `side` (geometric) and `to_viewer` are
  /// unit and on one side, save that `normal` may lean away from the viewer. Continuous; on that side, by kLeastFacing.
  /// Where the bump follows its object and `frame` is not null, N is taken to the shape's own space, the surface is
  /// raised there, and N' comes back as normals do.
  Vec3f bent(const Vec3f& normal, const Vec3f& side, const Vec3f& to_viewer, bool inward, const Vec3f& position,
             const Footprint& footprint, const ObjectFrame* frame) const;

 private:
  BumpDescription::Kind kind_;
  double amplitude_, frequency_;  ///< per unit of its space
  SolidOrigin origin_;
  Vec3d direction_;  ///< unit
  Octaves octaves_;
};

}  // namespace raytree
