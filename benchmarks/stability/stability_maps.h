// Where rays hold: rates of misses, false hits and self-hits over two quantities at a time, each against the truth in
// double. From a map follows its safe envelope; what docs/stability.md promises of it stands beside.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

struct MapAxis {
  std::string label;
  std::vector<std::string> values;  ///< from harmless to hard
};

/// Cells are row-major: [rows][columns].
struct MapQuantity {
  std::string name;           ///< "misses", "false hits", "self-hits"
  std::vector<double> rates;  ///< shares in [0, 1]; NaN where no ray could be asked
  /// The largest rate that docs/stability.md allows; NaN where it promises nothing.
  std::vector<double> promised;
};

inline constexpr double kNothingPromised = std::numeric_limits<double>::quiet_NaN();

struct StabilityMap {
  std::string name;    ///< "scale-offset"
  std::string title;   ///< "Scale and distance from the origin"
  std::string method;  ///< what is traced and what counts, a sentence or two
  MapAxis rows, columns;
  std::vector<MapQuantity> quantities;
  std::size_t rays = 0;  ///< asked in each cell
  std::string promise;   ///< the safe envelope as docs/stability.md has it, word for word
  std::string envelope;  ///< what this map shows: see clean_envelope()

  std::size_t cell(std::size_t row, std::size_t column) const { return row * columns.values.size() + column; }
};

/// Scene space coordinates throughout: what the renderer's recentering leaves of a scene's place.
std::vector<StabilityMap> stability_maps(const StabilityRun& run);

/// How far each row is clean, in words: "clean (all rates 0): 1e-6 up to 1e4; 1 up to 1e5".
std::string clean_envelope(const StabilityMap& map);

/// Cells where a rate is above what is promised, "self-hits at 1, 1e3: 0.5 instead of 0"; empty: the promise is kept.
std::vector<std::string> broken_promises(const StabilityMap& map);

std::string stability_maps_json(const std::vector<StabilityMap>& maps);

}  // namespace raytree::benchmarks
