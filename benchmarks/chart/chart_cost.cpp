#include "benchmarks/chart/chart_cost.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytree::benchmarks {
namespace {

constexpr double kRendersPerBudget = 25;  ///< of the scene's own settings, that a budget should hold at kAssumedRays
constexpr int kWidthStep = 20;            ///< pixels; widths of charts are multiples of it
/// Pixels. Adaptive methods take more samples a pixel in smaller pictures: half as many again in 48 as in 96 pixels.
constexpr int kSizeProbeWidth = 96;

ChartSize of_width(const ImageDescription& image, int width) {
  const double height = static_cast<double>(image.height) * width / image.width;
  return {width, std::max(1, static_cast<int>(height))};
}

}  // namespace

double ray_cost(const SceneDescription& scene) { return scene.groups.empty() ? 1 : kRayCostInGroups; }

ChartRender small_picture(ChartScene scene, int width, int height, int threads, const std::atomic<bool>* stop,
                          int small_width) {
  small_width = std::min(width, small_width);
  scene.description.image = {small_width, std::max(1, small_width * height / width)};
  Warnings dropped;
  return render_timed(std::move(scene), threads, stop, dropped);
}

std::optional<double> expected_rays(ChartScene scene, int width, int height, int threads, const std::atomic<bool>* stop,
                                    int small_width) {
  const ChartRender small = small_picture(std::move(scene), width, height, threads, stop, small_width);
  if (!small.complete) return std::nullopt;
  const double pixels = static_cast<double>(small.film.window().width) * small.film.window().height;
  return static_cast<double>(small.total_rays()) * (static_cast<double>(width) * height / pixels);
}

std::optional<ChartSize> affordable_size(const ChartSceneMaker& make, double budget_seconds, int threads,
                                         const std::atomic<bool>* stop) {
  ChartScene scene = make({});
  const ImageDescription image = scene.description.image;
  const double cost = ray_cost(scene.description);
  const ChartSize widest = of_width(image, std::min(image.width, kWidestChart));
  const std::optional<double> rays =
      expected_rays(std::move(scene), widest.width, widest.height, threads, stop, kSizeProbeWidth);
  if (!rays) return std::nullopt;
  const double affordable = budget_seconds * kAssumedRays / kRendersPerBudget / cost;
  if (*rays <= affordable) return widest;
  const int width = static_cast<int>(widest.width * std::sqrt(affordable / *rays)) / kWidthStep * kWidthStep;
  return of_width(image, std::clamp(width, std::min(kNarrowestChart, widest.width), widest.width));
}

}  // namespace raytree::benchmarks
