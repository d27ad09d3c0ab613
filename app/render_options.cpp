#include "app/render_options.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "app/suggestion.h"
#include "renderer/atomic_file.h"

namespace raytree::app {
namespace {

namespace fs = std::filesystem;

/// The flags as they were typed.
struct RenderFlags {
  SceneFlags scene;
  std::vector<std::string> words;  ///< without a flag: the scene, and file names that follow the first one of -o
  std::vector<std::string> outputs;
  std::string format, crop, threads, channels, exposure, ocio, display, view, statistics, counts, progress = "auto";
  bool half = false, quiet = false, verbose = false;
};

void add_flags(CLI::App& command, RenderFlags& flags) {
  command
      .add_option("SCENE", flags.words,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes)")
      ->type_name("");
  command
      .add_option(
          "-o,--output", flags.outputs,
          "Image file: .exr (scene-linear), .png, .jpg, .tif (display-referred); - is standard output; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group("Output");
  command.add_option("--format", flags.format, "Format of standard output: exr, png, jpeg or tiff")
      ->type_name("NAME")
      ->group("Output");
  command.add_option("--channels", flags.channels, "Channel groups of an EXR, separated by commas, or all")
      ->type_name("LIST")
      ->group("Output");
  command.add_flag("--half", flags.half, "Store colors in an EXR as 16-bit floats")->group("Output");
  command.add_option("--stats", flags.statistics, "Write what the render cost as JSON; - is standard output")
      ->type_name("FILE.json")
      ->group("Output");
  command
      .add_option("--counts", flags.counts,
                  "spd: trace the standard render of the SPD and print its rays beside the published ones")
      ->type_name("NAME")
      ->group("Output");
  add_scene_flags(command, flags.scene, true);
  add_shading_flag(command, flags.scene);
  add_hierarchy_flags(command, flags.scene);
  add_intersector_flags(command, flags.scene);
  command.add_option("--crop", flags.crop, "Render this window of the image alone")
      ->type_name("WxH+X+Y")
      ->group("Scene");
  command.add_option("--threads", flags.threads, "Threads; default: all. Pixels do not depend on it")
      ->type_name("N")
      ->group("Tracing");
  command.add_option("--exposure", flags.exposure, "Brighten (or darken) the display-referred files")
      ->type_name("STOPS")
      ->group("Display");
  command.add_option("--ocio", flags.ocio, "OpenColorIO config; default: $OCIO, else the built-in one")
      ->type_name("FILE")
      ->group("Display");
  command.add_option("--display", flags.display, "Display of the config (raytree ocio list)")
      ->type_name("NAME")
      ->group("Display");
  command.add_option("--view", flags.view, "View of that display")->type_name("NAME")->group("Display");
  command.add_option("--progress", flags.progress, "auto, bar, plain (a line per 5 %) or none")
      ->type_name("MODE")
      ->group("Messages");
  command.add_flag("--quiet", flags.quiet, "Errors alone: no progress, no warnings")->group("Messages");
  command.add_flag("--verbose", flags.verbose, "Say where time and memory went, and every warning")->group("Messages");
}

ImageFormat parse_format(const std::string& name) {
  if (name == "exr") return ImageFormat::exr;
  if (name == "png") return ImageFormat::png;
  if (name == "jpeg" || name == "jpg") return ImageFormat::jpeg;
  if (name == "tiff" || name == "tif") return ImageFormat::tiff;
  throw usage_error(fmt::format("--format: unknown format \"{}\"; formats: exr, png, jpeg, tiff", name));
}

bool has_image_name(const std::string& word) {
  try {
    image_format(word);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The scene among the words without a flag. After `-o a.exr b.png` the second name belongs to -o as well: no scene
/// ends as an image does.
void sort_words(RenderFlags& flags) {
  for (const std::string& word : flags.words) {
    if (!flags.outputs.empty() && has_image_name(word)) {
      flags.outputs.push_back(word);
    } else if (flags.scene.scene.empty()) {
      flags.scene.scene = word;
    } else if (has_image_name(word)) {
      throw usage_error(fmt::format("unexpected argument \"{0}\"; an image to write follows -o: -o {0}", word));
    } else {
      throw usage_error(fmt::format("unexpected argument \"{}\": the scene is {} already", word, flags.scene.scene));
    }
  }
}

/// Whether two names of files, there or not, are one file's.
bool same_file(const std::string& a, const std::string& b) {
  const auto whole = [](const std::string& path) {
    std::error_code code;
    const fs::path resolved = fs::weakly_canonical(fs::absolute(path, code), code);
    return code ? fs::path(path).lexically_normal() : resolved;
  };
  return whole(a) == whole(b);
}

std::vector<OutputFile> parse_outputs(const RenderFlags& flags) {
  if (flags.outputs.empty() && flags.counts.empty())
    throw usage_error("no output: add -o FILE, for example -o picture.png or -o picture.exr (- is standard output)");
  std::vector<OutputFile> outputs;
  for (const std::string& path : flags.outputs) {
    for (const OutputFile& other : outputs) {
      if (other.path == path) throw usage_error(fmt::format("-o: {} is given twice", path));
      if (other.path != "-" && path != "-" && same_file(other.path, path))
        throw usage_error(fmt::format("-o: {} and {} are one file", other.path, path));
    }
    if (path != "-") {
      outputs.push_back({path, image_format(path)});
      check_writable(path);
      continue;
    }
    if (flags.format.empty()) throw usage_error("-o -: standard output needs --format exr, png, jpeg or tiff");
    if (isatty(STDOUT_FILENO))
      throw usage_error("-o -: standard output is a terminal; redirect it to a file or a pipe");
    outputs.push_back({path, parse_format(flags.format)});
  }
  if (!flags.format.empty() &&
      std::none_of(outputs.begin(), outputs.end(), [](const auto& o) { return o.path == "-"; }))
    throw usage_error("--format is for standard output (-o -); a file's format follows from its name");
  return outputs;
}

PixelWindow parse_crop(const std::string& text) {
  const std::size_t first = text.find('+');
  const std::size_t second = first == std::string::npos ? first : text.find('+', first + 1);
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  if (second != std::string::npos) {
    const auto x = whole_number(text.substr(first + 1, second - first - 1)), y = whole_number(text.substr(second + 1));
    if (x && y && *x >= 0 && *y >= 0 && *x <= kMost && *y <= kMost) {
      const std::string size_text = text.substr(0, first);
      const std::size_t cross = std::min(size_text.find('x'), size_text.size());
      const auto width = whole_number(size_text.substr(0, cross)),
                 height = whole_number(size_text.substr(std::min(cross + 1, size_text.size())));
      if (width && height && *width >= 1 && *height >= 1 && *width <= kMost && *height <= kMost)
        return {static_cast<int>(*x), static_cast<int>(*y), static_cast<int>(*width), static_cast<int>(*height)};
      if (width && height && *width <= kMost && *height <= kMost)
        throw usage_error(fmt::format("--crop: \"{}\": a crop is at least 1x1", text));
    }
  }
  throw usage_error(fmt::format("--crop: \"{}\" is not WxH+X+Y in pixels, for example 320x200+640+0", text));
}

double parse_exposure(const std::string& text) {
  const double stops = parse_real("--exposure", text);
  if (std::abs(stops) > kLargestExposure)
    throw usage_error(
        fmt::format("--exposure: \"{}\" is not from -{} to {} stops", text, kLargestExposure, kLargestExposure));
  return stops;
}

/// Whether --counts asks for the SPD's standard render, which says itself how it is traced.
bool parse_counts(const RenderFlags& flags) {
  if (flags.counts.empty()) return false;
  if (flags.counts != "spd")
    throw usage_error(fmt::format("--counts: unknown table \"{}\"; tables: spd", flags.counts));
  const SceneFlags& scene = flags.scene;
  for (const auto& [flag, text] :
       {std::pair{"--depth", &scene.depth}, std::pair{"--cutoff", &scene.cutoff},
        std::pair{"--antialias", &scene.antialias}, std::pair{"--threshold", &scene.threshold},
        std::pair{"--levels", &scene.levels}, std::pair{"--minimum-level", &scene.minimum_level},
        std::pair{"--crop", &flags.crop}})
    if (!text->empty()) throw usage_error(fmt::format("--counts spd and {} exclude each other", flag));
  return true;
}

ProgressMode parse_progress(const std::string& text) {
  if (text == "auto") return ProgressMode::automatic;
  if (text == "bar") return ProgressMode::bar;
  if (text == "plain") return ProgressMode::plain;
  if (text == "none") return ProgressMode::none;
  throw usage_error(fmt::format("--progress: unknown mode \"{}\"; modes: auto, bar, plain, none", text));
}

}  // namespace

bool RenderCommandOptions::writes_display_referred() const {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const OutputFile& output) { return output.display_referred(); });
}

int parse_threads(const std::string& text) {
  if (text.empty()) return std::clamp(tbb::info::default_concurrency(), 1, kMostThreads);
  return static_cast<int>(parse_integer("--threads", text, 1, kMostThreads));
}

ChannelSet parse_channels(const std::string& text) {
  std::vector<std::string> known;
  for (int i = 0; i < kChannelGroupCount; ++i) known.emplace_back(channel_group_name(static_cast<ChannelGroup>(i)));
  ChannelSet channels;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    begin = end + 1;
    if (name.empty())
      throw usage_error(fmt::format("--channels: \"{}\": a name is missing {}", text,
                                    end == text.size() ? "after the last comma"
                                    : end == 0         ? "before the first comma"
                                                       : "between commas"));
    if (name == "all") {
      for (int i = 0; i < kChannelGroupCount; ++i) channels.add(static_cast<ChannelGroup>(i));
      continue;
    }
    const std::optional<ChannelGroup> group = channel_group_from_name(name);
    if (!group)
      throw usage_error(fmt::format("--channels: unknown group \"{}\"{}; groups: {}, all", name,
                                    did_you_mean(name, known), joined(known)));
    channels.add(*group);
  }
  return channels;
}

void check_writable(const std::string& path) {
  std::error_code code;
  if (fs::is_directory(path, code))
    throw Error(ErrorKind::bad_input, {path, 0, ""}, "is a folder, not a file to write");
  if (fs::exists(path, code) && !fs::is_regular_file(path, code)) {  // a device or pipe is written in place
    if (access(path.c_str(), W_OK) == 0) return;
    throw Error(ErrorKind::failure, {path, 0, ""}, fmt::format("cannot be written to: {}", std::strerror(errno)));
  }
  const fs::path parent = fs::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (!fs::is_directory(folder, code))
    throw Error(ErrorKind::bad_input, {path, 0, ""}, fmt::format("there is no folder {} to write to", folder));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(ErrorKind::failure, {path, 0, ""},
                fmt::format("the folder {} cannot be written to: {}", folder, std::strerror(errno)));
  // Rights are not all: /proc grants them, and takes no files. Begun and dropped, the file leaves nothing behind.
  const AtomicFile probe(path);
}

namespace {

/// Statistics go to a file of their own. Throws Error (bad_input).
void check_statistics(const RenderCommandOptions& options) {
  for (const OutputFile& output : options.outputs)
    if (output.path != "-" && same_file(output.path, options.statistics))
      throw usage_error(fmt::format("--stats: {} is the image to write; give another file", options.statistics));
  if (fs::exists(options.scene.scene) && same_file(options.scene.scene, options.statistics))
    throw usage_error(fmt::format("--stats: {} is the scene; give another file", options.statistics));
  check_writable(options.statistics);
}

}  // namespace

std::optional<RenderCommandOptions> parse_render_options(const Words& words) {
  RenderFlags flags;
  CLI::App command("Render a scene to image files.", "raytree render");
  add_flags(command, flags);
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  sort_words(flags);

  RenderCommandOptions options;
  options.scene = flags.scene;
  check_scene_flags(options.scene);
  options.spd_counts = parse_counts(flags);
  options.outputs = parse_outputs(flags);
  if (!flags.crop.empty()) options.crop = parse_crop(flags.crop);
  options.threads = parse_threads(flags.threads);
  options.half = flags.half;
  options.statistics = flags.statistics;
  options.quiet = flags.quiet;
  options.verbose = flags.verbose;
  if (flags.quiet && flags.verbose) throw usage_error("--quiet and --verbose exclude each other");
  options.progress = flags.quiet ? ProgressMode::none : parse_progress(flags.progress);

  const bool writes_exr = std::any_of(options.outputs.begin(), options.outputs.end(),
                                      [](const OutputFile& output) { return !output.display_referred(); });
  if (!flags.channels.empty()) {
    options.channels = parse_channels(flags.channels);
  } else {
    options.channels.add(ChannelGroup::color);
    // Alpha is of use to who composes the linear file; in a display-referred one it would cut the background out.
    if (writes_exr) options.channels.add(ChannelGroup::alpha);
  }
  if (options.writes_display_referred()) options.channels.add(ChannelGroup::color);

  options.display.ocio_config = flags.ocio;
  options.display.display = flags.display;
  options.display.view = flags.view;
  if (!flags.exposure.empty()) options.display.exposure = parse_exposure(flags.exposure);
  const auto without_effect = [&](bool given, const char* flag, const char* why) {
    if (given) options.warnings.push_back({{}, fmt::format("{} has no effect: {}", flag, why)});
  };
  if (options.scene.intersector == "spheres") {
    const char* const why = "bounding spheres are searched by --sphere-search";
    without_effect(!options.scene.hierarchy.empty(), "--hierarchy", why);
    without_effect(!options.scene.memory.empty(), "--memory", why);
  } else {
    const char* const why = "it is for --intersector spheres";
    without_effect(!options.scene.sphere_size.empty(), "--sphere-size", why);
    without_effect(!options.scene.sphere_search.empty(), "--sphere-search", why);
  }
  if (!options.writes_display_referred()) {
    const char* const why = "EXR is scene-linear, and no display-referred file is written";
    without_effect(!flags.exposure.empty(), "--exposure", why);
    without_effect(!flags.ocio.empty(), "--ocio", why);
    without_effect(!flags.display.empty(), "--display", why);
    without_effect(!flags.view.empty(), "--view", why);
  }
  if (!writes_exr) {
    without_effect(!flags.channels.empty(), "--channels", "no EXR is written");
    without_effect(flags.half, "--half", "no EXR is written");
  }

  if (!options.statistics.empty()) {
    const bool image_on_stdout = std::any_of(options.outputs.begin(), options.outputs.end(),
                                             [](const OutputFile& output) { return output.path == "-"; });
    if (options.statistics != "-")
      check_statistics(options);
    else if (image_on_stdout)
      throw usage_error("--stats - and -o -: standard output takes one of the two");
  }
  if (options.spd_counts)
    for (const auto& [taken, flag] :
         {std::pair{options.statistics == "-", "--stats -"},
          std::pair{std::any_of(options.outputs.begin(), options.outputs.end(),
                                [](const OutputFile& output) { return output.path == "-"; }),
                    "-o -"}})
      if (taken) throw usage_error(fmt::format("--counts and {}: standard output takes one of the two", flag));
  return options;
}

}  // namespace raytree::app
