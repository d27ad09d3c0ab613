// How long a measuring command may take, as its --budget says.
#pragma once

#include <string>

namespace raytree::app {

/// Seconds of "90", "90s", "1.5m" or "2h", of 1 s to a week. Throws Error (bad_input) naming --budget.
double parse_budget(const std::string& text);

}  // namespace raytree::app
