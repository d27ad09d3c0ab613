// What a user at a terminal sees: standard error is a real pseudo-terminal.
#include <gtest/gtest.h>

#include <regex>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

/// What was drawn over the same line, one after the other: what follows a carriage return up to "erase the rest".
std::vector<std::string> drawn_lines(const std::string& terminal) {
  std::vector<std::string> lines;
  const std::regex drawing("\r([^\r\n\x1b]*)\x1b\\[K");
  for (std::sregex_iterator match(terminal.begin(), terminal.end(), drawing), end; match != end; ++match)
    lines.push_back((*match)[1].str());
  return lines;
}

/// Index of the first line that begins so; the number of lines where none does.
std::size_t first_with(const std::vector<std::string>& lines, const std::string& begin) {
  std::size_t i = 0;
  while (i < lines.size() && lines[i].rfind(begin, 0) != 0) ++i;
  return i;
}

ProgramResult render_on_terminal(int columns, const std::vector<std::string>& scene, const std::string& output,
                                 const std::string& term = "xterm") {
  ProgramOptions options;
  options.terminal_columns = columns;
  options.environment = {"TERM=" + term};
  std::vector<std::string> words = {"render", "-o", output, "--size", "320x240", "--threads", "1"};
  words.insert(words.end(), scene.begin(), scene.end());
  return run_program(words, options);
}

const std::vector<std::string> kTerrain = {"terrain", "--set", "shapes.terrain.triangles=300000", "--antialias",
                                           "grid:6"};

TEST(Terminal, TheBarTellsPhasesThenShareSpeedAndTimeLeft) {
  TemporaryFolder folder;
  const ProgramResult result = render_on_terminal(100, kTerrain, folder.path("a.png"));
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> lines = drawn_lines(result.err);
  // What takes long in a large scene is named while it lasts, in this order.
  std::size_t last = 0;
  for (const char* begin : {"reading terrain", "generating terrain", "building over ", "tracing [", "writing "}) {
    const std::size_t at = first_with(lines, begin);
    ASSERT_LT(at, lines.size()) << "no line " << begin << "\n" << result.err;
    EXPECT_GE(at, last) << begin << "\n" << result.err;
    last = at;
  }
  EXPECT_TRUE(
      std::regex_match(lines[first_with(lines, "building over ")], std::regex("building over [0-9]{6} triangles")));

  const std::regex tracing(
      "tracing \\[(#*)(\\.*)\\] +([0-9]+) %  ([0-9]+\\.[0-9]{2}) Mrays/s(  ETA [0-9:.]+ (ms|s|min))?");
  int drawn = 0, with_time_left = 0, last_share = 0;
  for (const std::string& line : lines) {
    if (line.rfind("tracing", 0) != 0 || line == "tracing") continue;
    std::smatch parts;
    ASSERT_TRUE(std::regex_match(line, parts, tracing)) << line;
    const int share = std::stoi(parts[3]);
    EXPECT_GE(share, last_share);
    EXPECT_LE(share, 100);
    last_share = share;
    // The bar's marks tell the same share, to a mark.
    const auto filled = static_cast<double>(parts[1].length()), width = filled + static_cast<double>(parts[2].length());
    EXPECT_NEAR(filled / width, share / 100.0, 1 / width + 0.01) << line;
    EXPECT_TRUE(share == 0 || std::stod(parts[4]) > 0) << line;
    ++drawn;
    with_time_left += parts[5].matched;
  }
  EXPECT_GE(drawn, 3) << result.err;
  EXPECT_GE(with_time_left, 2) << result.err;
  // The bar is gone when the last message is written.
  const std::size_t message = result.err.rfind("wrote ");
  ASSERT_NE(message, std::string::npos) << result.err;
  EXPECT_EQ(result.err.substr(message - 4, 4), "\r\x1b[K") << result.err;
}

TEST(Terminal, FilesBeingReadAreNamed) {
  TemporaryFolder folder;
  write_text(folder.path("model.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_text(
      folder.path("scene.json"),
      R"({"raytree": 1, "shapes": {"m": {"type": "mesh", "file": "model.obj"}, "f": {"type": "sphere_flake"}}})");
  const ProgramResult result = render_on_terminal(200, {folder.path("scene.json")}, folder.path("a.png"));
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<std::string> lines = drawn_lines(result.err);
  for (const std::string& line :
       {"reading " + folder.path("scene.json"), std::string("reading model.obj"), std::string("generating f")})
    EXPECT_LT(first_with(lines, line), lines.size()) << line << "\n" << result.err;
}

TEST(Terminal, NoLineReachesTheTerminalsEdge) {
  TemporaryFolder folder;
  for (const int columns : {20, 40, 60}) {
    const ProgramResult result = render_on_terminal(columns, kTerrain, folder.path("a.png"));
    ASSERT_EQ(result.status, 0) << result.err;
    const std::vector<std::string> lines = drawn_lines(result.err);
    EXPECT_LT(first_with(lines, "tracing"), lines.size());
    for (const std::string& line : lines) EXPECT_LT(line.size(), static_cast<std::size_t>(columns)) << line;
  }
}

TEST(Terminal, ATerminalThatCannotRedrawGetsPlainLines) {
  TemporaryFolder folder;
  const ProgramResult result = render_on_terminal(100, kTerrain, folder.path("a.png"), "dumb");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("tracing  50 %"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace raytree::test
