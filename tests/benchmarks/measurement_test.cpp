// What every row rests on: medians and quartiles, bounds and verdicts, pairs in turn.
#include "benchmarks/measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace raytree::benchmarks {
namespace {

TEST(Measurement, QuartilesOfKnownSamples) {
  const Spread odd = spread_of({5, 1, 4, 2, 3});
  EXPECT_EQ(odd.low, 2);
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.high, 4);
  EXPECT_EQ(odd.count, 5);
  const Spread even = spread_of({4, 1, 3, 2});
  EXPECT_EQ(even.low, 1.75);
  EXPECT_EQ(even.median, 2.5);
  EXPECT_EQ(even.high, 3.25);
  EXPECT_EQ(spread_of({7}).median, 7);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

TEST(Measurement, PairsAreTakenInTurnAndTheWarmUpDoesNotCount) {
  std::string order;
  int a_runs = 0;
  PairLimits limits;
  limits.least = 3;
  limits.most = 5;
  limits.enough = 1e-9;  // never reached by the ratios below, so all five pairs are taken
  const PairedSpread pairs = measure_pairs(
      [&] {
        order += 'a';
        return a_runs++ == 0 ? 1000.0 : static_cast<double>(a_runs);
      },
      [&] {
        order += 'b';
        return 2.0;
      },
      limits);
  EXPECT_EQ(order, "abababababab");
  EXPECT_EQ(pairs.ratio.count, 5);
  EXPECT_EQ(pairs.a.median, 4);      // of 2 3 4 5 6
  EXPECT_EQ(pairs.ratio.median, 2);  // of 1 1.5 2 2.5 3
}

TEST(Measurement, StopsOnceTheMedianIsCertain) {
  PairLimits limits;
  limits.least_seconds = 0;
  const PairedSpread pairs = measure_pairs([] { return 3.0; }, [] { return 2.0; }, limits);
  EXPECT_EQ(pairs.ratio.count, limits.least);
  EXPECT_EQ(pairs.ratio.median, 1.5);
}

Figure figure_of(BoundKind kind, double median, double bound) {
  Figure figure;
  figure.row = "row";
  figure.what = "what";
  figure.measured = {median, median, median, 1};
  figure.kind = kind;
  figure.bound = bound;
  return figure;
}

TEST(Measurement, BoundsHoldOnTheirOwnSide) {
  EXPECT_TRUE(figure_of(BoundKind::at_least, 0.55, 0.55).holds());
  EXPECT_FALSE(figure_of(BoundKind::at_least, 0.5499, 0.55).holds());
  EXPECT_TRUE(figure_of(BoundKind::at_most, 30, 30).holds());
  EXPECT_FALSE(figure_of(BoundKind::at_most, 30.01, 30).holds());
  EXPECT_TRUE(figure_of(BoundKind::none, 1e9, 0).holds());
  const double nan = std::nan("");
  EXPECT_FALSE(figure_of(BoundKind::at_least, nan, 0).holds());
  EXPECT_FALSE(figure_of(BoundKind::at_most, nan, 1).holds());
}

TEST(Measurement, AProblemOutweighsAGoodFigure) {
  Figure figure = figure_of(BoundKind::at_least, 1, 0.5);
  figure.problem = "the pictures differ";
  EXPECT_FALSE(figure.holds());
  EXPECT_NE(table_line(figure).find("**falls short**: the pictures differ"), std::string::npos);
}

TEST(Measurement, ATableLineHasTheColumnsOfTheHead) {
  const std::string head = table_head(), line = table_line(figure_of(BoundKind::at_least, 0.612, 0.55));
  const auto bars = [](const std::string& text) {
    return std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find('\n')), '|');
  };
  EXPECT_EQ(bars(head), bars(line));
  EXPECT_EQ(line, "| row | what | 0.61 | >= 0.55 | holds |\n");
}

TEST(Measurement, JsonHoldsWhatTheTableShows) {
  const auto json = nlohmann::json::parse(
      figures_json({{"processor", "one"}}, {figure_of(BoundKind::at_most, 31, 30), figure_of(BoundKind::none, 5, 0)}));
  EXPECT_EQ(json["machine"]["processor"], "one");
  EXPECT_EQ(json["figures"][0]["at_most"], 30);
  EXPECT_EQ(json["figures"][0]["holds"], false);
  EXPECT_EQ(json["figures"][1]["holds"], true);
  EXPECT_FALSE(json["figures"][1].contains("at_least"));
}

TEST(Measurement, AnIntervalIsReachedByQuartilesAndNoise) {
  Figure figure;
  figure.row = "row", figure.what = "what";
  figure.kind = BoundKind::within, figure.bound = 2, figure.upper = 3, figure.noise = 0.1;
  const auto holds = [&](double low, double high) {
    figure.measured = {low, 0.5 * (low + high), high, 9};
    return figure.holds();
  };
  EXPECT_TRUE(holds(2.2, 2.4));
  EXPECT_TRUE(holds(1.7, 1.9)) << "2 is within a tenth of 1.9";
  EXPECT_TRUE(holds(3.2, 3.4));
  EXPECT_FALSE(holds(1.7, 1.8));
  EXPECT_FALSE(holds(3.4, 3.5));
  EXPECT_FALSE(holds(std::nan(""), std::nan("")));
  EXPECT_NE(table_line(figure).find("2.00 to 3.00"), std::string::npos);
}

}  // namespace
}  // namespace raytree::benchmarks
