// The stability suite's cases of sampling, the ray tree, curved surfaces and pictures: each as it must be, the same in
// every run; and the case that rests on what a planted fault takes away notices it.
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

StabilityRun quick_run() {
  StabilityRun run;
  run.effort = 0.1;
  run.pictures = false;
  return run;
}

/// Every figure lies where it must, again in another run, and every case shows the renderer's own method.
void expect_verdicts(const std::vector<StabilityCase>& cases, std::size_t count) {
  EXPECT_EQ(cases.size(), count);
  for (const StabilityCase& one : cases) {
    SCOPED_TRACE(one.name);
    const StabilityResult result = one.run(quick_run()), again = one.run(quick_run());
    ASSERT_EQ(again.figures.size(), result.figures.size());
    bool own = false;
    for (std::size_t i = 0; i < result.figures.size(); ++i) {
      const StabilityFigure& figure = result.figures[i];
      std::printf("%2d %s: %s, %s: %.5g in [%.5g, %.5g], %s\n", one.row, one.name, figure.method.c_str(),
                  figure.quantity.c_str(), figure.measured, figure.low, figure.high, word_of(figure.verdict()));
      EXPECT_NE(word_of(figure.verdict()), std::string("fails")) << figure.method << ": " << figure.quantity;
      EXPECT_EQ(figure.measured, again.figures[i].measured) << figure.method << ": " << figure.quantity;
      EXPECT_FALSE(figure.known.empty());
      own |= figure.verdict() == StabilityVerdict::holds;
    }
    EXPECT_TRUE(own) << "no figure of the renderer's own method";
  }
}

TEST(StabilityCases, OfSamplingAreAsTheyMustBe) { expect_verdicts(sampling_cases(), 4); }
TEST(StabilityCases, OfTheRayTreeAreAsTheyMustBe) { expect_verdicts(ray_tree_cases(), 12); }
TEST(StabilityCases, OfCurvedSurfacesAreAsTheyMustBe) { expect_verdicts(curved_cases(), 11); }
TEST(StabilityCases, OfPicturesAreAsTheyMustBe) { expect_verdicts(picture_cases(), 7); }

TEST(StabilityCases, CracksBetweenRatesNoticeThatEdgesAreNotWatertight) {
  for (const StabilityCase& one : curved_cases()) {
    if (one.name != std::string("uneven-rates")) continue;
    StabilityRun run = quick_run();
    run.faults.not_robust = true;
    int failing = 0;
    for (const StabilityFigure& figure : one.run(run).figures) failing += figure.verdict() == StabilityVerdict::fails;
    EXPECT_GE(failing, 1);
    return;
  }
  ADD_FAILURE() << "there is no such case";
}

}  // namespace
}  // namespace raytree::benchmarks
