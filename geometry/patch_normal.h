// Normals of parametric patches: P_u x P_v, and what stands in for it where it vanishes because an edge is a point or
// the two partials are parallel. Names the methods, so that they can be compared; the patches' own files apply them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "geometry/power_series.h"
#include "geometry/vec.h"

namespace raytree {

/// A point of a patch with its derivatives by the patch's parameters, both in [0, 1].
struct PatchDerivatives {
  Vec3d position, du, dv, duu, duv, dvv;
};

/// What is done where P_u x P_v vanishes.
enum class DegenerateNormal : std::uint8_t {
  none,         ///< nothing: the normal is (0, 0, 0)
  gouraud,      ///< Gouraud 1971, p. 27-28: the tangents of the two boundaries that end in the collapsed edge
  first_order,  ///< DU dNu + DV dNv toward the patch's inside, as OpenSubdiv has it
  limit         ///< the limit of the normals that lie inside
};

/// P_u x P_v counts as vanished up to this share of the square of the patch's derivative scale s. At N = tau s^2 the
/// direction of P_u x P_v is wrong by a few ulp over tau (2.2e-16 / tau), and that of what takes its place by how far
/// the parameter then lies from the singular one, about tau: they are equal at tau = 2^-26, 1.5e-8 rad.
inline constexpr double kVanishedNormal = 0x1p-26;

/// Gouraud's method asks which partial vanishes: one so much shorter than the other, half the digits of
/// kVanishedNormal. Where neither is, the two are parallel and he has no remedy.
inline constexpr double kVanishedPartial = 0x1p-13;

/// P_u and P_v along the line (u, v) + t toward, as series of t, each times any positive function of t.
struct TangentSeries {
  VectorOf<PowerSeries> du, dv;
};

/// The direction from (u, v) to the inside of the unit square: away from the nearer border in each parameter.
inline Vec2d inward(double u, double v) { return {u < 0.5 ? 1.0 : -1.0, v < 0.5 ? 1.0 : -1.0}; }

/// N = P_u x P_v by its first derivatives: d_u dNu + d_v dNv with dNu = P_uu x P_v + P_u x P_uv and
/// dNv = P_uv x P_v + P_u x P_vv. Not unit.
inline Vec3d first_order_normal(const PatchDerivatives& at, const Vec2d& toward) {
  return (at.duu.cross(at.dv) + at.du.cross(at.duv)) * toward.x +
         (at.duv.cross(at.dv) + at.du.cross(at.dvv)) * toward.y;
}

/// The first term of P_u x P_v along a line that has not vanished: the direction of the limit. `scale`: as
/// kVanishedNormal has it. (0, 0, 0) where none is left.
Vec3d leading_normal(const TangentSeries& tangents, double scale);

/// Gouraud's: tangents across the collapsed edge at both its ends, toward the edge's higher parameter: `at_low` and
/// `at_high`; `edge_along_u`: the edge is v = 0 or 1; `far_edge`: it is u = 1 or v = 1. Not unit.
Vec3d gouraud_normal(const Vec3d& at_low, const Vec3d& at_high, bool edge_along_u, bool far_edge);

/// Unit normal of a patch, (0, 0, 0) where the method finds none. `scale`: derivative_scale(patch). Patch: what has
/// evaluate(patch, u, v) and tangent_series(patch, u, v, toward).
template <class Patch>
Vec3d patch_normal(const Patch& patch, const PatchDerivatives& at, double u, double v, double scale,
                   DegenerateNormal method) {
  const double least = kVanishedNormal * scale * scale;
  const Vec3d cross = at.du.cross(at.dv);
  Vec3d normal = cross;
  if (!(cross.length() > least)) {
    normal = {0, 0, 0};
    if (method == DegenerateNormal::gouraud) {
      // Which partial vanishes says along which parameter the collapsed edge runs.
      const double u_length = at.du.length(), v_length = at.dv.length();
      const bool along_u = u_length < v_length;
      const bool far_edge = (along_u ? v : u) > 0.5;
      const double edge = far_edge ? 1 : 0;
      normal = along_u ? gouraud_normal(evaluate(patch, 0, edge).dv, evaluate(patch, 1, edge).dv, true, far_edge)
                       : gouraud_normal(evaluate(patch, edge, 0).du, evaluate(patch, edge, 1).du, false, far_edge);
      const bool collapsed = std::min(u_length, v_length) <= kVanishedPartial * std::max(u_length, v_length);
      if (!collapsed || !(normal.length() > least)) normal = {0, 0, 0};
    } else if (method == DegenerateNormal::first_order) {
      normal = first_order_normal(at, inward(u, v));
      if (!(normal.length() > least)) normal = {0, 0, 0};
    } else if (method == DegenerateNormal::limit) {
      normal = leading_normal(tangent_series(patch, u, v, inward(u, v)), scale);
    }
  }
  const double length = normal.length();
  return length > 0 ? normal / length : Vec3d(0, 0, 0);
}

}  // namespace raytree
