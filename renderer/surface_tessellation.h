// Curved shapes become triangles here: the scene's settings and camera on one side, geometry/tessellation*.h on the
// other. The result depends on scene, camera and the full frame's size, never on a crop.
#pragma once

#include <functional>

#include "geometry/error.h"
#include "geometry/facet_record.h"
#include "geometry/mesh_source.h"
#include "geometry/parametric_surface.h"
#include "geometry/tessellation_view.h"
#include "geometry/triangle_mesh.h"
#include "renderer/scene.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Calls its argument with each way from the space of a list of shapes to the world. Empty: the list is the scene's
/// own, and that space the world.
using ListPlaces = std::function<void(const std::function<void(const Matrix44d&)>&)>;

/// An eye that lies in the sphere about a use of a group, or close to it, counts as so many of its radii away.
inline constexpr double kLeastUseDistance = 0.05;

/// The camera's look at shapes of the world. Throws Error (bad_input) for a camera without a view.
TessellationView world_view(const CameraDescription& camera, const ImageDescription& image,
                            const SourceLocation& where);

/// A look that is at least as close as `view` on each of the places of what lies in `box`: the nearest use's pixel, for
/// every point and direction. With one place alone it is the view itself.
TessellationView nearest_view(const TessellationView& view, const ListPlaces& places, const Bounds3d& box);

class SurfaceTessellation {
 public:
  /// measure: compare all that is made with its limit surface, for `raytree info --tessellation`.
  SurfaceTessellation(const SceneDescription& scene, const CameraDescription& camera, bool measure);

  /// `surface` lies in the shape's space; so do the triangles. Uniform where the scene's rate says so; else no more
  /// than the view needs. Fills summary.tessellation and adds a warning for faces that stay coarser than the tolerance.
  /// `parameters`: see tessellate(). Throws Error (bad_input).
  TriangleMesh make(const ParametricSurface& surface, const ShapeDescription& shape, const ListPlaces& places,
                    ShapeSummary& summary, Warnings& warnings, FacetParameters* parameters = nullptr) const;

  /// Whether all of `hull`, in the shape's space, lies outside the full frame: see outside_frame(). For the scene's own
  /// shapes.
  bool is_outside_frame(const Bounds3d& hull, const ShapeDescription& shape) const;

  /// How wide a pixel is at places of a list of shapes, near those in `box`: at least as narrow as any of its uses is
  /// seen with.
  PixelSize pixel_size(const ListPlaces& places, const Bounds3d& box) const;

 private:
  TessellationSettings settings_;
  TessellationView view_;
  bool measure_;
};

}  // namespace raytree
