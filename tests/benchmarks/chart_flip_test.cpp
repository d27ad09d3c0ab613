// FLIP against what its description fixes: distances of colors that are known, and properties.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/chart/flip.h"

namespace raytree::benchmarks {
namespace {

constexpr int kEdge = 32;

template <class Color>
std::vector<float> painted(Color&& color) {
  std::vector<float> srgb;
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x)
      for (const float value : color(x, y)) srgb.push_back(value);
  return srgb;
}

FlipPicture uniform(float r, float g, float b) {
  return flip_picture(kEdge, kEdge, painted([&](int, int) { return std::array{r, g, b}; }));
}

/// Squares of two grays by turns, `size` pixels wide.
FlipPicture checkered(int size, float dark, float light, double per_degree = kFlipPixelsPerDegree) {
  return flip_picture(kEdge, kEdge, painted([&](int x, int y) {
                        const float gray = (x / size + y / size) % 2 == 0 ? dark : light;
                        return std::array{gray, gray, gray};
                      }),
                      per_degree);
}

TEST(Flip, EqualPicturesDoNotDiffer) { EXPECT_EQ(flip_mean(checkered(3, 0.2f, 0.8f), checkered(3, 0.2f, 0.8f)), 0); }

// CIELAB of the primaries of sRGB under D65, as color tables have them: green (87.737, -86.185, 83.181), blue (32.303,
// 79.197, -107.864). With Hunt's factor L / 100 their HyAB is 55.434 + |(-101.199, 107.823)| = 203.31, to the power .7
// 41.276: the distance that is 1 by definition.
TEST(Flip, GreenAndBlueAreFarthestApart) { EXPECT_NEAR(flip_mean(uniform(0, 1, 0), uniform(0, 0, 1)), 1, 1e-5); }

// Black and white are 100 apart: 100^.7 = 25.119 lies above the knee .4 x 41.276, so .95 + .05 (25.119 - 16.510) /
// (41.276 - 16.510).
TEST(Flip, BlackAndWhiteFollowTheFormula) {
  EXPECT_NEAR(flip_mean(uniform(0, 0, 0), uniform(1, 1, 1)), 0.96738, 2e-5);
  EXPECT_NEAR(flip_mean(uniform(1, 1, 1), uniform(0, 0, 0)), 0.96738, 2e-5);
}

// L = 903.3 Y below Y = .008856, so sRGB codes 1/255 and 2/255 (Y = code / 12.92) are .27418 apart: below the knee,
// .27418^.7 x .95 / 16.510.
TEST(Flip, SmallDifferencesFollowTheFormula) {
  const float step = 1.0f / 255;
  const double expected = std::pow(903.2963 / 12.92 / 255, 0.7) * 0.95 / 16.5104;
  EXPECT_NEAR(flip_mean(uniform(step, step, step), uniform(2 * step, 2 * step, 2 * step)), expected, 1e-4);
}

// Detectors see a line of one pixel that filters nearly wash out: its error is above what its color alone has.
TEST(Flip, AMissingLineIsSeen) {
  const auto with_line = flip_picture(kEdge, kEdge, painted([](int x, int) {
                                        const float gray = x == kEdge / 2 ? 0.6f : 0.5f;
                                        return std::array{gray, gray, gray};
                                      }));
  const std::vector<float> map = flip_map(with_line, uniform(0.5f, 0.5f, 0.5f));
  const FlipPicture shaded = uniform(0.5f, 0.5f, 0.5f);
  FlipPicture blind = with_line;
  blind.edges = shaded.edges;
  blind.points = shaded.points;
  const std::vector<float> color_alone = flip_map(blind, shaded);
  const std::size_t on_line = std::size_t{kEdge} * (kEdge / 2) + kEdge / 2;
  EXPECT_GT(map[on_line], 1.2f * color_alone[on_line]);
  EXPECT_LT(map[on_line - 14], 0.01f) << "14 pixels away nothing is seen of it";
}

TEST(Flip, FineDetailCountsForLessThanCoarse) {
  const auto against_mean = [](double per_degree) {
    // The gray of the same mean light as black and white by turns.
    const float mean = 0.7353569f;
    return flip_mean(checkered(1, 0, 1, per_degree), flip_picture(kEdge, kEdge, painted([&](int, int) {
                                                                    return std::array{mean, mean, mean};
                                                                  }),
                                                                  per_degree));
  };
  EXPECT_LT(against_mean(120), 0.8 * against_mean(10));
}

TEST(Flip, IsSymmetricAndWithinZeroAndOne) {
  const FlipPicture a = checkered(5, 0.1f, 0.9f), b = checkered(4, 0.3f, 1.0f);
  EXPECT_EQ(flip_map(a, b), flip_map(b, a));
  const std::vector<float> map = flip_map(a, b);
  const auto [least, most] = std::minmax_element(map.begin(), map.end());
  EXPECT_GE(*least, 0);
  EXPECT_LE(*most, 1);
}

}  // namespace
}  // namespace raytree::benchmarks
