// Rows 59 to 62: numbers on their way to a file and to a display.
#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "benchmarks/samples/rough_mirror.h"
#include "benchmarks/scratch_folder.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/picture_parts.h"
#include "renderer/film_image.h"
#include "renderer/image_file.h"

namespace raytree::benchmarks {
namespace {

using namespace samples;

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargestHalf = 65504;

// --- row 59 ---

/// The film's color as it comes back from an EXR file.
DecodedImage written_and_read(const Film& film, bool half, EncodeReport& report) {
  const ScratchFolder folder;
  const std::string file = folder.path() / "values.exr";
  report = write_image_file(file, scene_linear_image(film, half, {}), ImageFormat::exr);
  return read_image_file(file);
}

/// A lamp of 2e5 in the middle, shown as shares of that: as floats, and as the EXR file has it in half; what is
/// infinite orange.
void add_half_pictures(StabilityResult& result) {
  constexpr int kSize = 45;
  constexpr double kPeak = 2e5;
  Film film(kSize, kSize, {0, 0, kSize, kSize}, {ChannelGroup::color});
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSize * kSize; ++i) {
      const double x = i % kSize - kSize / 2, y = i / kSize - kSize / 2;
      film.plane(ChannelGroup::color, c)[i] = static_cast<float>(kPeak * std::exp(-(x * x + y * y) / 150));
    }
  const float* const values = film.plane(ChannelGroup::color, 0);
  EncodeReport report;
  const DecodedImage clamped = written_and_read(film, true, report), full = written_and_read(film, false, report);
  const auto add = [&](std::string caption, const auto& value) {
    result.pictures.push_back(painted_picture(
        std::move(caption), kSize, kSize,
        [&](int x, int y) {
          const double light = double(value(static_cast<std::size_t>(y * kSize + x))) / kPeak;
          return std::isfinite(light) ? gray(light) : kFaultColor;
        },
        4));
  };
  const auto plane_of = [](const DecodedImage& image) {
    return image.planes[static_cast<std::size_t>(image.plane_index("R"))].data();
  };
  add("A lamp of 2e5, half as OpenEXR rounds: infinite from 65520 on (orange)",
      [&](std::size_t i) { return imath_half_to_float(imath_float_to_half(values[i])); });
  add("Half, clamped: 65504 at most, counted", [&](std::size_t i) { return plane_of(clamped)[i]; });
  add("float32, the default: as it is", [&](std::size_t i) { return plane_of(full)[i]; });
}

StabilityResult half_overflow(const StabilityRun& run) {
  StabilityResult result;
  constexpr std::size_t kCount = 6;
  const float values[kCount] = {65504, 65519, 65520, 1e30f, -7e4f, 1e-8f};
  Film film(kCount, 1, {0, 0, kCount, 1}, {ChannelGroup::color});
  for (int c = 0; c < 3; ++c) std::copy(values, values + kCount, film.plane(ChannelGroup::color, c));
  // OpenEXR's own conversion, Imath's: what is written where nobody looks.
  int infinite = 0;
  for (const float value : values) infinite += !std::isfinite(imath_half_to_float(imath_float_to_half(value)));
  result.figures.push_back(known_failure("half as OpenEXR rounds", "of 65519, 65520, 1e30, -7e4: become infinite",
                                         infinite, 3, 3, "from 65520 on all; 65519 becomes 65504"));
  EncodeReport half_report, full_report;
  const DecodedImage half = written_and_read(film, true, half_report),
                     full = written_and_read(film, false, full_report);
  const auto plane = [](const DecodedImage& image) -> const std::vector<float>& {
    return image.planes[static_cast<std::size_t>(image.plane_index("R"))];
  };
  int bad = 0, changed = 0;
  float largest = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    bad += !std::isfinite(plane(half)[i]);
    largest = std::max(largest, std::abs(plane(half)[i]));
    changed += std::memcmp(&plane(full)[i], &values[i], sizeof(float)) != 0;
  }
  result.figures.push_back(held("half, clamped", "values read back that are infinite", bad, 0, 0, "0"));
  result.figures.push_back(held("half, clamped", "largest value read back", double(largest), double(kLargestHalf),
                                double(kLargestHalf), "65504, the largest half"));
  result.figures.push_back(held("half, clamped", "values counted as clamped",
                                static_cast<double>(half_report.half_clamped), 12, 12, "4 in each of 3 channels"));
  result.figures.push_back(
      known_failure("half", "1e-8 read back", double(plane(half)[5]), 0, 0, "0: below half of 2^-24, the least half"));
  result.figures.push_back(held("float32, the default", "values read back that differ in any bit", changed, 0, 0, "0"));
  if (run.pictures) add_half_pictures(result);
  return result;
}

// --- row 60 ---

/// Gray with a disc of infinite light, on the left below a square of NaN, on the right one of -2; each through
/// `shown`, which takes linear light to a display's.
template <class Shown>
StabilityPicture bad_values_picture(std::string caption, const Shown& shown) {
  constexpr int kSize = 44;
  return painted_picture(
      std::move(caption), kSize, kSize,
      [&](int x, int y) {
        float light = 0.18f;
        if (std::hypot(x - kSize / 2 + 0.5, y - 13.5) < 9) light = kInfinite;
        if (y >= 28 && y < 40) light = x < 18 && x >= 6 ? kNotANumber : x >= 26 && x < 38 ? -2.0f : light;
        const float value = shown(light);
        // Painted light is shown as its root.
        return value >= 0 && value <= 1 ? gray(double(value) * double(value)) : kFaultColor;
      },
      4);
}

StabilityResult display_values(const StabilityRun& run) {
  StabilityResult result;
  DisplayOptions options;
  options.ocio_config = "builtin";
  int bad = 0, views = 0;
  std::int64_t counted = 0;
  float apart = 0;
  const auto transform_of = [&](const std::string& display, const std::string& view) {
    options.display = display, options.view = view;
    return DisplayTransform(options);
  };
  for (const DisplayChoices& choice : DisplayTransform(options).choices())
    for (const std::string& view : choice.views) {
      const DisplayTransform transform = transform_of(choice.display, view);
      float rgb[] = {kInfinite,  1,          1, kNotANumber, kNotANumber, kNotANumber,
                     -kInfinite, -kInfinite, 2, -2,          3e38f,       -3e38f};
      counted += transform.apply(rgb, 4);
      for (const float v : rgb) bad += !std::isfinite(v);
      float bright[] = {kInfinite, 1, 1, kLargestHalf, 1, 1};
      transform.apply(bright, 2);
      for (int c = 0; c < 3; ++c) apart = std::max(apart, std::abs(bright[c] - bright[c + 3]));
      ++views;
    }
  result.figures.push_back(held("made finite first", "values that are not finite behind any view", bad, 0, 0, "0"));
  result.figures.push_back(held("made finite first", "infinite red less red of 65504, any view", double(apart), 0, 0,
                                "0: the brightest there is; unguarded, ACES SDR turns it to 4e-11, black"));
  result.figures.push_back(
      held("made finite first", "values counted, a view", double(counted) / views, 6, 6, "6 of 12 were not finite"));
  float values[] = {kInfinite, kInfinite, kInfinite, kNotANumber, kNotANumber, kNotANumber};
  transform_of("sRGB", "ACES SDR").apply(values, 2);
  result.figures.push_back(held("made finite first", "infinite light as ACES SDR shows it", double(values[0]), 0.99, 1,
                                "white, 1 but for the curve's shoulder"));
  result.figures.push_back(held(
      "made finite first", "NaN as ACES SDR shows it, over black",
      [&] {
        float black[] = {0, 0, 0};
        transform_of("sRGB", "ACES SDR").apply(black, 1);
        return double(values[3] - black[0]);
      }(),
      0, 0, "0"));
  if (run.pictures) {
    result.pictures.push_back(bad_values_picture(
        "x / (1 + x), unguarded: infinite light, NaN and -2 are nothing that a display can show (orange)",
        [](float light) { return light / (1 + light); }));
    for (const char* const view : {"Standard", "ACES SDR"}) {
      const DisplayTransform transform = transform_of("sRGB", view);
      result.pictures.push_back(bad_values_picture(
          std::string(view) + ", made finite first: the brightest there is, and black", [&](float light) {
            float rgb[] = {light, light, light};
            transform.apply(rgb, 1);
            return std::clamp(rgb[0], 0.0f, 1.0f);
          }));
    }
  }
  return result;
}

// --- row 61 ---

/// A plane half of which reflects no number, seen by `size` x `size` pixels that the border does not touch but for the
/// middle column's samples.
SceneDescription poisoned(int size, int grid) {
  SceneDescription scene = dark_scene(size, front_camera(size));
  CheckerPattern edge;
  edge.plane = CheckerPattern::Plane::xy;
  edge.even = Rgb(kNotANumber), edge.odd = Rgb(1);
  edge.filtered = false;
  edge.size = 1000;
  edge.offset = {0.5, -500};  // in the middle of a column of pixels
  scene.ambient = Rgb(1);
  scene.materials = {material("m", edge)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.render.antialias = {Antialiasing::Method::grid, grid};
  return scene;
}

StabilityResult poisoned_pixels(const StabilityRun& run) {
  StabilityResult result;
  constexpr int kSize = 8, kGrid = 2, kSamples = kGrid * kGrid;
  const RenderResult rendered = rendered_for(run, poisoned(kSize, kGrid));
  int bad = 0;
  for (int i = 0; i < kSize * kSize; ++i) bad += !std::isfinite(rendered.film.plane(ChannelGroup::color, 0)[i]);
  // Samples of a pixel summed as they come: one of them is enough.
  int spread = 0;
  for (int x = 0; x < kSize; ++x) {
    float sum = 0;
    for (int s = 0; s < kGrid; ++s) sum += x + (s + 0.5) / kGrid - kSize / 2 > 0.5 ? kNotANumber : 1.0f;
    spread += std::isnan(sum);
  }
  result.figures.push_back(known_failure("samples summed as they are", "share of pixels that one bad half poisons",
                                         spread / double(kSize), 0.5, 0.5,
                                         "the pixels on the border too: a NaN spreads by the filter"));
  result.figures.push_back(held("bad samples count 0", "pixels that are no numbers", bad, 0, 0, "0 (pbrt-v4, same)"));
  result.figures.push_back(held("bad samples count 0", "samples counted / those that were bad",
                                double(rendered.statistics.not_finite_samples) / (kSize * (kSize / 2 - 0.5) * kSamples),
                                1, 1, "1: each is reported"));
  result.figures.push_back(held("bad samples count 0", "light of a pixel on the border",
                                double(color_at(rendered.film, kSize / 2, 0).r), 0.5, 0.5, "1/2: its good half"));
  if (run.pictures) {
    constexpr int kMagnified = 20;
    result.pictures.push_back(painted_picture(
        "Samples summed as they are: no number wherever one of four is none (orange)", kSize, kSize,
        [](int x, int) { return x < kSize / 2 ? gray(1) : kFaultColor; }, kMagnified));
    result.pictures.push_back(stability_picture("Bad samples count 0: the border keeps its good half", rendered.film));
    result.pictures.back().magnified = kMagnified;
  }
  return result;
}

// --- row 62 ---

/// A rough mirror in which a small lamp of radiance `lamp` is seen nowhere sharply: every pixel alike in the mean.
SceneDescription lamp_in_rough_mirror(int size, double roughness, int samples, double lamp, double angle) {
  SceneDescription scene = mirror_plane(size, roughness, samples);
  scene.ambient = Rgb(1);
  scene.materials.push_back(material("lamp", Rgb(static_cast<float>(lamp))));
  const Vec3d mirrored = Vec3d(0, 1, -1).normalized();
  scene.shapes.push_back(shape(SphereShape{mirrored * 1e5, 1e5 * std::sin(angle)}, "lamp"));
  return scene;
}

StabilityResult fireflies(const StabilityRun& run) {
  StabilityResult result;
  constexpr double kRoughness = 0.2, kLamp = 100, kAngle = 0.04;
  constexpr int kSamples = 16;
  const int size = run.effort < 0.5 ? 32 : 64;
  const Vec3d mirrored = Vec3d(0, 1, -1).normalized();
  const double chance = MirroredDirections(Vec3d(0, -1, -1).normalized(), kRoughness, 800).mean([&](const Vec3d& r) {
    return r.dot(mirrored) > std::cos(kAngle) ? 1.0 : 0.0;
  });
  const double truth = chance * kLamp;
  const RenderResult rendered = rendered_for(run, lamp_in_rough_mirror(size, kRoughness, kSamples, kLamp, kAngle));
  const auto pixels = std::size_t(size) * std::size_t(size);
  const double clamp = 2;
  std::vector<double> errors;
  double sum = 0, clamped = 0, all = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double value = double(rendered.film.plane(ChannelGroup::color, 0)[i]);
    sum += value, clamped += std::min(value, clamp);
    errors.push_back((value - truth) * (value - truth) / (truth * truth + 1e-2));
    all += errors.back();
  }
  std::sort(errors.begin(), errors.end());
  const auto kept = static_cast<std::size_t>(std::ceil(0.999 * double(pixels)));
  double trimmed = 0;
  for (std::size_t i = 0; i < kept; ++i) trimmed += errors[i];
  all /= double(pixels), trimmed /= double(kept);
  // N facets hit the lamp k times, independently at worst and once at most at best: variances p (1 - p) / N and
  // p (1 - N p) / N of L. Of P pixels the variance is known to 4 sqrt(kurtosis / P), the kurtosis being about
  // 3 + 1 / (N p).
  const double hits = kSamples * chance, scale = kLamp * kLamp * chance / kSamples / (truth * truth + 1e-2);
  const double noise = 4 * std::sqrt((3 + 1 / hits) / double(pixels));
  result.figures.push_back(known_failure("16 facets a sample", "relMSE of a lamp in a rough mirror", all,
                                         scale * (1 - hits) * (1 - noise), scale * (1 - chance) * (1 + noise),
                                         "p (1 - p) L^2 / N over the square of the mean: outliers rule"));
  result.figures.push_back(known_failure(
      "16 facets a sample", "relMSE without the worst thousandth / with it", trimmed / all, 0.9, 1 - 1e-3,
      ".95 to 1 - 1/1000: a thousandth of the pixels, three hits each, holds up to a twentieth of the error"));
  const double sigma = kLamp * std::sqrt(chance / kSamples / double(pixels));
  result.figures.push_back(held("nothing is clamped", "mean of the picture / the lamp's light",
                                sum / double(pixels) / truth, 1 - 4 * sigma / truth - 0.02,
                                1 + 4 * sigma / truth + 0.02, "1: unbiased; four deviations, and quadrature's 1/50"));
  // Each hit is worth L / N = 6.25, and clamped 2: of a Poisson number of hits, at least one.
  const double expected = clamp * (1 - std::exp(-hits)) / truth, best = clamp * hits / truth;
  const double clamped_noise = 4 * clamp * std::sqrt(hits / double(pixels)) / truth + 0.02 * best;
  result.figures.push_back(known_failure("pixels clamped to 2", "mean of the picture / the lamp's light",
                                         clamped / double(pixels) / truth, expected - clamped_noise,
                                         best + clamped_noise, "2 (1 - exp(-N p)) / (p L): the light is lost"));
  if (run.pictures)
    for (const int samples : {16, 256}) {
      constexpr double kShownLamp = 30;  // so that the mean is gray
      result.pictures.push_back(stability_picture(
          samples == 16 ? "16 facets a sample: fireflies where all should be one gray" : "256 facets a sample",
          rendered_for(run, lamp_in_rough_mirror(90, kRoughness, samples, kShownLamp, kAngle)).film));
      result.pictures.back().magnified = 2;
    }
  return result;
}

}  // namespace

std::vector<StabilityCase> number_cases() {
  return {
      {59, "half-overflow", "Radiance that 16 bits cannot hold", "65519, 65520, 1e30, -7e4 and 1e-8 to an EXR file",
       "clamped to 65504 and counted, or float32; off: the conversion of the library", "OpenEXR, half", half_overflow},
      {60, "display-values", "Infinity and NaN before the view", "infinite, NaN and negative values into every view",
       "values made finite before OpenColorIO sees them", "OpenColorIO issues 1707 and 1764", display_values},
      {61, "nan-pixels", "Samples that are no numbers", "a surface half of which reflects NaN, 4 samples a pixel",
       "bad samples count 0 and are reported; off: summed as they are", "pbrt-v4, integrators.cpp", poisoned_pixels},
      {62, "fireflies", "Rare bright samples", "a lamp of 100 and .04 radians in a mirror of roughness .2",
       "none but more facets: nothing is clamped in silence", "relMSE with and without the worst thousandth",
       fireflies}};
}

std::vector<StabilityCase> picture_cases() {
  std::vector<StabilityCase> all = number_cases();
  for (StabilityCase& one : determinism_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace raytree::benchmarks
