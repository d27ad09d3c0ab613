// Graphs of the stability suite as inline SVG, drawn as those of other benchmarks are.
#pragma once

#include <string>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

/// An <svg> element; both axes logarithmic, a tick at each decade of y and each x that a line has. Empty where no point
/// can be drawn.
std::string graph_svg(const StabilityGraph& graph);

}  // namespace raytree::benchmarks
