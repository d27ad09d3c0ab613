// Spheres, cones, cylinders and discs cut in flat facets of a given number, with the normals of the surface at their
// vertices: the models that Gouraud and Phong shade. Exact ones are cone.h's and the intersector's.
#pragma once

#include "geometry/cone.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Poles on the y axis; `sides` >= 3 meridians, the first toward +z, `stacks` >= 2 rings of facets: triangles at the
/// poles, quads elsewhere.
PolygonMesh faceted_sphere(const Vec3d& center, double radius, int sides, int stacks);

/// `sides` >= 3, `stacks` >= 1; quads, triangles at a tip, where each has the normal of its own middle. Vertices lie in
/// the same half planes about the axis as those of faceted_disc() with that axis, whichever way it points.
PolygonMesh faceted_cone(const Cone& cone, int sides, int stacks);

/// One polygon of `sides` >= 3 corners on the circle, facing `normal` (any length but zero).
PolygonMesh faceted_disc(const Vec3d& center, const Vec3d& normal, double radius, int sides);

}  // namespace raytree
