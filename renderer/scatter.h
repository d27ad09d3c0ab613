// Places on a terrain for the uses of a group: where they stand, how they are turned and scaled.
#pragma once

#include <vector>

#include "geometry/terrain.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vec.h"
#include "renderer/scene_description.h"

namespace raytree {

/// Transforms of the uses, in the space that `terrain`, a mesh that make_terrain() made for `grid`, was moved to.
/// Points lie on its triangles. Places come from a sequence that fills the square evenly (Roberts 2018, R2), shaken
/// within their share of it. A place's scale and turn, and whether it lies in a clearing, depend on the seed and its
/// number.
std::vector<Matrix44d> scattered(const ScatterShape& scatter, const TriangleMesh& terrain, const TerrainGrid& grid);

}  // namespace raytree
