#include "benchmarks/stability/stability.h"

#include <fnmatch.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>

namespace raytree::benchmarks {
namespace {

struct StabilityGroup {
  const char* title;
  std::vector<StabilityCase> (*cases)();
};
constexpr StabilityGroup kStabilityGroups[] = {
    {"Shading of facets", facet_cases},
    {"What falls between samples", sampling_cases},
    {"The ray tree, optics and media", ray_tree_cases},
    {"Intersection, offsets and scale", intersection_cases},
    {"Patches and subdivision surfaces", curved_cases},
    {"Numbers on the way to a file", picture_cases},
};

/// What the case measured; its error where it threw one. None: it was stopped.
std::optional<StabilityEntry> entry_of(const GroupedCase& grouped, const StabilityRun& run) {
  const auto stopped = [&] { return run.stop != nullptr && run.stop->load(); };
  if (stopped()) return std::nullopt;
  StabilityEntry entry{grouped, {}, {}};
  try {
    entry.result = grouped.what.run(run);
  } catch (const std::exception& error) {
    entry.error = error.what();
  }
  if (stopped()) return std::nullopt;
  return entry;
}

}  // namespace

std::vector<GroupedCase> stability_cases() {
  std::vector<GroupedCase> all;
  for (const StabilityGroup& group : kStabilityGroups)
    for (const StabilityCase& what : group.cases()) all.push_back({group.title, what});
  return all;
}

std::vector<GroupedCase> matching_cases(const std::vector<GroupedCase>& cases, const std::string& pattern) {
  std::vector<GroupedCase> matching;
  for (const GroupedCase& grouped : cases)
    if (fnmatch(pattern.c_str(), grouped.what.name, 0) == 0) matching.push_back(grouped);
  return matching;
}

double stability_effort(double budget_seconds) {
  return std::clamp(budget_seconds / kFullSuiteSeconds, kLeastEffort, 1.0);
}

StabilityVerdict StabilityEntry::verdict() const {
  if (!error.empty() || result.figures.empty()) return StabilityVerdict::fails;
  StabilityVerdict worst = StabilityVerdict::fails_as_known;
  for (const StabilityFigure& figure : result.figures) {
    if (figure.verdict() == StabilityVerdict::fails) return StabilityVerdict::fails;
    if (figure.verdict() == StabilityVerdict::holds) worst = StabilityVerdict::holds;
  }
  return worst;
}

void StabilityCounts::add(StabilityVerdict verdict) {
  holds += verdict == StabilityVerdict::holds;
  fails_as_known += verdict == StabilityVerdict::fails_as_known;
  fails += verdict == StabilityVerdict::fails;
}

StabilityCounts StabilityReport::cases() const {
  StabilityCounts counts;
  for (const StabilityEntry& entry : entries) counts.add(entry.verdict());
  return counts;
}

StabilityCounts StabilityReport::figures() const {
  StabilityCounts counts;
  for (const StabilityEntry& entry : entries) {
    for (const StabilityFigure& figure : entry.result.figures) counts.add(figure.verdict());
    if (!entry.error.empty() || entry.result.figures.empty()) counts.add(StabilityVerdict::fails);
  }
  return counts;
}

StabilityReport run_stability(const std::vector<GroupedCase>& cases, const StabilityOptions& options) {
  std::vector<std::optional<StabilityEntry>> entries(cases.size());
  std::mutex mutex;
  std::size_t done = 0;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, cases.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          // A thread that waits inside a case must not begin another one above it on its stack.
          tbb::this_task_arena::isolate([&] { entries[i] = entry_of(cases[i], options.run); });
          const std::lock_guard lock(mutex);
          ++done;
          if (options.on_case && entries[i]) options.on_case(cases[i].what, done, cases.size());
        }
      },
      tbb::simple_partitioner());
  StabilityReport report;
  report.faults = options.run.faults;
  report.effort = options.run.effort;
  for (std::optional<StabilityEntry>& entry : entries) {
    if (entry)
      report.entries.push_back(std::move(*entry));
    else
      report.complete = false;
  }
  return report;
}

}  // namespace raytree::benchmarks
