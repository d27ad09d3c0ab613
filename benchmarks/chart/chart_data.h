// What a chart holds once it is measured, and what follows from it: the Pareto front and the findings in words.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/chart/chart_reference.h"
#include "benchmarks/chart/chart_settings.h"
#include "benchmarks/chart/error_metrics.h"
#include "benchmarks/measurement.h"

namespace raytree::benchmarks {

struct ChartPoint {
  ChartSetting setting;
  std::string command;                            ///< whole, as a shell takes it
  std::string key;                                ///< hash of what is rendered: settings of one key are one point
  std::vector<double> cpu_seconds, wall_seconds;  ///< a sample each repetition
  double build_seconds = 0;
  std::array<std::uint64_t, kRayKindCount> rays{};
  std::vector<double> peak_bytes;  ///< a sample each repetition; none where the system does not tell
  std::uint64_t film_bytes = 0, array_bytes = 0, tracer_bytes = 0;  ///< by their sizes
  ErrorMetrics errors;
  std::vector<std::byte> picture;  ///< PNG
  std::string picture_hash;        ///< of its light, bit for bit
  bool repeats = true;             ///< every repetition gave the same picture, bit for bit

  Spread cpu() const { return spread_of(cpu_seconds); }
  Spread wall() const { return spread_of(wall_seconds); }
  std::uint64_t counted_bytes() const { return film_bytes + array_bytes + tracer_bytes; }
  /// Peak, median of the repetitions; where it could not be measured, what is counted by sizes.
  double memory_bytes() const {
    return peak_bytes.empty() ? static_cast<double>(counted_bytes()) : spread_of(peak_bytes).median;
  }
};

struct ChartData {
  std::string scene, title;
  std::string scene_hash, version, machine;
  int width = 0, height = 0, threads = 0;
  double budget_seconds = 0;
  ReferencePlan plan;
  std::string reference_command;  ///< of the half with more samples
  double reference_seconds = 0;
  ErrorMetrics floor;
  std::vector<std::byte> reference_picture;  ///< PNG
  std::vector<ChartPoint> points;            ///< measured, in the order of the sweep
  std::vector<std::string> left_out;         ///< what was not measured, and why; a sentence each
  bool complete = true;                      ///< false: interrupted
};

/// A setting as the front sees it: smaller is better.
struct CostAndError {
  double cost = 0, error = 0;
};

/// Indices of the points that no other dominates (none is at most as dear and at most as wrong, and better in one of
/// the two), from cheap to dear. Points that are not finite never are on it; of equal points the first is.
std::vector<std::size_t> pareto_front(const std::vector<CostAndError>& points);

/// Of median processor seconds against a metric.
std::vector<std::size_t> chart_front(const ChartData& data, const MetricInfo& metric);

struct HalvingCost {
  double factor = 1;         ///< of time, for half of the error
  std::size_t settings = 0;  ///< that tell it: those above the floor
};

/// By what factor time grows along a front with each halving of the error, by least squares in logarithms over the
/// points above the floor; none where fewer than three are left.
std::optional<HalvingCost> cost_of_halving(const std::vector<CostAndError>& front, double floor);

/// One finding: a sentence, and the point it speaks of.
struct Finding {
  std::string text;
  std::optional<std::size_t> point;
};
std::vector<Finding> findings_of(const ChartData& data);

/// "0.42 s", "38 ms".
std::string short_seconds(double seconds);
/// Three digits: "0.00123", "1.2e-05".
std::string short_number(double value);

}  // namespace raytree::benchmarks
