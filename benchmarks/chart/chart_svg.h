// A chart as a drawing: time against error, both logarithmic.
#pragma once

#include <string>

#include "benchmarks/chart/chart_data.h"

namespace raytree::benchmarks {

/// An SVG element that can stand alone or in a page, light and dark by the reader's choice: the front as a line, its
/// points named, dominated points greyed, quartiles of time and the reference's own error as bars, the floor below
/// which no error is known. Every point is an element of class "point" with its index in data-point.
std::string chart_svg(const ChartData& data, const MetricInfo& metric);

}  // namespace raytree::benchmarks
