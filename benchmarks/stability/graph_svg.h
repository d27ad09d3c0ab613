// Graphs of the stability suite as inline SVG, drawn as those of other benchmarks are.
#pragma once

#include <string>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

/// An <svg> element. Ticks stand at whole decades of a logarithmic axis (of x at the lines' own places where those are
/// few), at round steps of a linear one. Empty where no point can be drawn.
std::string graph_svg(const StabilityGraph& graph);

}  // namespace raytree::benchmarks
