// What a run of the stability suite found, as a table for people and as JSON for programs.
#pragma once

#include <string>
#include <string_view>

#include "benchmarks/stability/stability.h"

namespace raytree::benchmarks {

/// "holds", "fails as known", "fails".
std::string_view verdict_words(StabilityVerdict verdict);

/// A figure in the fewest digits that tell it: four significant ones, counts whole, "not measured" for NaN.
std::string figure_text(double value);

/// Where a figure must lie: "[0, 1e-6]", "1 ± 1.0e-06"; "0" where that is one number.
std::string interval_text(const StabilityFigure& figure);

/// "no-offsets, not-robust"; empty: none.
std::string planted_text(const StabilityFaults& faults);

/// "52 cases; 143 figures: 90 hold, 53 fail as known, 0 fail".
std::string counts_text(const StabilityReport& report);

/// Table: case, method, measured, best known, verdict; then the counts.
std::string stability_text(const StabilityReport& report);
/// `maps`: JSON that stands as "maps" beside the cases; empty: none.
std::string stability_json(const StabilityReport& report, const std::string& maps = {});

}  // namespace raytree::benchmarks
