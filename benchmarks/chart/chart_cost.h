// What renders will take, told by small pictures of the same scene: by rays, which are counted and not timed, so that
// what is decided by them is the same on every run and machine.
#pragma once

#include <optional>

#include "benchmarks/chart/chart_render.h"

namespace raytree::benchmarks {

/// Rays a second that a budget is reckoned with, whatever the machine does.
inline constexpr double kAssumedRays = 4e6;
/// As many as that of them a ray counts for in a scene with groups: instances are traced more slowly.
inline constexpr double kRayCostInGroups = 3;
/// What one ray of the scene counts for.
double ray_cost(const SceneDescription& scene);
inline constexpr int kProbeWidth = 48;       ///< pixels; of small pictures
inline constexpr int kWidestChart = 400;     ///< pixels, where the user names no size; the scene's own if that is less
inline constexpr int kNarrowestChart = 120;  ///< pixels; less shows nothing

/// The scene in a picture `small_width` pixels wide, of about the shape of `width` x `height`.
ChartRender small_picture(ChartScene scene, int width, int height, int threads, const std::atomic<bool>* stop,
                          int small_width = kProbeWidth);

/// Rays that a picture of `width` x `height` will have, by the small one. None: stopped.
std::optional<double> expected_rays(ChartScene scene, int width, int height, int threads, const std::atomic<bool>* stop,
                                    int small_width = kProbeWidth);

struct ChartSize {
  int width = 0, height = 0;
};

/// The size of a chart's pictures where the user names none: the scene's own, at most kWidestChart wide, and smaller
/// where the budget would hold too few renders of so many pixels. None: stopped. Throws Error as preparing does.
std::optional<ChartSize> affordable_size(const ChartSceneMaker& make, double budget_seconds, int threads,
                                         const std::atomic<bool>* stop);

}  // namespace raytree::benchmarks
