// The stability suite: all groups of cases, and the run over those that are asked for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmarks/stability/stability_case.h"

namespace raytree::benchmarks {

/// A case and the part of the suite that it belongs to.
struct GroupedCase {
  const char* group;  ///< title: "Shading of facets"
  StabilityCase what;
};

/// All cases, group by group, in the order of their rows within a group.
std::vector<GroupedCase> stability_cases();

/// Those whose name matches a pattern of the shell: *, ? and [...].
std::vector<GroupedCase> matching_cases(const std::vector<GroupedCase>& cases, const std::string& pattern);

/// Seconds that the whole suite takes about at full effort on two cores: a budget below it scales efforts down.
inline constexpr double kFullSuiteSeconds = 60;
/// The least share of the full effort that cases are asked for.
inline constexpr double kLeastEffort = 0.05;

/// A function of the budget alone, not of the clock, so that figures repeat.
double stability_effort(double budget_seconds);

struct StabilityOptions {
  StabilityRun run;
  /// From any thread, one at a time, after each case.
  std::function<void(const StabilityCase& done, std::size_t count, std::size_t total)> on_case;
};

struct StabilityEntry {
  GroupedCase grouped;
  StabilityResult result;
  std::string error;  ///< what the case threw; empty: it ran to its end

  /// The worst of its figures' verdicts; `fails` also where something was thrown or nothing measured. A case that shows
  /// a remedy beside a known failure holds.
  StabilityVerdict verdict() const;
};

struct StabilityCounts {
  std::size_t holds = 0, fails_as_known = 0, fails = 0;
  std::size_t total() const { return holds + fails_as_known + fails; }
  void add(StabilityVerdict verdict);
};

struct StabilityReport {
  StabilityFaults faults;
  double effort = 1;
  std::vector<StabilityEntry> entries;  ///< in the order of the cases
  bool complete = true;                 ///< false: stopped; entries that did not run are missing

  StabilityCounts cases() const;
  StabilityCounts figures() const;  ///< a case that threw, or measured nothing, counts as one that fails
};

/// Runs the cases, several at a time. What they measure depends on the options alone, never on threads or time.
StabilityReport run_stability(const std::vector<GroupedCase>& cases, const StabilityOptions& options);

}  // namespace raytree::benchmarks
