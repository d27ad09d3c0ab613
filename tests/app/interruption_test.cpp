// Interrupting the program, in whatever it is doing: it stops within a second and leaves no file.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

class CommandLineInterruption : public testing::TestWithParam<int> {};

TEST_P(CommandLineInterruption, StopsWithinASecondAndLeavesNothing) {
  // Into the reading, the generating, the build, the tessellation and the tracing, adaptive too, of scenes that take
  // much longer than that.
  const std::vector<double> delays =
      GetParam() == SIGINT ? std::vector<double>{0.05, 0.4, 1.2} : std::vector<double>{0.3};
  for (const double after : delays) {
    for (const std::vector<std::string>& scene :
         {std::vector<std::string>{"terrain", "--set", "shapes.terrain.triangles=20000000"},
          {kScene, "--size", "4000x4000", "--antialias", "grid:4"},
          {kScene, "--size", "4000x4000", "--antialias", "whitted", "--threshold", "0", "--levels", "6"},
          {"teapot", "--rate", "1024"}}) {
      TemporaryFolder folder;
      ProgramOptions options;
      options.signal = GetParam();
      options.signal_after = after;
      const ProgramResult result =
          run_program(with(with({"render"}, scene), {"-o", folder.path("a.exr"), "-o", folder.path("a.png")}), options);
      EXPECT_EQ(result.status, 128 + GetParam()) << scene[0] << " after " << after << "\n" << result.err;
      EXPECT_LT(result.seconds_after_signal, 1.0) << scene[0] << " after " << after;
      EXPECT_TRUE(folder.names().empty()) << folder.names().front();
      EXPECT_FALSE(contains(result.err, "error")) << result.err;
    }
  }
}

void expect_stopped(const std::vector<std::string>& words, const ProgramOptions& options, const TemporaryFolder& folder,
                    const std::vector<std::string>& inputs) {
  const ProgramResult result = run_program(words, options);
  EXPECT_EQ(result.status, 128 + options.signal) << result.err;
  EXPECT_LT(result.seconds_after_signal, 1.0);
  EXPECT_EQ(folder.names(), inputs);
  EXPECT_FALSE(contains(result.err, "error")) << result.err;
}

/// A mesh file of some hundred megabytes of text, all of it valid: `unit` again and again.
void write_large(const std::string& path, const std::string& begin, const std::string& unit, std::size_t units,
                 const std::string& face, std::size_t faces) {
  std::ofstream file(path, std::ios::binary);
  file << begin;
  for (const auto& [text, count] : {std::pair(unit, units), {face, faces}}) {
    std::string block;
    for (int i = 0; i < 1000; ++i) block += text;
    for (std::size_t i = 0; i < count / 1000; ++i) file << block;
  }
}

TEST_P(CommandLineInterruption, WhileALargeTextIsRead) {
  TemporaryFolder folder;
  const std::string obj = folder.path("large.obj"), ply = folder.path("large.ply");
  constexpr std::size_t kVertices = 4000000, kFaces = 4000000;
  write_large(obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "v 1.2345678 -2.3456789 3.4567891\n", kVertices, "f 1 2 3\n", kFaces);
  write_large(ply,
              "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kVertices) +
                  "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(kFaces) +
                  "\nproperty list uchar int vertex_indices\nend_header\n",
              "1.2345678 -2.3456789 3.4567891\n", kVertices, "3 0 1 2\n", kFaces);
  for (const std::string& mesh : {obj, ply})
    for (const double after : {0.1, 0.3}) {
      SCOPED_TRACE(mesh + " after " + std::to_string(after));
      ProgramOptions options;
      options.signal = GetParam();
      options.signal_after = after;
      expect_stopped({"render", mesh, "-o", folder.path("a.exr")}, options, folder, {"large.obj", "large.ply"});
    }
}

TEST_P(CommandLineInterruption, OnceAllIsTracedAndWhileItIsWritten) {
  TemporaryFolder folder;
  // The sky alone is soon traced; what follows takes longer than the test needs to send its signal.
  write_text(folder.path("sky.json"),
             R"({"raytree": 1, "image": {"width": 4000, "height": 4000}, "render": {"antialias": "none"},
                 "background": {"type": "gradient"}})");
  struct When {
    std::string text, progress, file;
    std::vector<std::string> flags;
  };
  for (const When& when : {When{"100 %", "plain", "a.tif", {}},
                           {"writing ", "bar", "a.tif", {}},
                           {"100 %", "plain", "a.exr", {"--channels", "all"}},
                           {"writing ", "bar", "a.exr", {"--channels", "all"}},
                           {"writing ", "bar", "a.png", {"--set", "background.horizon=[0.1,0.5,0.9]"}}}) {
    SCOPED_TRACE(when.file + " at \"" + when.text + "\"");
    ProgramOptions options;
    options.signal = GetParam();
    options.signal_on = when.text;
    expect_stopped(with({"render", folder.path("sky.json"), "-o", folder.path(when.file), "--progress", when.progress},
                        when.flags),
                   options, folder, {"sky.json"});
  }
}

std::string signal_name(const testing::TestParamInfo<int>& test) {
  return test.param == SIGINT ? "interrupt" : test.param == SIGTERM ? "terminate" : "hang_up";
}

INSTANTIATE_TEST_SUITE_P(Signals, CommandLineInterruption, testing::Values(SIGINT, SIGTERM, SIGHUP), signal_name);

}  // namespace
}  // namespace raytree::test
