// Interrupting the program: it stops within a second and leaves no file.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

class CommandLineInterruption : public testing::TestWithParam<int> {};

TEST_P(CommandLineInterruption, StopsWithinASecondAndLeavesNothing) {
  // Into the reading, the generating, the build and the tracing of a scene that takes much longer than that.
  const std::vector<double> delays =
      GetParam() == SIGINT ? std::vector<double>{0.05, 0.4, 1.2} : std::vector<double>{0.3};
  for (const double after : delays) {
    for (const std::vector<std::string>& scene :
         {std::vector<std::string>{"terrain", "--set", "shapes.terrain.triangles=20000000"},
          {kScene, "--size", "4000x4000", "--antialias", "grid:4"}}) {
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

INSTANTIATE_TEST_SUITE_P(Signals, CommandLineInterruption, testing::Values(SIGINT, SIGTERM),
                         [](const auto& test) { return test.param == SIGINT ? "interrupt" : "terminate"; });

}  // namespace
}  // namespace raytree::test
