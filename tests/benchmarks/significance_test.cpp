// The words "faster" and "slower": chance alone brings them about as seldom as promised, and a real change does not
// escape them.
#include "benchmarks/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace raytree::benchmarks {
namespace {

/// Speeds with noise of `spread` that has a long tail to the slow side, as timings have.
std::vector<double> synthetic_speeds(std::mt19937_64& random, double mean, double spread, int count) {
  std::normal_distribution<double> noise;
  std::vector<double> speeds;
  for (int i = 0; i < count; ++i) {
    const double tail = random() % 8 == 0 ? 2 * std::abs(noise(random)) : 0;
    speeds.push_back(mean / (1 + spread * (noise(random) + tail)));
  }
  return speeds;
}

TEST(Significance, RanksHaveTheChancesOfTheTables) {
  // Of 10 choices of 2 among 5 one is the highest and one the lowest: 2 / 10.
  EXPECT_NEAR(compare_speeds({1, 2, 3}, {4, 5}, 0).chance, 0.2, 1e-12);
  // U = 1 of 5 x 5: choices with U of 0 and 1 are 2 of 252, twice.
  EXPECT_NEAR(compare_speeds({1, 2, 3, 4, 6}, {5, 7, 8, 9, 10}, 0).chance, 4.0 / 252, 1e-12);
  // The table's 5 % bound of n = m = 10 is U <= 23 (Mann and Whitney 1947): U = 23 within it, 24 not.
  const std::vector<double> after{-1, -2, -3, -4, -5, -6, -7, 7.5, 8.5, 8.6};
  const std::vector<double> before{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_NEAR(compare_speeds(before, after, 0).chance, 2 * 0.0216, 0.01);
  EXPECT_DOUBLE_EQ(compare_speeds({1, 1, 1}, {1, 1, 1}, 0).chance, 1);
}

TEST(Significance, NothingChangedIsSaidOfEqualDistributionsInAtLeast95OfAHundredTrials) {
  std::mt19937_64 random(1980);
  for (const double least : {0.0, kBetweenProcesses})
    for (const int count : {5, 9, 15}) {
      int changed = 0;
      constexpr int kTrials = 400;
      for (int trial = 0; trial < kTrials; ++trial)
        changed +=
            compare_speeds(synthetic_speeds(random, 5, 0.02, count), synthetic_speeds(random, 5, 0.02, count), least)
                .change != Change::none;
      EXPECT_LE(changed, kTrials / 20) << count << " samples, " << least;
    }
}

TEST(Significance, TenPercentAreSeenThroughNoiseOfTwo) {
  std::mt19937_64 random(7);
  for (const int count : {7, 9, 15}) {
    int faster = 0, slower = 0;
    constexpr int kTrials = 100;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto slow = synthetic_speeds(random, 5, 0.02, count), fast = synthetic_speeds(random, 5.5, 0.02, count);
      faster += compare_speeds(slow, fast).change == Change::faster;
      slower += compare_speeds(fast, slow).change == Change::slower;
    }
    EXPECT_GE(faster, 98) << count;
    EXPECT_GE(slower, 98) << count;
  }
}

TEST(Significance, SmallOrFewIsNoChange) {
  std::mt19937_64 random(9);
  // Two percent with hardly any noise: real ranks, but no more than processes differ.
  const Comparison small = compare_speeds(synthetic_speeds(random, 5, 1e-4, 9), synthetic_speeds(random, 5.1, 1e-4, 9));
  EXPECT_LT(small.chance, kChance);
  EXPECT_EQ(small.change, Change::none);
  EXPECT_EQ(compare_speeds({1, 1, 1}, {9, 9, 9}).change, Change::too_few);
  EXPECT_EQ(compare_speeds({}, {9}).change, Change::too_few);
}

TEST(Significance, ManySamplesGoByTheNormalDistributionThatFewOnesTendTo) {
  // The same shift on both sides of the change from exact shares to the normal distribution.
  const auto chance = [](int count) {
    std::vector<double> before, after;
    for (int i = 0; i < count; ++i) before.push_back(i), after.push_back(i + 6.25);
    return compare_speeds(before, after, 0).chance;
  };
  EXPECT_NEAR(chance(41), chance(40), 0.005);
  EXPECT_GT(chance(40), 0.01);
  std::vector<double> before, after;
  for (int i = 0; i < 200; ++i) before.push_back(i), after.push_back(i + 0.5);
  EXPECT_GT(compare_speeds(before, after, 0).chance, 0.5);
  for (double& value : after) value += 60;
  EXPECT_LT(compare_speeds(before, after, 0).chance, 1e-6);
}

}  // namespace
}  // namespace raytree::benchmarks
