// Colors that vary over a surface: checkers, stripes and noise, seen through the window of a pixel where that is known.
// A color that is constant costs one test of a pointer.
#pragma once

#include <memory>

#include "geometry/surface.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/footprint.h"
#include "renderer/scene_description.h"

namespace raytree {

class ObjectFrame;
class VaryingColor;

struct Pattern {
  Rgb even, odd;                                ///< what is mixed; equal when constant
  std::shared_ptr<const VaryingColor> varying;  ///< null: constant, `even`

  bool varies() const { return kFeatures.patterns && varying != nullptr; }
  /// `frame`: of the shape that the point lies on, where it has one (object_space.h); else null.
  Rgb at(const SurfacePoint& point, const Footprint& footprint, const ObjectFrame* frame) const {
    return varies() ? mixed(point, footprint, frame) : even;
  }
  bool follows_object() const;  ///< it lies in the shape's own space
  /// No smaller than any value: mixtures lie between the two.
  Rgb largest() const { return max(even, odd); }

 private:
  Rgb mixed(const SurfacePoint& point, const Footprint& footprint, const ObjectFrame* frame) const;
};

/// `scene_origin`: see ShapeSet::origin. Positions are measured from where the pattern begins, in double, so that they
/// keep their digits far from the world's origin.
Pattern make_pattern(const ColorPattern& description, const Vec3d& scene_origin);

/// Whether it looks at texture coordinates.
bool needs_texture(const ColorPattern& description);

}  // namespace raytree
