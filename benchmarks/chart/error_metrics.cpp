#include "benchmarks/chart/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/angle.h"
#include "geometry/vec.h"

namespace raytree::benchmarks {
namespace {

/// The three planes of a group, pixel by pixel.
std::vector<float> interleaved_planes(const Film& film, ChannelGroup group, std::size_t pixels) {
  std::vector<float> values(3 * pixels);
  for (int c = 0; c < 3; ++c) {
    const float* plane = film.plane(group, c);
    for (std::size_t i = 0; i < pixels; ++i) values[3 * i + static_cast<std::size_t>(c)] = plane[i];
  }
  return values;
}

double value_at(const std::vector<float>& values, std::size_t index) { return static_cast<double>(values[index]); }

double degrees_between_normals(const std::vector<float>& a, const std::vector<float>& b, std::size_t pixel) {
  const Vec3d p(value_at(a, 3 * pixel), value_at(a, 3 * pixel + 1), value_at(a, 3 * pixel + 2));
  const Vec3d q(value_at(b, 3 * pixel), value_at(b, 3 * pixel + 1), value_at(b, 3 * pixel + 2));
  return std::atan2(p.cross(q).length(), p.dot(q)) / kDegree;
}

void add_geometry_errors(const ChartPicture& reference, const ChartPicture& test, ErrorMetrics& errors) {
  double distance = 0, degrees = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < reference.alpha.size(); ++i) {
    const double expected = value_at(reference.distance, i), found = value_at(test.distance, i);
    if (reference.alpha[i] != 1 || test.alpha[i] != 1 || !std::isfinite(expected) || !std::isfinite(found)) continue;
    distance += std::abs(found - expected) / expected;
    degrees += degrees_between_normals(reference.normal, test.normal, i);
    ++count;
  }
  if (count == 0) return;
  errors.distance = distance / static_cast<double>(count);
  errors.normal_degrees = degrees / static_cast<double>(count);
}

}  // namespace

ChartPicture chart_picture(const Film& film, const DisplayTransform& display) {
  ChartPicture picture;
  picture.width = film.window().width;
  picture.height = film.window().height;
  const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  picture.linear = interleaved_planes(film, ChannelGroup::color, pixels);
  picture.shown = picture.linear;
  display.apply(picture.shown.data(), static_cast<std::int64_t>(pixels));
  for (float& value : picture.shown) value = std::clamp(value, 0.0f, 1.0f);
  const float* alpha = film.plane(ChannelGroup::alpha, 0);
  const float* distance = film.plane(ChannelGroup::depth, 0);
  picture.alpha.assign(alpha, alpha + pixels);
  picture.distance.assign(distance, distance + pixels);
  picture.normal = interleaved_planes(film, ChannelGroup::normal, pixels);
  picture.seen = flip_picture(picture.width, picture.height, picture.shown);
  return picture;
}

ErrorMetrics picture_errors(const ChartPicture& reference, const ChartPicture& test) {
  ErrorMetrics errors;
  const std::size_t pixels = reference.alpha.size();
  double squares = 0, relative = 0;
  std::size_t over = 0;
  std::vector<double> largest(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    double step = 0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const double expected = value_at(reference.linear, k), off = value_at(test.linear, k) - expected;
      squares += off * off;
      relative += off * off / (expected * expected + kRelativeGround);
      largest[i] = std::max(largest[i], std::abs(off));
      step = std::max(step, std::abs(value_at(test.shown, k) - value_at(reference.shown, k)));
    }
    over += step > kDisplayStep;
  }
  const auto count = static_cast<double>(pixels);
  errors.rmse = std::sqrt(squares / (3 * count));
  errors.relative_mse = relative / (3 * count);
  errors.over_step = static_cast<double>(over) / count;
  // The smallest value that at least 99.9 % of the pixels do not exceed.
  const auto rank = static_cast<std::size_t>(std::ceil(0.999 * count)) - 1;
  std::nth_element(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(rank), largest.end());
  errors.p999 = largest[rank];
  errors.maximum = *std::max_element(largest.begin() + static_cast<std::ptrdiff_t>(rank), largest.end());
  errors.flip = flip_mean(reference.seen, test.seen);
  add_geometry_errors(reference, test, errors);
  return errors;
}

}  // namespace raytree::benchmarks
