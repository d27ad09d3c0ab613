// Rows 27 and 28: what a perturbed normal does to the noise of a picture, and to rays near the surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "benchmarks/samples/rough_mirror.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/ray_tree_parts.h"
#include "renderer/low_discrepancy.h"
#include "renderer/rough_surface.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

constexpr double kRoughness = 0.2, kCeiling = 2, kSquare = 1.5;
constexpr std::array kFacetCounts{4, 16, 64, 256};

/// Slope of log error over log N for N = 4, 16, 64...: the exponent by which errors fall.
double error_slope(const std::vector<double>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double u = std::log(4.0) * static_cast<double>(i), v = std::log(errors[i]);
    x += u, y += v, xx += u * u, xy += u * v;
  }
  const auto n = static_cast<double>(errors.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

double ceiling_checker(const Vec3d& from, const Vec3d& mirrored) {
  const Vec3d p = from + mirrored * (kCeiling / mirrored.y);
  const double cell = std::floor(p.x / kSquare) + std::floor(p.z / kSquare);
  return std::fmod(std::abs(cell), 2.0) < 0.5 ? 1.0 : 0.0;
}

SceneDescription rough_scene(int size, int samples, bool checker) {
  SceneDescription scene = mirror_plane(size, kRoughness, samples);
  if (!checker) {
    scene.background = GradientBackground{Rgb(0), Rgb(0), Rgb(1)};
    return scene;
  }
  CheckerPattern pattern;
  pattern.even = Rgb(1), pattern.odd = Rgb(0), pattern.size = kSquare;
  scene.ambient = Rgb(1);
  scene.materials.push_back(material("checker", pattern));
  scene.shapes.push_back(shape(PlaneShape{{0, kCeiling, 0}, {0, -1, 0}}, "checker"));
  scene.cameras[0].position = {0, 1, 1};
  return scene;
}

/// RMSE of the renderer's picture for each number of facets. The truth is a quadrature, so a bias would level the
/// errors off.
std::vector<double> rendered_errors(const StabilityRun& run, int size, bool checker) {
  const MirroredDirections mirrored(Vec3d(0, -1, -1).normalized(), kRoughness, run.effort < 0.5 ? 100 : 200);
  std::vector<double> truth(std::size_t(size) * std::size_t(size), mirrored.mean([](const Vec3d& r) { return r.y; }));
  std::vector<double> errors;
  for (const int samples : kFacetCounts) {
    const Scene scene = prepared_for(run, rough_scene(size, samples, checker));
    RenderOptions options;
    options.stop = run.stop;
    const RenderResult result = render(scene, options);
    double square = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const std::size_t i = pixel_index(result.film, x, y);
        if (checker && errors.empty()) {
          Vec3f origin, direction;
          scene.camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, origin, direction);
          const Vec3d at = Vec3d(origin) - Vec3d(direction) * (double(origin.y) / double(direction.y));
          truth[i] = mirrored.mean([&](const Vec3d& r) { return ceiling_checker(at, r); });
        }
        const double difference = double(result.film.plane(ChannelGroup::color, 0)[i]) - truth[i];
        square += difference * difference;
      }
    errors.push_back(std::sqrt(square) / size);
  }
  return errors;
}

/// The same of facets drawn independently, as Whitted's were: their own noise, without a renderer.
std::vector<double> independent_errors(int pixels) {
  const Vec3d direction = Vec3d(0, -1, -1).normalized();
  const double truth = MirroredDirections(direction, kRoughness, 100).mean([](const Vec3d& r) { return r.y; });
  std::mt19937_64 random(27);
  std::normal_distribution<double> slope(0, kRoughness);
  std::vector<double> errors;
  for (const int samples : kFacetCounts) {
    double square = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      double sum = 0;
      for (int i = 0; i < samples;) {
        const double x = slope(random), z = slope(random);
        const Vec3d facet = Vec3d(-x, 1, -z).normalized();
        const Vec3d mirrored = direction - facet * (2 * direction.dot(facet));
        if (direction.dot(facet) >= 0 || mirrored.y <= 0) continue;
        sum += mirrored.y, ++i;
      }
      square += (sum / samples - truth) * (sum / samples - truth);
    }
    errors.push_back(std::sqrt(square / pixels));
  }
  return errors;
}

StabilityResult facet_noise(const StabilityRun& run) {
  StabilityResult result;
  const int size = run.effort < 0.5 ? 8 : 16;
  // The logarithm of an RMSE of P pixels deviates by 1 / sqrt(2 P); over four steps of log 4 the slope by
  // 1 / sqrt(2 P) / (log 4 sqrt 5). Four of that.
  const double noise = 4 / std::sqrt(2.0 * size * size) / (std::log(4.0) * std::sqrt(5.0));
  result.figures.push_back(known_failure("independent facets", "exponent of RMSE over facets, gradient",
                                         error_slope(independent_errors(size * size)), -0.5 - noise, -0.5 + noise,
                                         "-1/2: noise of independent draws"));
  // Even points: -3/4 where what is seen has edges, which the facets that are redrawn make too, down to -1 where it is
  // smooth. Squares toward the horizon are smaller than the points' spacing, and there even points are independent
  // ones.
  const auto exponent = [&](bool checker) { return error_slope(rendered_errors(run, size, checker)); };
  result.figures.push_back(held("Owen-scrambled Sobol points", "exponent of RMSE over facets, gradient",
                                exponent(false), -1 - noise, -0.75 + noise, "-3/4 to -1: N^(-3/4) at edges"));
  result.figures.push_back(held("Owen-scrambled Sobol points", "exponent of RMSE over facets, checker", exponent(true),
                                -0.75 - noise, -0.5, "-3/4 at edges, -1/2 toward the horizon"));
  for (const int samples : {4, 64})
    add_picture(run, result, samples == 4 ? "4 facets a sample" : "64 facets a sample",
                rough_scene(160, samples, true));
  return result;
}

/// Mirrored directions seen along the surface: a hundredth a pixel, the horizon at two thirds of the height. Orange
/// below it.
template <class Mirrored>
StabilityPicture mirrored_picture(std::string caption, std::uint32_t points, const Mirrored& mirrored) {
  constexpr int kWidth = 180, kHeight = 120, kHorizon = 80;
  std::vector<int> counts(std::size_t(kWidth) * kHeight);
  for (std::uint32_t i = 0; i < points; ++i) {
    const Vec3d r(mirrored(i));
    const int x = static_cast<int>(std::floor(r.z * 100)) + kWidth / 2;
    const int y = kHorizon - 1 - static_cast<int>(std::floor(r.y * 100));
    if (x >= 0 && x < kWidth && y >= 0 && y < kHeight) ++counts[std::size_t(y) * kWidth + std::size_t(x)];
  }
  return painted_picture(
      std::move(caption), kWidth, kHeight,
      [&](int x, int y) {
        const double density = 1 - std::exp(-counts[std::size_t(y) * kWidth + std::size_t(x)] * 2e4 / points);
        const PaintedColor ground = y < kHorizon ? gray(0.01) : gray(0.06);
        const PaintedColor light = y < kHorizon ? PaintedColor{0.3, 0.6, 0.9} : kFaultColor;
        return PaintedColor{ground.r + density * light.r, ground.g + density * light.g, ground.b + density * light.b};
      },
      2);
}

void add_mirrored_pictures(StabilityResult& result, const StabilityRun& run) {
  if (!run.pictures) return;
  constexpr std::uint32_t kPoints = 1 << 14;
  const Material mirror = rough_mirror(0.1f);
  const ShadingPoint point = level_point(mirror, 80);
  const Vec3f normal(0, 1, 0), v = point.direction;
  const TangentFrame frame = tangent_frame(normal);
  result.pictures.push_back(mirrored_picture(
      "R of facets as they are drawn, roughness .1 at 80 degrees: below the horizon (orange)", kPoints,
      [&](std::uint32_t i) {
        const Vec3f facet =
            facet_normal(normal, frame, Vec2f(normal_deviates(low_discrepancy_point(i, 28))) * mirror.roughness);
        return v - facet * (2 * v.dot(facet));
      }));
  result.pictures.push_back(
      mirrored_picture("Redrawn: R of facets that serve, none below", kPoints,
                       [&](std::uint32_t i) { return rough_branches(point, 1.5f, 28, i, kPoints).reflected; }));
}

StabilityResult below_surface(const StabilityRun& run) {
  StabilityResult result;
  const int points = scaled(run, 1 << 16, 1 << 12);
  double lowest = 1, worst_mean = 0, allowed = 0;
  struct Published {
    double degrees, roughness, share;
  };
  for (const Published& known : {Published{80, 0.1, 0.193}, {60, 0.2, 0.100}}) {
    const Material mirror = rough_mirror(static_cast<float>(known.roughness));
    const ShadingPoint point = level_point(mirror, known.degrees);
    const Vec3f normal(0, 1, 0);
    const TangentFrame frame = tangent_frame(normal);
    int refused = 0;
    double height = 0, square = 0;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(points); ++i) {
      const Vec2f slopes = Vec2f(normal_deviates(low_discrepancy_point(i, 28))) * mirror.roughness;
      refused += !facet_serves(point, facet_normal(normal, frame, slopes), 1.5f);
      const Branches children = rough_branches(point, 1.5f, 28, i, static_cast<std::uint32_t>(points));
      lowest = std::min(lowest, double(children.reflected.y));
      height += double(children.reflected.y), square += double(children.reflected.y) * double(children.reflected.y);
    }
    const MirroredDirections truth(Vec3d(point.direction), known.roughness);
    const double share = 1 - truth.served(), mean = height / points;
    // Even points deviate by less than independent ones do; four deviations of those.
    const double noise = 4 * std::sqrt(share * (1 - share) / points);
    char quantity[80];
    std::snprintf(quantity, sizeof quantity, "share of R below the surface, %g degrees, sigma %g", known.degrees,
                  known.roughness);
    result.figures.push_back(known_failure("facets as they are drawn", quantity, refused / double(points),
                                           share - noise, share + noise,
                                           known.roughness < 0.15 ? "Q((90 - i) / 2 sigma) = .191, sampled .193"
                                                                  : "Q((90 - i) / 2 sigma) = .095, sampled .100"));
    worst_mean = std::max(worst_mean, std::abs(mean - truth.mean([](const Vec3d& r) { return r.y; })));
    allowed = std::max(allowed, 4 * std::sqrt((square / points - mean * mean) / points));
  }
  result.figures.push_back(held("redrawn", "lowest sine of R over the surface", lowest, 0, 1, "not below 0"));
  result.figures.push_back(held("redrawn", "mean sine of R less that of the density above the surface", worst_mean, 0,
                                allowed, "0, four deviations of independent points"));
  add_mirrored_pictures(result, run);
  return result;
}

}  // namespace

std::vector<StabilityCase> rough_cases() {
  return {{27, "facet-noise", "Noise of perturbed normals",
           "a mirror of roughness .2 under a gradient and under a checker, 4 to 256 facets a sample",
           "facets from scrambled even points; off: independent draws", "Whitted 1980, p. 345", facet_noise},
          {28, "facets-below", "Perturbed rays that go below the surface", "roughness .1 seen at 80 degrees, .2 at 60",
           "facets that do not serve are redrawn; off: as they come", "Whitted 1980, sec. 2", below_surface}};
}

}  // namespace raytree::benchmarks
