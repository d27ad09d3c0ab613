#include "app/statistics_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/messages.h"
#include "app/process.h"
#include "renderer/machine.h"
#include "renderer/scene_fields.h"
#include "renderer/scene_reader.h"

namespace raytree::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRayKindNames[kRayKindCount] = {"primary", "shadow", "reflected", "refracted"};

double millions_per_second(const RenderStatistics& trace) {
  return trace.wall_seconds > 0 ? static_cast<double>(trace.total_rays()) / trace.wall_seconds * 1e-6 : 0;
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// Text of the JSON; file names need not be UTF-8.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string statistics_json(const RenderReport& report) {
  const RenderStatistics& trace = report.trace;
  const Machine here = machine();
  Json json;
  json["raytree"] = version();
  json["scene"] = report.scene;
  json["settings"] = {{"width", report.image.width},
                      {"height", report.image.height},
                      {"window", {report.window.x0, report.window.y0, report.window.width, report.window.height}},
                      {"camera", report.camera},
                      {"depth", report.settings.depth},
                      {"cutoff", report.settings.cutoff},
                      {"antialias", antialiasing_text(report.settings.antialias)},
                      {"threads", report.threads}};
  json["machine"] = {{"processor", here.processor},
                     {"hardware_threads", here.hardware_threads},
                     {"compiler", here.compiler},
                     {"build_type", here.build_type}};
  Json rays;
  for (int i = 0; i < kRayKindCount; ++i) rays[kRayKindNames[i]] = trace.rays[static_cast<std::size_t>(i)];
  rays["total"] = trace.total_rays();
  rays["millions_per_second"] = millions_per_second(trace);
  json["rays"] = rays;
  json["samples"] = trace.samples;
  json["seconds"] = {{"load", report.read_seconds + report.prepare.load},
                     {"build", report.prepare.build},
                     {"trace", trace.wall_seconds},
                     {"display", report.display_seconds},
                     {"write", report.write_seconds},
                     {"before_trace", report.before_trace_seconds},
                     {"total", seconds_since_launch()}};
  json["clock"] = {{"first_ray", report.first_ray_clock}};
  json["time_split_percent"] = {{"overhead", percent(trace.overhead_seconds(), trace.thread_seconds)},
                                {"intersection", percent(trace.intersection_seconds, trace.thread_seconds)},
                                {"shading", percent(trace.shading_seconds, trace.thread_seconds)}};
  json["memory_bytes"] = {{"peak", peak_memory_bytes()},
                          {"film", report.film_bytes},
                          {"arrays", report.array_bytes},
                          {"intersector", report.intersector_bytes}};
  json["counts"] = {{"eye_hits", trace.eye_hits},
                    {"branches_cut", trace.branches_cut},
                    {"branches_at_depth_limit", trace.branches_at_depth_limit},
                    {"not_finite_samples", trace.not_finite_samples},
                    {"not_finite_display_values", report.display_not_finite},
                    {"deepest_level", trace.deepest_level}};
  json["files"] = report.files;
  Json warnings = Json::array();
  for (const Warning& warning : report.warnings)
    warnings.push_back({{"message", located_message(warning.where, warning.message)}, {"count", warning.count}});
  json["warnings"] = warnings;
  return text_of(json, 2) + "\n";
}

std::string statistics_text(const RenderReport& report) {
  const RenderStatistics& trace = report.trace;
  std::string text =
      fmt::format("phases     load {}, build {}, trace {}, display {}, write {}; {} from launch to the first ray\n",
                  readable_seconds(report.read_seconds + report.prepare.load), readable_seconds(report.prepare.build),
                  readable_seconds(trace.wall_seconds), readable_seconds(report.display_seconds),
                  readable_seconds(report.write_seconds), readable_seconds(report.before_trace_seconds));
  text += "rays      ";
  for (int i = 0; i < kRayKindCount; ++i)
    text += fmt::format(" {} {},", grouped(trace.rays[static_cast<std::size_t>(i)]), kRayKindNames[i]);
  text += fmt::format(" {} in all; {:.2f} Mrays/s on {} thread{}\n", grouped(trace.total_rays()),
                      millions_per_second(trace), report.threads, report.threads == 1 ? "" : "s");
  text += fmt::format("time split overhead {:.0f} %, intersection {:.0f} %, shading {:.0f} %\n",
                      percent(trace.overhead_seconds(), trace.thread_seconds),
                      percent(trace.intersection_seconds, trace.thread_seconds),
                      percent(trace.shading_seconds, trace.thread_seconds));
  text += fmt::format("tree       deepest level {}; {} branches cut by the cutoff, {} at the depth limit\n",
                      trace.deepest_level, grouped(trace.branches_cut), grouped(trace.branches_at_depth_limit));
  text += fmt::format("memory     peak {} (arrays {}, intersector {}, film {})\n", readable_bytes(peak_memory_bytes()),
                      readable_bytes(report.array_bytes), readable_bytes(report.intersector_bytes),
                      readable_bytes(report.film_bytes));
  text += "tracer     " + report.hierarchy + "\n";
  text += fmt::format("not finite {} of {} samples counted as 0", grouped(trace.not_finite_samples),
                      grouped(trace.samples));
  return text;
}

std::string settings_metadata(const SceneDescription& scene, const std::string& camera) {
  SceneDescription settings;
  settings.image = scene.image;
  settings.render = scene.render;
  settings.background = scene.background;
  settings.ambient = scene.ambient;
  for (const CameraDescription& candidate : scene.cameras)
    if (settings.cameras.empty() && (camera.empty() || candidate.name == camera)) settings.cameras.push_back(candidate);
  return text_of(Json::parse(write_scene(settings)), -1);
}

}  // namespace raytree::app
