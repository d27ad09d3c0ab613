// Errors of pictures that are off by known amounts.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "benchmarks/chart/error_metrics.h"
#include "geometry/angle.h"

namespace raytree::benchmarks {
namespace {

constexpr int kSide = 50;  ///< 2500 pixels: .1 % are 2.5

Film gray_film(float value) {
  Film film(kSide, kSide, {0, 0, kSide, kSide}, kChartChannels);
  for (int i = 0; i < kSide * kSide; ++i) {
    for (int c = 0; c < 3; ++c) film.plane(ChannelGroup::color, c)[i] = value;
    film.plane(ChannelGroup::alpha, 0)[i] = 1;
    film.plane(ChannelGroup::depth, 0)[i] = 10;
    film.plane(ChannelGroup::normal, 2)[i] = 1;
  }
  return film;
}

ErrorMetrics errors_between(const Film& reference, const Film& test) {
  DisplayOptions options;
  options.ocio_config = "builtin";
  const DisplayTransform display(options);
  return picture_errors(chart_picture(reference, display), chart_picture(test, display));
}

TEST(ChartErrors, EqualPicturesHaveNone) {
  EXPECT_EQ(errors_between(gray_film(0.25f), gray_film(0.25f)), (ErrorMetrics{0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(ChartErrors, AnOffsetIsItself) {
  const ErrorMetrics errors = errors_between(gray_film(0.25f), gray_film(0.5f));
  EXPECT_DOUBLE_EQ(errors.rmse, 0.25);
  EXPECT_NEAR(errors.relative_mse, 0.0625 / (0.0625 + kRelativeGround), 1e-12);  // 7500 roundings
  EXPECT_DOUBLE_EQ(errors.p999, 0.25);
  EXPECT_DOUBLE_EQ(errors.maximum, 0.25);
  EXPECT_DOUBLE_EQ(errors.over_step, 1);
  EXPECT_GT(errors.flip, 0.1);
}

// Three pixels of 2500 are more than .1 %, two are not.
TEST(ChartErrors, OutliersShowInThePercentileFromOneInAThousandOn) {
  for (const int count : {2, 3}) {
    Film film = gray_film(0.25f);
    for (int i = 0; i < count; ++i) film.plane(ChannelGroup::color, 1)[i * 700] = 1.25f;
    const ErrorMetrics errors = errors_between(gray_film(0.25f), film);
    EXPECT_DOUBLE_EQ(errors.p999, count == 2 ? 0 : 1) << count;
    EXPECT_DOUBLE_EQ(errors.maximum, 1);
    EXPECT_DOUBLE_EQ(errors.over_step, count / 2500.0);
    EXPECT_DOUBLE_EQ(errors.rmse, std::sqrt(count / 7500.0));
  }
}

// The view turns linear .2140 into .5 of the display's range, where a step of 1/255 is .0036 of light.
TEST(ChartErrors, StepsAreCountedAfterTheView) {
  EXPECT_EQ(errors_between(gray_film(0.2140f), gray_film(0.2140f + 0.0034f)).over_step, 0);
  EXPECT_EQ(errors_between(gray_film(0.2140f), gray_film(0.2140f + 0.0040f)).over_step, 1);
}

TEST(ChartErrors, GeometryIsComparedWhereBothPicturesAreCovered) {
  Film film = gray_film(0.25f);
  for (int i = 0; i < kSide * kSide; ++i) {
    film.plane(ChannelGroup::depth, 0)[i] = 10.1f;
    film.plane(ChannelGroup::normal, 0)[i] = static_cast<float>(std::sin(2 * kDegree));
    film.plane(ChannelGroup::normal, 2)[i] = static_cast<float>(std::cos(2 * kDegree));
  }
  film.plane(ChannelGroup::alpha, 0)[0] = 0.5f;  // neither this pixel's values nor the sky's count
  film.plane(ChannelGroup::depth, 0)[0] = 1000;
  film.plane(ChannelGroup::depth, 0)[1] = std::numeric_limits<float>::infinity();
  const ErrorMetrics errors = errors_between(gray_film(0.25f), film);
  EXPECT_NEAR(errors.distance, 0.01, 1e-7);
  EXPECT_NEAR(errors.normal_degrees, 2, 1e-5);
}

TEST(ChartErrors, WithoutASurfaceThereIsNoGeometry) {
  Film sky = gray_film(0.25f);
  std::fill_n(sky.plane(ChannelGroup::alpha, 0), kSide * kSide, 0.0f);
  EXPECT_TRUE(std::isnan(errors_between(sky, sky).distance));
}

}  // namespace
}  // namespace raytree::benchmarks
