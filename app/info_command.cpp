// `raytree info`: what is in a scene, what it will take and which parts of the renderer it switches on. Meshes are
// loaded, nothing is built or traced.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/prepared_scene.h"
#include "app/render_options.h"
#include "app/suggestion.h"
#include "geometry/angle.h"
#include "renderer/scene.h"
#include "renderer/scene_fields.h"

namespace raytree::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  SceneFlags scene;
  int threads = 0;
  ChannelSet channels;
  bool json = false, quiet = false, tessellation = false;
};

std::optional<InfoOptions> parse_info_options(const Words& words) {
  InfoOptions options;
  std::string threads, channels;
  CLI::App command("Say what is in a scene, and what it will take, without rendering.", "raytree info");
  command
      .add_option("SCENE", options.scene.scene,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes)")
      ->type_name("");
  command.add_flag("--json", options.json, "Print JSON");
  command.add_flag("--tessellation", options.tessellation,
                   "Measure how far the triangles of curved shapes lie off their limit surfaces");
  add_scene_flags(command, options.scene, false);
  add_shading_flag(command, options.scene);
  command.add_option("--channels", channels, "Channel groups that the film is reckoned with, or all")
      ->type_name("LIST");
  command.add_option("--threads", threads, "Threads; default: all")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  check_scene_flags(options.scene);
  options.threads = parse_threads(threads);
  options.channels = channels.empty() ? ChannelSet{ChannelGroup::color, ChannelGroup::alpha} : parse_channels(channels);
  return options;
}

/// As Film holds them: four bytes a pixel and plane.
std::uint64_t film_bytes(const ImageDescription& image, const ChannelSet& channels) {
  std::uint64_t planes = 0;
  for (int i = 0; i < kChannelGroupCount; ++i)
    if (const auto group = static_cast<ChannelGroup>(i); channels.has(group)) planes += plane_names(group).size();
  return planes * 4 * static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
}

bool is_bounded(const Bounds3d& box) {
  return !box.isEmpty() && std::isfinite(box.min.length2()) && std::isfinite(box.max.length2()) &&
         box.min.length2() < 1e300 && box.max.length2() < 1e300;
}

Json json_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
Json json_of(const Bounds3d& box) {
  if (!is_bounded(box)) return nullptr;
  return {{"min", json_of(box.min)}, {"max", json_of(box.max)}};
}

const char* kind_of(const LightDescription& light) {
  return std::visit([]<class Kind>(const Kind&) { return Alternative<Kind>::name.data(); }, light.kind);
}

std::string camera_name(const Scene& scene, const SceneFlags& flags) {
  if (!flags.camera.empty() || scene.description.cameras.empty()) return flags.camera;
  return scene.description.cameras.front().name;
}

struct Totals {
  std::uint64_t faces[3] = {0, 0, 0}, triangles = 0, spheres = 0;  ///< each once, however often it is used
  std::uint64_t instanced_triangles = 0, instanced_spheres = 0;    ///< as often as they are used
};

Totals totals(const SceneSummary& summary) {
  Totals sum;
  const auto add = [&](const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes) {
      for (int i = 0; i < 3; ++i) sum.faces[i] += shape.faces_by_size[i];
      sum.triangles += shape.triangles;
      sum.spheres += shape.spheres;
      sum.instanced_triangles += shape.instanced_triangles;
      sum.instanced_spheres += shape.instanced_spheres;
    }
  };
  add(summary.shapes);
  for (const GroupSummary& group : summary.groups) add(group.shapes);
  return sum;
}

constexpr double kDegrees = 180 / kPi;

/// Facets that are held to the same, and to what.
struct NormalRow {
  const char* key;
  std::string name;
  const NormalError& error;
  std::optional<double> bound;  ///< pixels of shading
  const char* reason;           ///< why they may be off by more than the tolerance
};

std::vector<NormalRow> normal_rows(const TessellationSummary& made) {
  const TessellationError& error = *made.measured;
  const auto times = [&](double share) {
    return made.tolerance ? std::optional<double>(*made.tolerance * share) : std::nullopt;
  };
  return {
      {"regular", "regular", error.regular, times(1), ""},
      {"irregular", "irregular", error.irregular, times(kLooseShading),
       "at extraordinary vertices, semi-sharp creases and tips, and between patches that are no polynomials, normals "
       "converge slowly"},
      {"small", fmt::format("below {} pixels", kShortestShadedEdge), error.small, times(kLooseShading),
       "their normals are blends of the surface's own less than that far away"}};
}

/// In units of the tolerance.
constexpr double kNotableSeam = 0.1;

/// Of the facets of a NormalError or a ProvedDistance.
template <class Facets>
double share_over(const Facets& error) {
  return error.facets > 0 ? double(error.over) / double(error.facets) : 0;
}

Json json_of(const TessellationSummary& made) {
  Json json = {
      {"faces", made.faces}, {"triangles", made.triangles}, {"bytes", made.bytes}, {"coarse_faces", made.coarse_faces}};
  if (made.unseen) json["unseen"] = true;
  if (!made.measured) return json;
  Json& measured = json["measured"];
  measured = {{"samples", made.measured->samples},
              {"largest_pixels", made.measured->largest.pixels},
              {"largest_shading_pixels", made.measured->largest.shading},
              {"largest_distance", made.measured->largest.distance},
              {"largest_normal_angle_degrees", made.measured->largest.angle * kDegrees},
              {"seam_pixels", made.measured->seam}};
  const ProvedDistance& proved = made.measured->proved;
  measured["proved"] = {
      {"triangles", proved.facets}, {"largest_pixels", proved.pixels}, {"share_over_tolerance", share_over(proved)}};
  for (const NormalRow& row : normal_rows(made)) {
    Json& normals = measured["normals"][row.key];
    normals = {{"triangles", row.error.facets},
               {"largest_angle_degrees", row.error.angle * kDegrees},
               {"largest_shading_pixels", row.error.shading},
               {"bound_shading_pixels", row.bound ? Json(*row.bound) : Json(nullptr)},
               {"share_over_tolerance", share_over(row.error)}};
    if (*row.reason != 0) normals["reason"] = row.reason;
  }
  return json;
}

Json json_of(const ShapeSummary& shape) {
  return {
      {"id", shape.id},
      {"name", shape.name},
      {"kind", shape.kind},
      {"material", shape.material},
      {"shading", shape.shading},
      {"faces",
       {{"triangles", shape.faces_by_size[0]}, {"quads", shape.faces_by_size[1]}, {"larger", shape.faces_by_size[2]}}},
      {"traced_triangles", shape.triangles},
      {"spheres", shape.spheres},
      {"instances", shape.instances},
      {"first_extra_id", shape.first_extra_id},
      {"instanced_triangles", shape.instanced_triangles},
      {"instanced_spheres", shape.instanced_spheres},
      {"tessellation", shape.tessellation ? json_of(*shape.tessellation) : Json(nullptr)},
      {"bounds", json_of(shape.bounds)}};
}

std::string info_json(const Scene& scene, const InfoOptions& options) {
  const SceneDescription& description = scene.description;
  const SceneSummary& summary = scene.summary;
  const std::uint64_t film = film_bytes(description.image, options.channels);
  Json json;
  json["scene"] = description.name;
  json["title"] = description.title;
  json["image"] = {{"width", description.image.width}, {"height", description.image.height}};
  json["camera"] = camera_name(scene, options.scene);
  json["cameras"] = Json::array();
  for (const CameraDescription& camera : description.cameras) json["cameras"].push_back(camera.name);
  json["bounds"] = json_of(summary.bounds);
  json["objects"] = Json::array();
  for (const ShapeSummary& shape : summary.shapes) json["objects"].push_back(json_of(shape));
  json["groups"] = Json::array();
  for (const GroupSummary& group : summary.groups) {
    Json shapes = Json::array();
    for (const ShapeSummary& shape : group.shapes) shapes.push_back(json_of(shape));
    json["groups"].push_back({{"name", group.name}, {"instances", group.instances}, {"shapes", std::move(shapes)}});
  }
  const Totals sum = totals(summary);
  json["totals"] = {{"objects", summary.shapes.size()},
                    {"faces", {{"triangles", sum.faces[0]}, {"quads", sum.faces[1]}, {"larger", sum.faces[2]}}},
                    {"traced_triangles", sum.triangles},
                    {"spheres", sum.spheres},
                    {"instances", summary.instances},
                    {"instanced_triangles", sum.instanced_triangles},
                    {"instanced_spheres", sum.instanced_spheres}};
  json["materials_in_use"] = summary.materials_in_use;
  json["lights"] = Json::array();
  for (const LightDescription& light : description.lights)
    json["lights"].push_back(
        {{"name", light.name}, {"kind", kind_of(light)}, {"color", {light.color.r, light.color.g, light.color.b}}});
  json["features"] = summary.features;
  json["memory_bytes"] = {{"arrays", summary.array_bytes},
                          {"intersector", summary.intersector_bytes},
                          {"film", film},
                          {"total", summary.array_bytes + summary.intersector_bytes + film}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string text_of(const Bounds3d& box) {
  if (!is_bounded(box)) return "unbounded";
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.min.x, box.min.y, box.min.z, box.max.x,
                     box.max.y, box.max.z);
}

std::string text_of(const std::vector<std::string>& words) { return words.empty() ? "none" : joined(words); }

/// Columns as wide as their widest cell; the last one is left as it is.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i + 1 < row.size() ? fmt::format(" {:<{}} ", row[i], widths[i]) : " " + row[i];
    text += line + "\n";
  }
  return text;
}

/// Rows for each curved shape, the scene's and those of groups: of distance, then of normals by what they are held to.
std::string tessellation_text(const SceneSummary& summary) {
  std::vector<std::vector<std::string>> rows = {{"name", "faces", "triangles", "memory", "coarse", "samples",
                                                 "pixels off", "units off", "seams", "proved", "at most", "over"}};
  std::vector<std::vector<std::string>> normals = {
      {"name", "class", "triangles", "normal off", "shading off", "held to", "over the tolerance"}};
  std::vector<std::string> notes, unseen;
  const auto add = [&](const std::string& group, const std::vector<ShapeSummary>& shapes) {
    for (const ShapeSummary& shape : shapes) {
      if (shape.tessellation && shape.tessellation->unseen)
        unseen.push_back(fmt::format("{}{}: not made, no ray of the picture can meet it", group, shape.name));
      if (!shape.tessellation || !shape.tessellation->measured) continue;
      const TessellationSummary& made = *shape.tessellation;
      const FacetDeviation& largest = made.measured->largest;
      rows.push_back({group + shape.name, grouped(made.faces), grouped(made.triangles), readable_bytes(made.bytes),
                      grouped(made.coarse_faces), grouped(made.measured->samples),
                      fmt::format("{:.4f}", largest.pixels), fmt::format("{:.3g}", largest.distance),
                      fmt::format("{:.4f}", made.measured->seam), grouped(made.measured->proved.facets),
                      fmt::format("{:.4f}", made.measured->proved.pixels),
                      fmt::format("{:.2f} %", 100 * share_over(made.measured->proved))});
      if (made.tolerance && made.measured->seam > kNotableSeam * *made.tolerance)
        notes.push_back(group + shape.name +
                        ": its faces disagree about where they meet by as many pixels as \"seams\" says; no facets lie "
                        "nearer to them than that");
      for (const NormalRow& row : normal_rows(made)) {
        if (row.error.facets == 0) continue;
        normals.push_back({group + shape.name, row.name, grouped(row.error.facets),
                           fmt::format("{:.4f} degrees", row.error.angle * kDegrees),
                           fmt::format("{:.4f}", row.error.shading),
                           row.bound ? fmt::format("{:.4f}", *row.bound) : std::string("-"),
                           fmt::format("{:.2f} %", 100 * share_over(row.error))});
        const std::string note = row.name + ": " + row.reason;
        if (*row.reason != 0 && std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      }
    }
  };
  add("", summary.shapes);
  for (const GroupSummary& group : summary.groups) add(group.name + "/", group.shapes);
  if (rows.size() == 1 && unseen.empty()) return "tessellation  no curved shapes\n";
  std::string text = "tessellation\n";
  if (rows.size() > 1)
    text +=
        table(rows) + "normals    angles, and pixels of the picture that shading is off by for them\n" + table(normals);
  for (const std::string& note : unseen) text += "  " + note + "\n";
  for (const std::string& note : notes) text += "  " + note + "\n";
  return text;
}

std::string info_text(const Scene& scene, const InfoOptions& options) {
  constexpr std::size_t kObjectsShown = 40;
  const SceneDescription& description = scene.description;
  const SceneSummary& summary = scene.summary;
  std::string text = fmt::format("scene      {}\n", description.name);
  if (!description.title.empty()) text += fmt::format("title      {}\n", description.title);
  text += fmt::format("image      {} x {} pixels\n", description.image.width, description.image.height);
  std::vector<std::string> cameras;
  for (const CameraDescription& camera : description.cameras) cameras.push_back(camera.name);
  text += fmt::format("camera     {}{}\n", camera_name(scene, options.scene),
                      cameras.size() > 1 ? " (of " + joined(cameras) + ")" : "");
  const Totals sum = totals(summary);
  text += fmt::format("objects    {}\n", grouped(summary.shapes.size()));
  std::vector<std::vector<std::string>> rows = {
      {"id", "name", "kind", "material", "triangles", "quads", "larger", "traced", "spheres", "bounds"}};
  for (std::size_t i = 0; i < std::min(kObjectsShown, summary.shapes.size()); ++i) {
    const ShapeSummary& shape = summary.shapes[i];
    rows.push_back({std::to_string(shape.id), shape.name, shape.kind, shape.material, grouped(shape.faces_by_size[0]),
                    grouped(shape.faces_by_size[1]), grouped(shape.faces_by_size[2]), grouped(shape.triangles),
                    grouped(shape.spheres), text_of(shape.bounds)});
  }
  if (rows.size() > 1) text += table(rows);
  if (summary.shapes.size() > kObjectsShown)
    text += fmt::format("  ... and {} more (--json lists all)\n", grouped(summary.shapes.size() - kObjectsShown));
  text += fmt::format("faces      {} triangles, {} quads, {} larger; traced as {} triangles and {} spheres\n",
                      grouped(sum.faces[0]), grouped(sum.faces[1]), grouped(sum.faces[2]), grouped(sum.triangles),
                      grouped(sum.spheres));
  if (options.tessellation) text += tessellation_text(summary);
  if (!summary.groups.empty()) {
    text += fmt::format("groups     {}\n", summary.groups.size());
    rows = {{"name", "instances", "shapes", "traced", "spheres"}};
    for (std::size_t i = 0; i < std::min(kObjectsShown, summary.groups.size()); ++i) {
      const GroupSummary& group = summary.groups[i];
      std::uint64_t triangles = 0, spheres = 0;
      for (const ShapeSummary& shape : group.shapes) triangles += shape.triangles, spheres += shape.spheres;
      rows.push_back(
          {group.name, grouped(group.instances), grouped(group.shapes.size()), grouped(triangles), grouped(spheres)});
    }
    text += table(rows);
    text += fmt::format("instances  {}, which stand for {} triangles and {} spheres\n", grouped(summary.instances),
                        grouped(sum.instanced_triangles), grouped(sum.instanced_spheres));
  }
  text += fmt::format("bounds     {}\n", text_of(summary.bounds));
  text += fmt::format("materials  {}\n", text_of(summary.materials_in_use));
  std::vector<std::string> lights;
  for (const LightDescription& light : description.lights)
    lights.push_back(fmt::format("{} ({})", light.name.empty() ? "unnamed" : light.name, kind_of(light)));
  text += fmt::format("lights     {}\n", text_of(lights));
  text += fmt::format("features   {}\n", text_of(summary.features));
  const std::uint64_t film = film_bytes(description.image, options.channels);
  text +=
      fmt::format("memory     {} (arrays {}, intersector {} estimated, film {})\n",
                  readable_bytes(summary.array_bytes + summary.intersector_bytes + film),
                  readable_bytes(summary.array_bytes), readable_bytes(summary.intersector_bytes), readable_bytes(film));
  return text;
}

}  // namespace

int info_command(const Words& words) {
  const std::optional<InfoOptions> options = parse_info_options(words);
  if (!options) return kSuccess;
  return with_prepared_scene({options->scene, options->threads, false, options->quiet, options->tessellation},
                             [&](const Scene& scene, const Interruption&) {
                               print_result(options->json ? info_json(scene, *options) : info_text(scene, *options));
                             });
}

}  // namespace raytree::app
