// `raytree validate`: renders a scene and asks a slow and plain tracer every ray again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/prepared_scene.h"
#include "app/render_options.h"
#include "app/suggestion.h"
#include "app/truth.h"
#include "benchmarks/planted_fault.h"
#include "benchmarks/validation.h"
#include "renderer/atomic_file.h"
#include "renderer/image_file.h"

namespace raytree::app {
namespace {

using benchmarks::ValidationOptions;
using benchmarks::ValidationReport;

constexpr const char* kInPlace = "-";

struct ValidateOptions {
  SceneFlags scene;
  std::vector<std::string> scenes;
  std::int64_t pixels = 10000;  ///< 0: all
  int threads = 0;
  std::string truth;                                ///< empty: the scene's default
  const benchmarks::PlantedFault* fault = nullptr;  ///< null: none
  std::string picture;                              ///< file; empty: none
  std::string json;                                 ///< file beside the text; kInPlace: in place of it; empty: none
  bool table = false;                               ///< a line of Markdown for each scene in place of the text
  bool quiet = false;
};

/// --json without a name, before another flag or at the end, is given the name that stands for none.
Words with_json_value(const Words& words) {
  Words result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    result.push_back(words[i]);
    if (words[i] == "--json" && (i + 1 == words.size() || (words[i + 1].size() > 1 && words[i + 1][0] == '-')))
      result.emplace_back(kInPlace);
  }
  return result;
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const benchmarks::PlantedFault& fault : benchmarks::planted_faults()) names.emplace_back(fault.name);
  return names;
}

/// Throws Error (bad_input) unless it is the name of one, or empty.
const benchmarks::PlantedFault* fault_named(const std::string& name) {
  if (name.empty()) return nullptr;
  for (const benchmarks::PlantedFault& fault : benchmarks::planted_faults())
    if (fault.name == name) return &fault;
  const std::vector<std::string> names = fault_names();
  throw usage_error(
      fmt::format("--plant: \"{}\" is none of: {}{}", name, fmt::join(names, ", "), did_you_mean(name, names)));
}

std::optional<ValidateOptions> parse_validate_options(const Words& words) {
  ValidateOptions options;
  std::string threads, pixels, fault;
  bool full = false;
  CLI::App command(
      "Compare the rays of a picture, one sample at each pixel's center, with what a slow and plain tracer in double "
      "precision says of the same rays. Exit status 3 when something differs that rounding does not explain.",
      "raytree validate");
  command
      .add_option("SCENE", options.scenes,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes); several "
                  "with --table")
      ->type_name("");
  command.add_option("--rays", pixels, "Compare the trees of about so many eye rays; default: 10000")->type_name("N");
  command.add_flag("--full", full, "Compare the trees of all pixels");
  add_truth_flag(command, options.truth);
  command
      .add_option(
          "--plant", fault,
          fmt::format("Plant a fault in the fast tracer, to see that it is found: {}", fmt::join(fault_names(), ", ")))
      ->type_name("FAULT");
  command.add_option("-o,--output", options.picture, "Picture with the disagreements marked (.png)")->type_name("FILE");
  command.add_flag("--table", options.table, "Print a table of Markdown, a line for each scene");
  command.add_option("--json", options.json, "Print JSON; with a name, write it to that file beside the text")
      ->type_name("[FILE]");
  add_scene_flags(command, options.scene, false);
  add_hierarchy_flags(command, options.scene);
  command.add_option("--threads", threads, "Threads; default: all. The report does not depend on it")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  if (!parse_usage(command, with_json_value(words))) return std::nullopt;
  options.scene.antialias = "none";
  check_truth(options.truth);
  options.fault = fault_named(fault);
  if (options.scenes.empty()) options.scenes.emplace_back();
  if (options.scenes.size() > 1 && !options.table)
    throw usage_error(
        fmt::format("unexpected argument \"{}\": several scenes are compared with --table", options.scenes[1]));
  if (options.table && (!options.json.empty() || !options.picture.empty()))
    throw usage_error("--table prints a table and nothing else: leave -o and --json away");
  options.scene.scene = options.scenes.front();
  check_scene_flags(options.scene);
  if (full && !pixels.empty()) throw usage_error("--full compares all pixels: leave --rays away");
  if (!pixels.empty()) options.pixels = parse_integer("--rays", pixels, 1, std::int64_t(1) << 40);
  if (full) options.pixels = 0;
  options.threads = parse_threads(threads);
  if (!options.picture.empty()) {
    if (image_format(options.picture) != ImageFormat::png)
      throw usage_error(fmt::format("-o: {} does not end in .png", options.picture));
    check_writable(options.picture);
  }
  if (!options.json.empty() && options.json != kInPlace) check_writable(options.json);
  return options;
}

void write_report(const ValidateOptions& options, const ValidationReport& report) {
  if (options.table) return print_result(benchmarks::validation_table_line(report));
  const std::string json = options.json.empty() ? "" : benchmarks::report_json(report);
  print_result(options.json == kInPlace ? json : benchmarks::report_text(report));
  if (!options.json.empty() && options.json != kInPlace) write_file_atomically(options.json, json.data(), json.size());
  if (options.picture.empty()) return;
  std::array<std::vector<std::uint8_t>, 3> planes;
  write_image_file(options.picture, benchmarks::marked_image(report, planes), ImageFormat::png);
}

}  // namespace

int validate_command(const Words& words) {
  std::optional<ValidateOptions> options = parse_validate_options(words);
  if (!options) return kSuccess;
  if (options->table) print_result(benchmarks::validation_table_head());
  bool holds = true;
  for (const std::string& scene_name : options->scenes) {
    options->scene.scene = scene_name;
    SceneRun run{options->scene, options->threads, true, options->quiet};
    run.keep_sources = truth_needs_sources(options->truth);
    const int status = with_prepared_scene(run, [&](Scene& scene, const Interruption& interruption) {
      ValidationOptions validation;
      validation.pixels = static_cast<std::uint64_t>(options->pixels);
      const std::string truth_name = truth_for(options->truth, scene);
      validation.tolerance = facet_tolerance(truth_name, scene);
      validation.stop = &interruption.stop();
      if (options->fault != nullptr)
        scene.intersector = std::make_unique<benchmarks::FaultyTracer>(std::move(scene.intersector),
                                                                       options->fault->make(*scene.shapes));
      const std::unique_ptr<const ReferenceTracer> truth = make_truth(truth_name, scene, validation.stop);
      ValidationReport report = validate(scene, *scene.shapes, *truth, validation);
      report.truth_name = truth_name;
      if (options->fault != nullptr) report.planted_fault = options->fault->description;
      if (!report.complete) return;
      write_report(*options, report);
      holds &= report.holds();
    });
    if (status != kSuccess) return status;
  }
  return holds ? kSuccess : kFallsShort;
}

}  // namespace raytree::app
