#include "benchmarks/chart/chart_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "benchmarks/chart/chart_page.h"
#include "benchmarks/chart/chart_svg.h"
#include "renderer/atomic_file.h"
#include "renderer/film_image.h"
#include "renderer/image_file.h"

namespace raytree::benchmarks {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kChartVersion = 3;  ///< of chart.json
constexpr const char* kParts[] = {"defaults", "ends", "between", "added", "crossed"};

std::string in_folder(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }
std::string picture_path(const std::string& folder, const std::string& key) {
  return (fs::path(folder) / "pictures" / (key + ".png")).string();
}
constexpr const char* kReferenceKey = "reference";

std::vector<std::byte> bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

/// JSON has no NaN: null stands for it.
Json errors_json(const ErrorMetrics& errors) {
  Json json = Json::object();
  for (const MetricInfo& metric : kMetrics) json[metric.key] = errors.*metric.value;
  return json;
}

ErrorMetrics errors_from_json(const Json& json) {
  ErrorMetrics errors;
  for (const MetricInfo& metric : kMetrics) {
    const Json& value = json.at(metric.key);
    errors.*metric.value = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  return errors;
}

Json point_json(const ChartPoint& point) {
  const Spread cpu = point.cpu(), wall = point.wall();
  Json json;
  json["knob"] = point.setting.knob;
  json["value"] = point.setting.value;
  json["part"] = kParts[static_cast<std::size_t>(point.setting.part)];
  json["flags"] = point.setting.flags;
  json["command"] = point.command;
  json["key"] = point.key;
  json["cpu_seconds"] = {{"median", cpu.median}, {"low", cpu.low}, {"high", cpu.high}, {"samples", point.cpu_seconds}};
  json["wall_seconds"] = {
      {"median", wall.median}, {"low", wall.low}, {"high", wall.high}, {"samples", point.wall_seconds}};
  json["build_seconds"] = point.build_seconds;
  json["rays"] = {{"primary", point.rays[0]},
                  {"shadow", point.rays[1]},
                  {"reflected", point.rays[2]},
                  {"refracted", point.rays[3]}};
  json["memory_bytes"] = {{"peak", point.peak_bytes.empty() ? Json() : Json(spread_of(point.peak_bytes).median)},
                          {"peak_samples", point.peak_bytes},
                          {"film", point.film_bytes},
                          {"arrays", point.array_bytes},
                          {"intersector", point.tracer_bytes}};
  json["errors"] = errors_json(point.errors);
  json["picture_hash"] = point.picture_hash;
  json["repeats"] = point.repeats;
  return json;
}

ChartPoint point_from_json(const Json& json) {
  ChartPoint point;
  point.setting.knob = json.at("knob");
  point.setting.value = json.at("value");
  const auto part = std::find(std::begin(kParts), std::end(kParts), json.at("part").get<std::string>());
  point.setting.part =
      part == std::end(kParts) ? SweepPart::between : static_cast<SweepPart>(part - std::begin(kParts));
  point.setting.flags = json.at("flags").get<Words>();
  point.command = json.at("command");
  point.key = json.at("key");
  point.cpu_seconds = json.at("cpu_seconds").at("samples").get<std::vector<double>>();
  point.wall_seconds = json.at("wall_seconds").at("samples").get<std::vector<double>>();
  point.build_seconds = json.at("build_seconds");
  const Json& rays = json.at("rays");
  point.rays = {rays.at("primary"), rays.at("shadow"), rays.at("reflected"), rays.at("refracted")};
  const Json& memory = json.at("memory_bytes");
  point.peak_bytes = memory.at("peak_samples").get<std::vector<double>>();
  point.film_bytes = memory.at("film");
  point.array_bytes = memory.at("arrays");
  point.tracer_bytes = memory.at("intersector");
  point.errors = errors_from_json(json.at("errors"));
  point.picture_hash = json.at("picture_hash");
  point.repeats = json.at("repeats");
  return point;
}

ChartData data_from_json(const Json& json) {
  ChartData data;
  data.scene = json.at("scene");
  data.title = json.at("title");
  data.scene_hash = json.at("scene_hash");
  data.version = json.at("raytree");
  data.machine = json.at("machine");
  data.width = json.at("width");
  data.height = json.at("height");
  data.threads = json.at("threads");
  const Json& reference = json.at("reference");
  data.plan = {reference.at("grid"),
               reference.at("first").get<Words>(),
               reference.at("last").get<Words>(),
               reference.at("refined_pixels").get<std::vector<std::uint64_t>>(),
               reference.at("depth_residual"),
               reference.at("cutoff"),
               reference.at("words")};
  data.reference_seconds = reference.at("seconds");
  data.floor = errors_from_json(reference.at("own_error"));
  for (const Json& point : json.at("points")) data.points.push_back(point_from_json(point));
  return data;
}

/// The film that write_reference() wrote; none where the file is not such a one.
std::optional<Film> read_reference(const std::string& path, int width, int height) {
  std::error_code code;
  if (!fs::exists(path, code)) return std::nullopt;
  const DecodedImage image = read_image_file(path);
  if (image.width != width || image.height != height) return std::nullopt;
  Film film(width, height, {0, 0, width, height}, kChartChannels);
  for (const ChannelGroup group : {ChannelGroup::color, ChannelGroup::alpha, ChannelGroup::depth, ChannelGroup::normal})
    for (std::size_t c = 0; c < plane_names(group).size(); ++c) {
      const int plane = image.plane_index(plane_names(group)[c]);
      if (plane < 0) return std::nullopt;
      const std::vector<float>& values = image.planes[static_cast<std::size_t>(plane)];
      std::copy(values.begin(), values.end(), film.plane(group, static_cast<int>(c)));
    }
  return film;
}

void write_chart_text(const std::string& path, const std::string& text) {
  write_file_atomically(path, text.data(), text.size());
}

/// A picture whose name tells what it shows is written once.
void write_chart_picture(const std::string& path, const std::vector<std::byte>& bytes) {
  std::error_code code;
  if (fs::file_size(path, code) == bytes.size() && !code && bytes_of_file(path) == bytes) return;
  write_file_atomically(path, bytes.data(), bytes.size());
}

std::string quoted_csv(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) c == '"' ? quoted += "\"\"" : quoted += c;
  return quoted + "\"";
}

}  // namespace

std::string chart_json(const ChartData& data) {
  Json json;
  json["raytree_chart"] = kChartVersion;
  json["raytree"] = data.version;
  json["scene"] = data.scene;
  json["title"] = data.title;
  json["scene_hash"] = data.scene_hash;
  json["machine"] = data.machine;
  json["width"] = data.width;
  json["height"] = data.height;
  json["threads"] = data.threads;
  json["budget_seconds"] = data.budget_seconds;
  json["complete"] = data.complete;
  json["reference"] = {{"command", data.reference_command},
                       {"words", data.plan.words},
                       {"depth_residual", data.plan.depth_residual},
                       {"cutoff", data.plan.cutoff},
                       {"grid", data.plan.grid},
                       {"first", data.plan.first},
                       {"last", data.plan.last},
                       {"refined_pixels", data.plan.refined},
                       {"seconds", data.reference_seconds},
                       {"own_error", errors_json(data.floor)}};
  json["findings"] = Json::array();
  for (const Finding& finding : findings_of(data)) json["findings"].push_back(finding.text);
  json["left_out"] = data.left_out;
  for (const MetricInfo& metric : kMetrics)
    if (metric.charted) json["fronts"][metric.key] = chart_front(data, metric);
  json["points"] = Json::array();
  for (const ChartPoint& point : data.points) json["points"].push_back(point_json(point));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string chart_csv(const ChartData& data) {
  const std::vector<std::size_t> front = chart_front(data, kMetrics.front());
  std::string csv =
      "point,knob,value,front,cpu_seconds,cpu_low,cpu_high,wall_seconds,wall_low,wall_high,repetitions,"
      "build_seconds,rays_primary,rays_shadow,rays_reflected,rays_refracted,peak_memory_bytes,counted_memory_bytes";
  for (const MetricInfo& metric : kMetrics) csv += fmt::format(",{}", metric.key);
  csv += ",command\n";
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const ChartPoint& point = data.points[i];
    const Spread cpu = point.cpu(), wall = point.wall();
    const std::string peak = point.peak_bytes.empty() ? "" : fmt::format("{:.0f}", point.memory_bytes());
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", i, quoted_csv(point.setting.knob),
                       quoted_csv(point.setting.value), std::count(front.begin(), front.end(), i), cpu.median, cpu.low,
                       cpu.high, wall.median, wall.low, wall.high, cpu.count, point.build_seconds, point.rays[0],
                       point.rays[1], point.rays[2], point.rays[3], peak, point.counted_bytes());
    for (const MetricInfo& metric : kMetrics) {
      const double value = point.errors.*metric.value;
      csv += std::isfinite(value) ? fmt::format(",{}", value) : ",";
    }
    csv += "," + quoted_csv(point.command) + "\n";
  }
  return csv;
}

std::optional<EarlierChart> read_earlier_chart(const std::string& folder) {
  const std::string path = in_folder(folder, "chart.json");
  std::error_code code;
  if (!fs::exists(path, code)) return std::nullopt;
  EarlierChart earlier;
  Json version;
  try {
    std::ifstream file(path, std::ios::binary);
    const Json json = Json::parse(file);
    version = json.at("raytree_chart");
    if (version == kChartVersion) earlier.data = data_from_json(json);
  } catch (const std::exception&) {
    throw Error(ErrorKind::bad_input, {path, 0, ""},
                "is no chart of this program; remove it, or choose another folder");
  }
  if (version != kChartVersion)
    throw Error(ErrorKind::bad_input, {path, 0, ""},
                fmt::format("is a chart as another version of this program writes them ({}, this one {}); --fresh "
                            "measures anew",
                            version.dump(), kChartVersion));
  for (ChartPoint& point : earlier.data.points) point.picture = bytes_of_file(picture_path(folder, point.key));
  std::erase_if(earlier.data.points, [](const ChartPoint& point) { return point.picture.empty(); });
  earlier.reference = read_reference(in_folder(folder, "reference.exr"), earlier.data.width, earlier.data.height);
  return earlier;
}

void write_chart(const std::string& folder, const ChartData& data) {
  fs::create_directories(fs::path(folder) / "pictures");
  for (const ChartPoint& point : data.points) write_chart_picture(picture_path(folder, point.key), point.picture);
  write_chart_picture(picture_path(folder, kReferenceKey), data.reference_picture);
  write_chart_text(in_folder(folder, "chart.json"), chart_json(data));
  write_chart_text(in_folder(folder, "points.csv"), chart_csv(data));
  write_chart_text(in_folder(folder, "chart.svg"), chart_svg(data, kMetrics.front()));
  write_chart_text(in_folder(folder, "chart.html"), chart_page(data));
}

void write_reference(const std::string& folder, const Film& reference) {
  fs::create_directories(folder);
  write_image_file(in_folder(folder, "reference.exr"), scene_linear_image(reference, false, {}), ImageFormat::exr);
}

}  // namespace raytree::benchmarks
