#include "benchmarks/chart/flip.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/angle.h"

namespace raytree::benchmarks {
namespace {

using Triple = std::array<double, 3>;
using FlipPlane = std::vector<float>;

/// One axis of a filter: taps from -radius to radius.
using Taps = std::vector<double>;

/// Linear Rec.709 to XYZ, D65; rows of the matrix.
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

Triple matrix_product(const double (&matrix)[3][3], const Triple& v) {
  Triple result{};
  for (std::size_t row = 0; row < 3; ++row)
    result[row] = matrix[row][0] * v[0] + matrix[row][1] * v[1] + matrix[row][2] * v[2];
  return result;
}

struct XyzInverse {
  double rows[3][3];
  XyzInverse() {
    const auto& m = kToXyz;
    const auto minor = [&](int r, int c) {
      const int r0 = (r + 1) % 3, r1 = (r + 2) % 3, c0 = (c + 1) % 3, c1 = (c + 2) % 3;
      return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    };
    const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) rows[r][c] = minor(c, r) / determinant;
  }
};

const Triple& white_point() {
  static const Triple xyz = matrix_product(kToXyz, {1, 1, 1});
  return xyz;
}

double linear_of_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

/// XYZ over that of white.
Triple relative_xyz(const Triple& linear) {
  const Triple xyz = matrix_product(kToXyz, linear);
  return {xyz[0] / white_point()[0], xyz[1] / white_point()[1], xyz[2] / white_point()[2]};
}

/// The opponent space in which the eye's contrast sensitivity is applied: achromatic, red-green, blue-yellow.
Triple opponent_of_linear(const Triple& linear) {
  const Triple xyz = relative_xyz(linear);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Triple linear_of_opponent(const Triple& opponent) {
  static const XyzInverse inverse;
  const double y = (opponent[0] + 16) / 116, x = y + opponent[1] / 500, z = y - opponent[2] / 200;
  return matrix_product(inverse.rows, {x * white_point()[0], y * white_point()[1], z * white_point()[2]});
}

/// CIELAB, with a and b scaled by lightness: colors of dark surfaces differ less (Hunt).
Triple hunt_lab(const Triple& linear) {
  const auto f = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Triple xyz = relative_xyz(linear);
  const double lightness = 116 * f(xyz[1]) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(xyz[0]) - f(xyz[1])),
          0.01 * lightness * 200 * (f(xyz[1]) - f(xyz[2]))};
}

/// City-block distance in lightness plus Euclidean in (a, b): HyAB.
double hyab(const Triple& p, const Triple& q) { return std::abs(p[0] - q[0]) + std::hypot(p[1] - q[1], p[2] - q[2]); }

constexpr double kColorExponent = 0.7;    ///< q_c
constexpr double kKnee = 0.4;             ///< p_c: share of the largest distance...
constexpr double kKneeError = 0.95;       ///< p_t: ...that is mapped to this error
constexpr double kFeatureExponent = 0.5;  ///< q_f
constexpr double kFeatureWidth = 0.082;   ///< degrees; w of the detectors

/// Compressed color distances to [0, 1]: most of the range goes to small ones.
double color_error(double distance) {
  static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColorExponent);
  const double knee = kKnee * largest, compressed = std::pow(distance, kColorExponent);
  return compressed < knee ? compressed * kKneeError / knee
                           : kKneeError + (compressed - knee) / (largest - knee) * (1 - kKneeError);
}

/// The plane filtered along rows by `across` and along columns by `down`; pixels beyond the border are those on it.
FlipPlane filtered_plane(const FlipPlane& plane, int width, int height, const Taps& across, const Taps& down) {
  const auto columns = static_cast<std::size_t>(width);
  const int radius_x = static_cast<int>(across.size() / 2), radius_y = static_cast<int>(down.size() / 2);
  FlipPlane half(plane.size()), result(plane.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    std::vector<double> padded(columns + across.size() - 1), sums(columns);
    for (int y = rows.begin(); y < rows.end(); ++y) {
      const float* row = plane.data() + static_cast<std::size_t>(y) * columns;
      for (std::size_t i = 0; i < padded.size(); ++i)
        padded[i] = static_cast<double>(row[std::clamp(static_cast<int>(i) - radius_x, 0, width - 1)]);
      std::fill(sums.begin(), sums.end(), 0.0);
      for (std::size_t tap = 0; tap < across.size(); ++tap)
        for (std::size_t x = 0; x < columns; ++x) sums[x] += across[tap] * padded[x + tap];
      std::transform(sums.begin(), sums.end(), half.begin() + static_cast<std::ptrdiff_t>(y) * width,
                     [](double v) { return static_cast<float>(v); });
    }
  });
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    std::vector<double> sums(columns);
    for (int y = rows.begin(); y < rows.end(); ++y) {
      std::fill(sums.begin(), sums.end(), 0.0);
      for (int i = -radius_y; i <= radius_y; ++i) {
        const double tap = down[static_cast<std::size_t>(i + radius_y)];
        const float* row = half.data() + static_cast<std::size_t>(std::clamp(y + i, 0, height - 1)) * columns;
        for (std::size_t x = 0; x < columns; ++x) sums[x] += tap * static_cast<double>(row[x]);
      }
      std::transform(sums.begin(), sums.end(), result.begin() + static_cast<std::ptrdiff_t>(y) * width,
                     [](double v) { return static_cast<float>(v); });
    }
  });
  return result;
}

/// One term of a contrast sensitivity function, a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm kSensitivity[3][2] = {
    {{1, 0.0047}, {0, 1e-5}}, {{1, 0.0053}, {0, 1e-5}}, {{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kWidestSensitivity = 0.04;

/// A channel as the eye resolves it. The sum of two Gaussians is not separable, each of them is.
FlipPlane resolved(const FlipPlane& plane, int width, int height, const SensitivityTerm (&terms)[2],
                   double per_degree) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidestSensitivity / (2 * kPi * kPi)) * per_degree));
  std::vector<double> sum(plane.size());
  double total = 0;
  for (const SensitivityTerm& term : terms) {
    if (term.a == 0) continue;
    Taps taps;
    double one = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double degrees = i / per_degree;
      taps.push_back(std::exp(-kPi * kPi * degrees * degrees / term.b));
      one += taps.back();
    }
    for (double& tap : taps) tap /= one;
    const double weight = term.a * std::sqrt(kPi / term.b) * one * one;
    total += weight;
    const FlipPlane part = filtered_plane(plane, width, height, taps, taps);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * static_cast<double>(part[i]);
  }
  FlipPlane result(plane.size());
  for (std::size_t i = 0; i < sum.size(); ++i) result[i] = static_cast<float>(sum[i] / total);
  return result;
}

/// Positive taps to sum 1 and negative ones to -1.
void balance(Taps& taps) {
  double positive = 0, negative = 0;
  for (const double tap : taps) (tap > 0 ? positive : negative) += tap;
  for (double& tap : taps) tap /= tap > 0 ? positive : -negative;
}

/// Magnitude of the first derivative (edges) or the second (points) of the Gaussian-smoothed plane.
FlipPlane detected(const FlipPlane& plane, int width, int height, bool points, double per_degree) {
  const double sigma = 0.5 * kFeatureWidth * per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  Taps smooth, slope;
  double total = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double gaussian = std::exp(-i * i / (2 * sigma * sigma));
    smooth.push_back(gaussian);
    slope.push_back(points ? (i * i / (sigma * sigma) - 1) * gaussian : -i * gaussian);
    total += gaussian;
  }
  for (double& tap : smooth) tap /= total;
  balance(slope);
  const FlipPlane x = filtered_plane(plane, width, height, slope, smooth),
                  y = filtered_plane(plane, width, height, smooth, slope);
  FlipPlane magnitude(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) magnitude[i] = std::hypot(x[i], y[i]);
  return magnitude;
}

}  // namespace

FlipPicture flip_picture(int width, int height, const std::vector<float>& srgb, double pixels_per_degree) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::array<FlipPlane, 3> channels;
  for (FlipPlane& plane : channels) plane.resize(pixels);
  FlipPlane achromatic(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    Triple linear;
    for (std::size_t c = 0; c < 3; ++c)
      linear[c] = linear_of_srgb(std::clamp(static_cast<double>(srgb[3 * i + c]), 0.0, 1.0));
    const Triple opponent = opponent_of_linear(linear);
    for (std::size_t c = 0; c < 3; ++c) channels[c][i] = static_cast<float>(opponent[c]);
    achromatic[i] = static_cast<float>((opponent[0] + 16) / 116);
  }
  for (std::size_t c = 0; c < 3; ++c)
    channels[c] = resolved(channels[c], width, height, kSensitivity[c], pixels_per_degree);
  FlipPicture picture;
  picture.width = width;
  picture.height = height;
  picture.lightness.resize(pixels);
  picture.a.resize(pixels);
  picture.b.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    Triple linear = linear_of_opponent({channels[0][i], channels[1][i], channels[2][i]});
    for (double& value : linear) value = std::clamp(value, 0.0, 1.0);
    const Triple lab = hunt_lab(linear);
    picture.lightness[i] = static_cast<float>(lab[0]);
    picture.a[i] = static_cast<float>(lab[1]);
    picture.b[i] = static_cast<float>(lab[2]);
  }
  picture.edges = detected(achromatic, width, height, false, pixels_per_degree);
  picture.points = detected(achromatic, width, height, true, pixels_per_degree);
  return picture;
}

std::vector<float> flip_map(const FlipPicture& reference, const FlipPicture& test) {
  std::vector<float> map(reference.lightness.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double color = color_error(
        hyab({reference.lightness[i], reference.a[i], reference.b[i]}, {test.lightness[i], test.a[i], test.b[i]}));
    const double feature =
        std::max(std::abs(static_cast<double>(reference.edges[i]) - static_cast<double>(test.edges[i])),
                 std::abs(static_cast<double>(reference.points[i]) - static_cast<double>(test.points[i])));
    const double seen = std::pow(std::min(1.0, feature / std::sqrt(2.0)), kFeatureExponent);
    map[i] = static_cast<float>(color > 0 ? std::pow(color, 1 - seen) : 0.0);
  }
  return map;
}

double flip_mean(const FlipPicture& reference, const FlipPicture& test) {
  double sum = 0;
  for (const float error : flip_map(reference, test)) sum += static_cast<double>(error);
  return sum / static_cast<double>(reference.lightness.size());
}

}  // namespace raytree::benchmarks
