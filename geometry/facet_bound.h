// A bound on how far a flat facet lies from a bicubic polynomial, proved from control points: nothing is sampled.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "geometry/bezier_patch.h"
#include "geometry/facet_deviation.h"
#include "geometry/tessellation_view.h"

namespace raytree {

/// Bounds TessellationView::pixels() over the convex hull of 16 points of a surface's space, relative to
/// its `origin`: by the projections of the points and the least depth among them. Where the hull reaches behind the eye
/// and into the view there is no bound, and all are infinite.
class PixelBound {
 public:
  PixelBound(const TessellationView& view, const Vec3d& origin, const std::array<Vec3d, 16>& points);

  double of(const Vec3d& displacement) const;
  double of_any(double length) const;  ///< of a displacement so long in any direction

 private:
  const TessellationView& view_;
  double stretch_;                ///< of the way to the world, at most
  bool seen_ = false;             ///< by the rules of the frame, else at a distance alone
  double least_scale_ = 1;        ///< world units a pixel
  std::array<Vec2d, 16> slopes_;  ///< of the points as the eye sees them
  std::size_t slope_count_ = 0;
};

/// Bounds FacetDeviation::pixels over one facet of a bicubic polynomial.
///
/// Let f be the polynomial, x a place of the facet's parameters and l_i its barycentric coordinates. By Taylor's
/// theorem about x the facet's point of the same coordinates is off by e = sum l_i D_i / 2, D_i the second derivative
/// along x - v_i, somewhere between. sum l_i (u_i - u)^2 is the variance of numbers from an interval of length du, at
/// most du^2 / 4 (Popoviciu 1935), and the mixed sum is at most du dv / 4 (Cauchy and Schwarz). So for any direction n,
/// and any facet within a box of parameters of du x dv,
///   |n e| <= (A du^2 + 2 B du dv + C dv^2) / 8,
/// where A, B and C bound |n f_uu|, |n f_uv| and |n f_vv| over the box: Filip, Magedson and Markot 1986 have it for
/// right triangles. Second derivatives are polynomials too, so the control points of the box, differenced twice, bound
/// them. The way to the facet is e across the facet, and along it at most so much of e as SampledFacet counts. How many
/// pixels a displacement looks is bounded by the projections of the box's control points and the least depth among
/// them.
class FacetBound {
 public:
  /// `patch`: relative to `origin`, its weights all equal. `corners`: of the facet, parameters in [0, 1]^2.
  FacetBound(const BezierPatch& patch, const TessellationView& view, const Vec3d& origin,
             const std::array<Vec2f, 3>& corners);

  /// Of a facet with these corners, exact but for rounding; infinity where the view has no bound, as about the eye.
  double pixels(const SampledFacet& facet) const;

 private:
  std::array<Vec3d, 8> along_u_, along_v_;  ///< du^2 f_uu, dv^2 f_vv
  std::array<Vec3d, 9> mixed_;              ///< du dv f_uv
  std::optional<PixelBound> pixels_;        ///< over the box
};

}  // namespace raytree
