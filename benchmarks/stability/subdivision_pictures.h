// Pictures of limit surfaces for the stability suite: a cage as the renderer shows it, beside what it would be by other
// rules.
#pragma once

#include <string>

#include "benchmarks/stability/stability_case.h"
#include "geometry/polygon_mesh.h"
#include "renderer/scene_description.h"

namespace raytree::benchmarks {

/// The limit surface of a cage.
ShapeDescription limit_shape(const PolygonMesh& cage, const SubdivisionRules& rules);
/// A mesh as it is, one normal a vertex made of all faces about it.
ShapeDescription smooth_shape(PolygonMesh mesh);
/// The limit surfaces of the faces, each a cage of its own.
ShapeDescription faces_apart(const PolygonMesh& cage);

enum class SurfaceView : std::uint8_t {
  of_cube,  ///< cube_cage(): top, which has the crease, and two sides
  of_grid,  ///< grid_cage(4, 4, 0) from straight above
  of_fan,   ///< three quads about the z axis
};

/// Nothing where the run wants no pictures.
void add_surface_picture(const StabilityRun& run, StabilityResult& result, std::string caption, ShapeDescription shape,
                         SurfaceView view);

}  // namespace raytree::benchmarks
