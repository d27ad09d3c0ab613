#include "benchmarks/stability/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmarks/report_page.h"

namespace raytree::benchmarks {
namespace {

using OrderedJson = nlohmann::ordered_json;

const char* verdict_key(StabilityVerdict verdict) {
  switch (verdict) {
    case StabilityVerdict::holds:
      return "holds";
    case StabilityVerdict::fails_as_known:
      return "fails_as_known";
    case StabilityVerdict::fails:
      break;
  }
  return "fails";
}

OrderedJson counts_json(const StabilityCounts& counts) {
  return {{"holds", counts.holds}, {"fails_as_known", counts.fails_as_known}, {"fails", counts.fails}};
}

OrderedJson figure_json(const StabilityFigure& figure) {
  OrderedJson json{{"method", figure.method}, {"quantity", figure.quantity}};
  // JSON knows neither NaN nor infinity.
  const auto set = [&](const char* key, double value) {
    if (std::isfinite(value))
      json[key] = value;
    else
      json[key] = nullptr;
  };
  set("measured", figure.measured);
  set("low", figure.low);
  set("high", figure.high);
  json["known"] = figure.known;
  json["expectation"] = figure.expectation == StabilityExpectation::holds ? "holds" : "fails_as_known";
  json["verdict"] = verdict_key(figure.verdict());
  return json;
}

/// Characters of UTF-8 text.
std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, character_count(text)), ' ');
}

}  // namespace

std::string_view verdict_words(StabilityVerdict verdict) {
  return verdict == StabilityVerdict::fails_as_known ? "fails as known" : verdict_key(verdict);
}

std::string figure_text(double value) {
  if (std::isnan(value)) return "not measured";
  if (value == std::floor(value) && std::abs(value) < 1e7) return fmt::format("{:.0f}", value);
  return fmt::format("{:.4g}", value);
}

std::string interval_text(const StabilityFigure& figure) {
  if (figure.low == figure.high) return figure_text(figure.low);
  if (std::isinf(figure.high)) return "at least " + figure_text(figure.low);
  const double middle = (figure.low + figure.high) / 2, half = (figure.high - figure.low) / 2;
  // Where both ends look alike in four digits, or but for their sign.
  if (half < 1e-3 * std::abs(middle) || middle == 0) return fmt::format("{} \u00b1 {:.1e}", figure_text(middle), half);
  return fmt::format("[{}, {}]", figure_text(figure.low), figure_text(figure.high));
}

std::string planted_text(const StabilityFaults& faults) {
  std::string text;
  if (faults.no_offsets) text = "no-offsets";
  if (faults.not_robust) text += text.empty() ? "not-robust" : ", not-robust";
  return text;
}

std::string counts_text(const StabilityReport& report) {
  const StabilityCounts figures = report.figures();
  return fmt::format("{} case{}; {} figures: {} hold, {} fail as known, {} fail", report.entries.size(),
                     report.entries.size() == 1 ? "" : "s", figures.total(), figures.holds, figures.fails_as_known,
                     figures.fails);
}

std::string stability_text(const StabilityReport& report) {
  using TableRow = std::array<std::string, 6>;
  std::vector<TableRow> rows{{"case", "method", "quantity", "measured", "best known", "verdict"}};
  for (const StabilityEntry& entry : report.entries) {
    const std::string name = entry.grouped.what.name;
    for (const StabilityFigure& figure : entry.result.figures) {
      const std::string verdict(verdict_words(figure.verdict()));
      rows.push_back({name, figure.method, figure.quantity, figure_text(figure.measured), figure.known,
                      figure.verdict() == StabilityVerdict::fails
                          ? fmt::format("{}: not within {}", verdict, interval_text(figure))
                          : verdict});
    }
    if (!entry.error.empty())
      rows.push_back({name, "", "", "", "", "fails: " + entry.error});
    else if (entry.result.figures.empty())
      rows.push_back({name, "", "", "", "", "fails: nothing was measured"});
  }
  std::array<std::size_t, 6> widths{};
  for (const TableRow& row : rows)
    for (std::size_t c = 0; c + 1 < row.size(); ++c) widths[c] = std::max(widths[c], character_count(row[c]));
  std::string text;
  for (const TableRow& row : rows) {
    for (std::size_t c = 0; c + 1 < row.size(); ++c) text += padded(row[c], widths[c]) + "  ";
    text += row.back() + "\n";
  }
  text += "\n";
  if (const std::string planted = planted_text(report.faults); !planted.empty())
    text += fmt::format("planted: {}\n", planted);
  return text + counts_text(report) + "\n";
}

std::string stability_json(const StabilityReport& report, const std::string& maps) {
  OrderedJson json;
  json["machine"] = machine_line();
  json["effort"] = report.effort;
  json["planted"] = OrderedJson::array();
  if (report.faults.no_offsets) json["planted"].push_back("no-offsets");
  if (report.faults.not_robust) json["planted"].push_back("not-robust");
  json["counts"] = {{"cases", counts_json(report.cases())}, {"figures", counts_json(report.figures())}};
  json["cases"] = OrderedJson::array();
  for (const StabilityEntry& entry : report.entries) {
    const StabilityCase& what = entry.grouped.what;
    OrderedJson one{{"name", what.name},
                    {"row", what.row},
                    {"group", entry.grouped.group},
                    {"title", what.title},
                    {"provocation", what.provocation},
                    {"remedy", what.remedy},
                    {"source", what.source},
                    {"verdict", verdict_key(entry.verdict())}};
    if (!entry.error.empty()) one["error"] = entry.error;
    one["figures"] = OrderedJson::array();
    for (const StabilityFigure& figure : entry.result.figures) one["figures"].push_back(figure_json(figure));
    json["cases"].push_back(std::move(one));
  }
  if (!maps.empty()) json["maps"] = OrderedJson::parse(maps);
  // What others wrote in an error may not be UTF-8.
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace raytree::benchmarks
