// `raytree stability` from outside: what it prints, writes and ends with.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

TEST(StabilityCommand, LeavesTablePageAndJson) {
  TemporaryFolder folder;
  const std::string out = folder.path("made/for/it");
  const ProgramResult result =
      run_program({"stability", "-o", out, "--filter", "gouraud-highlight-*", "--budget", "5s"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  for (const char* part : {"best known", "gouraud-highlight-shape", "gouraud-highlight-loss", "cos^50",
                           "fails as known", "holds", "2 cases; ", ", 0 fail"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
  const auto json = nlohmann::json::parse(file_text(out + "/stability.json"));
  EXPECT_EQ(json["cases"].size(), 2u);
  EXPECT_EQ(json["counts"]["figures"]["fails"], 0);
  const std::string page = file_text(out + "/stability.html");
  EXPECT_TRUE(contains(page, "data:image/png;base64,"));
  EXPECT_TRUE(contains(page, "id=\"gouraud-highlight-loss\""));
}

TEST(StabilityCommand, PlantedFaultsEndInStatus3) {
  TemporaryFolder folder;
  const std::pair<const char*, const char*> faults[] = {{"no-offsets", "self-hits"}, {"not-robust", "edge-leaks"}};
  for (const auto& [fault, name] : faults) {
    const std::vector<std::string> command = {"stability", "-o", folder.path("out"), "--filter", name,
                                              "--budget",  "6s"};
    EXPECT_EQ(run_program(command).status, 0) << name;
    std::vector<std::string> planted = command;
    planted.insert(planted.end(), {"--plant", fault});
    const ProgramResult result = run_program(planted);
    EXPECT_EQ(result.status, 3) << fault;
    EXPECT_TRUE(contains(result.out, " fails")) << result.out;
  }
}

TEST(StabilityCommand, PrintsJsonAndHeedsBudgetAndPlantedFaults) {
  TemporaryFolder folder;
  const ProgramResult result =
      run_program({"stability", "-o", folder.path("out"), "--filter", "normals-by-weights", "--budget", "0.5m",
                   "--json", "--plant", "no-offsets", "--plant", "not-robust"});
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["effort"], 0.5);
  EXPECT_EQ(json["planted"], nlohmann::json::array({"no-offsets", "not-robust"}));
  EXPECT_EQ(result.status, 0) << "the case is about neither fault";
  EXPECT_EQ(result.out, file_text(folder.path("out/stability.json")));
}

TEST(StabilityCommand, ListsCases) {
  const ProgramResult result = run_program({"stability", "--list", "--filter", "*-flicker"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "gouraud-flicker  row  3  ")) << result.out;
  EXPECT_FALSE(contains(result.out, "facets-needed")) << result.out;
}

TEST(StabilityCommand, WrongInputIsNamed) {
  expect_bad_input({"stability"}, {"-o DIR"});
  expect_bad_input({"stability", "-o", "x", "--filter", "nothing"}, {"nothing", "--list"});
  expect_bad_input({"stability", "-o", "x", "--plant", "no-offset"}, {"no-offset", "did you mean no-offsets?"});
  for (const char* budget : {"", "s", "-3s", "0", "soon"})
    expect_bad_input({"stability", "-o", "x", "--budget", budget}, {"--budget"});
}

TEST(StabilityCommand, AFolderThatCannotBeMadeIsAFailure) {
  const ProgramResult result = run_program({"stability", "-o", "/dev/null/x", "--filter", "normals-by-weights"});
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.err, "/dev/null/x")) << result.err;
}

// Found out before anything is measured: the whole suite is asked for.
TEST(StabilityCommand, AFolderThatCannotBeWrittenIsNamed) {
  TemporaryFolder folder;
  for (const std::string out : {"/proc/none", "/proc/none/", "/proc"}) {
    const ProgramResult result = run_program({"stability", "-o", out});
    EXPECT_EQ(result.status, 1) << out;
    EXPECT_TRUE(contains(result.err, "error: /proc") && contains(result.err, "cannot")) << result.err;
    EXPECT_TRUE(result.out.empty()) << out;
    EXPECT_LT(result.seconds, 2) << out;
  }
  expect_bad_input({"stability", "-o", folder.write("file", "")}, {"file", "is a file", "folder"});
  std::filesystem::create_directories(folder.path("taken/stability.json"));
  expect_bad_input({"stability", "-o", folder.path("taken")}, {"stability.json", "is a folder"});
  EXPECT_FALSE(std::filesystem::exists(folder.path("taken/stability.html")));
}

TEST(StabilityCommand, TheFolderMayEndInASlash) {
  TemporaryFolder folder;
  const ProgramResult result =
      run_program({"stability", "-o", folder.path("new") + "//", "--filter", "normals-by-weights", "--budget", "1s"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_FALSE(file_text(folder.path("new/stability.json")).empty());
}

TEST(StabilityCommand, AnInterruptedRunLeavesNoFile) {
  TemporaryFolder folder;
  ProgramOptions options;
  options.signal = SIGINT;
  options.signal_after = 0.3;
  const ProgramResult result = run_program({"stability", "-o", folder.path("out")}, options);
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path("out/stability.html")));
}

}  // namespace
}  // namespace raytree::test
