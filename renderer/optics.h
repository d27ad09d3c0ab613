// Directions and weights of the reflected and the refracted ray: Whitted 1980, sec. 2, and Fresnel's equations.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/surface.h"
#include "geometry/vec.h"

namespace raytree {

/// Mirror direction of `direction` (unit, V of Whitted 1980, toward the surface) about unit `normal` with V.N < 0.
/// Whitted's R = V' + 2 N, V' = V / |V.N|, made unit.
template <class Vec>
Vec reflected_direction(const Vec& direction, const Vec& normal) {
  return renormalized(direction - normal * (2 * direction.dot(normal)));
}

/// Square of what refracted_cosine() yields; not above 0 at total internal reflection.
template <class Real>
Real refracted_cosine_square(Real cos_i, Real eta) {
  return 1 - eta * eta * std::max(Real(0), 1 - cos_i * cos_i);
}

/// Cosine of the angle of refraction, by Snell's law sin t = eta sin i; none at total internal reflection. `eta`: 1 /
/// k_n, the index of the side that the ray comes from over that of the side it enters. cos_i in [0, 1].
template <class Real>
std::optional<Real> refracted_cosine(Real cos_i, Real eta) {
  const Real square = refracted_cosine_square(cos_i, eta);
  if (!(square > 0)) return std::nullopt;
  return std::sqrt(square);
}

/// Refracted direction, unit, of a ray whose cosines are known. Equals Whitted's P = k_f (N + V') - N made unit,
/// without his division by V.N, which overflows at grazing incidence (tests/renderer/optics_test.cpp holds one to the
/// other).
template <class Vec>
Vec refracted_direction(const Vec& direction, const Vec& normal, typename Vec::BaseType eta,
                        typename Vec::BaseType cos_i, typename Vec::BaseType cos_t) {
  return renormalized(direction * eta + normal * (eta * cos_i - cos_t));
}

/// The same from the directions alone; none at total internal reflection.
template <class Vec>
std::optional<Vec> refracted_direction(const Vec& direction, const Vec& normal, typename Vec::BaseType eta) {
  const auto cos_i = -direction.dot(normal);
  if (const auto cos_t = refracted_cosine(cos_i, eta))
    return refracted_direction(direction, normal, eta, cos_i, *cos_t);
  return std::nullopt;
}

/// Share of unpolarized light that a dielectric surface reflects, both cosines known: the mean of R_s and R_p.
/// R_s = ((c_i - k c_t) / (c_i + k c_t))^2, R_p = ((k c_i - c_t) / (k c_i + c_t))^2, k = relative_index = 1 / eta.
template <class Real>
Real fresnel_reflectance(Real cos_i, Real cos_t, Real relative_index) {
  const Real s_sum = cos_i + relative_index * cos_t, p_sum = relative_index * cos_i + cos_t;
  // One division serves both. Grazing along a surface of index 1 makes both sums 0: all is reflected.
  const Real product = s_sum * p_sum;
  const Real inverse = 1 / product;
  const Real s = (cos_i - relative_index * cos_t) * p_sum * inverse;
  const Real p = (relative_index * cos_i - cos_t) * s_sum * inverse;
  return product > 0 ? (s * s + p * p) / 2 : Real(1);
}

/// The same from cos_i in [0, 1]; 1 at total internal reflection.
template <class Real>
Real fresnel_reflectance(Real cos_i, Real relative_index) {
  const auto cos_t = refracted_cosine(cos_i, 1 / relative_index);
  return cos_t ? fresnel_reflectance(cos_i, *cos_t, relative_index) : Real(1);
}

/// A direction that must stay on `side`'s side of the surface (unit geometric normal): one that an interpolated normal
/// sent to the other side is mirrored back. Continuous: at the surface's plane both agree.
inline Vec3f kept_on_side(const Vec3f& direction, const Vec3f& side) {
  const float height = direction.dot(side);
  return direction - side * (height >= 0 ? 0.0f : 2 * height);
}

}  // namespace raytree
