// The commands that measure, run whole with a small budget: they end in time, leave nothing of their subject out
// without a word, and what they write is whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// As docs/command-line.md promises: what is under way when the time ends is ended, not cut.
constexpr double kMostOfBudget = 1.5;

/// The elements that a page's text opens stand in pairs, and it ends.
void expect_whole_page(const std::string& page) {
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u) << page.substr(0, 40);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  for (const std::string element : {"html", "head", "body", "svg", "table", "script", "style", "section"}) {
    const std::size_t opened = count_of(page, "<" + element + ">") + count_of(page, "<" + element + " ");
    EXPECT_EQ(opened, count_of(page, "</" + element + ">")) << element;
  }
  // Nothing is fetched: the only addresses are names of the standards.
  EXPECT_EQ(count_of(page, "src=\"http"), 0u);
  EXPECT_EQ(count_of(page, "url(http"), 0u);
  EXPECT_EQ(count_of(page, "<link"), 0u);
}

void expect_machine_in(const Json& machine) {
  for (const char* key : {"processor", "instruction_set", "compiler", "build_type", "tracer"})
    EXPECT_FALSE(machine.at(key).get<std::string>().empty()) << key;
  EXPECT_GE(machine.at("hardware_threads").get<int>(), 1);
}

/// A figure that was measured: positive, and between its quartiles.
void expect_speed(const Json& spread, const std::string& row) {
  ASSERT_TRUE(spread["median"].is_number()) << row;
  EXPECT_GT(spread["median"].get<double>(), 0) << row;
  EXPECT_LE(spread["low"].get<double>(), spread["median"].get<double>()) << row;
  EXPECT_GE(spread["high"].get<double>(), spread["median"].get<double>()) << row;
}

/// Each configuration of the scene is a row of every kind of rays, or named as left out.
void expect_whole_scene(const Json& scene) {
  std::set<std::string> kinds, left_out;
  std::map<std::string, std::set<std::string>> kinds_of;
  for (const Json& out : scene["left_out"]) {
    left_out.insert(out["name"]);
    EXPECT_FALSE(out["reason"].get<std::string>().empty()) << out;
  }
  for (const Json& row : scene["rows"]) {
    const std::string name = row["name"];
    expect_speed(row["millions_per_second"], name);
    expect_speed(row["over_baseline"], name);
    EXPECT_EQ(row["suspicious"], false) << row;
    EXPECT_EQ(row["repeatable"], true) << row;
    EXPECT_LE(row["hits"].get<std::size_t>(), row["rays"].get<std::size_t>()) << row;
    // A bare call is no hundred times as fast as another, nor the naive tracer faster than all.
    EXPECT_LT(row["over_baseline"]["median"].get<double>(), 100) << row;
    kinds.insert(row["kind"]);
    kinds_of[row["configuration"]].insert(row["kind"]);
  }
  const std::string name = scene["scene"];
  for (const char* kind : {"primary", "shadow", "mirror", "refracted", "bounce"})
    EXPECT_TRUE(kinds.count(kind)) << name << ": " << kind;
  for (const char* built : {"triangles/robust/medium", "triangles/plain/medium", "triangles/robust/medium-compact",
                            "triangles/robust/low", "triangles/robust/high", "naive"}) {
    const bool measured =
        std::any_of(kinds_of.begin(), kinds_of.end(), [&](const auto& one) { return one.first.rfind(built, 0) == 0; });
    // Nobody waits for the naive tracer over more than two million primitives; without triangles no edge leaks.
    const bool senseless = (std::string(built) == "naive" && scene["triangles"].get<double>() > 2e6) ||
                           (std::string(built) == "triangles/plain/medium" && scene["triangles"] == 0);
    EXPECT_TRUE(measured || left_out.count(built) || senseless) << name << ": " << built;
  }
  EXPECT_EQ(kinds_of["triangles/robust/medium/1"].size(), kinds.size()) << name << ": the baseline";
}

TEST(MeasuringBudget, BenchOfTheStandardSetIsWholeAndInTime) {
  const ProgramResult result = run_program({"bench", "standard", "--budget", "20s", "--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LE(result.seconds, kMostOfBudget * 20);
  const Json report = Json::parse(result.out);
  expect_machine_in(report["machine"]);
  EXPECT_EQ(report["suspicious"], false);
  EXPECT_EQ(report["seconds"], 20);
  std::set<std::string> measured;
  for (const Json& scene : report["scenes"]) {
    measured.insert(scene["scene"]);
    expect_whole_scene(scene);
  }
  for (const std::string name : {"spd-balls", "spd-tree", "scattered spheres", "catmull-clark", "forest",
                                 "terrain of 0.1 M", "terrain of 1 M", "terrain of 10 M"}) {
    const auto& out = report["left_out"];
    const bool named = std::any_of(out.begin(), out.end(), [&](const Json& line) {
      const std::string text = line;
      return text.rfind(name + ": ", 0) == 0 && contains(text, " s were ") && text.size() > name.size() + 20;
    });
    EXPECT_NE(measured.count(name) == 1, named) << name << ": measured or left out, and not both";
  }
  // What is small is always there.
  for (const char* name : {"spd-balls", "scattered spheres", "terrain of 0.1 M"}) EXPECT_TRUE(measured.count(name));
}

class ChartInTime : public testing::TestWithParam<const char*> {};

// One scene of a deep tree, one of many triangles.
TEST_P(ChartInTime, IsWhole) {
  const TemporaryFolder folder;
  const std::string out = folder.path("chart");
  const ProgramResult result = run_program({"chart", GetParam(), "--budget", "20s", "-o", out});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_LE(result.seconds, kMostOfBudget * 20);
  EXPECT_TRUE(contains(result.out, "Cheapest setting under 1/255")) << result.out;
  expect_whole_page(file_text(out + "/chart.html"));
  const Json chart = Json::parse(file_text(out + "/chart.json"));
  EXPECT_EQ(chart["complete"], true);
  EXPECT_TRUE(contains(chart["machine"], "Embree")) << chart["machine"];
  EXPECT_GT(chart["reference"]["own_error"]["rmse"].get<double>(), 0);
  EXPECT_GE(chart["points"].size(), 10u);
  for (const Json& point : chart["points"]) {
    const std::string key = point["key"];
    expect_speed(point["cpu_seconds"], key);
    for (const char* metric : {"rmse", "flip"}) EXPECT_GE(point["errors"][metric].get<double>(), 0) << key;
    EXPECT_FALSE(file_text(out + "/pictures/" + key + ".png").empty()) << key;
  }
  EXPECT_FALSE(chart["fronts"]["rmse"].empty());
  EXPECT_GE(count_of(file_text(out + "/points.csv"), "\n"), chart["points"].size());
  const std::string svg = file_text(out + "/chart.svg");
  EXPECT_EQ(count_of(svg, "<svg"), 1u);
  EXPECT_EQ(count_of(svg, "</svg>"), 1u);
}
INSTANTIATE_TEST_SUITE_P(MeasuringBudget, ChartInTime, testing::Values("spheres-1980", "glass", "terrain"));

TEST(MeasuringBudget, TheStabilitySuiteIsWholeAndInTime) {
  const TemporaryFolder folder;
  const std::string out = folder.path("stability");
  const ProgramResult result = run_program({"stability", "--budget", "20s", "-o", out});
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_LE(result.seconds, kMostOfBudget * 20);
  const Json report = Json::parse(file_text(out + "/stability.json"));
  EXPECT_TRUE(contains(report["machine"], "Embree")) << report["machine"];
  EXPECT_EQ(report["counts"]["figures"]["fails"], 0);
  EXPECT_EQ(report["cases"].size(), count_of(run_program({"stability", "--list"}).out, "\n"));
  EXPECT_GE(report["cases"].size(), 45u);
  EXPECT_GE(report["maps"].size(), 5u);
  const std::string page = file_text(out + "/stability.html");
  expect_whole_page(page);
  for (const Json& one : report["cases"]) {
    const std::string name = one["name"];
    EXPECT_TRUE(contains(page, "id=\"" + name + "\"")) << name;
    EXPECT_TRUE(contains(result.out, name)) << name;
    EXPECT_FALSE(one["figures"].empty()) << name;
  }
  for (const Json& map : report["maps"])
    EXPECT_TRUE(contains(result.out, "map " + map["name"].get<std::string>() + ": ")) << map["name"];
}

}  // namespace
}  // namespace raytree::test
