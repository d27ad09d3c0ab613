// Rows 4 and 5: bands that the eye sees where the light's value or slope breaks, as the response of its center and
// surround (a difference of Gaussians over the logarithm of light).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_circle.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "geometry/angle.h"

namespace raytree::benchmarks::facets {
namespace {

constexpr double kCenterSigma = 2, kSurroundSigma = 4;  ///< pixels
constexpr int kKernelReach = 20;                        ///< pixels: five times the wider sigma
constexpr double kMachRadius = 1000;                    ///< of the cylinder, pixels
constexpr int kMachWidth = 1100;  ///< pixels; the middle half of the cylinder and the kernel's reach
constexpr double kWeber = 0.01;   ///< the least relative step of light that is seen

/// Difference of Gaussians, sums to 0: [2 kKernelReach + 1].
std::vector<double> center_and_surround() {
  std::vector<double> kernel(2 * kKernelReach + 1);
  for (const double sigma : {kCenterSigma, kSurroundSigma}) {
    std::vector<double> gaussian;
    double sum = 0;
    for (int i = -kKernelReach; i <= kKernelReach; ++i) {
      gaussian.push_back(std::exp(-i * i / (2 * sigma * sigma)));
      sum += gaussian.back();
    }
    for (std::size_t i = 0; i < kernel.size(); ++i) kernel[i] += (sigma == kCenterSigma ? 1 : -1) * gaussian[i] / sum;
  }
  return kernel;
}

/// Largest |DoG * log(light / truth)| where the kernel lies within the middle half of the cylinder, in Weber's units.
template <class Values>
double mach_response(const Values& light, const std::vector<double>& truth) {
  const std::vector<double> kernel = center_and_surround();
  const auto half = static_cast<int>(kMachRadius / 2);
  double largest = 0;
  for (int x = kMachWidth / 2 - half; x < kMachWidth / 2 + half; ++x) {
    double sum = 0;
    for (int i = -kKernelReach; i <= kKernelReach; ++i) {
      const auto at = static_cast<std::size_t>(x + i);
      sum += kernel[static_cast<std::size_t>(i + kKernelReach)] * std::log(double(light[at]) / truth[at]);
    }
    largest = std::max(largest, std::abs(sum));
  }
  return largest / kWeber;
}

struct MachResponse {
  double seen = 0, predicted = 0;
};

/// A matte cylinder with a corner toward the viewer, and, with sides a multiple of 12, at 30 degrees.
MachResponse mach_response_of(int sides, ShadingMethod method, const StabilityRun& run) {
  const std::vector<double> centers = pixel_centers(kMachWidth, 1 / kMachRadius);
  const FacetedCircle facets(sides, -90), circle(0, 0);
  std::vector<double> truth, predicted;
  for (const double x : centers) {
    truth.push_back(circle.light(method, x, 1));
    predicted.push_back(facets.light(method, x, 1));
  }
  const SceneDescription scene = headlit_scene(faceted_cylinder(sides, method, -90), kMachWidth, 1, 1 / kMachRadius);
  return {mach_response(green_of(scene, run), truth), mach_response(predicted, truth)};
}

/// Sides that figures are given for, and more for the graph.
constexpr std::array<int, 4> kMachSides = {12, 24, 48, 96};

/// Rounding of light near 1 through a kernel whose magnitudes sum to less than 2, at light of at least cos 30 degrees.
const double kMachError = 2 * float_error() / std::cos(kPi / 6) / kWeber;

void add_mach_figures(StabilityResult& result, const char* name, ShadingMethod method, StabilityExpectation expectation,
                      const char* law, const StabilityRun& run) {
  StabilityGraph::Line seen{name, {}, false}, predicted{fmt::format("{}, closed form", name), {}, true};
  std::array<MachResponse, kMachSides.size()> responses;
  for (std::size_t i = 0; i < kMachSides.size(); ++i) {
    responses[i] = mach_response_of(kMachSides[i], method, run);
    seen.points.emplace_back(kMachSides[i], responses[i].seen);
    predicted.points.emplace_back(kMachSides[i], responses[i].predicted);
  }
  for (const std::size_t i : {std::size_t(1), std::size_t(2)})
    result.figures.push_back(predicted_figure(
        fmt::format("{}, {} sides", name, kMachSides[i]), "largest |DoG * log(light / truth)|, in 1 % (Weber)",
        responses[i].seen, responses[i].predicted, kMachError,
        fmt::format("{:.4g} (closed form); smooth 0", responses[i].predicted), expectation));
  // To first order in the angle between facets, 2 pi / k; at 24 sides the next terms are below a tenth: the square of
  // half that angle, and the true circle's own curvature within the kernel, 7.5 / (radius x angle cos 30).
  const double order = std::log2(responses[1].seen / responses[2].seen);
  const double angle = 2 * kPi / kMachSides[2];
  const double next = std::pow(kPi / kMachSides[1], 2) + 7.5 / (kMachRadius * angle * std::cos(kPi / 6));
  result.figures.push_back(predicted_figure(name, "how often it halves from 24 to 48 sides", order, 1,
                                            next / std::log(2.0), law, expectation));
  result.graphs.back().lines.push_back(std::move(seen));
  result.graphs.back().lines.push_back(std::move(predicted));
}

StabilityGraph mach_graph() {
  return {"Mach bands on a matte cylinder of 1000 pixels' radius",
          "sides",
          "largest |DoG * log(light / truth)|, in 1 %",
          {}};
}

/// What the eye's center and surround make of 24 sides, about the middle of the cylinder: gray where nothing, brighter
/// and darker by `gain` times log(light / truth).
void add_response_picture(StabilityResult& result, const StabilityRun& run, std::string caption, ShadingMethod method,
                          double gain) {
  if (!run.pictures) return;
  constexpr int kWidth = 620;
  const std::vector<double> kernel = center_and_surround();
  const FacetedCircle circle(0, 0);
  std::vector<double> truth;
  for (const double x : pixel_centers(kMachWidth, 1 / kMachRadius)) truth.push_back(circle.light(method, x, 1));
  const std::vector<float> light =
      green_of(headlit_scene(faceted_cylinder(24, method, -90), kMachWidth, 1, 1 / kMachRadius), run);
  result.pictures.push_back(painted_picture(std::move(caption), kWidth, 60, [&](int x, int) {
    double sum = 0;
    for (int i = -kKernelReach; i <= kKernelReach; ++i) {
      const auto at = static_cast<std::size_t>(x + (kMachWidth - kWidth) / 2 + i);
      sum += kernel[static_cast<std::size_t>(i + kKernelReach)] * std::log(double(light[at]) / truth[at]);
    }
    return gray(std::pow(std::clamp(0.5 + gain * sum, 0.0, 1.0), 2));
  }));
}

void add_cylinder_picture(StabilityResult& result, const StabilityRun& run, const char* caption, int sides,
                          ShadingMethod method) {
  add_picture(result, run, caption, headlit_scene(faceted_cylinder(sides, method, 90), 240, 180, 2.2), 240, 180);
}

StabilityResult flat_bands(const StabilityRun& run) {
  StabilityResult result;
  result.graphs.push_back(mach_graph());
  add_mach_figures(result, "flat", ShadingMethod::flat, StabilityExpectation::fails_as_known,
                   "1: a step of 2 (pi / k) tan 30 degrees", run);
  add_mach_figures(result, "Phong", ShadingMethod::phong, StabilityExpectation::holds,
                   "1: no steps, and what breaks of slope the facets' places leave", run);
  // DoG's largest response to a step of 1: where G_2 and G_4 are equal, at x^2 = 32/3 ln 2.
  const double at = std::sqrt(32 * std::log(2.0) / 3);
  const double response =
      0.5 * (std::erf(at / kCenterSigma / std::sqrt(2.0)) - std::erf(at / kSurroundSigma / std::sqrt(2.0)));
  const double angle = kPi / 48;
  const double step = std::log(std::cos(kPi / 6 - angle) / std::cos(kPi / 6 + angle));
  const MachResponse seen = mach_response_of(48, ShadingMethod::flat, run);
  // Samples stand up to half a pixel beside the largest response, which there falls as its second derivative says.
  const double slope = std::exp(-at * at / 8) * at / (std::pow(kCenterSigma, 3) * std::sqrt(2 * kPi)) / 8;
  result.figures.push_back({"flat, 48 sides", "the same over the response to one step", seen.seen * kWeber / step,
                            response - slope - kMachError * kWeber / step, response + 2 * angle * angle,
                            fmt::format("{:.4f} = Phi(x / 2) - Phi(x / 4) at x^2 = 32/3 ln 2", response),
                            StabilityExpectation::fails_as_known});
  add_cylinder_picture(result, run, "flat, 24 sides", 24, ShadingMethod::flat);
  add_cylinder_picture(result, run, "Phong, 24 sides", 24, ShadingMethod::phong);
  for (const auto& [caption, method] :
       {std::pair("What the eye's center and surround make of 24 flat sides, 15 times as strong", ShadingMethod::flat),
        {"The same of Phong's", ShadingMethod::phong}})
    add_response_picture(result, run, caption, method, 15);
  return result;
}

StabilityResult slope_bands(const StabilityRun& run) {
  StabilityResult result;
  result.graphs.push_back(mach_graph());
  add_mach_figures(result, "Gouraud", ShadingMethod::gouraud, StabilityExpectation::fails_as_known,
                   "1: a break of slope 2 (pi / k) |I''| (Gouraud 1971, sec. III)", run);
  add_mach_figures(result, "Phong", ShadingMethod::phong, StabilityExpectation::holds,
                   "1: its normals turn evenly, but points of facets lie off the circle", run);
  add_cylinder_picture(result, run, "Gouraud, 12 sides", 12, ShadingMethod::gouraud);
  add_cylinder_picture(result, run, "Phong, 12 sides", 12, ShadingMethod::phong);
  for (const auto& [caption, method] :
       {std::pair("What the eye's center and surround make of 24 sides by Gouraud, 1000 times as strong",
                  ShadingMethod::gouraud),
        {"The same of Phong's", ShadingMethod::phong}})
    add_response_picture(result, run, caption, method, 1000);
  return result;
}

}  // namespace

std::vector<StabilityCase> mach_band_cases() {
  return {{4, "flat-mach-bands", "Bands where the light of facets steps",
           "A matte cylinder of 12 to 96 flat sides, seen through the eye's center and surround",
           "Interpolated light has no steps, interpolated normals next to no breaks of slope",
           "Mach bands: Gouraud 1971, sec. III; Phong 1973, fig. 2.4", flat_bands},
          {5, "gouraud-mach-bands", "Bands where the slope of interpolated light breaks",
           "The same cylinder with light interpolated between its corners",
           "Interpolated normals: a fifth of the bands that is due to where the facets lie, and none head-on",
           "Gouraud 1971, sec. III: derivative discontinuities; B-58 engines, fig. 22", slope_bands}};
}

}  // namespace raytree::benchmarks::facets
