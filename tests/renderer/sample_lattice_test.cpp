// The map from lattice places to samples holds what a plain map holds, as an array of all places and hashed.
#include "renderer/sample_lattice.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/random.h"

namespace raytree {
namespace {

using test::Random;

TEST(SampleLattice, HoldsWhatAMapHolds) {
  Random random(41);
  SampleLattice lattice;
  for (const unsigned step : {32u, 4u, 1u})
    for (const std::size_t count : {std::size_t(64), std::size_t(256), std::size_t(2048 / step)})
      for (const std::size_t most : {std::size_t(5), std::size_t(700), std::size_t(5120)}) {
        lattice.begin(step, count, most);
        std::map<std::pair<int, int>, std::uint32_t> expected;
        const auto place = [&] { return static_cast<int>(step * random.below(count + 1)); };
        for (std::uint32_t i = 0; i < 4 * most; ++i) {
          const int x = place(), y = place();
          const auto known = expected.find({x, y});
          ASSERT_EQ(lattice.find(x, y), known == expected.end() ? SampleLattice::kNoSample : known->second);
          if (expected.size() == most) continue;
          const std::uint32_t sample = lattice.at(x, y, [&] { return i; });
          ASSERT_EQ(sample, expected.try_emplace({x, y}, i).first->second);
        }
      }
}

}  // namespace
}  // namespace raytree
