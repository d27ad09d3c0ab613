// `raytree_measure` from outside: what it refuses, before it measures for minutes.
#include <gtest/gtest.h>

#include <filesystem>

#include "benchmarks/child_process.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;

/// The words are refused with exit status 2, within a second or so, by a message that holds `part`.
void expect_refusal(const std::vector<std::string>& words, const std::string& part) {
  const test::TemporaryFolder scratch;
  std::vector<std::string> all{RAYTREE_MEASURE};
  all.insert(all.end(), words.begin(), words.end());
  const ChildResult result = run_child(all, scratch.path(""));
  EXPECT_EQ(result.status, 2) << result.errors;
  EXPECT_TRUE(contains(result.errors, part)) << result.errors;
  EXPECT_EQ(result.output, "");
}

TEST(MeasureProgram, RefusesChartsThatItCannotWrite) {
  const test::TemporaryFolder folder;
  const std::string chart = folder.path("chart.svg");
  expect_refusal({"naive", "--chart", folder.path("chart.png")}, "ends in .svg");
  expect_refusal({"naive", "--chart", folder.path("none/chart.svg")}, "none/chart.svg: --chart: the file cannot be");
  expect_refusal({"split", "--chart", chart}, "no row asked for has a chart; these have: naive");
  expect_refusal({"naive", "naive", "--chart", chart}, "--chart takes one row");
  expect_refusal({"naive", "--chart"}, "--chart takes a file name");
  expect_refusal({"naive", "--json", folder.path("none/figures.json")}, "--json: the file cannot be written");
  EXPECT_FALSE(std::filesystem::exists(chart)) << "a refusal leaves no file";
}

TEST(MeasureProgram, RefusesRowsThatThereAreNot) { expect_refusal({"flor"}, "no row \"flor\"; rows: floor"); }

}  // namespace
}  // namespace raytree::benchmarks
