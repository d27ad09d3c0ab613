// `raytree render`: from the scene's name to files, one step after the other. All that can be checked cheaply is
// checked before the first ray; interruptions are noticed between the steps and inside the long ones.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <optional>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/interruption.h"
#include "app/messages.h"
#include "app/process.h"
#include "app/render_options.h"
#include "app/spd_counts_text.h"
#include "app/statistics_json.h"
#include "geometry/stopwatch.h"
#include "renderer/atomic_file.h"
#include "renderer/film_image.h"
#include "renderer/spd_counts.h"

namespace raytree::app {
namespace {

/// Thrown between steps once a signal has come; it passes for no Error.
struct Interrupted {};

class RenderRun {
 public:
  RenderRun(RenderCommandOptions options, Progress& progress, const Interruption& interruption)
      : options_(std::move(options)), progress_(progress), interruption_(interruption) {}

  void run() {
    if (options_.writes_display_referred()) make_transform();
    SceneDescription description = load();
    const Scene scene = build(std::move(description));
    const RenderResult result = trace(scene);
    write(scene, result.film);
    report();
    if (options_.spd_counts) print_result(spd_counts_text(scene.description, result.statistics));
  }

 private:
  void check_interruption() const {
    if (interruption_.stop()) throw Interrupted();
  }

  /// What is wrong with a name that a flag gave is said of the flag.
  void make_transform() {
    try {
      transform_.emplace(options_.display);
    } catch (const Error& error) {
      SourceLocation where = error.where();
      const DisplayOptions& given = options_.display;
      if ((where.object == "display" && !given.display.empty()) || (where.object == "view" && !given.view.empty()))
        where.object.insert(0, "--");
      throw Error(error.kind(), where, error.message());
    }
  }

  SceneDescription load() {
    progress_.phase("reading " + options_.scene.scene);
    const Clock::time_point begin = Clock::now();
    SceneDescription description = load_scene(options_.scene, report_.warnings);
    if (options_.spd_counts) set_standard_spd_render(description);
    report_.read_seconds = seconds_since(begin);
    check_interruption();
    const PixelWindow frame{0, 0, description.image.width, description.image.height};
    window_ = options_.crop.value_or(frame);
    // Differences, not sums: the flag's numbers may be as large as an int.
    if (window_.width > frame.width || window_.height > frame.height || window_.x0 > frame.width - window_.width ||
        window_.y0 > frame.height - window_.height)
      throw usage_error(fmt::format("--crop: {}x{}+{}+{} reaches beyond the image of {} x {} pixels", window_.width,
                                    window_.height, window_.x0, window_.y0, frame.width, frame.height));
    return description;
  }

  Scene build(SceneDescription description) {
    progress_.phase("preparing " + options_.scene.scene);
    PrepareOptions prepare_options;
    prepare_options.camera = options_.scene.camera;
    prepare_options.threads = options_.threads;
    prepare_options.stop = &interruption_.stop();
    apply_tracer_flags(options_.scene, prepare_options);
    prepare_options.on_phase = [this](const std::string& text) { progress_.phase(text); };
    Scene scene = prepare(std::move(description), prepare_options, report_.warnings);
    check_interruption();
    report_.warnings.insert(report_.warnings.begin(), options_.warnings.begin(), options_.warnings.end());
    progress_.clear();
    if (!options_.quiet) print_warnings(report_.warnings, options_.verbose);
    return scene;
  }

  RenderResult trace(const Scene& scene) {
    RenderOptions render_options;
    render_options.window = window_;
    render_options.channels = options_.channels;
    render_options.threads = options_.threads;
    render_options.stop = &interruption_.stop();
    if (options_.progress != ProgressMode::none)
      render_options.on_progress = [this](const RenderProgress& done) { progress_.update(done); };
    report_.before_trace_seconds = seconds_since_launch();
    report_.first_ray_clock = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
    // Loaded while the tracing runs, and no sooner: the dynamic loader's lock, held for a third of a second, would stop
    // OpenColorIO, TBB and Embree, which open libraries of their own as they start.
    for (const OutputFile& output : options_.outputs) preload_image_io(output.format);
    progress_.begin_tracing();
    RenderResult result = render(scene, render_options);
    check_interruption();
    report_.scene = scene.description.name;
    report_.image = scene.description.image;
    report_.window = window_;
    report_.settings = scene.description.render;
    report_.camera = options_.scene.camera;
    if (report_.camera.empty() && !scene.description.cameras.empty())
      report_.camera = scene.description.cameras.front().name;
    report_.threads = options_.threads;
    report_.trace = result.statistics;
    report_.prepare = scene.seconds;
    report_.film_bytes = result.film.memory_bytes();
    report_.array_bytes = scene.summary.array_bytes;
    report_.intersector_bytes = scene.summary.intersector_bytes;
    report_.hierarchy = scene.summary.hierarchy;
    return result;
  }

  /// Nothing in it depends on time, machine or thread count, so that equal pictures are equal files.
  std::vector<std::pair<std::string, std::string>> metadata(const Scene& scene) const {
    std::vector<std::pair<std::string, std::string>> entries = {{"Software", "Raytree " + version()},
                                                                {"raytree:scene", scene.description.name}};
    if (!scene.description.title.empty()) entries.emplace_back("ImageDescription", scene.description.title);
    entries.emplace_back("raytree:settings", settings_metadata(scene.description, options_.scene.camera));
    return entries;
  }

  void write(const Scene& scene, const Film& film) {
    const auto common = metadata(scene);
    std::optional<DisplayImage> shown;
    if (transform_) {
      progress_.phase("applying the display transform");
      const Clock::time_point begin = Clock::now();
      shown = display_image(film, *transform_);
      report_.display_seconds = seconds_since(begin);
      report_.display_not_finite = shown->not_finite;
      check_interruption();
    }
    const Clock::time_point begin = Clock::now();
    for (const OutputFile& output : options_.outputs) {
      progress_.phase("writing " + output.path);
      write_image_file(output.path, image(output, film, shown, common), output.format,
                       [this] { check_interruption(); });
      report_.files.push_back(output.path);
      check_interruption();
    }
    report_.write_seconds = seconds_since(begin);
    progress_.clear();
  }

  Image image(const OutputFile& output, const Film& film, const std::optional<DisplayImage>& shown,
              std::vector<std::pair<std::string, std::string>> entries) const {
    if (!output.display_referred()) return scene_linear_image(film, options_.half, std::move(entries));
    entries.emplace_back("raytree:ocio_config", transform_->config_name());
    entries.emplace_back("raytree:display", transform_->display());
    entries.emplace_back("raytree:view", transform_->view());
    entries.emplace_back("raytree:exposure", fmt::format("{}", options_.display.exposure));
    return display_referred_image(*shown, film, std::move(entries));
  }

  void report() {
    if (!options_.quiet) {
      if (report_.trace.not_finite_samples && !options_.verbose)
        print_message(fmt::format("warning: {} of {} samples were not finite and count as 0",
                                  grouped(report_.trace.not_finite_samples), grouped(report_.trace.samples)));
      if (options_.verbose) print_message(statistics_text(report_));
      for (const std::string& file : report_.files)
        if (file != "-")
          print_message(fmt::format("wrote {} ({} x {} pixels, traced in {})", file, window_.width, window_.height,
                                    readable_seconds(report_.trace.wall_seconds)));
    }
    if (!options_.statistics.empty()) {
      const std::string json = statistics_json(report_);
      write_file_atomically(options_.statistics, json.data(), json.size());
    }
  }

  RenderCommandOptions options_;
  Progress& progress_;
  const Interruption& interruption_;
  std::optional<DisplayTransform> transform_;
  PixelWindow window_;
  RenderReport report_;
};

}  // namespace

int render_command(const Words& words) {
  const std::optional<RenderCommandOptions> options = parse_render_options(words);
  if (!options) return kSuccess;
  Progress progress(options->progress);
  const Interruption interruption([&progress] { progress.abandon(); });
  const auto threads = static_cast<std::size_t>(options->threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(options->threads);
  try {
    arena.execute([&] { RenderRun(*options, progress, interruption).run(); });
  } catch (const Interrupted&) {
  } catch (const Error&) {
    // A step that the signal cut short may say so as an error of its own.
    if (!interruption.stop()) throw;
  }
  if (!interruption.stop()) return kSuccess;
  progress.clear();
  if (!options->quiet) print_message("raytree: interrupted");
  return kSignalBase + interruption.signal();
}

}  // namespace raytree::app
