// The stability suite's cases of sampling, the ray tree, curved surfaces and pictures: each as it must be, and those that
// rest on what a planted fault takes away notice it.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {
namespace {

const char* word_of(StabilityVerdict verdict) {
  return verdict == StabilityVerdict::holds            ? "holds"
         : verdict == StabilityVerdict::fails_as_known ? "fails as known"
                                                       : "fails";
}

/// Every figure lies where it must, and every case shows the renderer's own method.
void expect_verdicts(const std::vector<StabilityCase>& cases, std::size_t count) {
  EXPECT_EQ(cases.size(), count);
  StabilityRun run;
  run.effort = 0.1;
  run.pictures = false;
  if (const char* text = std::getenv("RAYTREE_STABILITY_EFFORT")) run.effort = std::atof(text);
  for (const StabilityCase& one : cases) {
    SCOPED_TRACE(one.name);
    const StabilityResult result = one.run(run);
    bool own = false;
    for (const StabilityFigure& figure : result.figures) {
      std::printf("%2d %-18s %-28s %-70s %12.5g  [%.5g, %.5g] %s\n", one.row, one.name, figure.method.c_str(),
                  figure.quantity.c_str(), figure.measured, figure.low, figure.high, word_of(figure.verdict()));
      EXPECT_NE(figure.verdict(), StabilityVerdict::fails) << figure.method << ": " << figure.quantity;
      EXPECT_FALSE(figure.known.empty());
      own |= figure.verdict() == StabilityVerdict::holds;
    }
    EXPECT_TRUE(own) << "no figure of the renderer's own method";
  }
}

TEST(StabilityCases, OfSamplingAreAsTheyMustBe) { expect_verdicts(sampling_cases(), 4); }
TEST(StabilityCases, OfTheRayTreeAreAsTheyMustBe) { expect_verdicts(ray_tree_cases(), 12); }
TEST(StabilityCases, OfPicturesAreAsTheyMustBe) { expect_verdicts(picture_cases(), 7); }

}  // namespace
}  // namespace raytree::benchmarks
