// Stability maps as pictures of a page: inline SVG that needs no style sheet but the page's variables.
#pragma once

#include <cstddef>
#include <string>

#include "benchmarks/stability/stability_maps.h"

namespace raytree::benchmarks {

/// One quantity of a map, figures in the cells. Colors run over the logarithm of the rate, from pale to dark, in one
/// order of lightness for every kind of sight; cells without a failure are left as paper. A frame marks the cells that
/// docs/stability.md makes a promise of, a heavy red one where it is broken.
std::string heat_map_svg(const StabilityMap& map, std::size_t quantity);

/// A map as a section of a page (class `card`): title, method, its quantities side by side, promise and envelope.
std::string stability_map_html(const StabilityMap& map);

}  // namespace raytree::benchmarks
