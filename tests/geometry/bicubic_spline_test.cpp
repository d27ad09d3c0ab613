// Uniform bicubic B-splines by their polynomials, and at each set of sides where the surface ends.
#include "geometry/bicubic_spline.h"

#include <gtest/gtest.h>

namespace raytree {
namespace {

TEST(BicubicSpline, WeightsAreThoseOfTheBasisAndItsDerivatives) {
  for (const float t : {0.0f, 0.25f, 0.6f, 1.0f}) {
    const CubicWeights w(t);
    // Marsden's identity: control points x = -1, 0, 1, 2 give t; their squares t^2 + 1/3.
    float one = 0, x = 0, square = 0, slope = 0, slope_of_square = 0, second_of_square = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const float at = static_cast<float>(i) - 1;
      one += w.value[i], x += at * w.value[i], square += at * at * w.value[i];
      slope += at * w.first[i], slope_of_square += at * at * w.first[i], second_of_square += at * at * w.second[i];
    }
    EXPECT_NEAR(one, 1, 1e-6f);
    EXPECT_NEAR(x, t, 1e-6f);
    EXPECT_NEAR(square, t * t + 1.0f / 3, 1e-6f);
    EXPECT_NEAR(slope, 1, 1e-6f);
    EXPECT_NEAR(slope_of_square, 2 * t, 1e-6f);
    EXPECT_NEAR(second_of_square, 2, 1e-6f);
  }
}

TEST(BicubicSpline, EndsAtItsBoundaryWithoutCurvatureAcross) {
  for (std::uint8_t sides = 0; sides < kSideSets; ++sides) {
    SCOPED_TRACE(int(sides));
    BicubicControl control{};
    for (std::size_t i = 0; i < 64; ++i) control[i] = static_cast<float>((i * i * 5 + 3 * i) % 17);
    const BicubicControl before = control;
    end_at_sides(control, sides);
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column) {
        const bool beyond = (row == 0 && (sides & kBottomSide)) || (row == 3 && (sides & kTopSide)) ||
                            (column == 0 && (sides & kLeftSide)) || (column == 3 && (sides & kRightSide));
        if (!beyond) {
          EXPECT_EQ(control[16 * row + 4 * column], before[16 * row + 4 * column]);
        }
      }
    for (const float t : {0.0f, 0.3f, 1.0f}) {
      const CubicWeights along(t), start(0), end(1);
      const auto curvature = [&](const std::array<float, 4>& u, const std::array<float, 4>& v) {
        return weighted_sum(control, u, v)[1];
      };
      if (sides & kBottomSide) {
        EXPECT_NEAR(curvature(along.value, start.second), 0, 1e-4f);
      }
      if (sides & kTopSide) {
        EXPECT_NEAR(curvature(along.value, end.second), 0, 1e-4f);
      }
      if (sides & kLeftSide) {
        EXPECT_NEAR(curvature(start.second, along.value), 0, 1e-4f);
      }
      if (sides & kRightSide) {
        EXPECT_NEAR(curvature(end.second, along.value), 0, 1e-4f);
      }
    }
  }
}

}  // namespace
}  // namespace raytree
