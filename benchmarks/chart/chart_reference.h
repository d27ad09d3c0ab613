// What a chart takes for the truth: a picture of the limit surface with a deep tree, nothing or next to nothing cut and
// many samples, made twice over from different samples and facets, so that what is left of its own error is known.
#pragma once

#include <optional>
#include <string>

#include "benchmarks/chart/chart_render.h"
#include "benchmarks/chart/error_metrics.h"

namespace raytree::benchmarks {

/// How the reference is made. A function of scene, size and budget alone, never of how quick the machine is, so that
/// errors repeat.
struct ReferencePlan {
  int grid = 3;       ///< one half has grid^2 samples a pixel, the other (grid + 1)^2
  Words first, last;  ///< flags of the halves: the second's facets are half as large
  /// What a tree of any depth would change: RMSE in a small picture, by what the last levels of the tree changed.
  double depth_residual = 0;
  double cutoff = 0;  ///< radiance cut from a sample at most
  std::string words;  ///< what it is, in a sentence
  bool operator==(const ReferencePlan&) const = default;
};

/// Judges by rays counted in small pictures. None: stopped.
std::optional<ReferencePlan> plan_reference(const ChartSceneMaker& make, const SceneTraits& traits, int width,
                                            int height, double budget_seconds, int threads,
                                            const std::atomic<bool>* stop);

struct ChartReference {
  Film film{0, 0, {}, {}};  ///< mean of the halves, weighted by their samples
  /// Of the coarser half against the mean: somewhat more than the mean's own error, since independent halves lie on
  /// different sides of the truth. What no error of the chart can be told from.
  ErrorMetrics floor;
  double seconds = 0;  ///< wall time it took
};

/// None: stopped.
std::optional<ChartReference> make_reference(const ReferencePlan& plan, const ChartSceneMaker& make,
                                             const DisplayTransform& display, int threads,
                                             const std::atomic<bool>* stop, Warnings& warnings);

}  // namespace raytree::benchmarks
