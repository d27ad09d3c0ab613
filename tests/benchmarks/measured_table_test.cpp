// The table of `./run measure` in README: every row and line of it, its bounds and its verdicts.
#include "benchmarks/measured_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "benchmarks/expected_lines.h"
#include "benchmarks/rows.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;

std::string document(const std::string& name) {
  std::ifstream file(std::string(RAYTREE_SOURCE_DIR) + "/" + name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// What stands between README's markers.
std::string readme_table() {
  const std::string text = document("README.md"), begin = "<!-- measure:begin -->", end = "<!-- measure:end -->";
  const auto from = text.find(begin), to = text.find(end);
  EXPECT_NE(from, text.npos);
  EXPECT_NE(to, text.npos);
  return to > from && to != text.npos ? text.substr(from, to - from) : std::string();
}

/// An expected line as a run may print it: something in place of `*`, and a figure that is just what is asked for.
Figure sample_of(const Figure& expected) {
  Figure figure = expected;
  for (auto star = figure.what.find('*'); star != figure.what.npos; star = figure.what.find('*'))
    figure.what.replace(star, 1, "7");
  if (takes_any_interval(figure)) figure.bound = 2, figure.upper = 2.5;
  const double value = figure.kind == BoundKind::none ? 1 : figure.bound;
  figure.measured = {value, value, value, 3};
  return figure;
}

std::string sample_table() {
  std::string text = "Measured somewhere.\n\n" + table_head();
  for (const Figure& expected : expected_lines()) text += table_line(sample_of(expected));
  return text + "\nText after it | with a bar.\n";
}

/// The complaints about the sample table in which `from` stands as `to`, one a line.
std::string complaints_with(const std::string& from, const std::string& to) {
  std::string text = sample_table();
  const auto place = text.find(from);
  EXPECT_NE(place, text.npos) << from;
  if (place != text.npos) text.replace(place, from.size(), to);
  std::string result;
  for (const std::string& complaint : complaints_of_table(text)) result += complaint + "\n";
  return result;
}

TEST(MeasuredTable, ReadmeShowsEveryRowLineAndBoundWithTheVerdictThatFollows) {
  const std::string table = readme_table();
  for (const std::string& complaint : complaints_of_table(table))
    ADD_FAILURE() << "README.md, the table of ./run measure: " << complaint;
}

TEST(MeasuredTable, EveryRowHasExpectedLinesAndADescription) {
  const std::string description = document("docs/benchmarks.md");
  for (const Row& row : kRows) {
    EXPECT_TRUE(std::any_of(expected_lines().begin(), expected_lines().end(),
                            [&](const Figure& line) { return line.row == row.name; }))
        << row.name << " is a row of raytree_measure without lines in benchmarks/expected_lines.cpp";
    EXPECT_TRUE(contains(description, fmt::format("`{}`", row.name)) ||
                contains(description, fmt::format("## {}", row.name)))
        << row.name;
  }
  for (const Figure& line : expected_lines())
    EXPECT_TRUE(std::any_of(std::begin(kRows), std::end(kRows), [&](const Row& row) { return line.row == row.name; }))
        << line.row;
}

TEST(MeasuredTable, AWholeTableIsNotComplainedOf) {
  EXPECT_EQ(complaints_with("Measured somewhere.", "Measured elsewhere."), "");
}

TEST(MeasuredTable, WhatLacksIsNamed) {
  const std::string missing = complaints_with("| start | launch to the first ray", "| start | launch to the last ray");
  EXPECT_TRUE(contains(missing, "start: measures no line \"launch to the last ray, one sphere, 7\"")) << missing;
  EXPECT_TRUE(contains(
      missing, "start: lacks the line \"launch to the first ray, one sphere, *\" with the bound \"<= 30.00 ms\""))
      << missing;
  for (const Figure& expected : expected_lines()) {
    const std::string printed = table_line(sample_of(expected));
    const std::string complaints = complaints_with(printed, "");
    EXPECT_TRUE(contains(complaints, expected.row + ": lacks the line \"" + expected.what + "\""))
        << printed << complaints;
  }
  const std::string no_row = complaints_with("| start | launch", "| stare | launch");
  EXPECT_TRUE(contains(no_row, "no row \"stare\"")) << no_row;
}

TEST(MeasuredTable, OtherBoundsAreNamed) {
  const std::string other = complaints_with("| >= 0.55 (chase 0.65) |", "| >= 0.50 (chase 0.65) |");
  EXPECT_TRUE(contains(other, "floor: the bound is \">= 0.55 (chase 0.65)\", not \">= 0.50 (chase 0.65)\"")) << other;
  const std::string none = complaints_with("| <= 30.00 ms | holds |", "|  |  |");
  EXPECT_TRUE(contains(none, "start: the bound is \"<= 30.00 ms\", not \"\"")) << none;
  const std::string interval = complaints_with("| 2.00 to 2.50 |", "| about 2 |");
  EXPECT_TRUE(contains(interval, "ratios: the bound is an interval, not \"about 2\"")) << interval;
  const std::string unit = complaints_with("30.00 ms (30.00-30.00, n=3)", "0.03 s (0.03-0.03, n=3)");
  EXPECT_TRUE(contains(unit, "start: \"0.03 s (0.03-0.03, n=3)\" is no figure in ms")) << unit;
}

TEST(MeasuredTable, VerdictsFollowFromFigureAndBound) {
  const auto of_start = [](const std::string& measured, const std::string& verdict) {
    return complaints_with("30.00 ms (30.00-30.00, n=3) | <= 30.00 ms | holds |",
                           measured + " ms (1.00-99.00, n=3) | <= 30.00 ms | " + verdict + " |");
  };
  EXPECT_EQ(of_start("29.99", "holds"), "");
  EXPECT_EQ(of_start("30.01", "**falls short**"), "");
  EXPECT_EQ(of_start("30.00", "holds"), "");
  EXPECT_EQ(of_start("30.00", "**falls short**"), "") << "30.004 is printed so";
  EXPECT_EQ(of_start("4.00", "**falls short**: the pictures differ"), "");
  EXPECT_TRUE(contains(of_start("30.02", "holds"), "\"holds\" does not follow from 30.02 ms"));
  EXPECT_TRUE(contains(of_start("29.98", "**falls short**"), "does not follow"));
  EXPECT_TRUE(contains(of_start("4.00", ""), "does not follow"));
  EXPECT_TRUE(contains(of_start("4.00", "holds, chase met"), "does not follow"));

  const auto of_floor = [](const std::string& measured, const std::string& verdict) {
    return complaints_with("0.55 (0.55-0.55, n=3) | >= 0.55 (chase 0.65) | holds |",
                           measured + " (0.50-0.70, n=3) | >= 0.55 (chase 0.65) | " + verdict + " |");
  };
  EXPECT_EQ(of_floor("0.66", "holds, chase met"), "");
  EXPECT_EQ(of_floor("0.64", "holds"), "");
  EXPECT_TRUE(contains(of_floor("0.66", "holds"), "does not follow"));
  EXPECT_TRUE(contains(of_floor("0.64", "holds, chase met"), "does not follow"));
  EXPECT_TRUE(contains(of_floor("0.53", "holds"), "does not follow"));

  const auto of_ratios = [](const std::string& quartiles, const std::string& verdict) {
    return complaints_with("2.00 (2.00-2.00, n=3) | 2.00 to 2.50 | holds |",
                           "2.20 (" + quartiles + ", n=3) | 2.00 to 2.50 | " + verdict + " |");
  };
  EXPECT_EQ(of_ratios("1.75-1.87", "holds"), "") << "8 % is what two machines differ by";
  EXPECT_TRUE(contains(of_ratios("1.75-1.83", "holds"), "does not follow"));
  EXPECT_TRUE(contains(of_ratios("2.10-2.30", "**falls short**"), "does not follow"));
}

TEST(MeasuredTable, FiguresAreHeldAgainstTheSameList) {
  std::vector<Figure> figures;
  for (const Figure& expected : expected_lines())
    if (expected.row == "loading") figures.push_back(sample_of(expected));
  ASSERT_GE(figures.size(), 8u);
  EXPECT_TRUE(complaints_of_row("loading", figures).empty());

  std::vector<Figure> other = figures;
  other[0].bound = 250;
  ASSERT_EQ(complaints_of_row("loading", other).size(), 2u);
  EXPECT_TRUE(contains(complaints_of_row("loading", other)[0], "the bound is \">= 300 MB/s\", not \">= 250 MB/s\""));
  EXPECT_TRUE(contains(complaints_of_row("loading", other)[1], "lacks the line \"reading PLY binary, little-endian"));
  other[0].problem = "the program is missing";
  EXPECT_TRUE(complaints_of_row("loading", other).empty()) << "the row says itself what is wrong";
  other = figures;
  other[0].unit = "GB/s";
  EXPECT_FALSE(complaints_of_row("loading", other).empty());
}

TEST(MeasuredTable, PatternsFitWholeTexts) {
  EXPECT_TRUE(fits_pattern("a 12 b", "a * b"));
  EXPECT_TRUE(fits_pattern("ab", "a*b"));
  EXPECT_TRUE(fits_pattern("a x b y b", "a*b"));
  EXPECT_FALSE(fits_pattern("a 12 b!", "a * b"));
  EXPECT_FALSE(fits_pattern("a", "ab"));
  EXPECT_TRUE(fits_pattern("", "*"));
  EXPECT_FALSE(fits_pattern("", "a*"));
}

}  // namespace
}  // namespace raytree::benchmarks
