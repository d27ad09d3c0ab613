// Rows 1 to 7 and 11 to 19 of the catalogue of failures: every figure lies where closed forms and papers put it.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <set>

#include "benchmarks/stability/faceted_circle.h"
#include "benchmarks/stability/stability_report.h"

namespace raytree::benchmarks {
namespace {

StabilityReport run_facets(const std::vector<GroupedCase>& cases, int threads) {
  StabilityOptions options;
  options.run.effort = kLeastEffort;
  options.run.pictures = false;
  tbb::task_arena arena(threads);
  StabilityReport report;
  arena.execute([&] { report = run_stability(cases, options); });
  return report;
}
std::vector<GroupedCase> grouped_facet_cases() {
  std::vector<GroupedCase> cases;
  for (const StabilityCase& what : facet_cases()) cases.push_back({"Facets", what});
  return cases;
}

TEST(StabilityFacets, EveryFigureIsAsExpected) {
  std::set<int> rows;
  for (const StabilityEntry& entry : run_facets(grouped_facet_cases(), 2).entries) {
    const StabilityCase& what = entry.grouped.what;
    EXPECT_EQ(entry.error, "") << what.name;
    rows.insert(what.row);
    bool holds = false;
    for (const StabilityFigure& figure : entry.result.figures) {
      EXPECT_NE(figure.verdict(), StabilityVerdict::fails)
          << what.name << ", " << figure.method << ": " << figure.quantity << ": " << figure.measured << " in ["
          << figure.low << ", " << figure.high << "]";
      holds |= figure.verdict() == StabilityVerdict::holds;
    }
    EXPECT_TRUE(holds) << what.name << " shows no remedy";
  }
  for (int row = 1; row <= 19; ++row) EXPECT_EQ(rows.count(row), row < 8 || row > 10) << row;
}

TEST(StabilityFacets, FiguresDoNotDependOnThreads) {
  std::vector<GroupedCase> cases;
  for (const char* name : {"gouraud-flicker", "turning-facets", "mirrored-below-facet", "scanline-rotation"})
    for (const GroupedCase& grouped : matching_cases(grouped_facet_cases(), name)) cases.push_back(grouped);
  ASSERT_EQ(cases.size(), 4u);
  EXPECT_EQ(stability_json(run_facets(cases, 1)), stability_json(run_facets(cases, 3)));
}

// What the cases predict with, against hand-made values: a square on its corner, whose facets show 45 degrees.
TEST(StabilityFacets, TheFacetedCircleFollowsThePapersFormulas) {
  const facets::FacetedCircle square(4, 0);
  const double half = std::sqrt(0.5), exponent = 2;
  EXPECT_NEAR(square.light(ShadingMethod::flat, 0.3, exponent), half * half, 1e-12);
  EXPECT_NEAR(square.light(ShadingMethod::gouraud, 0.3, exponent), 0.7, 1e-12);
  EXPECT_NEAR(square.light(ShadingMethod::phong, 0.3, exponent), 0.7 * 0.7 / (0.3 * 0.3 + 0.7 * 0.7), 1e-12);
  EXPECT_EQ(square.light(ShadingMethod::phong, 1.1, exponent), 0);
  EXPECT_NEAR(facets::FacetedCircle(0, 0).light(ShadingMethod::limit, 0.6, exponent), 0.64, 1e-12);
  EXPECT_EQ(facets::pixel_centers(2, 0.5), (std::vector<double>{-0.25, 0.25}));
}

}  // namespace
}  // namespace raytree::benchmarks
