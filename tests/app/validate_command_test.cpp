// `raytree validate` and `raytree ray` from outside: what they print, write and end with.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

TEST(ValidateCommand, FindsNoDefectAndSaysSoInTextJsonAndPicture) {
  TemporaryFolder folder;
  const std::string png = folder.path("marked.png"), json = folder.path("report.json");
  const ProgramResult result =
      run_program({"validate", "glass", "--size", "64x48", "--full", "-o", png, "--json", json});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  for (const char* part : {"primary", "shadow", "reflected", "refracted", "defect", "largest ulp", "bounds", "rays/s",
                           "3072 of 3072 pixels", "no defect"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
  EXPECT_EQ(file_text(png).substr(1, 3), "PNG");
  const Json report = Json::parse(file_text(json));
  EXPECT_EQ(report["rays"]["primary"]["rays"], 64 * 48);
  EXPECT_EQ(report["rays"]["all"]["defect"], 0);
  EXPECT_EQ(report["holds"], true);
}

TEST(ValidateCommand, ReportsDoNotDependOnThreads) {
  const auto report = [](const char* threads) {
    Json json = Json::parse(
        run_program({"validate", "spheres-1980", "--size", "96x72", "--rays", "2000", "--json", "--threads", threads})
            .out);
    json.erase("speed");
    return json;
  };
  EXPECT_EQ(report("1"), report("3"));
}

TEST(ValidateCommand, TablesTakeSeveralScenes) {
  const ProgramResult result = run_program({"validate", "--table", "--size", "32x24", "spheres-1980", "glass"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(
      contains(result.out, "| scene | rays | edge | coplanar | grazing | tessellation | nonplanar | self | defect |"));
  EXPECT_TRUE(contains(result.out, "\n| spheres-1980 | "));
  EXPECT_TRUE(contains(result.out, "\n| glass | "));
}

TEST(ValidateCommand, ComparesWithWhitteds1980TracerUnlessFacetsHaveNoTolerance) {
  const auto compared = [](std::vector<std::string> more) {
    std::vector<std::string> words = {"validate", "teapot", "--size", "32x24", "--full"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(contains(result.out, "no defect"));
    return result.out;
  };
  EXPECT_TRUE(contains(compared({}), "truth    spheres\n"));
  EXPECT_TRUE(contains(compared({"--rate", "4"}), "truth    triangles\n"));
  EXPECT_TRUE(contains(compared({"--truth", "triangles"}), "truth    triangles\n"));
}

TEST(ValidateCommand, PlantedFaultsEndInStatus3) {
  for (const char* fault :
       {"dropped-triangles", "shifted-bound", "wrong-index", "epsilon", "wrong-distance", "swapped-barycentrics"}) {
    const ProgramResult result = run_program({"validate", "glass", "--size", "64x48", "--full", "--plant", fault});
    EXPECT_EQ(result.status, 3) << fault << "\n" << result.out << result.err;
    EXPECT_TRUE(contains(result.out, "DEFECTS")) << fault;
    EXPECT_TRUE(contains(result.out, "planted  ")) << fault;
  }
}

TEST(ValidateCommand, WrongInputIsNamed) {
  expect_bad_input({"validate", "glass", "--rays", "0"}, {"--rays"});
  expect_bad_input({"validate", "glass", "--rays", "9", "--full"}, {"--full", "--rays"});
  expect_bad_input({"validate", "glass", "rough"}, {"rough", "--table"});
  expect_bad_input({"validate", "glass", "-o", "a.exr"}, {"a.exr", ".png"});
  expect_bad_input({"validate", "glass", "--truth", "sphere"}, {"sphere", "did you mean spheres?"});
  expect_bad_input({"validate", "glass", "--plant", "epsilo"}, {"epsilo", "did you mean epsilon?"});
  expect_bad_input({"validate", "teapot", "--truth", "spheres", "--rate", "4"}, {"--truth spheres", "rate"});
  expect_bad_input({"ray", "glass", "0,0,0"}, {"two vectors"});
  expect_bad_input({"ray", "glass", "0,0,0", "0,0,0"}, {"direction"});
  expect_bad_input({"ray", "glass", "0,-2e18,0", "0,1,0"}, {"origin 0,-2e+18,0", "beyond 1e18"});
  expect_bad_input({"ray", "glass", "0,0,0", "0,1,1e30"}, {"direction 0,1,1e+30", "beyond 1e18"});
  expect_bad_input({"ray", "glass", "0,0,0", "0,0,1", "--end", "-1"}, {"--end"});
}

TEST(RayCommand, AsksBothTracersAboutOneRay) {
  const ProgramResult result = run_program({"ray", "spheres-1980", "0,1,5", "-0x1p-3,-0.2,-0.97"});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* part :
       {"truth     \"", "fast      \"", "coherent  \"", "agree", "normal", "as a shadow ray occluded"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
  // The same ray, ended before anything is met.
  const ProgramResult ended = run_program({"ray", "spheres-1980", "0,1,5", "-0x1p-3,-0.2,-0.97", "--end", "0.001"});
  EXPECT_TRUE(contains(ended.out, "truth     miss, by spheres\nfast      miss")) << ended.out;
}

}  // namespace
}  // namespace raytree::test
