// The suite as a whole: which failures it knows, and that its documentation lists them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
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
  std::set<int> rows;
  for (const GroupedCase& grouped : stability_cases()) rows.insert(grouped.what.row);
  EXPECT_GE(rows.size(), 60u);
  const std::string sentence = "`stability` provokes " + std::to_string(stability_cases().size()) + " known failures";
  EXPECT_NE(text_of("README.md").find(sentence), std::string::npos) << sentence;
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
