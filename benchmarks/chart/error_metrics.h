// How far a picture lies off another one: in light, in what a display shows, in what an eye sees, and in geometry.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "benchmarks/chart/flip.h"
#include "renderer/display.h"
#include "renderer/film.h"

namespace raytree::benchmarks {

/// A picture as errors are measured on it. Arrays are [height][width] or [height][width][3].
struct ChartPicture {
  int width = 0, height = 0;
  std::vector<float> linear;  ///< radiance, linear Rec.709; [3]
  std::vector<float> shown;   ///< display values after the view, before dither and rounding; [3]
  std::vector<float> alpha, distance;
  std::vector<float> normal;  ///< [3]
  FlipPicture seen;
};

/// The film must hold color, alpha, depth and normal.
ChartPicture chart_picture(const Film& film, const DisplayTransform& display);
inline const ChannelSet kChartChannels{ChannelGroup::color, ChannelGroup::alpha, ChannelGroup::depth,
                                       ChannelGroup::normal};

struct ErrorMetrics {
  double rmse = 0;          ///< root of the mean square over pixels and channels, linear light
  double relative_mse = 0;  ///< mean of (I - R)^2 / (R^2 + kRelativeGround), linear light
  double p999 = 0;          ///< of the pixels' largest channel errors, linear light, 99.9 % are at most this
  double maximum = 0;       ///< and all are at most this
  double over_step = 0;     ///< share of pixels off by more than 1/255 in some channel after the view
  double flip = 0;          ///< mean FLIP
  /// Mean over the pixels that are covered whole in both pictures; NaN where there are none.
  double distance = std::numeric_limits<double>::quiet_NaN();        ///< hit distance, relative
  double normal_degrees = std::numeric_limits<double>::quiet_NaN();  ///< shading normals
  bool operator==(const ErrorMetrics&) const = default;
};

inline constexpr double kRelativeGround = 1e-2;
inline constexpr double kDisplayStep = 1.0 / 255;

/// Of pictures of one size. Summed in the order of the pixels, so that equal pictures give equal bits.
ErrorMetrics picture_errors(const ChartPicture& reference, const ChartPicture& test);

/// One metric as the chart, the table and the files name it.
struct MetricInfo {
  const char* key;    ///< in files: "rmse"
  const char* label;  ///< on axes and in tables
  double ErrorMetrics::*value;
  bool charted;  ///< against time, on an axis of its own
};
inline constexpr std::array<MetricInfo, 8> kMetrics{{
    {"rmse", "RMSE, linear light", &ErrorMetrics::rmse, true},
    {"flip", "FLIP, mean", &ErrorMetrics::flip, true},
    {"over_step", "share of pixels off by > 1/255 after the view", &ErrorMetrics::over_step, true},
    {"p999", "99.9th percentile, linear light", &ErrorMetrics::p999, true},
    {"relative_mse", "relative MSE, linear light", &ErrorMetrics::relative_mse, true},
    {"maximum", "maximum, linear light", &ErrorMetrics::maximum, true},
    {"distance", "hit distance, mean relative error", &ErrorMetrics::distance, false},
    {"normal_degrees", "normal, mean error in degrees", &ErrorMetrics::normal_degrees, false},
}};

}  // namespace raytree::benchmarks
