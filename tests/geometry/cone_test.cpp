// The cut-off cone: closed forms, and points of random rays put back into its equation.
#include "geometry/cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace raytree {
namespace {

double radius_at(const ConeFrame& cone, double height) { return cone.base_radius + cone.slope * height; }

TEST(Cone, ACylinderIsCrossedAtItsChord) {
  const ConeFrame cylinder(Cone{{0, 0, 0}, {0, 4, 0}, 2, 2});
  for (const double offset : {0.0, 0.5, 1.9, 1.999999}) {
    const ConeCrossings crossings = cone_crossings(cylinder, {-10, 1, offset}, {1, 0, 0});
    const double half_chord = std::sqrt(4 - offset * offset);
    EXPECT_NEAR(crossings.near, 10 - half_chord, 1e-12) << offset;
    EXPECT_NEAR(crossings.far, 10 + half_chord, 1e-12) << offset;
  }
  EXPECT_EQ(cone_crossings(cylinder, {-10, 1, 2.001}, {1, 0, 0}).near, std::numeric_limits<double>::infinity());
  EXPECT_EQ(cone_crossings(cylinder, {-10, 4.001, 0}, {1, 0, 0}).near, std::numeric_limits<double>::infinity());
}

TEST(Cone, AConeOfHalfARightAngleIsCrossedWhereItsHeightSays) {
  // Radius 1 - y: a level ray at height y through the axis meets it at distance 1 - y from the axis.
  const ConeFrame cone(Cone{{0, 0, 0}, {0, 1, 0}, 1, 0});
  const ConeCrossings crossings = cone_crossings(cone, {-5, 0.25, 0}, {1, 0, 0});
  EXPECT_NEAR(crossings.near, 5 - 0.75, 1e-14);
  EXPECT_NEAR(crossings.far, 5 + 0.75, 1e-14);
  const Vec3d normal = cone_normal(cone, {-0.75, 0.25, 0});
  EXPECT_NEAR(normal.x, -std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(normal.y, std::sqrt(0.5), 1e-14);
}

// Along a line of the surface's own slope the quadratic term vanishes, and one crossing is left.
TEST(Cone, ARayParallelToAGeneratorMeetsTheOtherSideOnce) {
  const ConeFrame cone(Cone{{0, 0, 0}, {0, 1, 0}, 1, 0});
  const Vec3d along = Vec3d(-1, 1, 0).normalized();  // the generator at +x
  const Vec3d start(0.0, -0.5, 0);
  const ConeCrossings crossings = cone_crossings(cone, start, along);
  ASSERT_TRUE(std::isfinite(crossings.near));
  const Vec3d point = start + along * crossings.near;
  EXPECT_NEAR(std::abs(point.x), 1 - point.y, 1e-12);
  EXPECT_FALSE(std::isfinite(crossings.far));
}

TEST(Cone, CrossingsLieOnTheSurfaceHoweverFarTheEye) {
  std::mt19937 random(1980);
  std::uniform_real_distribution<double> unit(-1, 1), positive(0.05, 2);
  int crossed = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto vector = [&] { return Vec3d(unit(random), unit(random), unit(random)); };
    const Cone cone{vector() * 3, vector() * 3, i % 5 == 0 ? 0 : positive(random), positive(random)};
    const ConeFrame frame(cone);
    const double size = frame.length + cone.base_radius + cone.apex_radius;
    const double away = std::pow(10.0, (i % 7) - 1);
    const Vec3d target = cone.base + frame.axis * (frame.length * 0.5 * (1 + unit(random)));
    const Vec3d direction = vector().normalized();
    const Vec3d origin = target - direction * away;
    const ConeCrossings crossings = cone_crossings(frame, origin, direction);
    const Bounds3d box = bounds(cone);
    for (const double t : {crossings.near, crossings.far}) {
      if (!std::isfinite(t)) continue;
      ++crossed;
      const Vec3d point = origin + direction * t, from_base = point - cone.base;
      const double height = from_base.dot(frame.axis);
      const double distance = (from_base - frame.axis * height).length();
      // Two roundings of the eye's distance, and the square root of one where the ray grazes.
      const double tolerance = 16 * (away + size) * 0x1p-53 + size * 4e-8;
      EXPECT_NEAR(distance, radius_at(frame, height), tolerance);
      EXPECT_GE(height, -tolerance);
      EXPECT_LE(height, frame.length + tolerance);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(point[axis], box.min[axis] - tolerance);
        EXPECT_LE(point[axis], box.max[axis] + tolerance);
      }
      // The normal is across the generator through the point and across the circle.
      const Vec3d normal = cone_normal(frame, point);
      EXPECT_NEAR(normal.length(), 1, 1e-14);
      if (distance > 1e-3) {
        const Vec3d out = (from_base - frame.axis * height) * (1 / distance);
        EXPECT_NEAR(normal.dot(frame.axis + out * frame.slope), 0, 1e-12);
        EXPECT_GT(normal.dot(out), 0);
      }
    }
    // The line crosses the axis within the cone, so it crosses the surface, unless it leaves by the open ends.
    if (crossings.near < crossings.far && std::isfinite(crossings.far)) {
      EXPECT_LE(crossings.near, away + size);
    }
  }
  EXPECT_GT(crossed, 20000);
}

}  // namespace
}  // namespace raytree
