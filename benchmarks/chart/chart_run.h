// Measures a chart: the reference, then setting after setting, then all of them again by turns until their times are
// known or the budget is spent. Files are chart_files.h's matter.
#pragma once

#include <functional>

#include "benchmarks/chart/chart_data.h"

namespace raytree::benchmarks {

struct ChartOptions {
  ChartSceneMaker make;
  Words command;  ///< what heads every point's command: "raytree", "render", the scene, flags of the whole chart
  std::vector<Words> added;  ///< settings of the user's own
  std::string version;
  double budget_seconds = 120;  ///< wall
  int threads = 1;
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> on_phase;  ///< what begins, in a few words
  std::function<void(const Film&)> keep_reference;   ///< a reference that was made anew
  std::function<void(const ChartData&)> save;        ///< now and then, so that little is lost
};

/// What an earlier run left: points that need no measuring, and its reference. See chart_files.h.
struct EarlierChart {
  ChartData data;
  std::optional<Film> reference;
};

struct MeasuredChart {
  ChartData data;
  std::optional<Film> reference;  ///< none: stopped before there was one
  std::size_t points_kept = 0;    ///< of the earlier chart's
};

/// Throws Error for a scene that cannot be prepared or drawn.
MeasuredChart measure_chart(const ChartOptions& options, const EarlierChart* earlier, Warnings& warnings);

/// Whether two charts are of one scene, size, program and machine, so that points of one may stand in the other.
bool same_subject(const ChartData& a, const ChartData& b);

}  // namespace raytree::benchmarks
