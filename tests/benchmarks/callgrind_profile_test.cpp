// Instruction counts out of profiles written by hand after the format's description in valgrind's manual.
#include "benchmarks/callgrind_profile.h"

#include <gtest/gtest.h>

#include "geometry/error.h"

namespace raytree::benchmarks {
namespace {

TEST(CallgrindProfile, SumsOwnCostsAndSkipsThoseOfCalls) {
  const InstructionCounts counts = read_callgrind_profile(
      "# callgrind format\nversion: 1\ncmd: probe\npositions: line\nevents: Ir\n\n"
      "ob=(1) /bin/probe\nfl=(1) a.cpp\nfn=(1) main\n16 20\n"
      "cob=(2) /lib/tracer.so\ncfi=(2) b.cpp\ncfn=(2) trace\ncalls=1 50\n16 400\n+1 7\n"
      "ob=(2)\nfl=(2)\nfn=(2)\n51 100\n* 300\n"
      "totals: 427\n",
      "test");
  EXPECT_EQ(counts.total, 427u);
  EXPECT_EQ(counts.by_object.at("/bin/probe"), 27u);
  EXPECT_EQ(counts.by_object.at("/lib/tracer.so"), 400u);
}

TEST(CallgrindProfile, RefusesOtherText) {
  EXPECT_THROW(read_callgrind_profile("", "empty"), Error);
  EXPECT_THROW(read_callgrind_profile("events: Cycles\n1 2\n", "cycles"), Error);
  EXPECT_THROW(read_callgrind_profile("events: Ir\n1 many\n", "words"), Error);
}

}  // namespace
}  // namespace raytree::benchmarks
