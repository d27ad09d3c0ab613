// The chart as one HTML page that needs no network: findings, charts, pictures side by side, table.
#pragma once

#include <string>

#include "benchmarks/chart/chart_data.h"

namespace raytree::benchmarks {

std::string chart_page(const ChartData& data);

}  // namespace raytree::benchmarks
