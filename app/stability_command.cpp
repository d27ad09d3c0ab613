// `raytree stability`: runs the catalogue of failures and says which methods hold.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/budget.h"
#include "app/commands.h"
#include "app/exit_status.h"
#include "app/interruption.h"
#include "app/messages.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "app/render_options.h"
#include "app/suggestion.h"
#include "benchmarks/stability/heat_map_svg.h"
#include "benchmarks/stability/stability_maps.h"
#include "benchmarks/stability/stability_page.h"
#include "benchmarks/stability/stability_report.h"
#include "renderer/atomic_file.h"

namespace raytree::app {
namespace {

using benchmarks::GroupedCase;
using benchmarks::StabilityMap;
using benchmarks::StabilityReport;

constexpr const char* kAllCases = "*";
constexpr const char *kPage = "stability.html", *kJson = "stability.json";

struct StabilityCommandOptions {
  std::string folder, filter = kAllCases;
  benchmarks::StabilityFaults faults;
  double effort = 1;
  int threads = 0;
  bool list = false, json = false, quiet = false;
};

benchmarks::StabilityFaults parse_faults(const std::vector<std::string>& names) {
  benchmarks::StabilityFaults faults;
  for (const std::string& name : names) {
    if (name == "no-offsets")
      faults.no_offsets = true;
    else if (name == "not-robust")
      faults.not_robust = true;
    else
      throw usage_error(fmt::format("--plant: \"{}\" is none of: no-offsets, not-robust{}", name,
                                    did_you_mean(name, {"no-offsets", "not-robust"})));
  }
  return faults;
}

std::optional<StabilityCommandOptions> parse_stability_options(const Words& words) {
  StabilityCommandOptions options;
  std::vector<std::string> faults;
  std::string threads, budget = "60s";
  CLI::App command(
      "Run the catalogue of known failures of rendering methods: each is provoked and measured, with its remedy on and "
      "off. Exit status 3 when a figure is neither as it should be nor as its paper says.",
      "raytree stability");
  command.add_option("-o,--output", options.folder, "Folder for stability.html and stability.json, made if need be")
      ->type_name("DIR");
  command.add_option("--filter", options.filter, "Run the cases of these names alone, e.g. 'gouraud-*'")
      ->type_name("GLOB");
  command.add_flag("--list", options.list, "List the cases and run none");
  command.add_flag("--json", options.json, "Print JSON in place of the table");
  command
      .add_option("--budget", budget, "Time for the whole suite, e.g. 20s or 1m; default: 60s, which is full effort")
      ->type_name("TIME");
  command
      .add_option("--plant", faults,
                  "Plant a fault to see that the suite notices: no-offsets: rays start where they hit; not-robust: "
                  "edges leak; repeatable")
      ->type_name("FAULT");
  command.add_option("--threads", threads, "Threads; default: all. Figures do not depend on it")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No progress");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  options.faults = parse_faults(faults);
  options.effort = benchmarks::stability_effort(parse_budget(budget));
  options.threads = parse_threads(threads);
  if (options.folder.empty() && !options.list)
    throw usage_error("no output: add -o DIR, a folder for the page, for example -o stability");
  if (!options.folder.empty() && !options.list) options.folder = output_folder(options.folder, {kPage, kJson});
  return options;
}

std::string list_text(const std::vector<GroupedCase>& cases) {
  std::size_t width = 0;
  for (const GroupedCase& grouped : cases) width = std::max(width, std::string_view(grouped.what.name).size());
  std::string text;
  for (const GroupedCase& grouped : cases)
    text += fmt::format("{:<{}}  row {:>2}  {}\n", grouped.what.name, width, grouped.what.row, grouped.what.title);
  return text;
}

/// Throws Error (failure) where no folder can be made of that name.
void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(ErrorKind::failure, {}, fmt::format("{}: cannot make this folder: {}", folder, error.message()));
}

struct MeasuredSuite {
  StabilityReport report;
  std::vector<StabilityMap> maps;  ///< where all cases are run

  std::vector<std::string> broken_promises() const {
    std::vector<std::string> broken;
    for (const StabilityMap& map : maps)
      for (std::string& promise : benchmarks::broken_promises(map)) broken.push_back(std::move(promise));
    return broken;
  }
};

MeasuredSuite measured(const StabilityCommandOptions& options, const std::vector<GroupedCase>& cases,
                       Progress& progress, const Interruption& interruption) {
  benchmarks::StabilityOptions run;
  run.run.faults = options.faults;
  run.run.effort = options.effort;
  run.run.stop = &interruption.stop();
  run.on_case = [&](const benchmarks::StabilityCase& done, std::size_t count, std::size_t total) {
    progress.phase(fmt::format("{} of {}: {}", count, total, done.name));
  };
  // No limit on all of TBB: the cases about threads bring numbers of their own.
  tbb::task_arena arena(options.threads);
  MeasuredSuite suite;
  arena.execute([&] {
    suite.report = run_stability(cases, run);
    if (options.filter != kAllCases || !suite.report.complete) return;
    progress.phase("stability maps");
    suite.maps = benchmarks::stability_maps(run.run);
  });
  suite.report.complete &= !interruption.stop();
  return suite;
}

std::string json_text(const MeasuredSuite& suite) {
  return benchmarks::stability_json(suite.report,
                                    suite.maps.empty() ? std::string() : benchmarks::stability_maps_json(suite.maps));
}

std::string table_text(const MeasuredSuite& suite) {
  std::string text = benchmarks::stability_text(suite.report);
  for (const StabilityMap& map : suite.maps) text += fmt::format("map {}: {}\n", map.name, map.envelope);
  for (const std::string& broken : suite.broken_promises()) text += "BROKEN PROMISE " + broken + "\n";
  return text;
}

void write_stability(const std::string& folder, const MeasuredSuite& suite, const std::string& json) {
  make_folder(folder);
  std::vector<benchmarks::PageSection> sections;
  if (!suite.maps.empty()) {
    sections.push_back({"maps", "Where rays hold", ""});
    for (const StabilityMap& map : suite.maps) sections.back().html += benchmarks::stability_map_html(map);
  }
  const std::string page = benchmarks::stability_page(suite.report, sections);
  const std::filesystem::path path(folder);
  write_file_atomically((path / kPage).string(), page.data(), page.size());
  write_file_atomically((path / kJson).string(), json.data(), json.size());
}

}  // namespace

int stability_command(const Words& words) {
  const std::optional<StabilityCommandOptions> options = parse_stability_options(words);
  if (!options) return kSuccess;
  const std::vector<GroupedCase> cases = benchmarks::matching_cases(benchmarks::stability_cases(), options->filter);
  if (cases.empty())
    throw usage_error(
        fmt::format("--filter: no case is named \"{}\"; raytree stability --list names them", options->filter));
  if (options->list) {
    print_result(list_text(cases));
    return kSuccess;
  }
  make_folder(options->folder);
  Progress progress(options->quiet ? ProgressMode::none : ProgressMode::automatic);
  const Interruption interruption([&progress] { progress.abandon(); });
  const MeasuredSuite suite = measured(*options, cases, progress, interruption);
  progress.clear();
  if (!suite.report.complete) {
    print_message("raytree: interrupted");
    return kSignalBase + interruption.signal();
  }
  const std::string json = json_text(suite);
  write_stability(options->folder, suite, json);
  print_result(options->json ? json : table_text(suite));
  return suite.report.figures().fails > 0 || !suite.broken_promises().empty() ? kFallsShort : kSuccess;
}

}  // namespace raytree::app
