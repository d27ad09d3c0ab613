#include "app/scene_argument.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "app/suggestion.h"
#include "geometry/facet_pattern.h"
#include "geometry/mesh_file.h"
#include "geometry/patch_reader.h"
#include "renderer/builtin_scenes.h"
#include "renderer/mesh_scene.h"
#include "renderer/nff_reader.h"
#include "renderer/scene_fields.h"
#include "renderer/scene_reader.h"

namespace raytree::app {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::vector<std::string> builtin_names() {
  std::vector<std::string> names;
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  return names;
}

[[noreturn]] void throw_unknown_scene(const std::string& name) {
  const std::vector<std::string> builtin = builtin_names();
  const std::string extension = lower_extension(name);
  if (extension != ".json" && extension != ".nff" && extension != ".obj" && extension != ".ply" &&
      extension != ".bpt" && name.find('/') == std::string::npos)
    throw usage_error(fmt::format("scene \"{}\" is neither a file nor a built-in scene{}; built-in scenes: {}", name,
                                  did_you_mean(name, builtin), joined(builtin)));
  // A file was meant: the nearest name in its folder may be the right one.
  const fs::path path(name);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code code;
  if (!fs::is_directory(folder, code))
    throw Error(ErrorKind::bad_input, {name, 0, ""},
                fmt::format("no such file; there is no folder {}", folder.string()));
  std::vector<std::string> neighbours;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
    neighbours.push_back(entry->path().filename().string());
  std::sort(neighbours.begin(), neighbours.end());  // folders list in any order, messages do not
  throw Error(ErrorKind::bad_input, {name, 0, ""},
              fmt::format("no such file{}", did_you_mean(path.filename().string(), neighbours)));
}

struct Assignment {
  std::string path, value;
};

Assignment parse_assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw usage_error(fmt::format(
        "--set: \"{}\" is not PATH=VALUE, for example render.depth=12 or materials.glass.index_of_refraction=1.33",
        text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// A flag's number as a scene writes it: flags take .5 and +1, which JSON does not.
std::string json_number(const char* flag, const std::string& text) { return fmt::format("{}", parse_real(flag, text)); }

void set_image_size(SceneDescription& scene, const std::string& size) {
  const ImageSize wanted = parse_size("--size", size);
  set_scene_value(scene, "image.width", std::to_string(wanted.width), "--size");
  set_scene_value(scene, "image.height", std::to_string(wanted.height), "--size");
}

/// The image that a bare mesh's camera is fitted to: the default one with the flags' changes.
ImageDescription wanted_image(const SceneFlags& flags) {
  SceneDescription scene;
  for (const std::string& text : flags.sets) {
    const Assignment assignment = parse_assignment(text);
    if (assignment.path.rfind("image.", 0) == 0) set_scene_value(scene, assignment.path, assignment.value, "--set");
  }
  if (!flags.size.empty()) set_image_size(scene, flags.size);
  return scene.image;
}

Antialiasing parse_antialiasing(const std::string& text) {
  constexpr int kLargestGrid = 64;  // 4096 samples a pixel
  if (text == "none") return {Antialiasing::Method::none, 1};
  if (text == "whitted") return {Antialiasing::Method::whitted, 1};
  if (text.rfind("grid:", 0) == 0)
    return {Antialiasing::Method::grid,
            static_cast<int>(parse_integer("--antialias grid", text.substr(5), 1, kLargestGrid))};
  throw usage_error(
      fmt::format("--antialias: \"{}\" is none of: whitted (adaptive), grid:N (N x N samples a pixel), none", text));
}

/// The value of that name.
template <class E>
E parse_name(const char* flag, const std::string& text) {
  std::vector<std::string> names;
  for (const auto& entry : EnumTable<E>::entries) {
    if (entry.name == text) return entry.value;
    names.emplace_back(entry.name);
  }
  throw usage_error(fmt::format("{}: \"{}\" is none of: {}{}", flag, text, joined(names), did_you_mean(text, names)));
}

void apply_facet_flags(FacetSettings& facets, const SceneFlags& flags) {
  if (flags.classic) facets = {facets.shading, ShadowTerminator::classic, FacetReflections::classic};
  if (!flags.shading.empty()) facets.shading = parse_name<ShadingMethod>("--shading", flags.shading);
  if (!flags.terminator.empty())
    facets.shadow_terminator = parse_name<ShadowTerminator>("--terminator", flags.terminator);
  if (!flags.reflections.empty()) facets.reflections = parse_name<FacetReflections>("--reflections", flags.reflections);
}

SceneDescription read_scene_argument(const SceneFlags& flags, Warnings& warnings) {
  const std::string& name = flags.scene;
  std::error_code code;
  const fs::file_status status = fs::status(name, code);
  // A folder is no scene, so that the folder of a chart of "teapot" may have its name.
  if (is_builtin_scene(name) && (!fs::exists(status) || fs::is_directory(status))) return builtin_scene(name);
  if (!fs::exists(status)) throw_unknown_scene(name);
  if (fs::is_directory(status)) throw Error(ErrorKind::bad_input, {name, 0, ""}, "is a folder, not a scene");
  if (is_mesh_file_name(name) || is_patch_file_name(name)) return mesh_scene(name, warnings, wanted_image(flags));
  const std::string extension = lower_extension(name);
  if (extension == ".gz") throw Error(ErrorKind::bad_input, {name, 0, ""}, "is compressed; unpack it first (gunzip)");
  if (extension == ".nff") return read_nff_file(name, warnings);
  if (!extension.empty() && extension != ".json")
    throw Error(ErrorKind::bad_input, {name, 0, ""},
                "is no scene by its name: a scene file ends in .json or .nff, a mesh in .obj or .ply, patches in .bpt");
  return read_scene_file(name);
}

}  // namespace

ImageSize parse_size(const std::string& flag, const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto most = static_cast<std::int64_t>(std::numeric_limits<int>::max());
  const auto width = whole_number(text.substr(0, cross)),
             height = whole_number(cross == std::string::npos ? std::string() : text.substr(cross + 1));
  if (cross == std::string::npos || !width || !height || *width < 1 || *height < 1 || *width > most || *height > most)
    throw usage_error(fmt::format("{}: \"{}\" is not WxH in pixels, for example 1920x1080", flag, text));
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

void add_scene_flags(CLI::App& command, SceneFlags& flags, bool tracing) {
  command.add_option("--size", flags.size, "Image size in pixels")->type_name("WxH")->group("Scene");
  command.add_option("--camera", flags.camera, "Camera by its name; default: the scene's first")
      ->type_name("NAME")
      ->group("Scene");
  command.add_option("--set", flags.sets, "Set any value of the scene, e.g. render.depth=12; repeatable")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->group("Scene");
  command
      .add_option("--tolerance", flags.tolerance,
                  "Pixels that triangles may lie off the curved surface that they stand for; default: 0.25")
      ->type_name("PIXELS")
      ->group("Scene");
  command.add_option("--rate", flags.rate, "Cut every edge of a curved surface in N, whatever the view needs")
      ->type_name("N")
      ->group("Scene");
  if (!tracing) return;
  command
      .add_option("--terminator", flags.terminator,
                  "Shadow rays of smooth facets: classic, or offset against false shadows where light grazes")
      ->type_name("METHOD")
      ->group("Tracing");
  command
      .add_option("--reflections", flags.reflections,
                  "Rays mirrored to below their facet: classic (followed), clamped, or consistent (none arises)")
      ->type_name("METHOD")
      ->group("Tracing");
  command.add_flag("--classic", flags.classic, "No remedies: --terminator classic --reflections classic")
      ->group("Tracing");
  command.add_option("--depth", flags.depth, "Levels of the ray tree; the eye ray is level 1")
      ->type_name("N")
      ->group("Tracing");
  command
      .add_option("--cutoff", flags.cutoff,
                  "Largest radiance that cutting branches may take from a sample; 0: cut none")
      ->type_name("X")
      ->group("Tracing");
  command.add_option("--antialias", flags.antialias, "whitted: adaptive; grid:N: N x N samples a pixel; none")
      ->type_name("METHOD")
      ->group("Tracing");
  command
      .add_option("--threshold", flags.threshold,
                  "whitted: difference of a square's corners over its edge that divides it, display scale 0 to 1")
      ->type_name("X")
      ->group("Tracing");
  command.add_option("--levels", flags.levels, "whitted: how often a pixel is divided at most")
      ->type_name("N")
      ->group("Tracing");
  command.add_option("--minimum-level", flags.minimum_level, "whitted: how often every pixel is divided")
      ->type_name("N")
      ->group("Tracing");
  command
      .add_option("--rough-samples", flags.rough_samples,
                  "Facets that stand for a rough surface where a way down the tree first meets one")
      ->type_name("N")
      ->group("Tracing");
}

void add_shading_flag(CLI::App& command, SceneFlags& flags) {
  command.add_option("--shading", flags.shading, "Shade all facets so: flat, gouraud, phong or limit")
      ->type_name("METHOD")
      ->group("Scene");
}

void check_scene_flags(const SceneFlags& flags) {
  if (flags.scene.empty())
    throw usage_error(
        "no scene: give a scene file (.json, .nff), a mesh (.obj, .ply), patches (.bpt) or a built-in scene: " +
        joined(builtin_names()));
  if (!flags.size.empty()) parse_size("--size", flags.size);
  for (const std::string& text : flags.sets) parse_assignment(text);
  PrepareOptions tracer;
  apply_tracer_flags(flags, tracer);
  if (!flags.tolerance.empty() && !(parse_real("--tolerance", flags.tolerance) > 0))
    throw usage_error(fmt::format("--tolerance: {} is not larger than 0", flags.tolerance));
  if (!flags.rate.empty()) parse_integer("--rate", flags.rate, 1, kLargestRate);
  if (!flags.tolerance.empty() && !flags.rate.empty()) throw usage_error("--tolerance and --rate exclude each other");
  if (!flags.shading.empty()) parse_name<ShadingMethod>("--shading", flags.shading);
  if (!flags.terminator.empty()) parse_name<ShadowTerminator>("--terminator", flags.terminator);
  if (!flags.reflections.empty()) parse_name<FacetReflections>("--reflections", flags.reflections);
  if (flags.classic && !(flags.terminator.empty() && flags.reflections.empty()))
    throw usage_error("--classic and --terminator or --reflections exclude each other");
  if (!flags.depth.empty()) parse_integer("--depth", flags.depth, 1, kMaxDepth);
  if (!flags.cutoff.empty() && parse_real("--cutoff", flags.cutoff) < 0)
    throw usage_error(fmt::format("--cutoff: {} is negative; 0 cuts nothing", flags.cutoff));
  if (!flags.antialias.empty()) parse_antialiasing(flags.antialias);
  if (!flags.threshold.empty() && parse_real("--threshold", flags.threshold) < 0)
    throw usage_error(fmt::format("--threshold: {} is negative; 0 divides wherever corners differ", flags.threshold));
  const auto level = [](const char* flag, const std::string& text) {
    return static_cast<int>(parse_integer(flag, text, 0, kMaxSamplingLevels));
  };
  if (!flags.levels.empty()) level("--levels", flags.levels);
  if (!flags.minimum_level.empty()) level("--minimum-level", flags.minimum_level);
  if (!flags.rough_samples.empty()) parse_integer("--rough-samples", flags.rough_samples, 1, kMaxRoughSamples);
}

namespace {

/// Flags of adaptive anti-aliasing, where another method samples the picture.
void warn_of_idle_sampling_flags(const SceneFlags& flags, const SceneDescription& scene, Warnings& warnings) {
  if (scene.render.antialias.method == Antialiasing::Method::whitted) return;
  for (const auto& [flag, value] : {std::pair{"--threshold", &flags.threshold},
                                    {"--levels", &flags.levels},
                                    {"--minimum-level", &flags.minimum_level}})
    if (!value->empty()) warnings.push_back({{}, fmt::format("{} has no effect: it is for --antialias whitted", flag)});
}

}  // namespace

SceneDescription load_scene(const SceneFlags& flags, Warnings& warnings) {
  SceneDescription scene = read_scene_argument(flags, warnings);
  for (const std::string& text : flags.sets) {
    const Assignment assignment = parse_assignment(text);
    set_scene_value(scene, assignment.path, assignment.value, "--set");
  }
  if (!flags.size.empty()) set_image_size(scene, flags.size);
  if (!flags.tolerance.empty()) {
    set_scene_value(scene, "render.tessellation.tolerance", json_number("--tolerance", flags.tolerance), "--tolerance");
    scene.render.tessellation.rate = 0;
  }
  if (!flags.rate.empty()) set_scene_value(scene, "render.tessellation.rate", flags.rate, "--rate");
  apply_facet_flags(scene.render.facets, flags);
  if (!flags.depth.empty()) set_scene_value(scene, "render.depth", flags.depth, "--depth");
  if (!flags.cutoff.empty()) scene.render.cutoff = parse_real("--cutoff", flags.cutoff);
  if (!flags.antialias.empty()) scene.render.antialias = parse_antialiasing(flags.antialias);
  if (!flags.threshold.empty())
    set_scene_value(scene, "render.adaptive.threshold", json_number("--threshold", flags.threshold), "--threshold");
  if (!flags.levels.empty()) set_scene_value(scene, "render.adaptive.levels", flags.levels, "--levels");
  if (!flags.rough_samples.empty())
    set_scene_value(scene, "render.rough_samples", flags.rough_samples, "--rough-samples");
  if (!flags.minimum_level.empty())
    set_scene_value(scene, "render.adaptive.minimum_level", flags.minimum_level, "--minimum-level");
  if (const AdaptiveSampling& adaptive = scene.render.adaptive; adaptive.minimum_level > adaptive.levels)
    throw usage_error(
        fmt::format("--minimum-level: {} is more than the {} levels that a pixel is divided at most; "
                    "give --levels too",
                    adaptive.minimum_level, adaptive.levels));
  warn_of_idle_sampling_flags(flags, scene, warnings);
  if (!flags.camera.empty()) {
    std::vector<std::string> names;
    for (const CameraDescription& camera : scene.cameras) names.push_back(camera.name);
    if (std::find(names.begin(), names.end(), flags.camera) == names.end())
      throw usage_error(fmt::format("--camera: no camera \"{}\" in {}{}; cameras: {}", flags.camera, flags.scene,
                                    did_you_mean(flags.camera, names), joined(names)));
  }
  return scene;
}

}  // namespace raytree::app
