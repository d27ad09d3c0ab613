// What a chart leaves in its folder, each file whole or not at all: chart.html, chart.svg, points.csv, chart.json; and
// pictures/ and reference.exr, from which a later run goes on.
#pragma once

#include <optional>
#include <string>

#include "benchmarks/chart/chart_run.h"

namespace raytree::benchmarks {

std::string chart_json(const ChartData& data);
std::string chart_csv(const ChartData& data);

/// What an earlier run left in the folder; none where there is no chart.json. Points whose picture is missing are left
/// out. Throws Error (bad_input) for a chart.json that is not a chart's.
std::optional<EarlierChart> read_earlier_chart(const std::string& folder);

/// Writes all files; pictures first, so that chart.json names none that is missing. Throws Error (failure).
void write_chart(const std::string& folder, const ChartData& data);
/// Written once, before any point.
void write_reference(const std::string& folder, const Film& reference);

}  // namespace raytree::benchmarks
