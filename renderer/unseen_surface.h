// Which curved shapes need not be made: those that no ray can meet. Where eye rays are all the rays there are, that is
// what lies wholly outside the frame.
#pragma once

#include <span>

#include "geometry/patch_surface.h"
#include "geometry/polygon_mesh.h"
#include "geometry/tessellation_view.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Whether rays leave hits of this scene: some light casts shadows, or some material that a shape may show reflects or
/// transmits and the tree has levels for it. `assembled`: the shape that is being made, whose mesh file was read; those
/// of other shapes without a material of their own may yet name materials that do.
bool rays_leave_hits(const SceneDescription& scene, const ShapeDescription& assembled);

/// Whether all of `box` (the shape's space, to_world takes it to the world) lies on the far side of one border of the
/// full frame, widened by kFrameMargin and a pixel, or behind the eye. False where the view is any_direction. Never a
/// crop's: what is made must not depend on it.
bool outside_frame(const Bounds3d& box, const Matrix44d& to_world, const TessellationView& view);

/// A box about the limit surface of a cage, which lies within the convex hull of its control points: all rules' weights
/// are shares.
Bounds3d hull_bounds(const PolygonMesh& cage);

/// A box about patches. Bezier patches lie within their control points' hull, rational ones too; a Coons patch is the
/// sum of two ruled surfaces less a bilinear one, all within its curves' box, so within three times that box.
Bounds3d hull_bounds(std::span<const SurfacePatch> patches);

}  // namespace raytree
