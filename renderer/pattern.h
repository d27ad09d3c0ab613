// Colors that vary over a surface: checkers, stripes and noise, seen through the window of a pixel where that is known.
// A color that is constant costs one test of a pointer.
#pragma once

#include <cstdint>
#include <memory>

#include "geometry/lanes.h"
#include "geometry/surface.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/footprint.h"
#include "renderer/scene_description.h"

namespace raytree {

class ObjectFrame;
class VaryingColor;

/// Where the samples of one block of a batch look at a pattern.
struct SampleLanes {
  Vec3Lanes position;          ///< scene space
  Vec3Lanes edge, other_edge;  ///< of Footprint
  std::int32_t leaves_edges[kLanes];
};

struct Pattern {
  Rgb even, odd;                                ///< what is mixed; equal when constant
  std::shared_ptr<const VaryingColor> varying;  ///< null: constant, `even`

  bool varies() const { return kFeatures.patterns && varying != nullptr; }
  /// `frame`: of the shape that the point lies on, where it has one (object_space.h); else null.
  Rgb at(const SurfacePoint& point, const Footprint& footprint, const ObjectFrame* frame) const {
    return varies() ? mixed(point, footprint, frame) : even;
  }
  bool follows_object() const;  ///< it lies in the shape's own space
  bool has_cells() const;       ///< it is a checker over positions
  /// The same as at() of a whole block, of a pattern that has_cells() where no shape has a frame: into `cells` 1 where
  /// it is `even`, -1 where it is `odd`, 0 where the sample's window reaches over more than one cell.
  void find_cells(const SampleLanes& samples, std::int32_t (&cells)[kLanes]) const;
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
