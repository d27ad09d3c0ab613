// The program from outside: help, wrong input, lists, info, and the documentation that names each flag.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "renderer/builtin_scenes.h"
#include "tests/app/documentation.h"
#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// The commands, from the general help, which the program makes of the table that it runs them by.
std::vector<std::string> command_names() {
  const std::string help = run_program({"--help"}).out;
  std::istringstream lines(help.substr(std::min(help.find("Commands:\n"), help.size())));
  std::vector<std::string> names;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && !line.empty()) names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

// --- help, version, documentation ---------------------------------------------------------------------------

std::set<std::string> flags_in(const std::string& text) {
  std::set<std::string> flags;
  const std::regex flag("(^|[\\s,`(|\\[])(--[a-z][a-z-]*|-[a-z])\\b");
  for (std::sregex_iterator match(text.begin(), text.end(), flag), end; match != end; ++match)
    flags.insert((*match)[2].str());
  return flags;
}

TEST(CommandLineHelp, EveryFlagIsDocumentedAndEveryDocumentedFlagExists) {
  for (const std::string& command : command_names()) {
    const ProgramResult help = run_program({command, "--help"});
    ASSERT_EQ(help.status, 0) << help.err;
    EXPECT_EQ(help.err, "");
    // Flags stand in the first column of both; examples in running text may name those of other commands.
    std::set<std::string> in_help, in_documentation;
    const auto collect = [](const std::string& text, const std::string& pattern, std::set<std::string>& flags) {
      const std::regex line_start(pattern);
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) {
        std::smatch head;
        if (std::regex_search(line, head, line_start)) flags.merge(flags_in(head.str()));
      }
    };
    collect(help.out, "^  +-[^ ]+", in_help);
    collect(documentation_of(command), "^\\| `-[^|]*\\|", in_documentation);
    EXPECT_TRUE(in_help.count("--help")) << help.out;
    EXPECT_EQ(in_help, in_documentation) << command;
  }
}

TEST(CommandLineHelp, RenderHasEveryFlagPromised) {
  const std::string help = run_program({"render", "--help"}).out;
  for (const char* flag :
       {"-o",       "--size",    "--crop",      "--threads", "--depth",         "--cutoff",        "--antialias",
        "--camera", "--set",     "--channels",  "--half",    "--exposure",      "--ocio",          "--display",
        "--view",   "--stats",   "--threshold", "--levels",  "--minimum-level", "--rough-samples", "--progress",
        "--quiet",  "--verbose", "--version",   "--help",    "--format"})
    EXPECT_TRUE(flags_in(help).count(flag)) << flag;
}

TEST(CommandLineHelp, GeneralHelpListsEveryCommand) {
  const ProgramResult help = run_program({"--help"});
  EXPECT_EQ(help.status, 0);
  // The documentation has a section for each, and none of another.
  const std::string documentation = file_text(RAYTREE_SOURCE_DIR "/docs/command-line.md");
  const std::regex heading("\n## raytree ([a-z]+)\n");
  std::set<std::string> documented;
  for (std::sregex_iterator match(documentation.begin(), documentation.end(), heading), end; match != end; ++match)
    documented.insert((*match)[1].str());
  const std::vector<std::string> commands = command_names();
  EXPECT_EQ(std::set<std::string>(commands.begin(), commands.end()), documented);
  EXPECT_GE(commands.size(), 12u);
  const ProgramResult bare = run_program({});
  EXPECT_EQ(bare.status, 2);
  EXPECT_EQ(bare.out, "");
  EXPECT_TRUE(contains(bare.err, "Usage: raytree"));
}

TEST(CommandLineHelp, VersionFromTheProgramAndFromEachCommand) {
  const ProgramResult version = run_program({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(std::regex_match(version.out, std::regex("raytree [0-9]+\\.[0-9]+\\.[0-9]+ \\(.*\\)\n"))) << version.out;
  for (const std::string& command : command_names()) EXPECT_EQ(run_program({command, "--version"}).out, version.out);
}

// --- wrong input --------------------------------------------------------------------------------------------

TEST(CommandLineErrors, UnknownWordsAreNamedWithWhatWouldBeRight) {
  TemporaryFolder folder;
  const std::string png = folder.path("a.png");
  expect_bad_input({"rendr", kScene},
                   {"\"rendr\"", "did you mean render?",
                    "info, sheet, convert, scenes, schema, bench, chart, validate, stability, ray, ocio"});
  expect_bad_input({"--verison"}, {"--verison", "--version"});
  expect_bad_input(with(small_render(png), {"--thread", "2"}), {"unknown flag --thread;", "did you mean --threads?"});
  expect_bad_input(with(small_render(png), {"--exposur=1"}), {"unknown flag --exposur;", "--exposure"});
  expect_bad_input({"scenes", "--jsno"}, {"--jsno", "--json"});
  expect_bad_input({"schema", "more"}, {"unexpected argument \"more\""});
  expect_bad_input({"ocio"}, {"list, check"});
  expect_bad_input({"ocio", "chek"}, {"\"chek\"", "did you mean check?"});
  expect_bad_input({"render", "spheres-1908", "-o", png},
                   {"spheres-1908", "did you mean spheres-1980?", "built-in scenes: "});
  expect_bad_input({"info", "no/such/folder/scene.json"}, {"no/such/folder/scene.json", "no such file", "no folder"});
  expect_bad_input({"render", kScene, "more.json", "-o", png}, {"unexpected argument \"more.json\"", kScene});
  expect_bad_input({"render", kScene, png}, {"follows -o"});
  EXPECT_TRUE(folder.names().empty());
}

TEST(CommandLineErrors, ValuesOutOfPlaceNameTheFlagAndTheForm) {
  TemporaryFolder folder;
  const std::string png = folder.path("a.png"), exr = folder.path("a.exr");
  const auto wrong = [&](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    expect_bad_input(with({"render", kScene, "-o", png, "-o", exr}, flags), parts);
  };
  for (const char* size : {"64", "x", "64x", "64x0", "-4x4", "64x48x2", "6.5x4", "99999999999999999999x1", "64*48"})
    wrong({"--size", size}, {"--size", size});
  for (const char* crop : {"8x8", "8x8+1", "8x8+1+-1", "0x8+0+0", "8x8+a+0", "8x8+0+0+0"})
    wrong({"--crop", crop}, {"--crop", crop});
  for (const char* threads : {"0", "1025", "-1", "two", "1.5", ""}) wrong({"--threads", threads}, {"--threads"});
  for (const char* depth : {"0", "-3", "x"}) wrong({"--depth", depth}, {"--depth"});
  for (const char* cutoff : {"-1", "nan", "inf", "x"}) wrong({"--cutoff", cutoff}, {"--cutoff"});
  for (const char* method : {"grid", "grid:", "grid:0", "grid:x", "grid:100000", "corner"})
    wrong({"--antialias", method}, {"--antialias"});
  for (const char* threshold : {"-1", "nan", "inf", "x", ""}) wrong({"--threshold", threshold}, {"--threshold"});
  for (const char* level : {"-1", "7", "2.5", "x", ""}) {
    wrong({"--levels", level}, {"--levels"});
    wrong({"--minimum-level", level}, {"--minimum-level"});
  }
  for (const char* samples : {"0", "1025", "-1", "2.5", "x", ""})
    wrong({"--rough-samples", samples}, {"--rough-samples"});
  wrong({"--minimum-level", "3", "--levels", "2"}, {"--minimum-level", "3", "2 levels"});
  wrong({"--exposure", "bright"}, {"--exposure", "bright"});
  wrong({"--channels", "color,dept"}, {"--channels", "\"dept\"", "did you mean depth?", "truncation, all"});
  wrong({"--channels", "color,"}, {"--channels", "missing"});
  wrong({"--progress", "loud"}, {"--progress", "auto, bar, plain, none"});
  wrong({"--set", "render.depth"}, {"--set", "PATH=VALUE"});
  wrong({"--set", "=3"}, {"--set"});
  wrong({"--set", "render.deepth=3"}, {"--set", "deepth"});
  wrong({"--camera", "nobody"}, {"--camera", "nobody", "cameras: "});
  wrong({"--display", "Hercules"}, {"Hercules", "sRGB"});
  wrong({"--view", "Sideways"}, {"Sideways", "Standard"});
  wrong({"--ocio", folder.path("none.ocio")}, {"none.ocio"});
  wrong({"--quiet", "--verbose"}, {"--quiet"});
  wrong({"--size"}, {"--size"});
  wrong({"--size", "64x48", "--crop", "8x8+60+0"}, {"--crop", "64 x 48"});
  wrong({"--size", "64x48", "--crop", "8x8+2147483647+2147483647"}, {"--crop"});
  EXPECT_TRUE(folder.names().empty());
}

TEST(CommandLineErrors, OutputsAreCheckedBeforeAnythingIsRead) {
  TemporaryFolder folder;
  // The scene does not exist either: what is said of the output shows that it came first.
  const auto wrong = [](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    expect_bad_input(with({"render", "no-such-scene"}, flags), parts);
  };
  wrong({}, {"-o"});
  wrong({"-o", folder.path("a.gif")}, {"a.gif", "png"});
  wrong({"-o", folder.path("a")}, {"png"});
  wrong({"-o", folder.path("no/a.png")}, {"no/a.png", "no folder"});
  wrong({"-o", "-"}, {"--format"});
  wrong({"-o", "-", "--format", "gif"}, {"gif", "exr, png, jpeg, tiff"});
  wrong({"-o", folder.path("a.png"), "--format", "png"}, {"--format"});
  wrong({"-o", folder.path("a.png"), "-o", folder.path("a.png")}, {"twice"});
  wrong({"-o", folder.path("a.png"), "--stats", folder.path("no/s.json")}, {"no/s.json"});
  wrong({"-o", "-", "--format", "png", "--stats", "-"}, {"--stats"});
  std::filesystem::create_directory(folder.path("folder.png"));
  wrong({"-o", folder.path("folder.png")}, {"is a folder"});
}

TEST(CommandLineErrors, NoFileIsWrittenTwice) {
  TemporaryFolder folder;
  const std::string picture = folder.path("a.png"), link = folder.path("link.png"), other = folder.path("b.png");
  write_text(picture, "of before");
  std::filesystem::create_directory(folder.path("inner"));
  std::filesystem::create_symlink(picture, link);
  const auto wrong = [](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    expect_bad_input(with({"render", "no-such-scene"}, flags), parts);
  };
  wrong({"-o", picture, "-o", folder.path("./a.png")}, {"./a.png", "are one file"});
  wrong({"-o", picture, folder.path("inner/../a.png")}, {"inner/../a.png", "are one file"});
  wrong({"-o", link, "-o", picture}, {"link.png", "are one file"});
  wrong({"-o", other, "-o", folder.path("./b.png")}, {"are one file"});  // not there yet
  wrong({"-o", picture, "--stats", folder.path("./a.png")}, {"--stats", "a.png is the image to write"});
  const std::string scene = folder.path("scene.json");
  write_text(scene, R"({"raytree": 1})");
  expect_bad_input({"render", scene, "-o", other, "--stats", folder.path("./scene.json")}, {"--stats", "is the scene"});
  EXPECT_EQ(file_text(picture), "of before");
  EXPECT_EQ(file_text(scene), R"({"raytree": 1})");
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(CommandLineWarnings, FlagsOfAdaptiveSamplingThatDoNothingAreNamed) {
  TemporaryFolder folder;
  const std::vector<std::string> render = small_render(folder.path("a.png"));
  const std::vector<std::string> flags{"--threshold", "0.1", "--levels", "2", "--minimum-level", "1"};
  const ProgramResult idle = run_program(with(with(render, flags), {"--antialias", "grid:2"}));
  EXPECT_EQ(idle.status, 0) << idle.err;
  for (const char* flag : {"--threshold", "--levels", "--minimum-level"})
    EXPECT_TRUE(contains(idle.err, std::string(flag) + " has no effect: it is for --antialias whitted")) << idle.err;
  const ProgramResult used = run_program(with(with(render, flags), {"--antialias", "whitted"}));
  EXPECT_EQ(used.status, 0) << used.err;
  EXPECT_FALSE(contains(used.err, "has no effect")) << used.err;
}

TEST(CommandLineErrors, ScenesThatAreNone) {
  TemporaryFolder folder;
  write_text(folder.path("model.stl"), "solid");
  write_text(folder.path("model.ply.gz"), "x");
  write_text(folder.path("broken.json"), "{\n  \"raytree\": 1,\n  \"colour\": 3\n}\n");
  write_text(folder.path("empty.obj"), "");
  expect_bad_input({"info", folder.path("model.stl")}, {"model.stl", ".json", ".obj", ".ply"});
  expect_bad_input({"info", folder.path("model.ply.gz")}, {"unpack"});
  expect_bad_input({"info", folder.path("modle.stl.json")}, {"no such file"});
  expect_bad_input({"info", folder.path("broken.json")}, {"broken.json:3", "colour"});
  expect_bad_input({"info", folder.path("brokn.json")}, {"did you mean broken.json?"});
  expect_bad_input({"info", folder.path("empty.obj")}, {"empty.obj"});
  write_text(folder.path("broken.bpt"), "1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,0\n1\n0,0,0\n");
  expect_bad_input({"info", folder.path("broken.bpt")}, {"broken.bpt:2", "index 2 is out of range"});
  expect_bad_input({"render", folder.path("borken.bpt"), "-o", folder.path("a.png")}, {"did you mean broken.bpt?"});
  expect_bad_input({"info", folder.path("")}, {"folder"});
}

TEST(CommandLineErrors, AClosedStandardOutputIsAFailure) {
  ProgramOptions closed;
  closed.close_stdout = true;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"scenes"}, {"schema"}, {"info", kScene}}) {
    const ProgramResult result = run_program(words, closed);
    EXPECT_EQ(result.status, 1) << words.front() << result.err;
    EXPECT_TRUE(contains(result.err, "standard output")) << result.err;
  }
}

// --- commands that print ------------------------------------------------------------------------------------

TEST(CommandLineLists, ScenesAsTextAndJson) {
  const ProgramResult text = run_program({"scenes"});
  EXPECT_EQ(text.status, 0);
  EXPECT_EQ(text.err, "");
  const Json list = Json::parse(run_program({"scenes", "--json"}).out);
  ASSERT_EQ(list.size(), builtin_scenes().size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(list[i]["name"], builtin_scenes()[i].name);
    EXPECT_TRUE(contains(text.out, builtin_scenes()[i].name));
    EXPECT_TRUE(contains(text.out, builtin_scenes()[i].summary));
  }
}

TEST(CommandLineLists, SchemaIsJson) {
  const ProgramResult result = run_program({"schema"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(Json::parse(result.out).contains("$schema"));
}

TEST(CommandLineLists, OcioListsAndChecksTheBuiltInConfig) {
  const ProgramResult list = run_program({"ocio", "list", "--ocio", "builtin"});
  EXPECT_EQ(list.status, 0) << list.err;
  for (const char* part : {"sRGB", "CRT", "Standard", "Shade as brightness", "Raw", "(default)"})
    EXPECT_TRUE(contains(list.out, part)) << part << "\n" << list.out;
  const ProgramResult check = run_program({"ocio", "check"});
  EXPECT_EQ(check.status, 0) << check.out;
  for (const char* value : {"0.461356", "0.735357", "0.567858", "0.795536", "0.287607", "0.467735", "0.218776"})
    EXPECT_TRUE(contains(check.out, value)) << value << "\n" << check.out;
  EXPECT_FALSE(contains(check.out, "OFF"));
  EXPECT_EQ(run_program({"ocio", "check", "--ocio", "builtin"}).status, 0);
}

TEST(CommandLineInfo, BarePatchesStandUpright) {
  TemporaryFolder folder;
  // A square in the plane y = 0 of the file, 3 wide and 6 high along z.
  std::string text = "1\n3 3\n";
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) text += std::to_string(i) + " 0 " + std::to_string(2 * j) + "\n";
  write_text(folder.path("square.bpt"), text);
  const ProgramResult result = run_program({"info", folder.path("square.bpt"), "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json info = Json::parse(result.out);
  EXPECT_EQ(info["objects"][0]["kind"], "patches");
  EXPECT_EQ(info["totals"]["faces"]["quads"], 1);
  EXPECT_EQ(info["objects"][0]["bounds"]["max"], Json({3.0, 6.0, 0.0}));
}

TEST(CommandLineInfo, SaysWhatIsInAScene) {
  TemporaryFolder folder;
  // A cube's six quads.
  write_text(folder.path("cube.obj"),
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
             "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const ProgramResult text = run_program({"info", folder.path("cube.obj")});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part : {"objects    2", "clay", "ground", "key (directional)", "memory"})
    EXPECT_TRUE(contains(text.out, part)) << part << "\n" << text.out;

  const ProgramResult result = run_program({"info", folder.path("cube.obj"), "--json", "--size", "100x50"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json info = Json::parse(result.out);
  EXPECT_EQ(info["image"]["width"], 100);
  EXPECT_EQ(info["totals"]["faces"]["quads"], 6);
  EXPECT_EQ(info["totals"]["faces"]["triangles"], 0);
  EXPECT_EQ(info["totals"]["faces"]["larger"], 0);
  EXPECT_GE(info["totals"]["traced_triangles"], 12);
  EXPECT_EQ(info["objects"][0]["bounds"]["max"], Json({1.0, 1.0, 1.0}));
  EXPECT_EQ(info["objects"].size(), 2u);
  EXPECT_EQ(info["lights"].size(), 3u);
  EXPECT_EQ(info["materials_in_use"].size(), 2u);
  EXPECT_FALSE(info["features"].empty());
  // Color and alpha: four planes of floats.
  EXPECT_EQ(info["memory_bytes"]["film"], 4 * 4 * 100 * 50);
  EXPECT_GT(info["memory_bytes"]["arrays"], 0);
}

TEST(CommandLineInfo, CountsInstancesOnceAndAsOftenAsTheyAreUsed) {
  TemporaryFolder folder;
  write_text(folder.path("s.json"),
             R"({"raytree": 1,
                 "groups": {"hill": {"shapes": {"hill": {"type": "terrain", "triangles": 800}, "ball": {"type": "sphere"}}},
                            "pair": {"shapes": {"a": {"type": "instance", "group": "hill"},
                                                "b": {"type": "instance", "group": "hill"}}}},
                 "shapes": {"x": {"type": "instance", "group": "pair"}, "y": {"type": "instance", "group": "hill"}}})");
  const ProgramResult text = run_program({"info", folder.path("s.json")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_TRUE(contains(text.out, "instances  3, which stand for 2,400 triangles and 3 spheres")) << text.out;
  const ProgramResult result = run_program({"info", folder.path("s.json"), "--json"});
  const Json info = Json::parse(result.out);
  EXPECT_EQ(info["totals"]["traced_triangles"], 800);
  EXPECT_EQ(info["totals"]["spheres"], 1);
  EXPECT_EQ(info["totals"]["instances"], 3);
  EXPECT_EQ(info["totals"]["instanced_triangles"], 2400);
  EXPECT_EQ(info["objects"][0]["instances"], 2);
  EXPECT_EQ(info["objects"][0]["first_extra_id"], 3);
  EXPECT_EQ(info["groups"].size(), 2u);
}

}  // namespace
}  // namespace raytree::test
