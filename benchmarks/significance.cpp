#include "benchmarks/significance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "benchmarks/measurement.h"

namespace raytree::benchmarks {
namespace {

/// So many pairs of samples are counted out exactly; beyond, U is as good as normal, its mean n m / 2 and its variance
/// n m (n + m + 1) / 12 (Mann and Whitney 1947), with half a step for continuity.
constexpr std::size_t kMostExactPairs = 1600;

/// [u] share of choices of n ranks among n + m that give U = u.
std::vector<double> rank_sum_shares(std::size_t n, std::size_t m) {
  // Row by row in n: ways[j][u] for n' <= n samples against j of the others.
  std::vector<std::vector<double>> ways(m + 1, std::vector<double>(n * m + 1, 0.0));
  for (auto& row : ways) row[0] = 1;
  for (std::size_t i = 1; i <= n; ++i) {
    std::vector<std::vector<double>> next(m + 1, std::vector<double>(n * m + 1, 0.0));
    next[0][0] = 1;
    for (std::size_t j = 1; j <= m; ++j)
      for (std::size_t u = 0; u <= i * j; ++u) {
        // As shares, not counts: binomials of a few hundred leave double's range. The highest of i + j ranks belongs to
        // the first set with chance i / (i + j), and then counts j pairs.
        const auto of_first = static_cast<double>(i) / static_cast<double>(i + j);
        next[j][u] = (u >= j ? of_first * ways[j][u - j] : 0.0) + (1 - of_first) * next[j - 1][u];
      }
    ways = std::move(next);
  }
  return ways[m];
}

}  // namespace

const char* name_of(Change change) {
  constexpr const char* kNames[] = {"no change", "faster", "slower", "too few samples"};
  return kNames[static_cast<std::size_t>(change)];
}

Comparison compare_speeds(const std::vector<double>& before, const std::vector<double>& after, double least) {
  Comparison result;
  const std::size_t n = after.size(), m = before.size();
  if (n == 0 || m == 0) {
    result.change = Change::too_few;
    return result;
  }
  result.ratio = spread_of(after).median / spread_of(before).median;
  double wins = 0;
  for (const double a : after)
    for (const double b : before) wins += a > b ? 1.0 : a == b ? 0.5 : 0.0;
  // The distribution is symmetric: the smaller tail twice. Ties leave U between two whole numbers: the larger tail
  // counts.
  const double all = static_cast<double>(n * m), tail = std::ceil(std::min(wins, all - wins));
  double least_chance = 0;
  if (n * m <= kMostExactPairs) {
    const std::vector<double> shares = rank_sum_shares(n, m);
    double chance = 0;
    for (std::size_t u = 0; u <= static_cast<std::size_t>(tail); ++u) chance += shares[u];
    result.chance = std::min(1.0, 2 * chance), least_chance = 2 * shares[0];
  } else {
    const double deviation = std::sqrt(all * static_cast<double>(n + m + 1) / 12);
    result.chance = std::min(1.0, std::erfc((all / 2 - tail - 0.5) / (std::sqrt(2.0) * deviation)));
    // One sample can be the highest of many by chance; two of so many can hardly.
    if (std::min(n, m) == 1) least_chance = 2.0 / static_cast<double>(n + m);
  }
  if (least_chance >= kChance)
    result.change = Change::too_few;
  else if (result.chance < kChance && std::abs(result.ratio - 1) > least)
    result.change = result.ratio > 1 ? Change::faster : Change::slower;
  return result;
}

}  // namespace raytree::benchmarks
