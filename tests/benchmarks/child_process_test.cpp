// Programs run by the benchmarks: what they say, how they end.
#include "benchmarks/child_process.h"

#include <gtest/gtest.h>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

const std::filesystem::path kScratch = ::testing::TempDir();

TEST(ChildProcess, TellsOutputStatusAndCost) {
  const ChildResult result = run_child({"sh", "-c", "echo out; echo err >&2; exit 3"}, kScratch);
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.output, "out\n");
  EXPECT_EQ(result.errors, "err\n");
  EXPECT_GT(result.wall_seconds, 0);
  EXPECT_GT(result.peak_bytes, 0u);
}

TEST(ChildProcess, ASignalIsAStatus) { EXPECT_EQ(run_child({"sh", "-c", "kill -9 $$"}, kScratch).status, 137); }

TEST(ChildProcess, AMissingProgramIsAnError) { EXPECT_THROW(run_child({"./no-such-program-here"}, kScratch), Error); }

TEST(ChildProcess, FailureCarriesTheProgramsWords) {
  const ChildResult result = run_child({"sh", "-c", "echo no space >&2; exit 1"}, kScratch);
  try {
    require_success(result, "sh");
    FAIL() << "status 1 passed for success";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no space"), std::string::npos);
  }
}

}  // namespace
}  // namespace raytree::benchmarks
