// `raytree chart` from outside: what it writes, that errors repeat, that commands give the pictures charted, that it
// goes on where it was interrupted. Its page is chart_page_test.cpp's matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "renderer/image_file.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// Glass needs a tree, the cone has sides; small enough for seconds.
std::vector<std::string> small_chart(const TemporaryFolder& folder, const std::string& scene, const std::string& name) {
  return {"chart", scene, "-o", folder.path(name), "--size", "36x24", "--budget", "1s"};
}

Json chart_in(const TemporaryFolder& folder, const std::string& name) {
  return Json::parse(file_text(folder.path(name) + "/chart.json"));
}

TEST(ChartCommand, WritesEverythingAndErrorsRepeatToTheLastBit) {
  const TemporaryFolder folder;
  const ProgramResult first = run_program(small_chart(folder, "cone", "first"));
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_TRUE(contains(first.out, "Cheapest setting under 1/255")) << first.out;
  for (const char* file : {"chart.html", "chart.svg", "points.csv", "chart.json", "reference.exr"})
    EXPECT_FALSE(file_text(folder.path("first") + "/" + file).empty()) << file;
  ASSERT_EQ(run_program(with(small_chart(folder, "cone", "second"), {"--threads", "1"})).status, 0);
  const Json a = chart_in(folder, "first"), b = chart_in(folder, "second");
  EXPECT_EQ(a["reference"]["own_error"], b["reference"]["own_error"]);
  EXPECT_GT(a["reference"]["own_error"]["rmse"], 0);
  std::size_t compared = 0;
  for (const Json& point : a["points"])
    for (const Json& other : b["points"])
      if (point["key"] == other["key"]) {
        EXPECT_EQ(point["errors"].dump(), other["errors"].dump()) << point["command"];
        EXPECT_EQ(point["picture_hash"], other["picture_hash"]);
        ++compared;
      }
  EXPECT_GE(compared, 10u);
  // Knobs of the scene, and none that it has no use for.
  const std::string flags = a["points"].dump();
  for (const char* knob : {"--shading", "sides=8", "--edges", "--threshold"})
    EXPECT_TRUE(contains(flags, knob)) << knob;
  for (const char* knob : {"--rough-samples", "--cutoff", "--tolerance"}) EXPECT_FALSE(contains(flags, knob)) << knob;
}

// Patches, glass and rough surfaces, whose samples are drawn.
TEST(ChartCommand, ErrorsRepeatWhateverTheSceneHas) {
  const TemporaryFolder folder;
  for (const std::string scene : {"teapot", "glass", "rough"}) {
    ASSERT_EQ(run_program(small_chart(folder, scene, scene + "1")).status, 0);
    ASSERT_EQ(run_program(with(small_chart(folder, scene, scene + "2"), {"--threads", "1"})).status, 0);
    const Json a = chart_in(folder, scene + "1"), b = chart_in(folder, scene + "2");
    EXPECT_EQ(a["reference"]["own_error"], b["reference"]["own_error"]) << scene;
    EXPECT_EQ(a["points"][0]["errors"].dump(), b["points"][0]["errors"].dump()) << scene;
  }
}

TEST(ChartBudget, AnyHoldsTheSceneAsItIs) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program({"chart", "spheres-1980", "-o", folder.path("chart"), "--size", "24x16", "--budget", "1s"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json chart = chart_in(folder, "chart");
  EXPECT_EQ(chart["points"][0]["knob"], "defaults");
  EXPECT_EQ(chart["complete"], true);
  EXPECT_TRUE(contains(chart["reference"]["command"], "--depth")) << chart["reference"]["command"];
}

TEST(ChartCommand, CommandsGiveThePicturesCharted) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(small_chart(folder, "cone", "chart")).status, 0);
  const Json chart = chart_in(folder, "chart");
  std::size_t compared = 0;
  for (const Json& point : chart["points"]) {
    if (compared == 8) break;  // defaults and ends, sides among them
    const std::string png = folder.path("again.png"), command = point["command"];
    ASSERT_EQ(command.rfind("raytree render cone --size 36x24", 0), 0u) << command;
    const std::string line = RAYTREE_PROGRAM + command.substr(7) + " --quiet -o " + png;
    ASSERT_EQ(std::system(line.c_str()), 0) << line;
    const DecodedImage again = read_image_file(png);
    const DecodedImage charted =
        read_image_file(folder.path("chart") + "/pictures/" + point["key"].get<std::string>() + ".png");
    EXPECT_EQ(again.planes, charted.planes) << command;
    ++compared;
  }
  EXPECT_EQ(compared, 8u);
}

TEST(ChartCommand, GoesOnWhereItStoppedAndStartsAfreshOnRequest) {
  const TemporaryFolder folder;
  const auto words = small_chart(folder, "cone", "chart");
  ASSERT_EQ(run_program(words).status, 0);
  const Json before = chart_in(folder, "chart");
  const ProgramResult again = run_program(words);
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(contains(again.err, std::to_string(before["points"].size()) + " of them from before")) << again.err;
  const Json after = chart_in(folder, "chart");
  ASSERT_GE(after["points"].size(), before["points"].size());
  for (std::size_t i = 0; i < before["points"].size(); ++i) {
    const Json &then = before["points"][i], &now = after["points"][i];
    EXPECT_EQ(then["key"], now["key"]);
    EXPECT_EQ(then["errors"].dump(), now["errors"].dump());
    // Times that were taken are kept; those taken since stand behind them.
    const auto samples = then["cpu_seconds"]["samples"].size();
    ASSERT_GE(now["cpu_seconds"]["samples"].size(), samples);
    EXPECT_EQ(now["cpu_seconds"]["samples"][0], then["cpu_seconds"]["samples"][0]);
  }
  // Another subject, or --fresh, keeps nothing.
  EXPECT_FALSE(contains(run_program(with(words, {"--set", "render.depth=3"})).err, "from before"));
  EXPECT_FALSE(contains(run_program(with(words, {"--set", "render.depth=3", "--fresh"})).err, "from before"));
}

// Of itself a second affords the smallest of pictures here; what is there already is not thrown away for it.
TEST(ChartCommand, AShorterRunGoesOnWithALargerChart) {
  const TemporaryFolder folder;
  const std::vector<std::string> words{"chart", "glass", "-o", folder.path("chart"), "--budget", "1s"};
  ASSERT_EQ(run_program(with(words, {"--size", "150x100"})).status, 0);
  const ProgramResult again = run_program(words);
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(contains(again.err, "from before")) << again.err;
  EXPECT_EQ(chart_in(folder, "chart")["width"], 150);
  ASSERT_EQ(run_program(with(words, {"--fresh"})).status, 0);
  const Json fresh = chart_in(folder, "chart");
  EXPECT_EQ(fresh["width"], 120);
  EXPECT_TRUE(contains(fresh["points"][0]["command"], "--size 120x80")) << "the size is said";
}

TEST(ChartCommand, AnInterruptionKeepsWhatIsDone) {
  const TemporaryFolder folder;
  ProgramOptions options;
  options.signal = SIGINT;
  options.signal_after = 2;
  const ProgramResult result = run_program(
      {"chart", "cone", "-o", folder.path("chart"), "--size", "72x48", "--budget", "20s", "--threads", "1"}, options);
  EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
  EXPECT_LT(result.seconds_after_signal, 1.0);
  const Json chart = chart_in(folder, "chart");
  EXPECT_EQ(chart["complete"], false);
  EXPECT_GE(chart["points"].size(), 1u);
  EXPECT_TRUE(contains(file_text(folder.path("chart") + "/chart.html"), "interrupted"));
}

// 144 samples a pixel of a single level: dearer than one sample of the whole tree, and wrong.
TEST(ChartCommand, APlantedDominatedSettingNeverReachesTheFront) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program({"chart", "spheres-1980", "-o", folder.path("chart"), "--size", "36x24",
                                            "--budget", "5s", "--also", "--antialias grid:12 --depth 1"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json chart = chart_in(folder, "chart");
  std::size_t planted = chart["points"].size();
  for (std::size_t i = 0; i < chart["points"].size(); ++i)
    if (chart["points"][i]["knob"] == "added") planted = i;
  ASSERT_LT(planted, chart["points"].size());
  EXPECT_TRUE(contains(chart["points"][planted]["command"], "--antialias grid:12 --depth 1"));
  for (const char* metric : {"rmse", "flip"}) {
    const Json& front = chart["fronts"][metric];
    EXPECT_FALSE(front.empty());
    EXPECT_EQ(std::count(front.begin(), front.end(), planted), 0) << metric;
  }
  const std::string svg = file_text(folder.path("chart") + "/chart.svg");
  EXPECT_TRUE(contains(svg, "<circle class=\"point\" data-point=\"" + std::to_string(planted) + "\"")) << "greyed";
}

TEST(ChartInput, TheFolderMayEndInASlash) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program({"chart", "cone", "-o", folder.path("new") + "/", "--size", "16x12", "--budget", "1s"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "wrote " + folder.path("new/chart.html"))) << result.err;
  EXPECT_FALSE(file_text(folder.path("new/chart.html")).empty());
}

// Found out before anything is measured, and nothing is left behind.
TEST(ChartInput, AFolderThatCannotBeWrittenIsNamed) {
  const TemporaryFolder folder;
  const auto chart = [&](const std::string& out) {
    return run_program({"chart", "cone", "-o", out, "--size", "16x12", "--budget", "60s"});
  };
  for (const std::string out : {"/proc/none", "/proc/none/", "/proc"}) {
    const ProgramResult result = chart(out);
    EXPECT_EQ(result.status, 1) << out;
    EXPECT_TRUE(contains(result.err, "error: /proc") && contains(result.err, "cannot")) << result.err;
    EXPECT_LT(result.seconds, 10) << out;
  }
  // A folder where a file is to stand, and the other way round.
  for (const char* file : {"chart.html", "reference.exr"}) {
    std::filesystem::create_directories(folder.path(std::string("taken-") + file) + "/" + file);
    const ProgramResult result = chart(folder.path(std::string("taken-") + file));
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_TRUE(contains(result.err, file) && contains(result.err, "is a folder")) << result.err;
  }
  std::filesystem::create_directory(folder.path("own"));
  folder.write("own/pictures", "");
  expect_bad_input({"chart", "cone", "-o", folder.path("own")}, {"own/pictures", "is a file"});
  for (const std::string& name : folder.names())
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path(name)), {}), 1) << name;
}

TEST(ChartInput, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const std::string out = folder.path("chart");
  const auto wrong = [&](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    expect_bad_input(with({"chart", "cone", "-o", out}, flags), parts);
  };
  expect_bad_input({"chart", "cone"}, {"no output", "-o"});
  expect_bad_input({"chart", "-o", out}, {"no scene"});
  expect_bad_input({"chart", "conee", "-o", out}, {"conee", "did you mean cone"});
  expect_bad_input({"chart", "cone", "-o", folder.path("no/such")}, {"there is no folder"});
  expect_bad_input({"chart", "cone", "-o", folder.write("file", "")}, {"is a file", "folder"});
  for (const char* budget : {"0s", "-2m", "soon", "", "3d", "200h"}) wrong({"--budget", budget}, {"--budget"});
  wrong({"--size", "big"}, {"--size", "WxH"});
  wrong({"--camera", "nobody"}, {"--camera", "nobody"});
  wrong({"--set", "render.deepth=3"}, {"deepth"});
  wrong({"--also", "--shading gourad"}, {"--shading", "did you mean gouraud"});
  wrong({"--also", "--sieze 3"}, {"unknown flag --sieze"});
  wrong({"--also", "--help"}, {"help is no setting"});
  for (const std::string word : {"--size 3x3", "--size=3x3", "-o a.png", "--camera main", "--threads 2"})
    wrong({"--also", word}, {"--also", word.substr(0, word.find_first_of(" =")), "alike for all of a chart"});
  wrong({"--also", "--set 'a"}, {"quote"});
  wrong({"--threads", "0"}, {"--threads"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
  std::filesystem::create_directory(out);
  write_text(out + "/chart.json", R"({"raytree_chart": 2, "points": []})");
  wrong({}, {"chart.json", "another version", "2", "--fresh"});
  write_text(out + "/chart.json", "[]");
  wrong({"--budget", "1s"}, {"chart.json", "is no chart"});
}

}  // namespace
}  // namespace raytree::test
