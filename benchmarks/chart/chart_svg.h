// A chart as a drawing: time against error, both logarithmic.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/chart/chart_data.h"

namespace raytree::benchmarks {

/// 1, 2 and 5 times powers of ten within [low, high]; powers of ten alone where there would be more than nine.
std::vector<double> logarithmic_ticks(double low, double high);

/// An SVG element that can stand alone or in a page, light and dark by the reader's choice: the front as a line, its
/// points named, dominated points greyed, quartiles of time and the reference's own error as bars, the floor below
/// which no error is known. Every point is an element of class "point" with its index in data-point.
std::string chart_svg(const ChartData& data, const MetricInfo& metric);

}  // namespace raytree::benchmarks
