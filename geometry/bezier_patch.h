// Bicubic Bezier patches, polynomial and rational: points, derivatives and normals, in double. Bezier's form as
// Gouraud 1971, appendix B has it: P(u, v) = sum_ij A_ij F_i(u) F_j(v), F the cubic Bernstein polynomials.
#pragma once

#include <array>

#include "geometry/bezier_curve.h"
#include "geometry/patch_normal.h"
#include "geometry/vec.h"

namespace raytree {

/// The surface is right-handed: its outside is where P_u x P_v points.
struct BezierPatch {
  std::array<Vec3d, 16> points = points_at_origin<16>();  ///< [v][u]: points[4 j + i] goes with F_i(u) F_j(v)
  /// Positive, one a point; a rational patch where they differ. The homogeneous control points are (w P, w).
  std::array<double, 16> weights{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
};

/// The point and its derivatives, (u, v) in [0, 1]^2. Exact at the corners.
PatchDerivatives evaluate(const BezierPatch& patch, double u, double v);

/// The tangents' expansion along a line of the parameters.
TangentSeries tangent_series(const BezierPatch& patch, double u, double v, const Vec2d& toward);

/// The longest derivative that two neighboring control points stand for: 3 |P_i+1 - P_i| at most.
double derivative_scale(const BezierPatch& patch);

/// One side of the patch as a curve: 0: v = 0, 1: u = 1, 2: v = 1 backwards, 3: u = 0 backwards; once around.
BezierCurve side_curve(const BezierPatch& patch, int side);

/// The same surface with u and v exchanged: the other side is out.
BezierPatch transposed(const BezierPatch& patch);

}  // namespace raytree
