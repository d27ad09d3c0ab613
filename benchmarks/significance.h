// Whether two sets of timings differ, or noise alone may have made the difference.
#pragma once

#include <vector>

namespace raytree::benchmarks {

enum class Change : unsigned char {
  none,     ///< the noise allows no other word
  faster,   ///< the second set's values (speeds) are higher
  slower,   ///< lower
  too_few,  ///< so few samples that no difference could be told from chance
};
const char* name_of(Change change);

struct Comparison {
  double ratio = 1;   ///< median after / median before
  double chance = 1;  ///< of ranks so far apart, or further, if nothing had changed (two-sided)
  Change change = Change::none;
};

/// Chance that is taken for none: of a hundred unchanged rows, one may be said to have changed.
inline constexpr double kChance = 0.01;

/// What one process's speed differs from another's of the same program for no reason of either's: where its memory
/// lies, what else the machine does. Less than that is no change, however sure the ranks.
inline constexpr double kBetweenProcesses = 0.03;

/// Compares speeds before and after. Rank-sum test (Wilcoxon 1945; Mann and Whitney 1947): U counts the pairs of
/// which the sample after is the higher (ties half). If nothing changed, every choice of which n of the n + m ranks are
/// "before" is as likely as any other, so P(U = u) is the number of choices with that u over all binomial(n + m, n);
/// the numbers follow from c(n, m, u) = c(n - 1, m, u - m) + c(n, m - 1, u). It asks nothing of the noise's shape,
/// which for timings is skewed. A change is one that chance explains with less than kChance and that is larger than
/// `least` (a ratio's distance from 1).
Comparison compare_speeds(const std::vector<double>& before, const std::vector<double>& after,
                          double least = kBetweenProcesses);

}  // namespace raytree::benchmarks
