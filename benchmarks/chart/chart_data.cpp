#include "benchmarks/chart/chart_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace raytree::benchmarks {
namespace {

/// Errors that differ by less than this share count as alike.
constexpr double kErrorAlike = 0.02;
/// A time is told from another when they differ by this.
constexpr double kTold = 0.08;
constexpr double kFewPixels = 0.01;  ///< share of pixels that may be off by more than a step

const MetricInfo& primary_metric() { return kMetrics.front(); }

std::string flags_name(const ChartPoint& point) {
  if (point.setting.part == SweepPart::defaults) return "the scene's own settings";
  return command_text(point.setting.flags);
}

/// Whether times tell that a is the quicker one, noise or not.
bool clearly_quicker(const ChartPoint& a, const ChartPoint& b) {
  const Spread of_a = a.cpu(), of_b = b.cpu();
  return of_a.count > 1 && of_b.count > 1 && of_a.median < of_b.median * (1 - kTold) && of_a.high < of_b.low;
}

/// The cheapest of the points that hold. None: none holds.
template <class Holds>
std::optional<std::size_t> cheapest(const ChartData& data, Holds&& holds) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < data.points.size(); ++i)
    if (holds(data.points[i]) && (!best || data.points[i].cpu().median < data.points[*best].cpu().median)) best = i;
  return best;
}

const ChartPoint* defaults_of(const ChartData& data) {
  for (const ChartPoint& point : data.points)
    if (point.setting.part == SweepPart::defaults) return &point;
  return nullptr;
}

/// The value nearest to the default in time, of those that are at least as good, is no news: the rest is.
struct KnobReach {
  const ChartPoint *fastest = nullptr, *best = nullptr;
  double least_error = 0, most_error = 0, least_time = 0, most_time = 0;
};

std::map<std::string, KnobReach> reach_of_knobs(const ChartData& data, const ChartPoint& defaults) {
  std::map<std::string, KnobReach> knobs;
  for (const ChartPoint& point : data.points) {
    if (point.setting.part != SweepPart::ends && point.setting.part != SweepPart::between) continue;
    const double time = point.cpu().median, error = point.errors.rmse;
    KnobReach& reach = knobs[point.setting.knob];
    if (reach.best == nullptr) {
      reach.least_time = reach.most_time = defaults.cpu().median;
      reach.least_error = reach.most_error = defaults.errors.rmse;
      reach.best = reach.fastest = &point;
    }
    reach.least_time = std::min(reach.least_time, time);
    reach.most_time = std::max(reach.most_time, time);
    reach.least_error = std::min(reach.least_error, error);
    reach.most_error = std::max(reach.most_error, error);
    if (error < reach.best->errors.rmse) reach.best = &point;
    if (time < reach.fastest->cpu().median) reach.fastest = &point;
  }
  return knobs;
}

std::string listed_in_words(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

std::string error_words(double ErrorMetrics::*metric, double value) {
  return metric == &ErrorMetrics::over_step ? fmt::format("{:.2g} % of the pixels", 100 * value) : short_number(value);
}

/// Where settings differ in peak memory by more than measuring does.
void add_memory_finding(const ChartData& data, const ChartPoint& defaults, std::vector<Finding>& findings) {
  constexpr double kToldFactor = 1.25, kToldBytes = 2e6;
  const auto [least, most] =
      std::minmax_element(data.points.begin(), data.points.end(),
                          [](const ChartPoint& a, const ChartPoint& b) { return a.memory_bytes() < b.memory_bytes(); });
  const double low = least->memory_bytes(), high = most->memory_bytes();
  if (defaults.peak_bytes.empty() || high < kToldFactor * low || high < low + kToldBytes) return;
  findings.push_back(
      {fmt::format("Peak memory lies between {:.3g} MB ({}) and {:.3g} MB ({}); the scene's own "
                   "settings take {:.3g} MB.",
                   1e-6 * low, flags_name(*least), 1e-6 * high, flags_name(*most), 1e-6 * defaults.memory_bytes()),
       static_cast<std::size_t>(most - data.points.begin())});
}

/// What turning each knob alone brings over the defaults.
void add_knob_findings(const ChartData& data, const ChartPoint& defaults, std::vector<Finding>& findings) {
  const double time = defaults.cpu().median, error = defaults.errors.rmse;
  std::vector<std::string> nothing, slower, dear;
  const auto known = reach_of_knobs(data, defaults);
  for (const auto& [name, reach] : known) {
    const bool errors_alike =
        reach.most_error - reach.least_error <= std::max(kErrorAlike * error, 0.1 * data.floor.rmse);
    const bool improves = reach.least_error < error * (1 - kErrorAlike);
    const bool quickens = reach.least_time < time * (1 - kTold);
    if (errors_alike && !quickens) nothing.push_back(name);
    if (improves) {
      const double gain = error / std::max(reach.least_error, 1e-30), price = reach.best->cpu().median / time;
      if (price > gain * (1 + kTold) && price > 1 + kTold)
        dear.push_back(fmt::format("{} ({} divides the error by {:.3g} for {:.3g} times the time)", name,
                                   reach.best->setting.value, gain, price));
    }
  }
  if (!nothing.empty())
    findings.push_back(
        {fmt::format("These knobs buy nothing here: {}. Turned alone, none of their values measured is quicker "
                     "than the scene's own by {:.0f} % or changes the error.",
                     listed_in_words(nothing), 100 * kTold),
         std::nullopt});
  // Quicker, and not worse.
  const double most = std::max(error * (1 + kErrorAlike), std::min(error + 0.1 * data.floor.rmse, error * 1.1));
  const auto free = cheapest(data, [&](const ChartPoint& point) {
    return (point.setting.part == SweepPart::ends || point.setting.part == SweepPart::between) && point.repeats &&
           point.errors.rmse <= most && point.errors.flip <= defaults.errors.flip * (1 + kErrorAlike) + 1e-6;
  });
  if (free && clearly_quicker(data.points[*free], defaults))
    findings.push_back(
        {fmt::format("Speed for nothing: {} takes {:.0f} % of the time of the scene's own settings, with an "
                     "error that is no larger.",
                     flags_name(data.points[*free]), 100 * data.points[*free].cpu().median / time),
         free});
  if (!dear.empty())
    findings.push_back(
        {"Accuracy bought dear, where time grows by more than the error falls: " + listed_in_words(dear) + ".",
         std::nullopt});
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].error)) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].cost != points[b].cost ? points[a].cost < points[b].cost : points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order)
    if (points[i].error < least) {
      least = points[i].error;
      front.push_back(i);
    }
  return front;
}

std::vector<std::size_t> chart_front(const ChartData& data, const MetricInfo& metric) {
  std::vector<CostAndError> points;
  for (const ChartPoint& point : data.points)
    points.push_back(
        {point.repeats ? point.cpu().median : std::numeric_limits<double>::quiet_NaN(), point.errors.*metric.value});
  return pareto_front(points);
}

std::optional<HalvingCost> cost_of_halving(const std::vector<CostAndError>& front, double floor) {
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const CostAndError& point : front) {
    if (!(point.error > floor) || !(point.error > 0) || !(point.cost > 0)) continue;
    const double x = std::log(point.error), y = std::log(point.cost);
    n += 1, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  if (n < 3 || !(spread > 1e-12)) return std::nullopt;
  return HalvingCost{std::pow(2.0, -(n * sum_xy - sum_x * sum_y) / spread), static_cast<std::size_t>(n)};
}

std::vector<Finding> findings_of(const ChartData& data) {
  std::vector<Finding> findings;
  // `metric` is to be at most `bound`, which says nothing where the reference itself is further off.
  const auto say = [&](const std::string& what, std::optional<std::size_t> index, double ErrorMetrics::*metric,
                       double bound) {
    const double floor = data.floor.*metric;
    if (!index) {
      findings.push_back({floor > bound
                              ? fmt::format("{}: not known; the reference's own error is {}. A larger budget makes a "
                                            "better one.",
                                            what, error_words(metric, floor))
                              : what + ": none of the settings measured.",
                          std::nullopt});
      return;
    }
    const ChartPoint& point = data.points[*index];
    findings.push_back(
        {fmt::format("{}: {}; {} of processor time, RMSE {}, {:.2g} % of the pixels off by more than 1/255, "
                     "FLIP {}.",
                     what, flags_name(point), short_seconds(point.cpu().median), short_number(point.errors.rmse),
                     100 * point.errors.over_step, short_number(point.errors.flip)) +
             (point.errors.*metric < floor
                  ? fmt::format(" The reference's own error, {}, is larger: what lies below cannot be told apart.",
                                error_words(metric, floor))
                  : ""),
         index});
  };
  say("Cheapest setting under 1/255 (RMSE in linear light)",
      cheapest(data, [](const ChartPoint& point) { return point.repeats && point.errors.rmse < kDisplayStep; }),
      &ErrorMetrics::rmse, kDisplayStep);
  say("Cheapest setting with at most 1 % of the pixels off by more than 1/255 after the view",
      cheapest(data, [](const ChartPoint& point) { return point.repeats && point.errors.over_step <= kFewPixels; }),
      &ErrorMetrics::over_step, kFewPixels);
  const auto most_accurate =
      std::min_element(data.points.begin(), data.points.end(),
                       [](const ChartPoint& a, const ChartPoint& b) { return a.errors.rmse < b.errors.rmse; });
  if (most_accurate != data.points.end())
    say("Most accurate setting", static_cast<std::size_t>(most_accurate - data.points.begin()), &ErrorMetrics::rmse, 0);
  const std::vector<std::size_t> indices = chart_front(data, primary_metric());
  std::vector<CostAndError> front;
  for (const std::size_t i : indices)
    front.push_back({data.points[i].cpu().median, data.points[i].errors.*primary_metric().value});
  if (const std::optional<HalvingCost> cost = cost_of_halving(front, data.floor.rmse))
    findings.push_back(
        {fmt::format("Along the front each halving of the error costs x{:.2g} in time ({} settings{}).", cost->factor,
                     cost->settings, cost->settings < front.size() ? " above the reference's own error" : ""),
         std::nullopt});
  const ChartPoint* defaults = defaults_of(data);
  if (defaults != nullptr) {
    const auto index = static_cast<std::size_t>(defaults - data.points.data());
    const double time = defaults->cpu().median;
    if (std::find(indices.begin(), indices.end(), index) != indices.end()) {
      findings.push_back({fmt::format("The scene's own settings ({}) lie on the front.", short_seconds(time)), index});
    } else if (const auto better = cheapest(data, [&](const ChartPoint& point) {
                 return point.repeats && point.errors.rmse <= defaults->errors.rmse;
               })) {
      const double share = data.points[*better].cpu().median / time;
      findings.push_back(
          {share > 1 - kTold
               ? fmt::format("The scene's own settings ({}) lie within {:.0f} % of the front.", short_seconds(time),
                             std::max(1.0, 100 * (1 - share)))
               : fmt::format("The scene's own settings ({}) are dominated: {} reaches their RMSE in {:.0f} % "
                             "of the time.",
                             short_seconds(time), flags_name(data.points[*better]), 100 * share),
           share > 1 - kTold ? index : *better});
    }
    add_knob_findings(data, *defaults, findings);
    add_memory_finding(data, *defaults, findings);
  }
  for (const ChartPoint& point : data.points)
    if (!point.repeats)
      findings.push_back(
          {fmt::format("{} does not repeat: its pictures differ from run to run. It is kept off the front.",
                       flags_name(point)),
           static_cast<std::size_t>(&point - data.points.data())});
  return findings;
}

std::string short_seconds(double seconds) {
  if (seconds < 0.0995) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return seconds < 99.5 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "none";
  return fmt::format("{:.3g}", value);
}

}  // namespace raytree::benchmarks
