// The suite as a whole: which failures it knows, and that its documentation lists them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "benchmarks/stability/stability.h"

namespace raytree::benchmarks {
namespace {

constexpr const char* kListBegins =
    "<!-- cases:begin; RAYTREE_UPDATE_DOCS=1 benchmarks_tests writes what stands to the end -->\n";
constexpr const char* kListEnds = "<!-- cases:end -->\n";

std::string case_list() {
  std::string list = "| row | case | provoked by | remedy | source |\n|---:|---|---|---|---|\n";
  for (const GroupedCase& grouped : stability_cases()) {
    const StabilityCase& one = grouped.what;
    list += "| " + std::to_string(one.row) + " | `" + one.name + "` " + one.title + " | " + one.provocation + " | " +
            one.remedy + " | " + one.source + " |\n";
  }
  return list;
}

std::string text_of(const std::string& file) {
  std::stringstream text;
  text << std::ifstream(std::string(RAYTREE_SOURCE_DIR) + "/" + file).rdbuf();
  return text.str();
}

TEST(StabilityCatalogue, KnowsAsManyFailuresAsTheReadmeSays) {
  std::set<int> rows, catalogue;
  for (const GroupedCase& grouped : stability_cases()) rows.insert(grouped.what.row);
  for (int row = 1; row <= 66; ++row)
    if (row != 52) catalogue.insert(row);  // displacement, which Raytree has none of
  EXPECT_EQ(rows, catalogue);
  const std::string sentence = "`stability` provokes " + std::to_string(stability_cases().size()) + " known failures";
  EXPECT_NE(text_of("README.md").find(sentence), std::string::npos) << sentence;
}

/// Cases that show their remedy alone, and why.
const std::map<std::string, std::string>& shown_with_the_remedy_alone() {
  static const std::map<std::string, std::string> reasons = {
      {"wide-box", "the failure is of another program's tracer; ours holds as it is"},
      {"bad-rays", "without the check Embree ends the process"},
      {"extraordinary-vertices",
       "without limit masks there is no normal; docs/stability.md has an average's in a graph"},
      {"non-manifold", "OpenSubdiv sharpens such edges itself, and has no switch for it"},
      {"bad-topology", "without the check OpenSubdiv ends the process"},
      {"display-values",
       "without it what comes out depends on the display's transform: black, NaN or a clipped color"}};
  return reasons;
}

TEST(StabilityCatalogue, ShowsWhatFailsWithoutEachRemedy) {
  StabilityRun run;
  run.effort = 0.01;
  run.pictures = false;
  std::set<std::string> without;
  for (const GroupedCase& grouped : stability_cases()) {
    const StabilityCase& one = grouped.what;
    SCOPED_TRACE(one.name);
    EXPECT_NE(std::string(one.remedy), "");
    bool fails = false, holds = false;
    for (const StabilityFigure& figure : one.run(run).figures)
      (figure.expectation == StabilityExpectation::fails_as_known ? fails : holds) = true;
    EXPECT_TRUE(holds) << "nothing of the renderer's own method";
    if (!fails) without.insert(one.name);
  }
  std::set<std::string> excused;
  for (const auto& [name, reason] : shown_with_the_remedy_alone()) excused.insert(name);
  EXPECT_EQ(without, excused);
}

TEST(StabilityCatalogue, StandsInTheDocumentation) {
  const std::string path = std::string(RAYTREE_SOURCE_DIR) + "/docs/stability.md";
  std::string document = text_of("docs/stability.md");
  const std::size_t begin = document.find(kListBegins), end = document.find(kListEnds);
  ASSERT_NE(begin, std::string::npos) << path;
  ASSERT_NE(end, std::string::npos) << path;
  const std::size_t first = begin + std::string(kListBegins).size();
  if (const char* update = std::getenv("RAYTREE_UPDATE_DOCS"); update != nullptr && *update == '1') {
    document = document.substr(0, first) + case_list() + document.substr(end);
    std::ofstream(path) << document;
  }
  EXPECT_EQ(document.substr(first, document.find(kListEnds) - first), case_list());
}

}  // namespace
}  // namespace raytree::benchmarks
