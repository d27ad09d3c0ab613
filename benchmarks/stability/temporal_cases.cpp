// Row 3 over time: a cylinder of facets turns through one of its sides in 90 frames, which on the true cylinder nobody
// would see.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/stability/facet_cases.h"
#include "benchmarks/stability/faceted_circle.h"
#include "benchmarks/stability/faceted_scenes.h"
#include "renderer/scene_fields.h"

namespace raytree::benchmarks::facets {
namespace {

constexpr int kTurningSides = 12;
constexpr double kTurningExponent = 20;
constexpr int kTurningWidth = 240;  ///< pixels
constexpr double kTurningPixel = 2.2 / kTurningWidth;

/// One row of pixels a frame.
using FrameRows = std::vector<std::vector<double>>;

struct TemporalError {
  double deviation = 0;       ///< of (frame - truth) over time, root mean square over pixels
  double worst = 0;           ///< of one pixel
  double highlight_jump = 0;  ///< of its center of gravity from frame to frame, pixels, the largest
};

TemporalError temporal_error(const FrameRows& frames, const std::vector<double>& truth) {
  TemporalError error;
  double sum_of_squares = 0;
  for (std::size_t x = 0; x < truth.size(); ++x) {
    double sum = 0, squares = 0;
    for (const auto& frame : frames) sum += frame[x] - truth[x];
    const double mean = sum / double(frames.size());
    for (const auto& frame : frames) squares += (frame[x] - truth[x] - mean) * (frame[x] - truth[x] - mean);
    sum_of_squares += squares / double(frames.size());
    error.worst = std::max(error.worst, std::sqrt(squares / double(frames.size())));
  }
  error.deviation = std::sqrt(sum_of_squares / double(truth.size()));
  const auto center = [](const std::vector<double>& row) {
    double weight = 0, moment = 0;
    for (std::size_t x = 0; x < row.size(); ++x) weight += row[x], moment += row[x] * double(x);
    return moment / weight;
  };
  // After the last frame comes the first again.
  for (std::size_t f = 0; f < frames.size(); ++f)
    error.highlight_jump =
        std::max(error.highlight_jump, std::abs(center(frames[(f + 1) % frames.size()]) - center(frames[f])));
  return error;
}

StabilityResult turning_cylinder(const StabilityRun& run) {
  StabilityResult result;
  const int frame_count = run.effort < 0.5 ? 30 : 90;
  const std::vector<double> centers = pixel_centers(kTurningWidth, kTurningPixel);
  std::vector<double> truth;
  for (const double x : centers) truth.push_back(FacetedCircle(0, 0).light(ShadingMethod::limit, x, kTurningExponent));
  for (const auto& [name, method, expectation, caption] :
       {std::tuple("flat", ShadingMethod::flat, StabilityExpectation::fails_as_known, "flat: steps"),
        {"Gouraud", ShadingMethod::gouraud, StabilityExpectation::fails_as_known,
         "Gouraud: the highlight swells, fades and leaps"},
        {"Phong", ShadingMethod::phong, StabilityExpectation::holds, "Phong: it stands still"},
        {"limit", ShadingMethod::limit, StabilityExpectation::holds, ""}}) {
    FrameRows seen, predicted;
    for (int f = 0; f < frame_count; ++f) {
      const double turned = 360.0 / kTurningSides * f / frame_count;
      const std::vector<float> row = green_of(highlit_scene(faceted_cylinder(kTurningSides, method, turned),
                                                            kTurningWidth, 1, kTurningPixel, kTurningExponent),
                                              run);
      seen.emplace_back(row.begin(), row.end());
      predicted.emplace_back();
      const FacetedCircle circle(kTurningSides, turned);
      for (const double x : centers) predicted.back().push_back(circle.light(method, x, kTurningExponent));
    }
    const TemporalError error = temporal_error(seen, truth), known = temporal_error(predicted, truth);
    // No corner comes within rounding of a pixel's center, so that each sees the facet that the formulas say.
    const double rounding = float_error(kTurningExponent);
    const char* where = method == ShadingMethod::flat      ? "closed form of the facets' normals"
                        : method == ShadingMethod::gouraud ? "closed form: cos^n linear between corners"
                                                           : "closed form: the radius through the facet's point";
    result.figures.push_back(predicted_figure(
        name, "deviation of (frame - truth) over time, RMS over pixels", error.deviation, known.deviation, rounding,
        fmt::format("{:.4f} ({}); true cylinder 0", known.deviation, where), expectation));
    result.figures.push_back(predicted_figure(name, "the same of the worst pixel", error.worst, known.worst, rounding,
                                              fmt::format("{:.4f}", known.worst), expectation));
    result.figures.push_back(predicted_figure(
        name, "the highlight's largest leap between frames, pixels", error.highlight_jump, known.highlight_jump,
        kTurningWidth * rounding, fmt::format("{:.4f}; true cylinder 0", known.highlight_jump), expectation));
    if (method == ShadingMethod::limit) continue;
    std::vector<float> picture;
    for (const auto& row : seen)
      for (int line = 0; line < 180 / frame_count; ++line) picture.insert(picture.end(), row.begin(), row.end());
    add_gray_picture(result, run, fmt::format("{} (a frame a row, time runs down)", caption), picture, kTurningWidth,
                     180 / frame_count * frame_count);
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> temporal_cases() {
  return {{3, "turning-facets", "What a turning cylinder shows of its facets",
           "A cylinder of 12 sides with a highlight turns through one side in 90 frames; the true one does not change",
           "Interpolate normals in place of light", "Phong 1973, sec. I.2: highlights that jump from frame to frame",
           turning_cylinder}};
}

}  // namespace raytree::benchmarks::facets
