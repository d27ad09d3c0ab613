// Bilinearly blended Coons patches over four cubic Bezier curves, rational ones too: points, derivatives and normals,
// in double. The ruled surfaces over both pairs of opposite curves, added, less the bilinear patch of the corners.
#pragma once

#include <optional>

#include "geometry/bezier_patch.h"

namespace raytree {

/// The curves must meet in the corners exactly. The surface's outside is where P_u x P_v points. Where all weights are
/// equal it is a bicubic Bezier patch, whose inner points it makes of the outer ones.
/// A departure from Gouraud 1971: the points of rational curves are blended, not their homogeneous coordinates, so that
/// the curves are met whatever their weights in the corners.
struct CoonsPatch {
  BezierCurve bottom, top;  ///< v = 0 and v = 1, along u
  BezierCurve left, right;  ///< u = 0 and u = 1, along v
};

/// The point and its derivatives, (u, v) in [0, 1]^2.
PatchDerivatives evaluate(const CoonsPatch& patch, double u, double v);

/// The tangents' expansion along a line of the parameters.
TangentSeries tangent_series(const CoonsPatch& patch, double u, double v, const Vec2d& toward);

/// The longest derivative that two neighboring control points stand for.
double derivative_scale(const CoonsPatch& patch);

/// As that of BezierPatch.
BezierCurve side_curve(const CoonsPatch& patch, int side);

CoonsPatch transposed(const CoonsPatch& patch);

/// The same surface as a Bezier patch, which it is where all weights of all curves are equal.
std::optional<BezierPatch> as_bezier_patch(const CoonsPatch& patch);

}  // namespace raytree
