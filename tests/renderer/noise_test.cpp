// Gradient noise against what its definition implies: moments in closed form, independence, continuity, period, exact
// gradients, and the same bits everywhere.
#include "renderer/noise.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "renderer/scene_fields.h"

namespace raytree {
namespace {

static_assert(kMaxPatternOctaves == kMaxOctaves);

class Places {
 public:
  explicit Places(unsigned seed) : random_(seed) {}
  double number(double low, double high) { return low + (high - low) * (static_cast<double>(random_()) * 0x1p-64); }
  Vec3d within(double reach) { return {number(-reach, reach), number(-reach, reach), number(-reach, reach)}; }
  std::uint32_t seed() { return static_cast<std::uint32_t>(random_()); }

 private:
  std::mt19937_64 random_;
};

TEST(Noise, HasTheSameBitsEverywhere) {
  // A thousand values, their gradients and those of octaves; made once, by two compilers.
  Places places(1);
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](const Height& height) {
    for (const double x : {height.value, height.gradient.x, height.gradient.y, height.gradient.z})
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3u;
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3d place = places.within(1000);
    add(gradient_noise(place, places.seed()));
    add(octave_noise({5, 0.5, 3}, place, 0.01));
    add(ridged_noise({3, 0.6, 4}, place, 0));
  }
  EXPECT_EQ(hash, 0xe650f94b72891ec6u) << std::hex << hash;
}

TEST(Noise, HasItsClosedFormsMeanAndVariance) {
  // Integrals of w^2 and w^2 t^2 by Simpson's rule, exact enough: w^2 t^2 has degree 12.
  double i0 = 0, i2 = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = double(i) / kSteps, w = 1 - t * t * t * (t * (6 * t - 15) + 10);
    const double simpson = (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) / (3.0 * kSteps);
    i0 += simpson * w * w, i2 += simpson * w * w * t * t;
  }
  const double deviation = 4 * i0 * std::sqrt(i2);
  EXPECT_NEAR(kNoiseDeviation, deviation, 1e-6);
  Places places(2);
  for (const Octaves& octaves : {Octaves{1, 0.5, 0}, Octaves{4, 0.5, 9}, Octaves{6, 0.8, 77}, Octaves{3, 0, 5}}) {
    constexpr int kCount = 100'000;
    double sum = 0, squares = 0;
    for (int i = 0; i < kCount; ++i) {
      const double n = octave_noise(octaves, places.within(1e5), 0).value;
      ASSERT_LE(std::abs(n), octaves.largest());
      sum += n, squares += n * n;
    }
    // Independent draws: the mean's deviation is sigma / sqrt(N), that of the mean square at most sigma^2 sqrt(2 / N),
    // since the values' tails are lighter than a normal distribution's. Four of each.
    EXPECT_NEAR(sum / kCount, 0, 4 * deviation / std::sqrt(kCount)) << octaves.count;
    EXPECT_NEAR(squares / kCount / (deviation * deviation), 1, 4 * std::sqrt(2.0 / kCount)) << octaves.count;
  }
}

TEST(Noise, StaysWithinItsRangeWhereItIsLargest) {
  // The largest values are near a cell's middle: many cells, climbing from each middle.
  double largest = 0;
  Places places(3);
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t seed = places.seed();
    Vec3d place(0.5, 0.5, 0.5);
    Height height = gradient_noise(place, seed);
    for (double step = 0.1; step > 1e-3;) {
      const Vec3d next = place + height.gradient.normalized() * (height.value > 0 ? step : -step);
      const Height there = gradient_noise(next, seed);
      if (std::abs(there.value) > std::abs(height.value))
        place = next, height = there;
      else
        step /= 2;
    }
    largest = std::max(largest, std::abs(height.value));
  }
  EXPECT_LE(largest, kLargestNoise);
  EXPECT_GT(largest, 0.9);
}

TEST(Noise, IsZeroOnItsLatticeAndContinuousToTheSecondDerivative) {
  Places places(4);
  for (int i = 0; i < 300; ++i) {
    const std::uint32_t seed = places.seed();
    Vec3d place = places.within(50);
    EXPECT_EQ(gradient_noise({std::floor(place.x), std::floor(place.y), std::floor(place.z)}, seed).value, 0);
    // From both sides of a face between cells: values differ by what the step brings, gradients by the step times the
    // second derivatives, which are below 40, and second differences of gradients stay of that size too.
    const int axis = i % 3;
    place[axis] = std::floor(place[axis]);
    constexpr double kStep = 1e-6;
    Vec3d before = place, after = place, further = place, back = place;
    before[axis] -= kStep, after[axis] += kStep, further[axis] += 2 * kStep, back[axis] -= 2 * kStep;
    const Height a = gradient_noise(before, seed), b = gradient_noise(after, seed);
    EXPECT_NEAR(a.value, b.value, 2 * kStep * 4);
    EXPECT_LT((a.gradient - b.gradient).length(), 2 * kStep * 40);
    const Vec3d curvature_before = (a.gradient - gradient_noise(back, seed).gradient) / kStep,
                curvature_after = (gradient_noise(further, seed).gradient - b.gradient) / kStep;
    EXPECT_LT((curvature_before - curvature_after).length(), 1e-2);
  }
}

TEST(Noise, RepeatsAfterTwoToThe32AndNotBefore) {
  Places places(5);
  constexpr double kPeriod = 0x1p32;
  for (int i = 0; i < 100; ++i) {
    // Binary fractions, so that adding the period rounds nothing.
    const Vec3d place(std::floor(places.number(-1e6, 1e6)) / 256, std::floor(places.number(-1e6, 1e6)) / 256,
                      std::floor(places.number(-1e6, 1e6)) / 256);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d far = place;
      far[axis] += i % 2 == 0 ? kPeriod : -kPeriod;
      EXPECT_EQ(gradient_noise(far, 7).value, gradient_noise(place, 7).value);
    }
  }
  // Points more than two cells apart along an axis share no corner: uncorrelated, also at the usual suspects for a
  // period. The sample correlation of N independent pairs deviates by 1 / sqrt(N).
  constexpr int kPairs = 20'000;
  const auto correlation = [&](const Vec3d& shift, std::uint32_t other_seed) {
    double products = 0;
    for (int i = 0; i < kPairs; ++i) {
      const Vec3d place = places.within(1e4);
      products += gradient_noise(place, 7).value * gradient_noise(place + shift, other_seed).value;
    }
    return products / kPairs / (kNoiseDeviation * kNoiseDeviation);
  };
  for (const double shift : {2.0, 16.0, 255.0, 256.0, 4096.0, 65536.0, 16777216.0, 2147483648.0})
    for (const Vec3d& along : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(1, 1, 1), Vec3d(1, -1, 0)})
      EXPECT_NEAR(correlation(along * shift, 7), 0, 5 / std::sqrt(kPairs)) << shift << " along " << along;
  EXPECT_NEAR(correlation({0, 0, 0}, 8), 0, 5 / std::sqrt(kPairs));
  EXPECT_GT(correlation({0.1, 0, 0}, 7), 0.9);
}

TEST(Noise, WhatIsNotFiniteOrHasNoDigitsCountsAsZero) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e18, -1e300}) {
    EXPECT_EQ(gradient_noise({bad, 0.3, 0.4}, 1).value, gradient_noise({0, 0.3, 0.4}, 1).value);
    EXPECT_TRUE(std::isfinite(octave_noise({8, 0.5, 1}, {0.3, bad, 0.4}, 0).value));
  }
}

TEST(Noise, GradientsAreThoseOfCentralDifferences) {
  Places places(6);
  // A central difference errs by h^2 / 6 times the third derivative and by rounding, 1e-16 / h. The third derivatives
  // of an octave of frequency f are below 500 f^3; a ridge's by its crease: (2 / kCreaseWidth)^2 times that, at worst.
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 500; ++i) {
    const Vec3d place = places.within(20);
    const std::uint32_t seed = places.seed();
    const auto check = [&](const auto& height, double tolerance, const char* what) {
      const Vec3d gradient = height(place).gradient;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3d low = place, high = place;
        low[axis] -= kStep, high[axis] += kStep;
        EXPECT_NEAR(gradient[axis], (height(high).value - height(low).value) / (2 * kStep), tolerance) << what;
      }
    };
    const double third = 500 * kStep * kStep / 6;
    check([&](const Vec3d& p) { return gradient_noise(p, seed); }, third + 1e-9, "one octave");
    check(
        [&](const Vec3d& p) {
          return octave_noise({4, 0.5, seed}, p, 0.05);
        },
        third * (1 + 4 + 16 + 64) + 1e-9, "octaves");
    check(
        [&](const Vec3d& p) {
          return ridged_noise({2, 0.5, seed}, p, 0.05);
        },
        third * 4 / (kCreaseWidth * kCreaseWidth) * 5, "ridges");
  }
}

TEST(Noise, OctavesTooFineForTheWindowFadeOut) {
  EXPECT_EQ(octave_weight(0, 1), 1);
  EXPECT_EQ(octave_weight(0.5, 1), 1);
  EXPECT_DOUBLE_EQ(octave_weight(1.25, 1), 0.5);
  EXPECT_EQ(octave_weight(2, 1), 0);
  EXPECT_EQ(octave_weight(HUGE_VAL, 1), 0);
  EXPECT_EQ(octave_weight(NAN, 1), 0);
  Places places(7);
  for (int i = 0; i < 100; ++i) {
    const Vec3d place = places.within(10);
    // Through a window of one cell the second octave is gone: what is left is the first.
    const double amplitude = Octaves{8, 0.5, 3}.first_amplitude();
    EXPECT_NEAR(octave_noise({8, 0.5, 3}, place, 1).value,
                amplitude * octave_weight(1, 1) * gradient_noise(place, 3).value, 1e-12);
    EXPECT_EQ(octave_noise({8, 0.5, 3}, place, 2).value, 0);
  }
}

}  // namespace
}  // namespace raytree
