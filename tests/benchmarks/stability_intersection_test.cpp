// The cases about rays and surfaces: every method does as is known of it, and faults planted in the fast path show.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "benchmarks/stability/ray_probes.h"
#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {
namespace {

/// Names of the cases with a figure that fails.
std::set<std::string> failing_ray_cases(const StabilityFaults& faults) {
  StabilityRun run;
  run.faults = faults;
  run.effort = 0.05;
  run.pictures = false;
  std::set<std::string> failing;
  for (const StabilityCase& one : intersection_cases())
    for (const StabilityFigure& figure : one.run(run).figures)
      if (figure.verdict() == StabilityVerdict::fails) failing.insert(one.name);
  return failing;
}

class IntersectionCase : public testing::TestWithParam<std::size_t> {};

TEST_P(IntersectionCase, DoesAsIsKnown) {
  const StabilityCase one = intersection_cases()[GetParam()];
  StabilityRun run;
  run.effort = 0.05;
  const StabilityResult result = one.run(run);
  std::size_t own = 0;
  for (const StabilityFigure& figure : result.figures) {
    EXPECT_NE(figure.verdict(), StabilityVerdict::fails)
        << figure.method << ", " << figure.quantity << ": " << figure.measured << " outside [" << figure.low << ", "
        << figure.high << "]";
    EXPECT_LE(figure.low, figure.high);
    EXPECT_FALSE(figure.known.empty());
    own += figure.expectation == StabilityExpectation::holds;
  }
  EXPECT_GT(own, 0u) << "nothing is said of the renderer's own method";
  for (const StabilityPicture& picture : result.pictures) {
    const DisplayImage& image = picture.image;
    EXPECT_FALSE(picture.caption.empty());
    for (const auto& plane : image.planes)
      EXPECT_EQ(plane.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  }
}

INSTANTIATE_TEST_SUITE_P(Rows36To50, IntersectionCase, testing::Range<std::size_t>(0, 15), [](const auto& param) {
  std::string name = intersection_cases()[param.param].name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

TEST(IntersectionCases, AreRows36To50OnceEach) {
  std::multiset<int> rows;
  std::set<std::string> names;
  for (const StabilityCase& one : intersection_cases()) {
    rows.insert(one.row);
    names.insert(one.name);
  }
  std::multiset<int> expected;
  for (int row = 36; row <= 50; ++row) expected.insert(row);
  EXPECT_EQ(rows, expected);
  EXPECT_EQ(names.size(), expected.size());
}

TEST(IntersectionCases, ShowOffsetsThatAreNotThere) {
  StabilityFaults faults;
  faults.no_offsets = true;
  EXPECT_EQ(failing_ray_cases(faults), (std::set<std::string>{"self-hits", "skipped-layers"}));
}

TEST(IntersectionCases, ShowATracerThatIsNotRobust) {
  StabilityFaults faults;
  faults.not_robust = true;
  const std::set<std::string> failing = failing_ray_cases(faults);
  for (const char* name : {"edge-leaks", "corner-leaks", "double-hits"}) EXPECT_EQ(failing.count(name), 1u) << name;
}

TEST(IntersectionCases, RepeatThemselves) {
  StabilityRun run;
  run.effort = 0.05;
  run.pictures = false;
  for (const StabilityCase& one : intersection_cases()) {
    const StabilityResult first = one.run(run), second = one.run(run);
    ASSERT_EQ(first.figures.size(), second.figures.size());
    for (std::size_t i = 0; i < first.figures.size(); ++i)
      EXPECT_EQ(first.figures[i].measured, second.figures[i].measured) << one.name;
  }
}

/// Waechter and Binder's steps: 256 ulps (below 2 those of 1) along a normal of the axes, a fixed 2^-16 near 0.
TEST(RayProbes, StepIntegersAsPublished) {
  SurfacePoint point;
  point.position = {1, -2, 0.01f};
  const Vec3f start = departed(Departure::waechter_binder, point, {1, 0, 0}, {});
  EXPECT_EQ(start, Vec3f(1 + 256 * 0x1p-23f, -2, 0.01f));
  EXPECT_EQ(departed(Departure::waechter_binder, point, {0, 1, 0}, {}).y, -2 + 256 * 0x1p-23f);
  EXPECT_EQ(departed(Departure::waechter_binder, point, {0, 0, -1}, {}).z, 0.01f - 0x1p-16f);
}

}  // namespace
}  // namespace raytree::benchmarks
