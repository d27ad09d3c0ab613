// The polygons of the Standard Procedural Databases' gears, mountain, teapot and tetrahedra, Z up.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/polygon_mesh.h"

namespace raytree {

/// Collects polygons whose corners are their own.
class PolygonList {
 public:
  void add(std::span<const Vec3d> corners);
  std::shared_ptr<PolygonMesh> mesh() &&;

 private:
  std::shared_ptr<PolygonMesh> mesh_ = std::make_shared<PolygonMesh>();
};

inline constexpr int kSpdTeeth = 36;  ///< of a gear; four corners each

/// A gear about `center`, its top face, which points up; down to center.z - thickness. Each tooth takes from -0.19 to
/// 0.19 of its angle on the outer radius, and the gap from 0.3 to 0.7 on the inner one. Faces: top, 4 kSpdTeeth sides,
/// bottom, all outward.
std::shared_ptr<PolygonMesh> spd_gear(const Vec3d& center, double angle, double outer_radius, double inner_radius,
                                      double thickness);

/// 2 4^size triangles over [-1, 1]^2: Carpenter's midpoint displacement of squares, fractal dimension 2.2. Heights come
/// from a hash of the midpoint's place that seeds a polar Gaussian generator; the hash repeats itself, and is kept for
/// the published counts' sake.
std::shared_ptr<PolygonMesh> spd_mountain(int size);

/// Triangles of Bezier patches, size x size cells each, with normals; those with a side on the teapot's axis are left
/// out, and a corner on it has the normal +z above the middle, -z below.
std::shared_ptr<PolygonMesh> spd_patches(std::span<const BezierPatch> patches, int size);

/// The squares of a size x size board over [-4, 4]^2 at z = 0 whose indices have an odd or an even sum.
std::shared_ptr<PolygonMesh> spd_board(int size, bool odd);

/// 4^size triangles: a tetrahedron between opposite corners of the cube [-1, 1]^3 of four half as large, and so on.
std::shared_ptr<PolygonMesh> spd_tetrahedra(int size);

}  // namespace raytree
