// What row naive's figures and their chart share.
#pragma once

namespace raytree::benchmarks {

/// Shares of intersection that Whitted reports (1980, sec. 4), in percent: of "simple scenes", and what those of "more
/// complex scenes" are over. Which scenes were which he does not say.
inline constexpr double kSimpleShare = 75, kComplexShare = 95;

/// Plots of the chart.
inline constexpr const char *kRatioPlot = "ratio", *kSharePlot = "share";
/// Lines that are no series of one scene's sizes.
inline constexpr const char *kWhittedFigures = "his figures 6 and 7", *kDatabases = "Haines's databases";

}  // namespace raytree::benchmarks
