// From a parametric surface to triangles: a number of segments for every edge, points shared between the faces that
// meet there, so that no crack opens.
#pragma once

#include <cstdint>

#include "geometry/parametric_surface.h"
#include "geometry/triangle_mesh.h"

namespace raytree {

/// Every edge in `rate` >= 1 equal segments of its parameter. Positions of corners and edges are evaluated once and
/// shared by index between all faces that meet there; so are normals, but at sharp edges and corners. Runs on the task
/// arena's threads; the result does not depend on their number. triangle_faces holds source_face().
TriangleMesh tessellate_uniformly(const ParametricSurface& surface, int rate);

}  // namespace raytree
