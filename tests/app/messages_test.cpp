// What the program says of wrong input, word by word: the flag that was typed, the value, and what would be right.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>
#include <regex>
#include <set>

#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

/// The one line of an error, without the program's name before it.
std::string error_line(const std::vector<std::string>& arguments, int status = 2) {
  const ProgramResult result = run_program(arguments);
  EXPECT_EQ(result.status, status) << result.err;
  constexpr std::string_view kBegin = "raytree: error: ";
  EXPECT_EQ(result.err.rfind(kBegin, 0), 0u) << result.err;
  std::string line = result.err.substr(std::min(kBegin.size(), result.err.size()));
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

/// The error of a small render with these flags; no file may come of it.
std::string render_error(const std::vector<std::string>& flags) {
  const TemporaryFolder folder;
  std::string line = error_line(with(small_render(folder.path("a.png")), flags));
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
  return line;
}

std::string error_of_size(const std::string& size) {
  const TemporaryFolder folder;
  return error_line({"render", kScene, "-o", folder.path("a.png"), "--size", size});
}

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

/// Warnings of `info`, which reads and prepares a scene.
std::string warnings_of(const std::string& scene) {
  const ProgramResult result = run_program({"info", scene});
  EXPECT_EQ(result.status, 0) << result.err;
  return result.err;
}

TEST(FlagMessages, NameTheFlagThatWasTypedOnce) {
  const std::string typed = render_error({"--set", "render.dept=1"});
  EXPECT_EQ(typed.rfind("--set: render: unknown key \"dept\"; ", 0), 0u) << typed;
  EXPECT_EQ(occurrences(typed, "--set"), 1) << typed;
  const TemporaryFolder folder;
  const std::string cone = error_line(
      {"render", "cone", "-o", folder.path("a.png"), "--size", "16x12", "--set", "shapes.cone.interpolation=scan"});
  EXPECT_EQ(occurrences(cone, "--set"), 1) << cone;
  const std::string size = error_of_size("1000000x1000000");
  EXPECT_EQ(size.rfind("--size: image.width: 1000000 is out of range", 0), 0u) << size;
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--depth", "100000000"},
                                                {"--tolerance", "1e30"},
                                                {"--rate", "100000"},
                                                {"--threshold", "1e30"},
                                                {"--levels", "100"},
                                                {"--rough-samples", "100000"}}) {
    const std::string line = render_error(flags);
    EXPECT_EQ(line.rfind(flags[0] + ": ", 0), 0u) << line;
    EXPECT_EQ(occurrences(line, "--set"), 0) << line;
  }
}

TEST(FlagMessages, SayTheDepthThatIsAllowed) {
  for (const std::string depth : {"0", "100000000"})
    EXPECT_EQ(render_error({"--depth", depth}), "--depth: \"" + depth + "\" is not a whole number from 1 to 1000000");
}

TEST(FlagMessages, AFlagWithoutItsValueIsNamedAsItWasTyped) {
  EXPECT_EQ(error_line({"render", "cone", "-o"}), "-o: no value follows; it takes FILE");
  EXPECT_EQ(error_line({"render", "cone", "--output"}), "--output: no value follows; it takes FILE");
  EXPECT_EQ(error_line({"render", "cone", "-o", "a.png", "--size"}), "--size: no value follows; it takes WxH");
  EXPECT_EQ(error_line({"render", "cone", "--size", "--depth", "3", "-o", "a.png"}),
            "--size: no value follows; it takes WxH");
  EXPECT_EQ(error_line({"render", "cone", "--camera=", "-o", "a.png"}), "--camera: the value is empty");
  EXPECT_EQ(error_line({"info", "cone", "--set"}), "--set: no value follows; it takes PATH=VALUE");
}

TEST(FlagMessages, AFlagGivenTwiceIsNamed) {
  EXPECT_EQ(error_line({"info", kScene, "--size", "16x16", "--size", "32x32"}), "--size is given twice");
  EXPECT_EQ(error_line({"info", kScene, "--rate", "1", "--rate", "2", "--rate", "3"}), "--rate is given 3 times");
  EXPECT_EQ(render_error({"--ocio", "a", "--ocio", "b"}), "--ocio is given twice");
  EXPECT_EQ(error_line({"ray", kScene, "--end", "1", "--end", "2"}), "--end is given twice");
}

TEST(FlagMessages, ARaySaysWhichWordIsNoVector) {
  EXPECT_EQ(error_line({"ray", kScene, "0,0", "1"}), "origin \"0,0\" is not x,y,z");
  EXPECT_EQ(error_line({"ray", kScene, "0,0,0", "1"}), "direction \"1\" is not x,y,z");
  EXPECT_EQ(error_line({"ray", kScene, "1", "0,0,1"}), "origin \"1\" is not x,y,z");
  EXPECT_EQ(error_line({"ray", kScene, "0,0,0", "-1,0"}), "direction \"-1,0\" is not x,y,z");
  EXPECT_EQ(error_line({"ray", kScene, "0,0,0"}), "two vectors x,y,z follow the scene, origin and direction; 1 given");
}

TEST(FlagMessages, DisplaysAreMeantInAnyCase) {
  const std::string display = render_error({"--ocio", "builtin", "--display", "srgb"});
  EXPECT_EQ(display.rfind("--display: unknown display \"srgb\"; choices: \"sRGB\", ", 0), 0u) << display;
  EXPECT_TRUE(contains(display, "(did you mean \"sRGB\"?)")) << display;
  EXPECT_TRUE(contains(render_error({"--ocio", "builtin", "--display", "crt"}), "(did you mean \"CRT\"?)"));
  const std::string view = render_error({"--ocio", "builtin", "--view", "Foo"});
  EXPECT_EQ(view.rfind("--view: unknown view \"Foo\" of display \"sRGB\"; choices: \"", 0), 0u) << view;
  EXPECT_FALSE(contains(view, "did you mean")) << view;
  EXPECT_TRUE(contains(render_error({"--ocio", "builtin", "--view", "standrad"}), "(did you mean \"Standard\"?)"));
  EXPECT_EQ(render_error({"--exposure", "1e30"}), "--exposure: \"1e30\" is not from -100 to 100 stops");
}

TEST(FlagMessages, SayTheFormOfAValue) {
  EXPECT_EQ(render_error({"--memory", "lots"}), "--memory: \"lots\" is not a size, for example 800M or 4G");
  EXPECT_EQ(render_error({"--channels", "color,,alpha"}),
            "--channels: \"color,,alpha\": a name is missing between commas");
  EXPECT_EQ(render_error({"--channels", ",alpha"}), "--channels: \",alpha\": a name is missing before the first comma");
  EXPECT_EQ(render_error({"--channels", "color,"}), "--channels: \"color,\": a name is missing after the last comma");
  EXPECT_EQ(render_error({"--crop", "0x0+0+0"}), "--crop: \"0x0+0+0\": a crop is at least 1x1");
  EXPECT_EQ(render_error({"--crop", "8+0+0"}), "--crop: \"8+0+0\" is not WxH+X+Y in pixels, for example 320x200+640+0");
}

TEST(FlagMessages, NumbersAreTakenAsPeopleWriteThem) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(with(small_render(folder.path("a.png")), {"--tolerance", ".5", "--threshold", "+1e-1"}));
  EXPECT_EQ(result.status, 0) << result.err;
}

TEST(FlagMessages, ConvertSaysWhatItReads) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_line({"convert", "teapot", folder.path("t.ply"), "--rate", "3"}),
            "teapot: is a built-in scene, not a file of a mesh or of patches; .obj, .ply and .bpt are read");
  EXPECT_EQ(error_line({"convert", "a.stl", folder.path("t.ply")}),
            "a.stl: not the name of a file of a mesh or of patches; .obj, .ply and .bpt are read");
}

TEST(FileMessages, SayWhyNoFaceIsLeft) {
  const TemporaryFolder folder;
  const std::string path = folder.path("nan.obj");
  for (const auto& [number, reason] : {std::pair{"nan", "nan"}, {"1e39", "beyond the largest 32-bit float"}}) {
    write_text(path, std::string("v 0 0 0\nv 1 0 ") + number + "\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(error_line({"render", path, "-o", folder.path("b.png")}),
              path + ":2: vertex 2 is not finite (" + reason + "); its 1 face was dropped, so no face is left");
  }
}

TEST(FileMessages, CountWhatIsCountedAndNothingElse) {
  const TemporaryFolder folder;
  const std::string obj = folder.path("a.obj"), ply = folder.path("a.ply");
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", dropped = "faces with fewer than three distinct ";
  write_text(obj, good + "f 1 1 2\n");
  EXPECT_TRUE(contains(warnings_of(obj), "a.obj:5: " + dropped + "corners dropped (1 in all)\n")) << warnings_of(obj);
  write_text(obj, good + "f 1 1 2\nf 3 3\n");
  EXPECT_TRUE(contains(warnings_of(obj), "a.obj:5: " + dropped + "corners dropped (2 in all)\n")) << warnings_of(obj);
  write_text(ply,
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n");
  EXPECT_TRUE(contains(warnings_of(ply), "vertex properties not used: 'red', 'green', 'blue'\n")) << warnings_of(ply);
}

TEST(FileMessages, AFolderThatTakesNoFilesIsFoundBeforeTheScene) {
  // Rights allow it, the file system does not. The scene does not exist: what is said of the folder comes first.
  if (!std::filesystem::is_directory("/proc/self")) GTEST_SKIP() << "no /proc here";
  const ProgramResult result = run_program({"render", "no-such-scene", "-o", "/proc/raytree-test.png"});
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_TRUE(contains(result.err, "/proc")) << result.err;
  EXPECT_FALSE(contains(result.err, "no-such-scene")) << result.err;
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(error_line({"render", "no-such-scene", "-o", folder.path("a.png")}), "no-such-scene"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{}) << "looking leaves nothing behind";
}

TEST(FileMessages, ADamagedFileIsNamedWithTheShapeThatNamesIt) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("s.json");
  write_text(folder.path("m.ply"), "ply\nformat ascii 1.0\nelement vertex many\n");
  write_text(folder.path("p.bpt"), "1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,0\n1\n0,0,0\n");
  const std::string mesh = R"({"type": "mesh", "file": "m.ply"}}})",
                    patches = R"({"type": "patches", "file": "p.bpt"}}})";
  write_text(scene, "{\"raytree\": 1, \"shapes\":\n{\"m\": " + mesh);
  EXPECT_EQ(error_line({"info", scene}),
            folder.path("m.ply") + ":3: 'many' is not a count of elements (shapes.m of " + scene + ":2)");
  write_text(scene, "{\"raytree\": 1, \"shapes\":\n{\"p\": " + patches);
  const std::string line = error_line({"info", scene});
  EXPECT_EQ(line.rfind(folder.path("p.bpt") + ":2: ", 0), 0u) << line;
  EXPECT_TRUE(contains(line, " (shapes.p of " + scene + ":2)")) << line;
  // A file given on the command line has no such place.
  EXPECT_EQ(error_line({"info", folder.path("m.ply")}), folder.path("m.ply") + ":3: 'many' is not a count of elements");
}

TEST(FileMessages, OfScenesThatSayNothing) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("s.json");
  write_text(scene, "{}");
  EXPECT_EQ(error_line({"info", scene}), scene + ":1: missing key \"raytree\"; say \"raytree\": 1");
  for (const char* text : {"", " \n\t\r\n"}) {
    write_text(scene, text);
    EXPECT_EQ(error_line({"info", scene}), scene + ":1: the file is empty");
  }
}

// --- the script ./run -----------------------------------------------------------------------------------------

/// What `./run ARGUMENTS` prints, both streams; for arguments that build nothing.
std::string script_output(const std::string& arguments) {
  const std::string line = "'" RAYTREE_SOURCE_DIR "/run' " + arguments + " 2>&1";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(line.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> block;
  while (const std::size_t count = pipe ? std::fread(block.data(), 1, block.size(), pipe.get()) : 0)
    text.append(block.data(), count);
  return text;
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex expression(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match)
    found.insert((*match)[1].str());
  return found;
}

TEST(RunScriptCommands, KnowsEveryCommandOfTheProgramAndNamesThem) {
  const std::string help = run_program({"--help"}).out;
  const std::set<std::string> commands =
      matches(help.substr(0, help.find("Options:")).substr(help.find("Commands:") + 9), "\n  ([a-z]+) ");
  ASSERT_GE(commands.size(), 12u) << help;
  const std::string unknown = script_output("foo");
  const std::size_t list = unknown.find("these are known:");
  ASSERT_NE(list, std::string::npos) << unknown;
  std::set<std::string> named = matches(unknown.substr(list + 16), " ([a-z]+)");
  const std::string usage = script_output("help");
  const std::size_t first = usage.find("\n  ") + 3;
  EXPECT_EQ(matches(usage.substr(first, usage.find('\n', first) - first), "([a-z]+)"), commands) << usage;
  // The script's own: those of its dispatch, which are those of its help.
  std::set<std::string> own =
      matches(usage.substr(usage.find('\n', first), usage.find("Environment:")), "\n  ([a-z]+) ");
  for (const std::string& command : own) EXPECT_FALSE(commands.count(command)) << command;
  own.insert(commands.begin(), commands.end());
  EXPECT_EQ(named, own);
  const std::string script = file_text(RAYTREE_SOURCE_DIR "/run");
  std::set<std::string> dispatched = matches(script.substr(script.find("\ncase $command in")), "\n  ([a-z]+)[ )]");
  dispatched.insert(commands.begin(), commands.end());
  EXPECT_EQ(named, dispatched);
}

}  // namespace
}  // namespace raytree::test
