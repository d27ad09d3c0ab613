// A Catmull-Clark cage's limit surface as Bezier patches: the cage is refined about extraordinary vertices and creases
// until what is left regular are bicubic B-splines. The reference tracer divides them further.
#pragma once

#include <vector>

#include "geometry/error.h"
#include "geometry/limit_patch.h"
#include "geometry/polygon_mesh.h"
#include "geometry/subdivision_cage.h"

namespace raytree {

/// Refinements about smooth extraordinary vertices, and about creases and sharp corners. What then still is irregular,
/// 2^-8 and 2^-10 of a face wide, has a B-spline patch fitted to its limit: at 2^-8 of a face's width it is off by less
/// than 1e-7 of that width (tests: against the exact limits of vertices, and against OpenSubdiv's own evaluation).
inline constexpr int kSmoothIsolation = 8;
inline constexpr int kSharpIsolation = 10;

/// Relative to the mesh's origin, with faces and parameters as make_subdivision_surface() has them. Bilinear cages too;
/// none for Loop's scheme, whose patches are not bicubic. Throws Error (bad_input) at `where` as check_cage() does.
std::vector<LimitPatch> subdivision_patches(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                            const SourceLocation& where);

}  // namespace raytree
