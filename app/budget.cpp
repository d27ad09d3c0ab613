#include "app/budget.h"

#include <fmt/format.h>

#include <string_view>

#include "app/usage.h"

namespace raytree::app {

double parse_budget(const std::string& text) {
  constexpr std::string_view kUnits = "smh";
  constexpr double kSeconds[] = {1, 60, 3600}, kMostBudget = 7 * 24 * 3600;
  const std::size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  const bool has_unit = unit != std::string_view::npos;
  const double number = parse_real("--budget", has_unit ? text.substr(0, text.size() - 1) : text);
  const double seconds = number * (has_unit ? kSeconds[unit] : 1);
  if (!(seconds >= 1 && seconds <= kMostBudget))
    throw usage_error(fmt::format("--budget: \"{}\" is not within 1s and 168h; for example 20s, 2m or 1.5h", text));
  return seconds;
}

}  // namespace raytree::app
