// The stability suite's own machinery, over cases made up for it: verdicts, counts, planted faults, table, JSON, page.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "benchmarks/stability/stability_page.h"
#include "benchmarks/stability/stability_report.h"

namespace raytree::benchmarks {
namespace {

StabilityFigure made_up_figure(double measured, StabilityExpectation expectation) {
  return {"method <1>", "rate", measured, 0, 1, "0 & derived", expectation};
}
StabilityResult holding_case(const StabilityRun& run) {
  StabilityResult result;
  result.figures = {made_up_figure(0.5, StabilityExpectation::holds),
                    made_up_figure(1, StabilityExpectation::fails_as_known)};
  if (run.pictures) {
    StabilityPicture picture{"two pixels", {}};
    picture.image.width = 2, picture.image.height = 1;
    for (auto& plane : picture.image.planes) plane = {0, 255};
    result.pictures.push_back(picture);
    result.graphs.push_back({"A graph", "sides", "error", {{"line", {{8, 0.1}, {16, 0.01}}, false}}});
  }
  return result;
}
StabilityResult known_case(const StabilityRun&) {
  return {{made_up_figure(0.25, StabilityExpectation::fails_as_known)}, {}, {}};
}
StabilityResult about_offsets(const StabilityRun& run) {
  return {{made_up_figure(run.faults.no_offsets ? 2 : 0, StabilityExpectation::holds)}, {}, {}};
}
StabilityResult about_edges(const StabilityRun& run) {
  return {{made_up_figure(run.tracer_options().robust ? 0 : 2, StabilityExpectation::holds)}, {}, {}};
}
StabilityResult far_case(const StabilityRun&) {
  return {{made_up_figure(1.5, StabilityExpectation::fails_as_known)}, {}, {}};
}
StabilityResult unmeasured_case(const StabilityRun&) {
  return {{made_up_figure(std::numeric_limits<double>::quiet_NaN(), StabilityExpectation::holds)}, {}, {}};
}
StabilityResult empty_case(const StabilityRun&) { return {}; }
StabilityResult throwing_case(const StabilityRun&) { throw std::runtime_error("no <mesh>"); }

GroupedCase made_up(const char* name, StabilityResult (*run)(const StabilityRun&), const char* group = "Made up") {
  return {group, {7, name, "A title", "Something", "A remedy", "A paper", run}};
}
StabilityReport run_of(const std::vector<GroupedCase>& cases, const StabilityFaults& faults = {}) {
  StabilityOptions options;
  options.run.faults = faults;
  return run_stability(cases, options);
}
StabilityVerdict verdict_of(StabilityResult (*run)(const StabilityRun&), const StabilityFaults& faults = {}) {
  return run_of({made_up("one", run)}, faults).entries.at(0).verdict();
}

TEST(StabilityHarness, VerdictsAreTheWorstOfTheirFigures) {
  EXPECT_EQ(verdict_of(holding_case), StabilityVerdict::holds);
  EXPECT_EQ(verdict_of(known_case), StabilityVerdict::fails_as_known);
  for (const auto run : {far_case, unmeasured_case, empty_case, throwing_case})
    EXPECT_EQ(verdict_of(run), StabilityVerdict::fails);
}

TEST(StabilityHarness, PlantedFaultsReachTheCases) {
  EXPECT_EQ(verdict_of(about_offsets), StabilityVerdict::holds);
  EXPECT_EQ(verdict_of(about_edges), StabilityVerdict::holds);
  EXPECT_EQ(verdict_of(about_offsets, {true, false}), StabilityVerdict::fails);
  EXPECT_EQ(verdict_of(about_edges, {true, false}), StabilityVerdict::holds);
  EXPECT_EQ(verdict_of(about_edges, {false, true}), StabilityVerdict::fails);
}

TEST(StabilityHarness, EveryFigureIsCounted) {
  const StabilityReport report =
      run_of({made_up("a", holding_case), made_up("b", known_case), made_up("c", throwing_case),
              made_up("d", empty_case), made_up("e", far_case)});
  EXPECT_EQ(report.cases().holds, 1u);
  EXPECT_EQ(report.cases().fails_as_known, 1u);
  EXPECT_EQ(report.cases().fails, 3u);
  EXPECT_EQ(report.figures().holds, 1u);
  EXPECT_EQ(report.figures().fails_as_known, 2u);
  EXPECT_EQ(report.figures().fails, 3u);
  EXPECT_EQ(counts_text(report), "5 cases; 6 figures: 1 hold, 2 fail as known, 3 fail");
}

TEST(StabilityHarness, TablesNameCaseMethodFigureAndVerdict) {
  const std::string text = stability_text(run_of(
      {made_up("good", holding_case), made_up("broken", throwing_case), made_up("far", far_case)}, {true, true}));
  for (const char* part : {"case", "best known", "good", "method <1>", "0 & derived", "fails as known",
                           "fails: no <mesh>", "1.5", "fails: not within [0, 1]", "planted: no-offsets, not-robust"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(StabilityHarness, FiguresAndIntervalsAreToldInFewDigits) {
  EXPECT_EQ(figure_text(0), "0");
  EXPECT_EQ(figure_text(3445), "3445");
  EXPECT_EQ(figure_text(1.23456e-5), "1.235e-05");
  EXPECT_EQ(figure_text(std::numeric_limits<double>::quiet_NaN()), "not measured");
  const auto interval = [](double low, double high) {
    StabilityFigure figure;
    figure.low = low, figure.high = high;
    return interval_text(figure);
  };
  EXPECT_EQ(interval(0, 0), "0");
  EXPECT_EQ(interval(0, 0.25), "[0, 0.25]");
  EXPECT_EQ(interval(2 - 0x1p-20, 2 + 0x1p-20), "2 \u00b1 9.5e-07");
  EXPECT_EQ(interval(-0x1p-20, 0x1p-20), "0 ± 9.5e-07");
  EXPECT_EQ(interval(3, std::numeric_limits<double>::infinity()), "at least 3");
}

TEST(StabilityHarness, JsonHoldsEveryFigureAndNullForWhatIsNone) {
  const auto json = nlohmann::json::parse(stability_json(
      run_of({made_up("good", holding_case), made_up("nan", unmeasured_case), made_up("broken", throwing_case)},
             {false, true})));
  EXPECT_EQ(json["planted"], nlohmann::json::array({"not-robust"}));
  EXPECT_EQ(json["counts"]["cases"]["fails"], 2);
  ASSERT_EQ(json["cases"].size(), 3u);
  EXPECT_EQ(json["cases"][0]["verdict"], "holds");
  EXPECT_EQ(json["cases"][0]["figures"][1]["verdict"], "fails_as_known");
  EXPECT_EQ(json["cases"][0]["figures"][0]["measured"], 0.5);
  EXPECT_TRUE(json["cases"][1]["figures"][0]["measured"].is_null());
  EXPECT_EQ(json["cases"][2]["error"], "no <mesh>");
}

TEST(StabilityHarness, JsonHoldsMapsBesideCases) {
  const StabilityReport report = run_of({made_up("good", holding_case)});
  EXPECT_EQ(nlohmann::json::parse(stability_json(report)).count("maps"), 0u);
  EXPECT_EQ(nlohmann::json::parse(stability_json(report, "[{\"name\": \"scale\"}]"))["maps"][0]["name"], "scale");
}

TEST(StabilityHarness, PagesHoldPicturesGraphsVerdictsAndFurtherSections) {
  const StabilityReport report =
      run_of({made_up("good", holding_case), made_up("broken", throwing_case, "Another group")});
  const std::string page = stability_page(report, {{"maps", "Maps & more", "<p>here</p>"}});
  for (const char* part : {"id=\"good\"", "data:image/png;base64,", "two pixels", "<svg", "A graph", "method &lt;1&gt;",
                           "The case ended early: no &lt;mesh&gt;", "Another group", "All cases at a glance",
                           "<a href=\"#maps\">Maps &amp; more</a>", "<p>here</p>",
                           "class=\"known verdict\">fails as known", "class=\"chip fails\">fails"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("were planted"), std::string::npos);
  EXPECT_NE(stability_page(run_of({}, {true, false})).find("were planted"), std::string::npos);
  for (const char* address : {"http:", "https:", "src=\"//"}) EXPECT_EQ(page.find(address), std::string::npos);
}

TEST(StabilityHarness, PatternsAreThoseOfTheShell) {
  const std::vector<GroupedCase> cases{made_up("gouraud-flicker", known_case), made_up("edge-leak", known_case)};
  EXPECT_EQ(matching_cases(cases, "*").size(), 2u);
  EXPECT_EQ(matching_cases(cases, "gouraud-*").size(), 1u);
  EXPECT_EQ(matching_cases(cases, "gouraud").size(), 0u);
}

TEST(StabilityHarness, EffortIsAFunctionOfTheBudgetAlone) {
  EXPECT_EQ(stability_effort(60), 1);
  EXPECT_EQ(stability_effort(3600), 1);
  EXPECT_EQ(stability_effort(30), 0.5);
  EXPECT_EQ(stability_effort(1e-3), kLeastEffort);
}

TEST(StabilityHarness, AStoppedRunIsNotComplete) {
  const std::atomic<bool> stop{true};
  StabilityOptions options;
  options.run.stop = &stop;
  const StabilityReport report = run_stability({made_up("good", holding_case)}, options);
  EXPECT_FALSE(report.complete);
  EXPECT_TRUE(report.entries.empty());
}

TEST(StabilityHarness, GraphsWithoutAPointAreEmpty) {
  EXPECT_EQ(stability_page(run_of({made_up("known", known_case)})).find("<svg"), std::string::npos);
}

// What --filter, the page's links and docs rely on.
TEST(StabilityHarness, EveryCaseOfTheSuiteIsNamedOnceAndDescribed) {
  std::set<std::string> names;
  for (const GroupedCase& grouped : stability_cases()) {
    const StabilityCase& what = grouped.what;
    EXPECT_TRUE(names.insert(what.name).second) << what.name;
    EXPECT_GE(what.row, 1) << what.name;
    EXPECT_LE(what.row, 66) << what.name;
    EXPECT_EQ(std::string(what.name).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos)
        << what.name;
    for (const char* text : {what.title, what.provocation, what.remedy, what.source}) {
      ASSERT_NE(text, nullptr) << what.name;
      EXPECT_NE(std::string(text), "") << what.name;
    }
  }
}

}  // namespace
}  // namespace raytree::benchmarks
