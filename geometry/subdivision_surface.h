// The limit surface of a subdivision cage, face by face, through OpenSubdiv's Bfr. Triangles of it are made by
// tessellation.h; refined cages by subdivision_refinement.h.
#pragma once

#include <memory>

#include "geometry/error.h"
#include "geometry/parametric_surface.h"
#include "geometry/polygon_mesh.h"
#include "geometry/subdivision_cage.h"

namespace raytree {

/// Levels to which Bfr isolates features before it takes a Gregory patch for the limit: smooth extraordinary vertices,
/// and semi-sharp ones. Its own 2 and 6 leave errors of 2.5e-4 of the size and 1.4 degrees; with these, positions are
/// within 1e-6 and normals within .02 degrees (.2 at valence 12). At smooth extraordinary vertices themselves, position
/// and normal are exact by the limit masks.
inline constexpr int kSmoothApproximationLevel = 6;
inline constexpr int kSharpApproximationLevel = 9;

/// What evaluation may keep of patches that are not plain bicubic ones; beyond, their points are derived at each call.
inline constexpr std::size_t kPatchPointBudget = std::size_t(512) << 20;  // bytes

/// The surface keeps nothing of the mesh but copies of what it needs. Faces are those of the cage in its order; holes
/// and, under BoundaryRule::none, faces at the boundary have no sides. Where the first derivatives are parallel or
/// vanish, the normal is that of the first-order expansion into the face (Pu + du Puu + dv Puv) x (Pv + du Puv + dv
/// Pvv); where that vanishes too, of the nearest point toward the face's middle that has one, else the polygon's.
/// Runs on the task arena's threads; the result does not depend on their number. Throws Error (bad_input) at `where`
/// as check_cage() does. Nor does the result depend on the budget.
std::unique_ptr<ParametricSurface> make_subdivision_surface(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                                            const SourceLocation& where, Warnings& warnings,
                                                            std::size_t point_budget = kPatchPointBudget);

}  // namespace raytree
