// Directions and Fresnel weights against Whitted's R, P and k_f (1980, sec. 2) and the numbers of optics books.
#include "renderer/optics.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "geometry/angle.h"
#include "geometry/surface.h"
#include "renderer/shading.h"

namespace raytree {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Vec3d random_unit(std::mt19937_64& random) {
  std::normal_distribution<double> gauss;
  const Vec3d v(gauss(random), gauss(random), gauss(random));
  return unit(v);
}

/// Whitted 1980, sec. 2, as printed: V' = V / |V.N|, R = V' + 2 N, P = k_f (N + V') - N.
struct Whitted {
  Vec3d reflected, refracted;
  double k_f_to_minus_2;
  Whitted(const Vec3d& v, const Vec3d& n, double k_n) {
    const Vec3d scaled = v / std::abs(v.dot(n));
    reflected = unit(scaled + n * 2);
    k_f_to_minus_2 = k_n * k_n * scaled.dot(scaled) - (scaled + n).dot(scaled + n);
    if (k_f_to_minus_2 > 0) refracted = unit((n + scaled) * (1 / std::sqrt(k_f_to_minus_2)) - n);
  }
};

TEST(Optics, EqualWhittedsDirections) {
  std::mt19937_64 random(1980);
  std::uniform_real_distribution<double> log_index(std::log(0.4), std::log(2.5));
  int refracted = 0, total = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3d n = random_unit(random);
    Vec3d v = random_unit(random);
    if (v.dot(n) > 0) v = -v;
    const double k_n = std::exp(log_index(random));
    const double cos_i = -v.dot(n), sin_squared = 1 - cos_i * cos_i;
    const Whitted whitted(v, n, k_n);
    // V' is as long as R, so dividing by |V.N| costs no digits: each step rounds once or twice.
    EXPECT_LE((reflected_direction(v, n) - whitted.reflected).length(), 16 * kEpsilon);
    // k_f^-2 cos^2 i = k_n^2 - sin^2 i is a difference of numbers of up to k_n^2 + 1: its relative error is
    // amplified by their quotient, and V.N itself is rounded before it is divided by.
    const double room = k_n * k_n - sin_squared;
    const double tolerance = 16 * kEpsilon * (1 + (1 + k_n * k_n) / std::abs(room)) / std::min(1.0, cos_i * 4);
    if (std::abs(room) < 1e-9) continue;
    const auto ours = refracted_direction(v, n, 1 / k_n);
    ASSERT_EQ(ours.has_value(), room > 0);
    if (!ours) {
      EXPECT_LT(whitted.k_f_to_minus_2, 0);
      ++total;
      continue;
    }
    ++refracted;
    EXPECT_LE((*ours - whitted.refracted).length(), tolerance);
    EXPECT_NEAR(ours->length(), 1, 8 * kEpsilon);
    // Snell: sin t = sin i / k_n; and tan t = k_f tan i.
    const double sin_t = ours->cross(n).length(), cos_t = -ours->dot(n);
    EXPECT_NEAR(sin_t, std::sqrt(sin_squared) / k_n, 1e-7);  // sqrt of 1 - cos^2 loses half the digits near 0
    EXPECT_NEAR(sin_t, v.cross(n).length() / k_n, tolerance);
    if (cos_t > 1e-3 && cos_i > 1e-3) {
      EXPECT_NEAR(sin_t / cos_t / (v.cross(n).length() / cos_i) * std::sqrt(whitted.k_f_to_minus_2), 1, 1e-7);
    }
  }
  EXPECT_GT(refracted, 50000);
  EXPECT_GT(total, 10000);
}

TEST(Optics, FloatDirectionsKeepTheirDigits) {
  std::mt19937_64 random(7);
  const double unit_roundoff = 0x1p-24;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f n(random_unit(random));
    Vec3f v(random_unit(random));
    if (v.dot(n) > 0) v = -v;
    const double eta = i % 2 == 0 ? 1.5f : 1 / 1.5f;
    const Vec3d nd = unit(Vec3d(n)), vd = unit(Vec3d(v));
    EXPECT_LE((Vec3d(reflected_direction(v, n)) - reflected_direction(vd, nd)).length(), 12 * unit_roundoff);
    const auto exact = refracted_direction(vd, nd, eta);
    const auto ours = refracted_direction(v, n, static_cast<float>(eta));
    if (!exact || !ours) continue;
    // cos t = sqrt(1 - sin^2 t): an error of a few roundings under the root is divided by cos t.
    const double cos_t = -exact->dot(nd);
    if (cos_t > 1e-2) {
      EXPECT_LE((Vec3d(*ours) - *exact).length(), 8 * unit_roundoff * (1 + eta + (1 + eta * eta) / cos_t));
    }
  }
}

TEST(Optics, TotalInternalReflectionBeginsAtTheCriticalAngle) {
  const Vec3d n(0, 1, 0);
  const auto at = [&](double degrees) {
    return refracted_direction(Vec3d(std::sin(degrees * kDegree), -std::cos(degrees * kDegree), 0), n, 1.5);
  };
  EXPECT_TRUE(at(41.8102).has_value());
  EXPECT_FALSE(at(41.8104).has_value());
  EXPECT_FALSE(at(89.999).has_value());
  EXPECT_NEAR(std::asin(1 / 1.5) / kDegree, 41.8103, 5e-5);
}

TEST(Optics, FresnelMatchesTheTextbook) {
  // n = 1.5: ((n - 1) / (n + 1))^2 = .04 at normal incidence, from either side.
  EXPECT_NEAR(fresnel_reflectance(1.0, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_reflectance(1.0, 1 / 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_reflectance(1.0f, 1.5f), 0.04f, 1e-7f);
  // At Brewster's angle, atan 1.5 = 56.3099 degrees, R_p = 0, and R_s = ((n^2 - 1) / (n^2 + 1))^2.
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(brewster / kDegree, 56.3099, 5e-5);
  const double s = (1.5 * 1.5 - 1) / (1.5 * 1.5 + 1);
  EXPECT_NEAR(fresnel_reflectance(std::cos(brewster), 1.5), s * s / 2, 1e-15);
  EXPECT_EQ(fresnel_reflectance(0.0, 1.5), 1);
  EXPECT_EQ(fresnel_reflectance(0.0f, 1.5f), 1);
  // Inside glass: 1 from the critical angle on, less before.
  EXPECT_EQ(fresnel_reflectance(std::cos(41.8104 * kDegree), 1 / 1.5), 1);
  EXPECT_LT(fresnel_reflectance(std::cos(41.8102 * kDegree), 1 / 1.5), 1);
  // No surface at all.
  EXPECT_NEAR(fresnel_reflectance(0.3, 1.0), 0, 1e-30);
}

TEST(Optics, FresnelIsAShareAndTheSameBothWays) {
  for (const double index : {1.0001, 1.33, 1.5, 2.4, 10.0})
    for (int i = 0; i <= 900; ++i) {
      const double angle = i * 0.1 * kDegree, c = std::max(0.0, std::cos(angle));
      const double r = fresnel_reflectance(c, index);
      EXPECT_GE(r, 0);
      EXPECT_LE(r, 1);
      const float rounded = fresnel_reflectance(static_cast<float>(c), static_cast<float>(1 / index));
      EXPECT_GE(rounded, 0);
      EXPECT_LE(rounded, 1);
      // Stokes: the same share on the way in at i and on the way out at t. The way back rounds sin t near 90 degrees.
      if (i > 890) continue;
      const double cos_t = std::sqrt(1 - (1 - c * c) / (index * index));
      EXPECT_NEAR(fresnel_reflectance(cos_t, 1 / index), r, 1e-9) << index << " " << angle / kDegree;
    }
}

TEST(Optics, GrazingIncidenceIsFinite) {
  // Whitted's V / |V.N| has no value here.
  const Vec3f n(0, 1, 0), v(1, 0, 0);
  const Vec3f r = reflected_direction(v, n);
  EXPECT_EQ(r, v);
  const auto p = refracted_direction(v, n, 1 / 1.5f);
  ASSERT_TRUE(p.has_value());
  EXPECT_NEAR(p->x, 1 / 1.5f, 1e-6f);
  EXPECT_FALSE(refracted_direction(v, n, 1.5f).has_value());
  // At index 1 nothing bends, and a ray in the surface stays in it or is lost, but is never NaN.
  if (const auto straight = refracted_direction(v, n, 1.0f)) {
    EXPECT_EQ(*straight, v);
  }
}

TEST(Optics, KeptOnSideMirrorsAcrossTheSurface) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f side(random_unit(random)), direction(random_unit(random));
    const Vec3f kept = kept_on_side(direction, side);
    // Mirroring rounds a few times: what lay at height -h comes to h give or take that.
    EXPECT_GE(kept.dot(side), -4 * 0x1p-24f);
    EXPECT_NEAR(kept.dot(side), std::abs(direction.dot(side)), 8 * 0x1p-24f);
    EXPECT_NEAR(kept.length(), 1, 8 * 0x1p-24f);
    if (direction.dot(side) >= 0) {
      EXPECT_EQ(kept, direction);
    }
    EXPECT_LE((kept.cross(side) - direction.cross(side)).length(), 8 * 0x1p-24f);
  }
}

ShadingPoint glass_point(const Material& material, const Vec3f& direction, bool leaving) {
  ShadingPoint point{};
  point.surface.geometric_normal = point.surface.shading_normal = Vec3f(0, 1, 0);
  point.direction = direction;
  point.material = &material;
  point.leaving = leaving;
  return point;
}

TEST(Branches, ClassicWeightsAreConstantAndVanishAtTotalInternalReflection) {
  Material glass;
  glass.reflection = Rgb(0.1f, 0.2f, 0.3f);
  glass.transmission = Rgb(0.9f, 0.8f, 0.7f);
  glass.has_reflection = glass.has_transmission = true;
  glass.index = 1.5f;
  glass.inverse_index = 1 / 1.5f;
  for (const double degrees : {0.0, 20.0, 41.81, 41.811, 60.0, 89.0}) {
    const double angle = degrees * kDegree;
    const Vec3f direction(static_cast<float>(std::sin(angle)), static_cast<float>(-std::cos(angle)), 0);
    const Branches entering = branches(glass_point(glass, direction, false));
    EXPECT_EQ(entering.reflected_weight, glass.reflection);
    EXPECT_EQ(entering.refracted_weight, glass.transmission);
    const Branches leaving = branches(glass_point(glass, direction, true));
    EXPECT_EQ(leaving.reflected_weight, glass.reflection);
    EXPECT_EQ(leaving.refracted_weight, degrees < 41.8103 ? glass.transmission : Rgb(0));
  }
}

TEST(Branches, FresnelSharesLightBetweenTheTwoAndTotalReflectionKeepsAll) {
  Material glass;
  glass.reflection = Rgb(0.5f);
  glass.transmission = Rgb(0.25f);
  glass.has_reflection = glass.has_transmission = glass.fresnel = true;
  glass.index = 1.5f;
  glass.inverse_index = 1 / 1.5f;
  const Branches normal = branches(glass_point(glass, {0, -1, 0}, false));
  EXPECT_NEAR(normal.reflected_weight.g, 0.5f * 0.04f, 1e-7f);
  EXPECT_NEAR(normal.refracted_weight.g, 0.25f * 0.96f, 1e-7f);
  const float a = static_cast<float>(60 * kDegree);
  const Branches total = branches(glass_point(glass, {std::sin(a), -std::cos(a), 0}, true));
  EXPECT_EQ(total.reflected_weight, Rgb(0.5f));
  EXPECT_EQ(total.refracted_weight, Rgb(0));
}

TEST(Branches, InterpolatedNormalsNeverSendARayThroughTheFacet) {
  std::mt19937_64 random(17);
  Material glass;
  glass.reflection = glass.transmission = Rgb(0.5f);
  glass.has_reflection = glass.has_transmission = true;
  for (int i = 0; i < 20000; ++i) {
    glass.index = i % 3 == 0 ? 1.5f : 1.1f;
    glass.inverse_index = 1 / glass.index;
    const Vec3f facet(random_unit(random));
    Vec3f direction(random_unit(random));
    ShadingPoint point = glass_point(glass, direction, i % 2 == 0);
    point.surface.geometric_normal = direction.dot(facet) > 0 ? -facet : facet;
    const Vec3d lean = random_unit(random) * 0.9;
    point.surface.shading_normal = Vec3f(unit(Vec3d(point.surface.geometric_normal) + lean));
    const Branches children = branches(point);
    const Vec3f& side = point.surface.geometric_normal;
    EXPECT_GE(children.reflected.dot(side), -4 * 0x1p-24f);
    if (!is_black(children.refracted_weight)) {
      EXPECT_LE(children.refracted.dot(side), 4 * 0x1p-24f);
      EXPECT_NEAR(children.refracted.length(), 1, 1e-6);
    }
    EXPECT_NEAR(children.reflected.length(), 1, 1e-6);
  }
}

}  // namespace
}  // namespace raytree
