// The front, the price of accuracy and the sentences that follow from them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/benchmarks/chart_samples.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::charted_point;
using test::contains;

bool dominates(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

TEST(ChartFront, IsWhatNoPointDominates) {
  std::mt19937 random(1980);
  std::uniform_int_distribution<int> few(1, 30);  // with many ties
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points(40);
    for (CostAndError& point : points) point = {double(few(random)), double(few(random))};
    const std::vector<std::size_t> front = pareto_front(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool beaten =
          std::any_of(points.begin(), points.end(), [&](const auto& p) { return dominates(p, points[i]); });
      const bool twin_before = std::any_of(points.begin(), points.begin() + std::ptrdiff_t(i), [&](const auto& p) {
        return p.cost == points[i].cost && p.error == points[i].error;
      });
      EXPECT_EQ(std::count(front.begin(), front.end(), i), beaten || twin_before ? 0 : 1);
    }
    EXPECT_TRUE(std::is_sorted(front.begin(), front.end(),
                               [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; }));
  }
}

TEST(ChartFront, KeepsOffWhatIsDominatedNotFiniteOrDoesNotRepeat) {
  ChartData data = test::sample_chart();
  data.points.push_back(charted_point("nowhere", "1", 0.01, std::numeric_limits<double>::quiet_NaN()));
  data.points.push_back(charted_point("unsteady", "1", 0.01, 1e-9));
  data.points.back().repeats = false;
  const std::vector<std::size_t> front = chart_front(data, kMetrics.front());
  EXPECT_EQ(front, (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(ChartFindings, HalvingCostsWhatAPowerLawSays) {
  std::vector<CostAndError> front;
  for (int i = 0; i < 6; ++i) front.push_back({0.01 * std::pow(1.9, i), std::pow(0.5, i)});
  EXPECT_NEAR(cost_of_halving(front, 0).value().factor, 1.9, 1e-9);
  // Points below the floor say nothing.
  front.push_back({1000, 1e-6});
  EXPECT_NEAR(cost_of_halving(front, 1e-3).value().factor, 1.9, 1e-9);
  EXPECT_LT(cost_of_halving(front, 1e-3).value().settings, cost_of_halving(front, 0).value().settings);
  EXPECT_FALSE(cost_of_halving({{1, 1}, {2, 0.5}}, 0));
}

std::string all_findings(const ChartData& data) {
  std::string text;
  for (const Finding& finding : findings_of(data)) text += finding.text + "\n";
  return text;
}

TEST(ChartFindings, NameTheCheapestSettingsAndThePrice) {
  const std::string text = all_findings(test::sample_chart());
  // .2 / 2^6 = .0031 is the first below 1/255 = .0039.
  EXPECT_TRUE(contains(text, "Cheapest setting under 1/255 (RMSE in linear light): --levels 6; 6.4 s")) << text;
  EXPECT_TRUE(contains(text, "each halving of the error costs x2 in time")) << text;
  EXPECT_TRUE(contains(text, "scene's own settings (0.5 s) are dominated: --levels 2 reaches their RMSE in 80 %"))
      << text;
  ChartData coarse = test::sample_chart();
  std::erase_if(coarse.points, [](const ChartPoint& point) { return point.errors.rmse < 0.01; });
  EXPECT_TRUE(contains(all_findings(coarse), "under 1/255 (RMSE in linear light): none of the settings measured"));
}

TEST(ChartFindings, SayWhatTheReferenceCannotTell) {
  ChartData data = test::sample_chart();
  EXPECT_FALSE(contains(all_findings(data), "The reference's own error"));
  data.floor.rmse = 0.01;
  const std::string below = all_findings(data);
  EXPECT_TRUE(contains(below, "Most accurate setting: --levels 7;")) << below;
  EXPECT_TRUE(contains(below, "The reference's own error, 0.01, is larger")) << below;
  std::erase_if(data.points, [](const ChartPoint& point) { return point.errors.rmse < 0.01; });
  data.floor.over_step = 0.2;
  const std::string above = all_findings(data);
  EXPECT_TRUE(contains(above, "linear light): not known; the reference's own error is 0.01.")) << above;
  EXPECT_TRUE(contains(above, "after the view: not known; the reference's own error is 20 % of the pixels.")) << above;
}

TEST(ChartFindings, NameTheLeastAndTheMostMemory) {
  ChartData data = test::sample_chart();
  EXPECT_FALSE(contains(all_findings(data), "Peak memory"));
  data.points.push_back(charted_point("hungry", "1", 3, 0.05));
  data.points.back().peak_bytes = {31e6, 30e6, 30e6};
  EXPECT_TRUE(contains(all_findings(data), "between 2.5 MB (the scene's own settings) and 30 MB (--hungry 1); the"))
      << all_findings(data);
  // Sizes are counted where nothing is measured; they say less.
  for (ChartPoint& point : data.points) point.peak_bytes.clear();
  EXPECT_FALSE(contains(all_findings(data), "Peak memory"));
}

TEST(ChartFindings, NameKnobsThatBuyNothingAndSpeedForNothing) {
  ChartData data = test::sample_chart();
  data.points.push_back(charted_point("idle", "1", 0.5, 0.05));
  data.points.push_back(charted_point("idle", "2", 0.52, 0.0501));
  data.points.push_back(charted_point("waste", "less", 0.3, 0.05));
  const std::string text = all_findings(data);
  EXPECT_TRUE(contains(text, "knobs buy nothing here: idle and wasteful.")) << text;
  EXPECT_TRUE(contains(text, "Speed for nothing: --waste less takes 60 %")) << text;
}

TEST(ChartFindings, NameWhatIsBoughtDear) {
  ChartData data = test::sample_chart();
  data.points.push_back(charted_point("slow", "9", 5, 0.04));
  EXPECT_TRUE(contains(all_findings(data), "slow (9 divides the error by 1.25 for 10 times the time)"))
      << all_findings(data);
}

}  // namespace
}  // namespace raytree::benchmarks
