#include "benchmarks/measured_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "benchmarks/expected_lines.h"
#include "benchmarks/rows.h"

namespace raytree::benchmarks {
namespace {

/// "A to B" with the unit.
std::optional<std::pair<double, double>> interval_of(std::string_view text) {
  const auto split = text.find(" to ");
  if (split == text.npos) return std::nullopt;
  std::pair<double, double> ends;
  const char *const middle = text.data() + split, *const end = text.data() + text.size();
  if (std::from_chars(text.data(), middle, ends.first).ec != std::errc() ||
      std::from_chars(middle + 4, end, ends.second).ec != std::errc())
    return std::nullopt;
  return ends;
}

/// A line as it is printed.
struct PrintedLine {
  std::string row, what, measured, bound, verdict;
};

bool has_bound(const Figure& expected, const std::string& bound) {
  if (takes_any_interval(expected)) return bound.empty() || interval_of(bound);
  return bound == bound_text(expected);
}

/// The expected line that a printed one is; what is wrong with it where there is none.
struct Found {
  const Figure* expected = nullptr;
  std::string complaint;
};
Found found_line(const std::string& row, const std::string& what, const std::string& bound) {
  std::string bounds;
  for (const Figure& expected : expected_lines()) {
    if (expected.row != row || !fits_pattern(what, expected.what)) continue;
    if (has_bound(expected, bound)) return {&expected, ""};
    bounds += (bounds.empty() ? "" : " or ") +
              (takes_any_interval(expected) ? "an interval" : '"' + bound_text(expected) + '"');
  }
  if (bounds.empty()) return {nullptr, fmt::format("{}: measures no line \"{}\"", row, what)};
  return {nullptr, fmt::format("{}: the bound is {}, not \"{}\", of \"{}\"", row, bounds, bound, what)};
}

void complain_of_lacking(const std::string& row, const std::vector<const Figure*>& seen,
                         std::vector<std::string>& complaints) {
  for (const Figure& expected : expected_lines())
    if (expected.row == row && std::find(seen.begin(), seen.end(), &expected) == seen.end())
      complaints.push_back(fmt::format("{}: lacks the line \"{}\"", row, expected.what) +
                           (takes_any_interval(expected) || expected.kind == BoundKind::none
                                ? std::string()
                                : fmt::format(" with the bound \"{}\"", bound_text(expected))));
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// The lines of five columns but the head; others are text around the table.
std::vector<PrintedLine> printed_lines(std::string_view markdown) {
  std::vector<PrintedLine> lines;
  while (!markdown.empty()) {
    const auto end = std::min(markdown.find('\n'), markdown.size());
    std::string_view text = trimmed(markdown.substr(0, end));
    markdown.remove_prefix(std::min(end + 1, markdown.size()));
    if (text.size() < 2 || text.front() != '|' || text.back() != '|' || std::count(text.begin(), text.end(), '|') != 6)
      continue;
    std::string columns[5];
    for (std::string& column : columns) {
      text.remove_prefix(1);
      const auto bar = text.find('|');
      column = trimmed(text.substr(0, bar));
      text.remove_prefix(bar);
    }
    if (columns[0] == "row" || columns[0].find_first_not_of('-') == std::string::npos) continue;
    lines.push_back({columns[0], columns[1], columns[2], columns[3], columns[4]});
  }
  return lines;
}

/// A number as it is printed, and how far that is from what it may stand for.
struct RoundedNumber {
  double value = 0, half_digit = 0;
};
std::optional<RoundedNumber> leading_number(std::string_view& text) {
  RoundedNumber number;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
  if (error != std::errc()) return std::nullopt;
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.data()));
  const auto point = digits.find('.');
  // A little more than half a digit: the halves themselves go either way.
  number.half_digit = 0.5001 * std::pow(10, point == digits.npos ? 0 : -static_cast<double>(digits.size() - point - 1));
  text.remove_prefix(digits.size());
  return number;
}

/// "1.11 UNIT (1.11-1.12, n=7)" with each number moved by `side` (-1, 0, 1) half digits; none where it is no such text.
std::optional<Spread> printed_spread(std::string_view text, const std::string& unit, int side) {
  const auto moved = [side](const RoundedNumber& number) { return number.value + side * number.half_digit; };
  const auto median = leading_number(text);
  if (!median) return std::nullopt;
  Spread spread{moved(*median), moved(*median), moved(*median), 1};
  if (!unit.empty()) {
    if (text.substr(0, unit.size() + 1) != " " + unit) return std::nullopt;
    text.remove_prefix(unit.size() + 1);
  }
  if (text.empty()) return spread;
  if (text.substr(0, 2) != " (") return std::nullopt;
  text.remove_prefix(2);
  const auto low = leading_number(text);
  if (!low || text.empty() || text.front() != '-') return std::nullopt;
  text.remove_prefix(1);
  const auto high = leading_number(text);
  if (!high || text.substr(0, 4) != ", n=") return std::nullopt;
  spread.low = moved(*low), spread.high = moved(*high);
  return spread;
}

/// The verdict without "chase met", and whether that was said.
bool verdict_follows(Figure figure, const PrintedLine& line) {
  if (line.verdict.rfind("**falls short**: ", 0) == 0) return true;  // a problem outweighs any figure
  if (line.bound.empty()) return line.verdict.empty();
  if (const auto ends = interval_of(line.bound); ends && takes_any_interval(figure))
    figure.bound = ends->first, figure.upper = ends->second;
  bool can_hold = false, can_fall_short = false, can_be_chased = false, can_be_unchased = !std::isfinite(figure.chase);
  for (const int side : {-1, 1}) {
    figure.measured = *printed_spread(line.measured, figure.unit, side);
    (figure.holds() ? can_hold : can_fall_short) = true;
    if (!std::isfinite(figure.chase)) continue;
    Figure chased = figure;
    chased.bound = figure.chase;
    (chased.holds() ? can_be_chased : can_be_unchased) = true;
  }
  if (line.verdict == "holds") return can_hold && can_be_unchased;
  if (line.verdict == "holds, chase met") return can_hold && can_be_chased;
  return line.verdict == "**falls short**" && can_fall_short;
}

std::string complaint_of_figure(const Figure& expected, const PrintedLine& line) {
  const bool has_problem = line.verdict.rfind("**falls short**: ", 0) == 0;
  if (!has_problem && !printed_spread(line.measured, expected.unit, 0))
    return fmt::format("{}: \"{}\" is no figure{} of \"{}\"", line.row, line.measured,
                       expected.unit.empty() ? "" : " in " + expected.unit, line.what);
  if (!verdict_follows(expected, line))
    return fmt::format("{}: \"{}\" does not follow from {} and the bound \"{}\" of \"{}\"", line.row, line.verdict,
                       line.measured, line.bound, line.what);
  return "";
}

}  // namespace

bool fits_pattern(std::string_view text, std::string_view pattern) {
  const auto star = pattern.find('*');
  if (star == pattern.npos) return text == pattern;
  if (text.substr(0, star) != pattern.substr(0, star)) return false;
  pattern.remove_prefix(star + 1);
  for (std::size_t from = star; from <= text.size(); ++from)
    if (fits_pattern(text.substr(from), pattern)) return true;
  return false;
}

std::vector<std::string> complaints_of_row(const std::string& row, const std::vector<Figure>& figures) {
  std::vector<std::string> complaints;
  std::vector<const Figure*> seen;
  bool has_problem = false;
  for (const Figure& figure : figures) {
    if (!figure.problem.empty()) {
      has_problem = true;
      continue;
    }
    const Found found = found_line(row, figure.what, bound_text(figure));
    if (found.expected == nullptr)
      complaints.push_back(found.complaint);
    else if (found.expected->unit != figure.unit)
      complaints.push_back(fmt::format("{}: the unit is \"{}\", not \"{}\", of \"{}\"", row, found.expected->unit,
                                       figure.unit, figure.what));
    else
      seen.push_back(found.expected);
  }
  if (!has_problem) complain_of_lacking(row, seen, complaints);
  return complaints;
}

std::vector<std::string> complaints_of_table(std::string_view markdown) {
  std::vector<std::string> complaints;
  const std::vector<PrintedLine> lines = printed_lines(markdown);
  for (const Row& row : kRows) {
    std::vector<const Figure*> seen;
    for (const PrintedLine& line : lines) {
      if (line.row != row.name) continue;
      const Found found = found_line(line.row, line.what, line.bound);
      std::string complaint = found.complaint;
      if (found.expected != nullptr) {
        seen.push_back(found.expected);
        complaint = complaint_of_figure(*found.expected, line);
      }
      if (!complaint.empty()) complaints.push_back(complaint);
    }
    complain_of_lacking(row.name, seen, complaints);
  }
  for (const PrintedLine& line : lines)
    if (std::none_of(std::begin(kRows), std::end(kRows), [&](const Row& row) { return row.name == line.row; }))
      complaints.push_back(fmt::format("no row \"{}\": \"{}\"", line.row, line.what));
  return complaints;
}

}  // namespace raytree::benchmarks
