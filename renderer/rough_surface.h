// Rough surfaces by Whitted's perturbation (1980, sec. 2): a random facet takes the normal's place before R and P are
// formed. Which facet a ray meets, and the way through a thin rough sheet. How many there are and what they weigh is
// the ray tree's.
#pragma once

#include <cstdint>

#include "renderer/shading.h"

namespace raytree {

/// How a ray came about, as far as chance is concerned.
struct TreePath {
  std::uint32_t key = 0;       ///< of the sample's place and of the branches taken
  std::uint16_t index = 0;     ///< which of the samples of its first rough bounce it belongs to
  std::uint16_t is_split = 0;  ///< whether a rough bounce lies behind

  /// Of an eye ray: by the sample's place on a lattice finer than any samples' (2^-16 pixels).
  static TreePath of_eye(const Vec2f& position);
  TreePath child(bool refracted) const;
};

/// Points of the sequence that are tried for a facet before one is taken whose directions are mirrored back. A facet
/// that serves comes with a chance above 1/2, so this is rarer than 2^-16; but where an interpolated normal itself
/// reflects through its surface, it is the rule.
inline constexpr int kFacetDraws = 16;

/// As branches_between() takes it, where the surface separates its material's inside from empty space.
float plain_relative_index(const ShadingPoint& point);

/// Orthonormal directions across a unit vector.
struct TangentFrame {
  Vec3f tangent, bitangent;
};
TangentFrame tangent_frame(const Vec3f& normal);

/// Unit normal of the facet whose slopes along the frame are given: N - s_x T - s_y B.
Vec3f facet_normal(const Vec3f& normal, const TangentFrame& frame, const Vec2f& slopes);

/// Whether a ray can meet a facet and goes on from it on the right sides of the true surface: reflected above,
/// refracted below. `relative_index`: see dielectric_branches().
bool facet_serves(const ShadingPoint& point, const Vec3f& facet, float relative_index);

/// The children of sample `index` of `count` at a rough point. Both by one facet: slopes Gaussian of standard deviation
/// `roughness`. The first point of the key's sequence among index, index + count, index + 2 count... whose facet
/// serves. `relative_index`: as branches_between() takes it.
Branches rough_branches(const ShadingPoint& point, float relative_index, std::uint32_t key, std::uint32_t index,
                        std::uint32_t count);

/// Direction behind a thin rough sheet. To the first order in slopes a face of slope s changes the part of the
/// direction along the surface by (n cos t - cos i) s as the ray enters, and another face takes as much by its own
/// slope as it leaves: two independent faces make sqrt(2) (n cos t - cos i) sigma in both directions. The identity
/// where that would leave the unit sphere.
Vec3f thin_scattered(const Vec3f& direction, const Vec3f& normal, const TangentFrame& frame, const Vec2f& slopes,
                     float relative_index);

}  // namespace raytree
