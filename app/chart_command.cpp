// `raytree chart`: a scene rendered in many ways, speed against accuracy. What a setting's flags mean is read by the
// parser of `raytree render`.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/budget.h"
#include "app/commands.h"
#include "app/exit_status.h"
#include "app/interruption.h"
#include "app/messages.h"
#include "app/output_folder.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/render_options.h"
#include "app/scene_argument.h"
#include "benchmarks/chart/chart_cost.h"
#include "benchmarks/chart/chart_files.h"
#include "benchmarks/chart/chart_run.h"
#include "renderer/image_file.h"

namespace raytree::app {
namespace {

namespace fs = std::filesystem;
using benchmarks::ChartScene;

struct ChartFlags {
  std::string scene, output, size, camera, budget = "2m", threads;
  std::vector<std::string> sets, also;
  bool fresh = false, quiet = false;
};

/// Words of a line, apart by blanks; single quotes hold blanks together.
Words split_words(const std::string& line) {
  Words words;
  bool open = false, quoted = false;
  for (const char c : line) {
    if (c == '\'') {
      quoted = !quoted;
      if (!open) words.emplace_back(), open = true;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) words.emplace_back(), open = true;
      words.back() += c;
    }
  }
  if (quoted) throw usage_error(fmt::format("--also: the quote in \"{}\" does not end", line));
  return words;
}

std::optional<ChartFlags> parse_chart_flags(const Words& words) {
  ChartFlags flags;
  CLI::App command("Chart speed against accuracy: a scene in many settings, each with its time and its error.",
                   "raytree chart");
  command
      .add_option("SCENE", flags.scene,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes)")
      ->type_name("");
  command.add_option("-o,--output", flags.output, "Folder for chart.html and what belongs to it; made if need be")
      ->type_name("DIR")
      ->group("Output");
  command.add_option("--budget", flags.budget, "Time to spend: 20s, 2m, 1.5h; default: 2m")
      ->type_name("TIME")
      ->group("Output");
  command.add_flag("--fresh", flags.fresh, "Measure all anew, whatever DIR holds")->group("Output");
  command.add_option("--also", flags.also, "Measure a setting of your own: flags of raytree render; repeatable")
      ->type_name("FLAGS")
      ->allow_extra_args(false)
      ->group("Scene");
  command.add_option("--size", flags.size, "Image size in pixels; default: 400 wide at most, less for dear scenes")
      ->type_name("WxH")
      ->group("Scene");
  command.add_option("--camera", flags.camera, "Camera by its name; default: the scene's first")
      ->type_name("NAME")
      ->group("Scene");
  command.add_option("--set", flags.sets, "Set any value of the scene, for all settings; repeatable")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->group("Scene");
  command.add_option("--threads", flags.threads, "Threads; default: all. Errors do not depend on it")
      ->type_name("N")
      ->group("Tracing");
  command.add_flag("--quiet", flags.quiet, "Errors alone: no progress, no warnings, no findings")->group("Messages");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  return flags;
}

/// The folder to write to, where its files can be made. Throws Error where they cannot.
std::string checked_folder(const std::string& name) {
  if (name.empty()) throw usage_error("no output: add -o DIR, for example -o chart");
  std::string folder = output_folder(name, {"chart.html", "chart.svg", "points.csv", "chart.json", "reference.exr"});
  std::error_code code;
  if (!fs::is_directory(folder, code)) check_writable(folder);
  output_folder((fs::path(folder) / "pictures").string(), {});
  return folder;
}

/// Reads words as `raytree render` would, without an output.
ChartScene chart_scene(const Words& words, Warnings& warnings) {
  SceneFlags flags;
  CLI::App command("", "raytree render");
  command.add_option("SCENE", flags.scene);
  add_scene_flags(command, flags, true);
  add_shading_flag(command, flags);
  add_hierarchy_flags(command, flags);
  add_intersector_flags(command, flags);
  prepare_usage(command);
  // Asked for in place of a setting, help is no setting.
  if (std::any_of(words.begin(), words.end(),
                  [](const std::string& w) { return w == "-h" || w == "--help" || w == "--version"; }))
    throw usage_error("--also: help is no setting");
  parse_usage(command, words);
  check_scene_flags(flags);
  ChartScene scene{load_scene(flags, warnings), {}};
  apply_tracer_flags(flags, scene.prepare);
  scene.prepare.camera = flags.camera;
  return scene;
}

Words joined_words(Words first, const Words& last) {
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

/// The scene and what is alike in all settings but the size, as `raytree render` takes it.
Words scene_words(const ChartFlags& flags) {
  Words words{flags.scene};
  for (const std::string& set : flags.sets) words.insert(words.end(), {"--set", set});
  if (!flags.camera.empty()) words.insert(words.end(), {"--camera", flags.camera});
  return words;
}

/// Reads the scene under these words and a setting's.
benchmarks::ChartSceneMaker scene_maker(const Words& words) {
  return [words](const Words& flags) {
    Warnings same;
    return chart_scene(joined_words(words, flags), same);
  };
}

Words size_words(int width, int height) { return {"--size", fmt::format("{}x{}", width, height)}; }

class ChartCommand {
 public:
  ChartCommand(const ChartFlags& flags, int threads, Progress& progress, const Interruption& interruption)
      : flags_(flags), progress_(progress), interruption_(interruption) {
    options_.threads = threads;
  }

  void run() {
    options_.budget_seconds = parse_budget(flags_.budget);
    SceneFlags scene;
    scene.scene = flags_.scene;
    check_scene_flags(scene);
    folder_ = checked_folder(flags_.output);
    const auto earlier = flags_.fresh ? std::nullopt : benchmarks::read_earlier_chart(folder_);
    const Words own_words = scene_words(flags_);
    for (const std::string& line : flags_.also) {
      options_.added.push_back(split_words(line));
      for (const std::string& word : options_.added.back())
        for (const std::string_view fixed : {"--size", "--camera", "--threads", "--crop", "--output", "-o"})
          if (word == fixed || word.starts_with(std::string(fixed) + "="))
            throw usage_error(fmt::format("--also: {} is alike for all of a chart, and no setting", fixed));
      scene_maker(own_words)(options_.added.back());  // what is wrong is said before anything is measured
    }
    // The size is always said, so that commands mean what was measured.
    const Words common =
        joined_words(own_words, flags_.size.empty() ? chosen_size(earlier) : Words{"--size", flags_.size});
    options_.command = joined_words({"raytree", "render"}, common);
    options_.make = scene_maker(common);
    options_.version = version();
    options_.stop = &interruption_.stop();
    options_.on_phase = [this](const std::string& text) { progress_.phase(text); };
    options_.keep_reference = [this](const Film& film) { benchmarks::write_reference(folder_, film); };
    options_.save = [this](const benchmarks::ChartData& data) { benchmarks::write_chart(folder_, data); };
    Warnings warnings;
    const benchmarks::MeasuredChart chart = measure_chart(options_, earlier ? &*earlier : nullptr, warnings);
    progress_.clear();
    if (!flags_.quiet) print_warnings(warnings, false);
    if (chart.data.points.empty()) return;  // interrupted before there was anything
    benchmarks::write_chart(folder_, chart.data);
    if (!flags_.quiet) report(chart);
  }

 private:
  /// What the budget affords, or what an earlier chart of the scene has if that is larger: a shorter run goes on with
  /// it. Throws the interruption's Error where it was stopped.
  Words chosen_size(const std::optional<benchmarks::EarlierChart>& earlier) {
    progress_.phase("looking how large a picture the budget affords");
    const benchmarks::ChartSceneMaker make = scene_maker(scene_words(flags_));
    const std::optional<benchmarks::ChartSize> size =
        affordable_size(make, options_.budget_seconds, options_.threads, &interruption_.stop());
    if (!size) throw Error(ErrorKind::failure, {flags_.scene, 0, ""}, "interrupted");
    if (earlier && earlier->data.width > size->width) {
      Words words = size_words(earlier->data.width, earlier->data.height);
      if (scene_hash(make(words)) == earlier->data.scene_hash) return words;
    }
    return size_words(size->width, size->height);
  }

  void report(const benchmarks::MeasuredChart& chart) const {
    std::string text;
    for (const benchmarks::Finding& finding : findings_of(chart.data)) text += "- " + finding.text + "\n";
    if (!interruption_.stop()) print_result(text);
    const std::string kept = chart.points_kept > 0 ? fmt::format(", {} of them from before", chart.points_kept) : "";
    print_message(fmt::format("wrote {} ({} settings{})", (fs::path(folder_) / "chart.html").string(),
                              chart.data.points.size(), kept));
  }

  const ChartFlags& flags_;
  Progress& progress_;
  const Interruption& interruption_;
  std::string folder_;  ///< to write to
  benchmarks::ChartOptions options_;
};

}  // namespace

int chart_command(const Words& words) {
  const std::optional<ChartFlags> flags = parse_chart_flags(words);
  if (!flags) return kSuccess;
  const int threads = parse_threads(flags->threads);
  Progress progress(flags->quiet ? ProgressMode::none : ProgressMode::automatic);
  const Interruption interruption([&progress] { progress.abandon(); });
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  try {
    arena.execute([&] { ChartCommand(*flags, threads, progress, interruption).run(); });
  } catch (const Error&) {
    // A step that the signal cut short may say so as an error of its own.
    if (!interruption.stop()) throw;
  }
  if (!interruption.stop()) return kSuccess;
  progress.clear();
  if (!flags->quiet) print_message("raytree: interrupted");
  return kSignalBase + interruption.signal();
}

}  // namespace raytree::app
