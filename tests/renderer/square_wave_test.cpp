// Means of square waves and checkers over windows, against closed forms and against sums over many points.
#include "renderer/square_wave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace raytree {
namespace {

class UniformNumbers {
 public:
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  std::mt19937_64 random_{42};
};

/// Share of an interval that lies on cells of +1: the catalogue's g(x) = floor(x / 2) + 2 max(frac(x / 2) - 1/2, 0)
/// counts the others.
double interval_mean(double x, double width) {
  const auto odd = [](double t) {
    const double half = t / 2;
    return std::floor(half) + 2 * std::max(half - std::floor(half) - 0.5, 0.0);
  };
  return 1 - 2 * (odd(x + width / 2) - odd(x - width / 2)) / width;
}

TEST(SquareWave, MeansOverIntervalsAreThoseOfTheClosedForm) {
  UniformNumbers number;
  for (int i = 0; i < 20000; ++i) {
    const double x = number(-50, 50), width = std::pow(10.0, number(-3, 2));
    // Differences of numbers around 50 over widths of .001.
    EXPECT_NEAR(square_wave_mean(x, width), interval_mean(x, width), 1e-10);
    EXPECT_EQ(square_wave_mean(x, 0), square_wave(x));
    EXPECT_EQ(square_wave_mean(x, -width), square_wave_mean(x, width));
  }
  EXPECT_EQ(square_wave(0), 1);
  EXPECT_EQ(square_wave(0.999), 1);
  EXPECT_EQ(square_wave(1), -1);
  EXPECT_EQ(square_wave(-0.001), -1);
  EXPECT_EQ(square_wave_mean(0.3, 2), 0);
  EXPECT_EQ(square_wave_mean(0.5, 1), 1);
  for (const double wide : {1e7, HUGE_VAL, std::nan("")}) EXPECT_EQ(square_wave_mean(0.3, wide), 0);
}

TEST(SquareWave, MeansOverTwoIntervalsAreMeansOfMeans) {
  UniformNumbers number;
  for (int i = 0; i < 300; ++i) {
    const double x = number(-5, 5), width = number(0.01, 5), other = number(0.01, 5);
    constexpr int kSteps = 4000;
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) sum += interval_mean(x + ((k + 0.5) / kSteps - 0.5) * other, width);
    // The midpoint rule over a function whose slope is at most 2 / width, in steps of other / kSteps.
    EXPECT_NEAR(square_wave_mean(x, width, other), sum / kSteps, 2 * other / width / kSteps) << width << " " << other;
    EXPECT_EQ(square_wave_mean(x, width, other), square_wave_mean(x, other, width));
    EXPECT_EQ(square_wave_mean(x, width, 0), square_wave_mean(x, width));
  }
}

TEST(SquareWave, CheckerMeansOverParallelogramsAreThoseOfManyPoints) {
  UniformNumbers number;
  for (int i = 0; i < 150; ++i) {
    const double reach = std::pow(10.0, number(-2, 1));
    const PlaneVector center{number(-20, 20), number(-20, 20)}, edge{number(-reach, reach), number(-reach, reach)},
        other{number(-reach, reach), number(-reach, reach)};
    constexpr int kSteps = 300;
    double sum = 0;
    for (int s = 0; s < kSteps; ++s)
      for (int t = 0; t < kSteps; ++t) {
        const double u = (s + 0.5) / kSteps - 0.5, v = (t + 0.5) / kSteps - 0.5;
        sum += square_wave(center.a + u * edge.a + v * other.a) * square_wave(center.b + u * edge.b + v * other.b);
      }
    // An edge of a square that crosses the window errs by at most one row of points: 2 / kSteps each way.
    const double crossings = 2 + std::abs(edge.a) + std::abs(other.a) + std::abs(edge.b) + std::abs(other.b);
    EXPECT_NEAR(checker_mean(center, edge, other), sum / (kSteps * kSteps), 2 * crossings / kSteps)
        << edge.a << "," << edge.b << " " << other.a << "," << other.b;
    // The window is the same whichever edge comes first and whichever way it runs.
    EXPECT_NEAR(checker_mean(center, edge, other), checker_mean(center, other, {-edge.a, -edge.b}), 1e-9);
    EXPECT_NEAR(checker_mean(center, edge, other),
                checker_mean({center.b, center.a}, {edge.b, edge.a}, {other.b, other.a}), 1e-9);
  }
}

TEST(SquareWave, CheckerMeansOverBoxesAreProducts) {
  UniformNumbers number;
  for (int i = 0; i < 2000; ++i) {
    const PlaneVector center{number(-20, 20), number(-20, 20)};
    const double width = std::pow(10.0, number(-3, 1.2)), height = std::pow(10.0, number(-3, 1.2));
    EXPECT_NEAR(checker_mean(center, {width, 0}, {0, height}),
                interval_mean(center.a, width) * interval_mean(center.b, height), 1e-8)
        << width << " " << height;
  }
}

TEST(SquareWave, AlongADiagonalACheckerKeepsItsContrast) {
  // A long thin window along the squares' diagonal stays on one color, which a product of two means would lose.
  EXPECT_NEAR(checker_mean({0.5, 0.5}, {8, 8}, {0.01, -0.01}), 1 - 2 * 0.005, 1e-9);
  EXPECT_NEAR(checker_mean({1.5, 0.5}, {8, 8}, {0.01, -0.01}), -(1 - 2 * 0.005), 1e-9);
}

TEST(SquareWave, CheckerMeansOfUnusualWindowsAreInRange) {
  UniformNumbers number;
  const auto edge = [&] {
    const double reach = std::pow(10.0, number(-300, 18));
    return PlaneVector{number(0, 1) < 0.2 ? 0 : number(-reach, reach), number(0, 1) < 0.2 ? 0 : number(-reach, reach)};
  };
  for (int i = 0; i < 100000; ++i) {
    const double far = std::pow(10.0, number(-3, 18));
    const double mean = checker_mean({number(-far, far), number(-far, far)}, edge(), edge());
    EXPECT_TRUE(mean >= -1 && mean <= 1) << mean;
  }
  EXPECT_EQ(checker_mean({0.5, 0.5}, {0, 0}, {0, 0}), 1);
  EXPECT_EQ(checker_mean({0.5, 1.5}, {1e-9, 0}, {0, 1e-9}), -1);
  EXPECT_EQ(checker_mean({0.5, 0.5}, {HUGE_VAL, 0}, {0, 1}), 0);
  EXPECT_EQ(checker_mean({0.5, 0.5}, {std::nan(""), 0}, {0, 1}), 0);
}

}  // namespace
}  // namespace raytree
