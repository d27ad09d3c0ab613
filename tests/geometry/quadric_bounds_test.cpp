// Bounding spheres of cones and of instances: no point lies outside, and they are as small as is said.
#include "geometry/quadric_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/random.h"

namespace raytree {
namespace {

using test::Random;

Cone random_cone(Random& random, int i) {
  const double length = std::exp(random.uniform(-3, 3)), radius = std::exp(random.uniform(-3, 3));
  const Vec3d base = random.in_cube(10);
  const double other = i % 3 == 0 ? 0 : i % 3 == 1 ? radius : std::exp(random.uniform(-3, 3));
  const Cone cone{base, base + random.direction() * length, radius, other};
  return i % 2 == 0 ? cone : Cone{cone.apex, cone.base, cone.apex_radius, cone.base_radius};
}

/// A point of a cone's surface, at a share of the way from base to apex.
Vec3d point_of_cone(const Cone& cone, double share, const Vec3d& across) {
  return cone.base * (1 - share) + cone.apex * share +
         across * (cone.base_radius * (1 - share) + cone.apex_radius * share);
}

double farthest_of(const Cone& cone, const Vec3d& from, Random& random) {
  const Vec3d axis = (cone.apex - cone.base).normalized();
  double farthest = 0;
  for (int k = 0; k < 60; ++k) {
    const Vec3d across = axis.cross(random.direction()).normalized();
    const double share = k < 20 ? 0 : k < 40 ? 1 : random.uniform(0, 1);
    farthest = std::max(farthest, (point_of_cone(cone, share, across) - from).length());
  }
  return farthest;
}

TEST(QuadricBounds, TheSphereAboutAConeIsTheSmallest) {
  Random random(1);
  int touching_both = 0;
  for (int i = 0; i < 3000; ++i) {
    const Cone cone = random_cone(random, i);
    const BoundingSphere sphere = sphere_about(cone);
    ASSERT_LE(farthest_of(cone, sphere.center, random), sphere.radius) << i;
    // It touches a rim, and moved either way along the axis it would have to be wider.
    const double slack = 1e-12 * (sphere.radius + cone.base.length() + cone.apex.length());
    EXPECT_GE(farthest_of(cone, sphere.center, random), sphere.radius - slack) << i;
    const Vec3d axis = (cone.apex - cone.base).normalized();
    for (const double step : {-0.01, 0.01})
      EXPECT_GT(farthest_of(cone, sphere.center + axis * (step * sphere.radius), random), sphere.radius) << i;
    touching_both += sphere.center != cone.base && sphere.center != cone.apex;
  }
  EXPECT_GT(touching_both, 1000);
  EXPECT_LT(touching_both, 2900) << "no rim was an equator";
}

/// Stretched, sheared, turned and mirrored; as singular as instances may be.
Instance random_affine(Random& random, int i) {
  Instance instance{};
  for (;;) {
    const double size = std::exp(random.uniform(-5, 5));
    for (int row = 0; row < 3; ++row) {
      const Vec3d axis = random.in_cube(1) * (size * std::exp(random.uniform(-3, 0)));
      for (int column = 0; column < 3; ++column) instance.to_scene[row][column] = static_cast<float>(axis[column]);
    }
    if (i % 4 == 0)  // two axes alike but for little: far from right angles
      for (int column = 0; column < 3; ++column)
        instance.to_scene[1][column] = instance.to_scene[0][column] + 0.01f * instance.to_scene[1][column];
    for (int column = 0; column < 3; ++column)
      instance.to_scene[3][column] = static_cast<float>(random.uniform(-1, 1) * std::exp(random.uniform(-3, 8)));
    if (InstanceTransform(instance).cancellation() < kMostCancellation) return instance;
  }
}

/// The direction that the transform stretches most, by powers of M M^T.
Vec3d most_stretched(const InstanceTransform& transform, Random& random) {
  const auto transposed = [&](const Vec3d& v) {
    return Vec3d(transform.vector({1, 0, 0}).dot(v), transform.vector({0, 1, 0}).dot(v),
                 transform.vector({0, 0, 1}).dot(v));
  };
  Vec3d v = random.direction();
  for (int i = 0; i < 4000; ++i) v = transposed(transform.vector(v)).normalized();
  return v;
}

TEST(QuadricBounds, NoPointOfATransformedQuadricLiesOutside) {
  Random random(2);
  double loosest = 1;
  for (int i = 0; i < 600; ++i) {
    const Instance instance = random_affine(random, i);
    const InstanceTransform transform(instance);
    const auto expect_inside = [&](const BoundingSphere& about, const Vec3d& point, const char* kind) {
      EXPECT_LE((transform.point(point) - about.center).length(), about.radius) << kind << " " << i;
    };
    // A sphere, and the disc that it is the equator of.
    const BoundingSphere ball{random.in_cube(10), std::exp(random.uniform(-4, 4))};
    const BoundingSphere about_ball = sphere_about(transform, ball);
    const Vec3d normal = random.direction(), longest = most_stretched(transform, random);
    for (int k = 0; k < 50; ++k) {
      expect_inside(about_ball, ball.center + random.direction() * ball.radius, "sphere");
      expect_inside(about_ball, ball.center + normal.cross(random.direction()).normalized() * ball.radius, "disc");
    }
    expect_inside(about_ball, ball.center + longest * ball.radius, "end of the ellipsoid's longest axis");
    const double reach = transform.vector(longest).length(), slack = 0x1p-33 * about_ball.center.length();
    loosest = std::max(loosest, (about_ball.radius - slack) / (reach * ball.radius));
    // Cones, cylinders and cones with a tip.
    const Cone cone = random_cone(random, i);
    const BoundingSphere about_cone = sphere_about(transform, sphere_about(cone));
    const Vec3d axis = (cone.apex - cone.base).normalized();
    for (int k = 0; k < 100; ++k) {
      const Vec3d across = axis.cross(k % 2 == 0 ? longest : random.direction()).normalized();
      for (const Vec3d& way : {across, axis.cross(across)})
        for (const double share : {0.0, 1.0, random.uniform(0, 1)})
          for (const double side : {-1.0, 1.0})
            expect_inside(about_cone, point_of_cone(cone, share, way * side), "cone");
    }
  }
  EXPECT_LT(loosest, 1 + 1e-6) << "wider than the ellipsoid needs";
}

/// A matrix whose two largest singular values are one: where the closed form loses most digits.
TEST(QuadricBounds, StretchOfAnOblateTransformIsNoLess) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d x = random.direction(), y = x.cross(random.direction()).normalized(), z = x.cross(y);
    const double flat = std::exp(random.uniform(-10, 0));
    // (1 - n n^T) + flat n n^T, n in no axis' way: symmetric, singular values 1, 1 and flat.
    Instance instance{};
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        instance.to_scene[row][column] =
            static_cast<float>(x[row] * x[column] + y[row] * y[column] + flat * z[row] * z[column]);
    const InstanceTransform transform(instance);
    for (int k = 0; k < 20; ++k) {
      const double turn = random.uniform(0, 6.3);
      EXPECT_LE(transform.vector(x * std::cos(turn) + y * std::sin(turn)).length(), transform.stretch());
    }
    EXPECT_LT(transform.stretch(), 1 + 1e-6);
  }
}

}  // namespace
}  // namespace raytree
