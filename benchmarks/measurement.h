// What the benchmarks' rows share: timed pairs side by side, their median and spread, and figures held to a bound. No
// row prints; measure_main.cpp does.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace raytree::benchmarks {

/// Median and quartiles of a set of samples.
struct Spread {
  double low = 0, median = 0, high = 0;
  int count = 0;
};
/// Quartiles by linear interpolation between order statistics. An empty set gives NaN.
Spread spread_of(std::vector<double> samples);

struct PairLimits {
  int least = 7, most = 25;    ///< pairs
  double enough = 0.01;        ///< stops once the median's uncertainty, (high - low) / median / sqrt(count), is less
  double least_seconds = 1.5;  ///< and so much time has been spent
};

/// Runs a and b in turn (a b a b ...), after one run of each that does not count.
struct PairedSpread {
  Spread a, b;   ///< what each returned
  Spread ratio;  ///< of a over b, pair by pair
};
PairedSpread measure_pairs(const std::function<double()>& a, const std::function<double()>& b,
                           const PairLimits& limits);

enum class BoundKind { none, at_least, at_most, within };

/// Where a figure stands in its row's chart.
struct ChartPlace {
  std::string plot;  ///< of the row's plots
  std::string line;  ///< empty: in none
  double x = std::numeric_limits<double>::quiet_NaN();
};

/// One line of the table.
struct Figure {
  std::string row;   ///< e.g. "floor"
  std::string what;  ///< with the scene, the size, the threads
  std::string unit;  ///< e.g. "s", "%"; empty: a ratio
  Spread measured;
  BoundKind kind = BoundKind::none;
  double bound = 0;
  double upper = 0;  ///< of `within`: from `bound` to this
  /// Of `within`: what the figure is off by for no reason of its own, as a share; it holds where its quartiles, widened
  /// by this, reach the interval.
  double noise = 0;
  double chase = std::numeric_limits<double>::quiet_NaN();  ///< what is aimed at beyond the bound; NaN: nothing
  std::string note;                                         ///< what lies behind the figure; printed under the table
  std::string problem;  ///< why there is no figure, or why it does not count; empty: it does
  ChartPlace place;

  bool holds() const;
};

/// ">= 0.55 (chase 0.65)", "1.95 to 2.25", with the unit; empty without a bound.
std::string bound_text(const Figure& figure);
std::string table_head();
std::string table_line(const Figure& figure);
/// The figures and the header's lines as JSON, ending in a newline.
std::string figures_json(const std::vector<std::pair<std::string, std::string>>& header,
                         const std::vector<Figure>& figures);

}  // namespace raytree::benchmarks
