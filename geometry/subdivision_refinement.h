// Uniform refinement of a subdivision cage: the control points after N levels, as a polygon mesh, or those points on
// the limit surface. For export and for checks against other programs; pictures go through tessellation.h.
#pragma once

#include "geometry/error.h"
#include "geometry/polygon_mesh.h"
#include "geometry/subdivision_cage.h"

namespace raytree {

inline constexpr int kMaxRefinementLevels = 15;  ///< OpenSubdiv's own limit

enum class RefinedPoints : std::uint8_t {
  control,  ///< the refined cage's
  limit     ///< moved to the limit surface, with its normals: one a face along infinite creases and boundaries
};

/// Refines `levels` in [0, kMaxRefinementLevels] times. Faces without a surface (holes; at boundaries under
/// BoundaryRule::none) are left out; texture coordinates and groups follow. Control points of a mesh with tags keep
/// what is left of them, so that refining again goes on where this ended. Throws Error (bad_input) at `where` as
/// check_cage() does, and where there would be more than 2^29 faces.
PolygonMesh refine_uniformly(const PolygonMesh& mesh, const SubdivisionRules& rules, int levels, RefinedPoints points,
                             const SourceLocation& where, Warnings& warnings);

}  // namespace raytree
