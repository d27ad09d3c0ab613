// Peak memory of blocks whose size is known.
#include "benchmarks/resident_memory.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "app/sanitized.h"
#include "tests/benchmarks/chart_samples.h"

namespace raytree::benchmarks {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;
/// What the kernel's counts lag behind, with room for what the C++ library takes for itself.
constexpr double kLag = 2 * kMebibyte;

using Blocks = std::vector<std::vector<char>>;

/// Takes so much in blocks of 100 KiB, writes to all and frees them. Small blocks between them are returned: while
/// these are held, the C library keeps what was freed for itself.
Blocks take_and_free(double bytes) {
  constexpr std::size_t kBlock = 100 * 1024, kBetween = 2000;
  Blocks blocks, between;
  for (double taken = 0; taken < bytes; taken += kBlock) {
    blocks.emplace_back(kBlock, char(1));
    between.emplace_back(kBetween, char(1));
  }
  return between;
}

TEST(PeakMemory, IsWhatWasTakenThoughItWasFreed) {
  const PeakMemory memory;
  if (!memory.bytes()) GTEST_SKIP() << test::kNoPeakMemory;
  const Blocks between = take_and_free(48 * kMebibyte);
  const auto bytes = static_cast<double>(memory.bytes().value());
  EXPECT_GE(bytes, 48 * kMebibyte - kLag);
  if (!kAddressSanitized) {
    EXPECT_LE(bytes, 1.03 * 48 * kMebibyte + kLag);  // with the small blocks between
  }
}

TEST(PeakMemory, LeavesOutWhatWasTakenBefore) {
  const std::vector<char> held(static_cast<std::size_t>(32 * kMebibyte), char(1));
  const Blocks between = take_and_free(48 * kMebibyte);
  const PeakMemory memory;
  if (!memory.bytes()) GTEST_SKIP() << test::kNoPeakMemory;
  if (!kAddressSanitized) {
    EXPECT_LE(static_cast<double>(memory.bytes().value()), kLag);
  }
  EXPECT_EQ(held.back(), char(1));
}

// What an earlier stretch freed is not there for the next one to use unseen.
TEST(PeakMemory, CountsMemoryThatIsTakenAgain) {
  Blocks held;
  for (int round = 0; round < 3; ++round) {
    const PeakMemory memory;
    if (!memory.bytes()) GTEST_SKIP() << test::kNoPeakMemory;
    for (std::vector<char>& block : take_and_free(32 * kMebibyte)) held.push_back(std::move(block));
    EXPECT_GE(static_cast<double>(memory.bytes().value()), 32 * kMebibyte - kLag) << round;
  }
}

TEST(PeakMemory, FiguresOfTheSystemAreBytes) {
  const auto resident = status_bytes("VmRSS"), most = status_bytes("VmHWM");
  ASSERT_TRUE(resident && most);
  EXPECT_GT(*resident, 1'000'000u);
  EXPECT_GE(static_cast<double>(*most), static_cast<double>(*resident) - kLag);
  EXPECT_FALSE(status_bytes("VmNothing"));
}

}  // namespace
}  // namespace raytree::benchmarks
