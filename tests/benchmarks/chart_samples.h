// A chart without a render behind it, and what tests of its measurements share.
#pragma once

#include <string>

#include "benchmarks/chart/chart_data.h"

namespace raytree::test {

/// Why tests of peak memory are left out where PeakMemory knows none.
inline constexpr const char* kNoPeakMemory = "LEFT OUT: /proc/self/clear_refs does not work here";

/// A point that took so long and is off by so much, in every metric.
inline benchmarks::ChartPoint charted_point(const std::string& knob, const std::string& value, double seconds,
                                            double error) {
  using namespace benchmarks;
  ChartPoint point;
  point.setting = {knob, value, {"--" + knob, value}, SweepPart::between};
  if (knob == "defaults") point.setting = {knob, value, {}, SweepPart::defaults};
  point.command = "raytree render cone --size 4x4 " + command_text(point.setting.flags);
  point.key = text_hash(point.command);
  point.cpu_seconds = {seconds, 0.98 * seconds, 1.02 * seconds};
  point.wall_seconds = {seconds / 2, seconds / 2};
  point.rays = {16, 8, 4, 2};
  point.film_bytes = 128;
  point.array_bytes = 1000;
  point.tracer_bytes = 10'000;
  point.peak_bytes = {2.5e6, 2.4e6, 2.6e6};
  for (const MetricInfo& metric : kMetrics) point.errors.*metric.value = error;
  point.picture = {std::byte{1}, std::byte{2}};
  point.picture_hash = "0123";
  return point;
}

/// Time doubles as the error halves, from .1 s and .2 on; `knob` "wasteful" is dominated.
inline benchmarks::ChartData sample_chart() {
  using namespace benchmarks;
  ChartData data;
  data.scene = "cone";
  data.title = "A <cone> & more";
  data.scene_hash = "00ff";
  data.version = "0.0.0";
  data.machine = "here";
  data.width = data.height = 4;
  data.threads = 2;
  data.plan.words = "two halves";
  data.plan.grid = 3;
  data.reference_picture = {std::byte{7}};
  data.floor.rmse = 1e-4;
  data.points.push_back(charted_point("defaults", "the scene's own", 0.5, 0.05));
  for (int i = 0; i < 8; ++i)
    data.points.push_back(charted_point("levels", std::to_string(i), 0.1 * (1 << i), 0.2 / (1 << i)));
  data.points.push_back(charted_point("wasteful", "1", 3, 0.0501));
  return data;
}

}  // namespace raytree::test
