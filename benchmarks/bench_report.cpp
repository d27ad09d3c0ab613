#include "benchmarks/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "benchmarks/report_page.h"
#include "geometry/error.h"
#include "geometry/mapped_file.h"
#include "renderer/machine.h"

namespace raytree::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

std::string with_commas(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

Json spread_json(const Spread& spread) {
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}, {"count", spread.count}};
}

double bytes_each(const BenchReport& report, std::uint64_t bytes) {
  return report.primitives() > 0 ? static_cast<double>(bytes) / static_cast<double>(report.primitives()) : 0;
}

Json row_json(const BenchRow& row) {
  Json json = {{"name", row.name()},
               {"kind", row.rays_name},
               {"configuration", row.configuration},
               {"threads", row.threads},
               {"rays", row.rays},
               {"hits", row.hits},
               {"checksum", fmt::format("{:016x}", row.checksum)},
               {"repeatable", row.repeatable},
               {"differ", row.differ},
               {"checked", row.checked},
               {"wrong", row.wrong},
               {"suspicious", row.suspicious()},
               {"millions_per_second", spread_json(row.speed)},
               {"over_baseline", spread_json(row.ratio)}};
  if (!row.wrong_example.empty()) json["wrong_example"] = row.wrong_example;
  if (!row.beside.empty()) json["beside"] = row.beside, json["over_beside"] = spread_json(row.beside_ratio);
  json["samples"] = row.samples;
  return json;
}

Json scene_json(const BenchReport& report) {
  Json json = {{"scene", report.scene},
               {"image", {{"width", report.width}, {"height", report.height}}},
               {"triangles", report.triangles},
               {"others", report.others},
               {"instances", report.instances}};
  json["builds"] = Json::array();
  for (const BenchBuild& build : report.builds)
    json["builds"].push_back({{"name", build.scene},
                              {"seconds", spread_json(build.seconds)},
                              {"bytes", build.bytes},
                              {"peak_bytes", build.peak_bytes},
                              {"bytes_per_primitive", bytes_each(report, build.bytes)},
                              {"peak_bytes_per_primitive", bytes_each(report, build.peak_bytes)},
                              {"triangles_per_primitive", build.triangles_per_primitive}});
  json["rows"] = Json::array();
  for (const BenchRow& row : report.rows) json["rows"].push_back(row_json(row));
  json["left_out"] = Json::array();
  for (const BenchLeftOut& out : report.left_out)
    json["left_out"].push_back({{"name", out.name}, {"reason", out.reason}});
  return json;
}

std::string range_text(const Spread& spread) { return fmt::format("{:.3g}-{:.3g}", spread.low, spread.high); }

/// Columns that the longest name of a scene or configuration takes.
std::size_t name_width(const BenchReport& report) {
  std::size_t width = 0;
  for (const BenchBuild& build : report.builds) width = std::max(width, build.scene.size());
  for (const BenchRow& row : report.rows) width = std::max(width, row.configuration.size());
  return width;
}

std::string builds_text(const BenchReport& report) {
  const std::size_t width = name_width(report);
  std::string text = fmt::format("{:<{}} {:>9} {:>9} {:>9}\n", "built", width + 2, "seconds", "B each", "B at peak");
  for (const BenchBuild& build : report.builds) {
    text += fmt::format("  {:<{}} {:>9.4f} {:>9.1f} {:>9.1f}", build.scene, width, build.seconds.median,
                        bytes_each(report, build.bytes), bytes_each(report, build.peak_bytes));
    if (build.triangles_per_primitive > 1)
      text += fmt::format("  {:.2f} triangles in one", build.triangles_per_primitive);
    text += "\n";
  }
  return text;
}

/// What the check in double says of a row's answers.
std::string verdict_text(const BenchRow& row) {
  if (row.wrong > 0)
    return fmt::format("  OTHER ANSWERS ({} of {} checked are wrong, the first {})", with_commas(row.wrong),
                       with_commas(row.checked), row.wrong_example);
  return row.differ > 0 && row.checked == 0 ? "  not checked: no time" : "";
}

std::string rows_text(const BenchReport& report) {
  const std::size_t width = name_width(report);
  std::string text, kind;
  for (const BenchRow& row : report.rows) {
    if (row.rays_name != kind) {
      kind = row.rays_name;
      text += fmt::format("{:<{}} {:>8} {:>13} {:>7} {:>13} {:>6} {:>9} {:>9} {:>7}  {}\n", kind, width + 2, "Mrays/s",
                          "quartiles", "ratio", "quartiles", "beside", "rays", "hits", "differ", "checksum");
    }
    const std::string beside = row.beside.empty() ? "" : fmt::format("{:.2f}", row.beside_ratio.median);
    text += fmt::format("  {:<{}} {:>8.3g} {:>13} {:>7.3g} {:>13} {:>6} {:>9} {:>9} {:>7}  {:016x}{}{}\n",
                        row.configuration, width, row.speed.median, range_text(row.speed), row.ratio.median,
                        range_text(row.ratio), beside, with_commas(row.rays), with_commas(row.hits),
                        with_commas(row.differ), row.checksum, verdict_text(row),
                        row.repeatable ? "" : "  NOT THE SAME EACH TIME");
  }
  return text;
}

std::string changes_text(const BenchRunReport& report) {
  std::string text;
  for (const std::string& warning : report.before_warnings) text += "note: " + warning + "\n";
  std::size_t width = 0;
  for (const BenchChange& change : report.changes) width = std::max(width, change.row.size());
  text += fmt::format("{:<{}} {:>9} {:>9} {:>7} {:>8}  {}\n", "against " + report.before, width + 2, "Mrays/s", "now",
                      "ratio", "chance", "verdict");
  for (const BenchChange& change : report.changes)
    text += fmt::format("  {:<{}} {:>9.3g} {:>9.3g} {:>7.3f} {:>8.2g}  {}{}\n", change.row, width, change.before,
                        change.after, change.speed.ratio, change.speed.chance, name_of(change.speed.change),
                        change.same_answers ? "" : ", OTHER ANSWERS");
  return text;
}

Json parsed_report(const std::string& path) {
  const MappedFile file(path);
  const Json json = Json::parse(file.bytes(), nullptr, false);
  const auto refuse = [&](const char* why) { throw Error(ErrorKind::bad_input, {path, 0, ""}, why); };
  if (json.is_discarded()) refuse("this is not JSON; a report of raytree bench --json is expected");
  if (!json.is_object() || !json.contains("scenes") || !json["scenes"].is_array() || !json.contains("machine"))
    refuse("this is not a report of raytree bench --json");
  return json;
}

}  // namespace

std::string bench_text(const BenchRunReport& report) {
  std::string text = machine_line();
  if (!report.isa.empty()) text += ", held to " + report.isa;
  text += "\n";
  for (const BenchReport& scene : report.scenes) {
    text += fmt::format("\nscene {}, {} x {}: {} triangles, {} other shapes, {} instances; {} thread{}\n", scene.scene,
                        scene.width, scene.height, with_commas(scene.triangles), with_commas(scene.others),
                        with_commas(scene.instances), report.threads, report.threads == 1 ? "" : "s");
    text += builds_text(scene);
    text += fmt::format("ratio: speed over {}; beside: over the same call in the scene of the first\n", scene.baseline);
    text += rows_text(scene);
    for (const BenchLeftOut& out : scene.left_out) text += fmt::format("left out: {}: {}\n", out.name, out.reason);
  }
  for (const std::string& out : report.scenes_left_out) text += fmt::format("left out: {}\n", out);
  if (!report.before.empty()) text += "\n" + changes_text(report);
  return text;
}

std::string bench_json(const BenchRunReport& report) {
  const Machine here = machine();
  Json json;
  json["raytree"] = report.program;
  json["machine"] = {{"processor", here.processor},
                     {"hardware_threads", here.hardware_threads},
                     {"instruction_set", here.instruction_set},
                     {"compiler", here.compiler},
                     {"build_type", here.build_type},
                     {"tracer", here.tracer}};
  if (!report.isa.empty()) json["machine"]["tracer_held_to"] = report.isa;
  json["threads"] = report.threads;
  json["repetitions"] = report.repetitions;
  json["seconds"] = report.seconds;
  json["baseline"] = report.scenes.empty() ? kBenchBaseline : report.scenes.front().baseline;
  json["scenes"] = Json::array();
  bool suspicious = false;
  for (const BenchReport& scene : report.scenes) {
    json["scenes"].push_back(scene_json(scene));
    suspicious |= scene.suspicious();
  }
  json["suspicious"] = suspicious;
  json["left_out"] = report.scenes_left_out;
  if (!report.before.empty()) {
    json["before"] = {{"file", report.before}, {"notes", report.before_warnings}};
    json["changes"] = Json::array();
    for (const BenchChange& change : report.changes)
      json["changes"].push_back({{"scene", change.scene},
                                 {"row", change.row},
                                 {"before", change.before},
                                 {"after", change.after},
                                 {"ratio", change.speed.ratio},
                                 {"chance", change.speed.chance},
                                 {"verdict", name_of(change.speed.change)},
                                 {"same_answers", change.same_answers}});
  }
  // JSON has no NaN: null stands for it.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void compare_with(BenchRunReport& report, const std::string& path) {
  const Json before = parsed_report(path);
  report.before = path;
  try {
    std::map<std::pair<std::string, std::string>, const Json*> rows;
    for (const Json& scene : before.at("scenes"))
      for (const Json& row : scene.at("rows")) rows[{scene.at("scene"), row.at("name")}] = &row;
    const Machine here = machine();
    const auto note = [&](const char* what, const std::string& then, const std::string& now) {
      if (then != now) report.before_warnings.push_back(fmt::format("{} was {}, is {}", what, then, now));
    };
    note("processor", before.at("machine").at("processor"), here.processor);
    note("compiler", before.at("machine").at("compiler"), here.compiler);
    note("build type", before.at("machine").at("build_type"), here.build_type);
    note("tracer", before.at("machine").at("tracer"), here.tracer);
    note("the tracer's instruction set", before.at("machine").value("tracer_held_to", "the best"),
         report.isa.empty() ? "the best" : report.isa);
    note("number of threads", std::to_string(before.at("threads").get<int>()), std::to_string(report.threads));
    for (const BenchReport& scene : report.scenes)
      for (const BenchRow& row : scene.rows) {
        const auto found = rows.find({scene.scene, row.name()});
        if (found == rows.end()) continue;
        const Json& old = *found->second;
        const auto samples = old.at("samples").get<std::vector<double>>();
        BenchChange change;
        change.scene = scene.scene, change.row = row.name();
        change.speed = compare_speeds(samples, row.samples);
        change.before = spread_of(samples).median, change.after = row.speed.median;
        const bool same_rays = old.at("rays").get<std::size_t>() == row.rays;
        change.same_answers = !same_rays || (old.at("hits").get<std::uint64_t>() == row.hits &&
                                             old.at("checksum") == fmt::format("{:016x}", row.checksum));
        if (!same_rays)
          note(("number of rays of " + row.name()).c_str(), std::to_string(old.at("rays").get<std::size_t>()),
               std::to_string(row.rays));
        report.changes.push_back(std::move(change));
      }
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::bad_input, {path, 0, ""},
                fmt::format("this is not a report of raytree bench --json: {}", error.what()));
  }
  if (report.changes.empty())
    throw Error(ErrorKind::bad_input, {path, 0, ""}, "the report has no row of a scene that was measured now");
}

}  // namespace raytree::benchmarks
