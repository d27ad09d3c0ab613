#include "benchmarks/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::string number(double value) {
  if (!std::isfinite(value)) return "none";
  const double size = std::abs(value);
  if (size != 0 && size < 0.0995) return fmt::format("{:.3f}", value);
  if (size < 99.5) return fmt::format("{:.2f}", value);
  return fmt::format("{:.0f}", value);
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

std::string verdict(const Figure& figure) {
  if (!figure.problem.empty()) return "**falls short**: " + figure.problem;
  if (figure.kind == BoundKind::none) return "";
  if (!figure.holds()) return "**falls short**";
  const bool chased =
      std::isfinite(figure.chase) && (figure.kind == BoundKind::at_least ? figure.measured.median >= figure.chase
                                                                         : figure.measured.median <= figure.chase);
  return chased ? "holds, chase met" : "holds";
}

}  // namespace

Spread spread_of(std::vector<double> samples) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (samples.empty()) return {kNone, kNone, kNone, 0};
  std::sort(samples.begin(), samples.end());
  return {quantile(samples, 0.25), quantile(samples, 0.5), quantile(samples, 0.75), static_cast<int>(samples.size())};
}

PairedSpread measure_pairs(const std::function<double()>& a, const std::function<double()>& b,
                           const PairLimits& limits) {
  a();
  b();
  std::vector<double> of_a, of_b, ratios;
  const auto start = Clock::now();
  for (int pair = 0; pair < limits.most; ++pair) {
    of_a.push_back(a());
    of_b.push_back(b());
    ratios.push_back(of_a.back() / of_b.back());
    if (pair + 1 < limits.least) continue;
    const Spread ratio = spread_of(ratios);
    const double uncertainty = (ratio.high - ratio.low) / ratio.median / std::sqrt(static_cast<double>(ratio.count));
    const double spent = seconds_since(start);
    if (uncertainty <= limits.enough && spent >= limits.least_seconds) break;
  }
  return {spread_of(of_a), spread_of(of_b), spread_of(ratios)};
}

bool Figure::holds() const {
  if (!problem.empty()) return false;
  // Not a number falls short of any bound.
  if (kind == BoundKind::at_least) return measured.median >= bound;
  if (kind == BoundKind::at_most) return measured.median <= bound;
  if (kind == BoundKind::within) return measured.high * (1 + noise) >= bound && measured.low / (1 + noise) <= upper;
  return true;
}

std::string bound_text(const Figure& figure) {
  if (figure.kind == BoundKind::none) return "";
  if (figure.kind == BoundKind::within)
    return fmt::format("{} to {}", number(figure.bound), with_unit(number(figure.upper), figure.unit));
  std::string text =
      (figure.kind == BoundKind::at_least ? ">= " : "<= ") + with_unit(number(figure.bound), figure.unit);
  if (std::isfinite(figure.chase)) text += fmt::format(" (chase {})", number(figure.chase));
  return text;
}

std::string table_head() {
  return "| row | what | measured | bound | verdict |\n"
         "|---|---|---|---|---|\n";
}

std::string table_line(const Figure& figure) {
  std::string measured = "not measured";
  if (figure.measured.count > 0) {
    measured = with_unit(number(figure.measured.median), figure.unit);
    if (figure.measured.count > 1)
      measured += fmt::format(" ({}-{}, n={})", number(figure.measured.low), number(figure.measured.high),
                              figure.measured.count);
  }
  return fmt::format("| {} | {} | {} | {} | {} |\n", figure.row, figure.what, measured, bound_text(figure),
                     verdict(figure));
}

std::string figures_json(const std::vector<std::pair<std::string, std::string>>& header,
                         const std::vector<Figure>& figures) {
  Json json;
  for (const auto& [key, value] : header) json["machine"][key] = value;
  json["figures"] = Json::array();
  for (const Figure& figure : figures) {
    Json line = {{"row", figure.row}, {"what", figure.what}, {"unit", figure.unit}};
    // JSON has no NaN: null stands for it.
    line["median"] = figure.measured.median;
    line["low"] = figure.measured.low;
    line["high"] = figure.measured.high;
    line["count"] = figure.measured.count;
    if (figure.kind == BoundKind::within)
      line["within"] = {figure.bound, figure.upper};
    else if (figure.kind != BoundKind::none)
      line[figure.kind == BoundKind::at_least ? "at_least" : "at_most"] = figure.bound;
    line["holds"] = figure.holds();
    if (!figure.problem.empty()) line["problem"] = figure.problem;
    if (!figure.note.empty()) line["note"] = figure.note;
    if (!figure.place.line.empty())
      line["chart"] = {{"plot", figure.place.plot}, {"line", figure.place.line}, {"x", figure.place.x}};
    json["figures"].push_back(line);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace raytree::benchmarks
