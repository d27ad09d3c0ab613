// Colors that vary over a surface: checkers, stripes and noise, seen through the window of a pixel where that is known.
// A color that is constant costs one test of a pointer.
#pragma once

#include <memory>

#include "geometry/surface.h"
#include "geometry/vec.h"
#include "renderer/color.h"
#include "renderer/features.h"
#include "renderer/scene_description.h"

namespace raytree {

/// The parallelogram of a surface that a sample stands for: what the sample's share of the picture covers of the plane
/// that touches the surface. Both edges 0: a point.
struct Footprint {
  Vec3f edge{0, 0, 0}, other_edge{0, 0, 0};  ///< scene units, tangent to the surface
  /// Patterns with edges are taken at a point where the footprint is smaller than a cell of theirs: adaptive sampling
  /// finds the edges by what samples beside them differ in, and a sample that blurs them hides them from it.
  bool leaves_edges = false;
};

class VaryingColor;

struct Pattern {
  Rgb even, odd;                                ///< what is mixed; equal when constant
  std::shared_ptr<const VaryingColor> varying;  ///< null: constant, `even`

  bool varies() const { return kFeatures.patterns && varying != nullptr; }
  Rgb at(const SurfacePoint& point, const Footprint& footprint) const {
    return varies() ? mixed(point, footprint) : even;
  }
  /// No smaller than any value: mixtures lie between the two.
  Rgb largest() const { return max(even, odd); }

 private:
  Rgb mixed(const SurfacePoint& point, const Footprint& footprint) const;
};

/// `scene_origin`: see ShapeSet::origin. Positions are measured from where the pattern begins, in double, so that they
/// keep their digits far from the world's origin.
Pattern make_pattern(const ColorPattern& description, const Vec3d& scene_origin);

/// Whether it looks at texture coordinates.
bool needs_texture(const ColorPattern& description);

}  // namespace raytree
