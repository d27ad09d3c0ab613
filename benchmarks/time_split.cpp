// Row split: where a picture's time goes, in the parts that Whitted reports (1980, sec. 4): 13 % overhead, 75 %
// intersection, 12 % shading.
#include <fmt/format.h>

#include "benchmarks/reference_scenes.h"
#include "benchmarks/rows.h"
#include "renderer/render.h"

namespace raytree::benchmarks {
namespace {

constexpr int kRuns = 7;

}  // namespace

std::vector<Figure> measure_time_split(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const bool with_mesh : {false, true}) {
    const Scene scene = prepared(with_mesh ? reference_scene_with_mesh() : reference_scene());
    context.progress("split: " + scene.description.name);
    RenderOptions options;
    options.threads = 1;
    render(scene, options);
    std::vector<double> parts[3];
    for (int run = 0; run < kRuns; ++run) {
      const RenderStatistics statistics = render(scene, options).statistics;
      const double percent = 100 / statistics.thread_seconds;
      parts[0].push_back(percent * statistics.overhead_seconds());
      parts[1].push_back(percent * statistics.intersection_seconds);
      parts[2].push_back(percent * statistics.shading_seconds);
    }
    constexpr const char* kNames[3] = {"overhead", "intersection", "shading"};
    constexpr int kPaper[3] = {13, 75, 12};
    for (int i = 0; i < 3; ++i) {
      Figure figure;
      figure.row = "split";
      figure.what = fmt::format("{} (Whitted 1980: {} %), {}, 1 thread", kNames[i], kPaper[i], scene.description.name);
      figure.unit = std::string("%");
      figure.measured = spread_of(parts[i]);
      figures.push_back(figure);
    }
  }
  return figures;
}

}  // namespace raytree::benchmarks
