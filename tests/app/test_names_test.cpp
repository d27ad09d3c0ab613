// Documentation names tests: each must be there.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "tests/temporary_folder.h"

namespace raytree::test {
namespace {

std::set<std::string> tests_of_the_project() {
  // TEST(Suite, Name), TEST_P and the like, at the beginning of a line; the name may stand on the next one.
  const std::regex definition("\nTEST(?:_[FP])?\\(\\s*(\\w+),\\s*(\\w+)\\s*\\)");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(RAYTREE_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = file_text(entry.path().string());
    for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match)
      names.insert((*match)[1].str() + "." + (*match)[2].str());
  }
  return names;
}

/// What has the form of a test's name: two words of capitals and small letters joined by a period, of which the second
/// may be followed by a parameter.
std::set<std::string> tests_named_in(const std::string& file) {
  const std::regex name("\\b([A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*)\\.([A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*)\\b");
  const std::string text = file_text(file);
  std::set<std::string> names;
  for (std::sregex_iterator match(text.begin(), text.end(), name), end; match != end; ++match)
    names.insert((*match)[0].str());
  return names;
}

TEST(Documentation, NamesTestsThatAreThere) {
  const std::set<std::string> tests = tests_of_the_project();
  EXPECT_TRUE(tests.contains("Documentation.NamesTestsThatAreThere"));
  std::size_t found = 0;
  const auto check = [&](const std::filesystem::path& file) {
    for (const std::string& name : tests_named_in(file.string())) {
      EXPECT_TRUE(tests.contains(name)) << file.filename() << " names " << name;
      ++found;
    }
  };
  check(RAYTREE_SOURCE_DIR "/README.md");
  check(RAYTREE_SOURCE_DIR "/CONTRIBUTING.md");
  for (const auto& entry : std::filesystem::directory_iterator(RAYTREE_SOURCE_DIR "/docs"))
    if (entry.path().extension() == ".md") check(entry.path());
  EXPECT_GE(found, 40u) << "closed-forms.md alone names so many";
}

}  // namespace
}  // namespace raytree::test
