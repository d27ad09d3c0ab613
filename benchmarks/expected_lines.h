// What the table of `./run measure` holds before anything is measured: its lines and their bounds.
#pragma once

#include <vector>

#include "benchmarks/measurement.h"

namespace raytree::benchmarks {

/// Every line of the table: row, bound and unit, and in `what` the text with `*` for what a run decides, such as
/// numbers of rays. A line may stand for many, as those of `naive` do.
const std::vector<Figure>& expected_lines();

/// Whether lines of `expected` may have any interval as their bound, or none (of `ratios`).
bool takes_any_interval(const Figure& expected);

}  // namespace raytree::benchmarks
