// `raytree convert`: a file of a mesh or of patches in, one of a mesh out; subdivided, moved to the limit surface, or
// tessellated on the way.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/process.h"
#include "app/render_options.h"
#include "app/suggestion.h"
#include "geometry/mesh_file.h"
#include "geometry/obj_writer.h"
#include "geometry/patch_reader.h"
#include "geometry/patch_surface.h"
#include "geometry/ply_writer.h"
#include "geometry/subdivision_refinement.h"
#include "geometry/subdivision_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_rates.h"
#include "renderer/atomic_file.h"
#include "renderer/builtin_scenes.h"
#include "renderer/scene_fields.h"

namespace raytree::app {
namespace {

struct ConvertOptions {
  std::string input, output;
  std::optional<int> levels, rate;
  std::optional<double> tolerance;
  std::optional<SubdivisionScheme> scheme;
  bool limit = false, quiet = false;
  int threads = 0;

  bool tessellates() const { return rate || tolerance; }
  bool refines() const { return levels || limit; }
};

bool ends_in(const std::string& name, const std::string& ending) {
  return name.size() >= ending.size() && std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [](char e, char c) {
           return c == e || (c >= 'A' && c <= 'Z' && c - 'A' + 'a' == e);
         });
}

SubdivisionScheme parse_scheme(const std::string& text) {
  std::vector<std::string> names;
  for (const auto& entry : EnumTable<SubdivisionScheme>::entries) {
    if (entry.name == text) return entry.value;
    names.emplace_back(entry.name);
  }
  throw usage_error(fmt::format("--scheme: \"{}\" is none of: {}{}", text, joined(names), did_you_mean(text, names)));
}

std::optional<ConvertOptions> parse_convert_options(const Words& words) {
  ConvertOptions options;
  std::string levels, rate, tolerance, scheme, threads;
  CLI::App command("Write a mesh to another file: as it is, subdivided, on its limit surface, or tessellated.",
                   "raytree convert");
  command.add_option("IN", options.input, "Mesh (.obj, .ply) or Bezier patches (.bpt)")->type_name("");
  command.add_option("OUT", options.output, "File to write: .obj, or .ply (binary)")->type_name("");
  command
      .add_option("--subdivide", levels, "Refine the cage uniformly so often, 0 to 15, and write its control points")
      ->type_name("N");
  command.add_flag("--limit", options.limit, "Move the control points to the limit surface, with its normals");
  command.add_option("--rate", rate, "Write the limit surface as triangles: so many segments along each edge")
      ->type_name("N");
  command
      .add_option("--tolerance", tolerance,
                  "Write the limit surface as triangles: at most so far off, in units of the file")
      ->type_name("X");
  command.add_option("--scheme", scheme, "catmark, loop or bilinear; default: catmark")->type_name("NAME");
  command.add_option("--threads", threads, "Threads; default: all")->type_name("N");
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  if (!parse_usage(command, words)) return std::nullopt;
  if (options.input.empty() || options.output.empty())
    throw usage_error("give a mesh to read and a file to write: raytree convert IN OUT");
  if (!ends_in(options.output, ".obj") && !ends_in(options.output, ".ply"))
    throw usage_error(fmt::format("{}: meshes are written as .obj or .ply", options.output));
  if (!is_mesh_file_name(options.input) && !is_patch_file_name(options.input))
    throw usage_error(fmt::format("{}: {}; .obj, .ply and .bpt are read", options.input,
                                  is_builtin_scene(options.input)
                                      ? "is a built-in scene, not a file of a mesh or of patches"
                                      : "not the name of a file of a mesh or of patches"));
  if (!levels.empty()) options.levels = static_cast<int>(parse_integer("--subdivide", levels, 0, kMaxRefinementLevels));
  if (!rate.empty()) options.rate = static_cast<int>(parse_integer("--rate", rate, 1, kLargestRate));
  if (!tolerance.empty()) {
    options.tolerance = parse_real("--tolerance", tolerance);
    if (!(*options.tolerance > 0)) throw usage_error(fmt::format("--tolerance: {} is not larger than 0", tolerance));
  }
  if (options.rate && options.tolerance) throw usage_error("--tolerance and --rate exclude each other");
  if (options.tessellates() && options.refines())
    throw usage_error(
        fmt::format("{} makes triangles of the limit surface: it goes with neither --subdivide nor --limit",
                    options.rate ? "--rate" : "--tolerance"));
  if (is_patch_file_name(options.input)) {
    if (options.refines() || !scheme.empty())
      throw usage_error("--subdivide, --limit and --scheme are for cages; patches take --rate or --tolerance");
    if (!options.tessellates())
      throw usage_error(fmt::format("{}: patches are written as triangles: give --rate or --tolerance", options.input));
  }
  if (!scheme.empty()) options.scheme = parse_scheme(scheme);
  if (options.scheme && !options.refines() && !options.tessellates())
    throw usage_error("--scheme: says how to subdivide; give --subdivide, --limit, --rate or --tolerance too");
  options.threads = parse_threads(threads);
  return options;
}

PolygonMesh polygons(TriangleMesh&& triangles) {
  PolygonMesh mesh;
  mesh.origin = triangles.origin;
  mesh.positions = std::move(triangles.positions);
  mesh.corners = std::move(triangles.corners);
  mesh.normals = std::move(triangles.normals);
  mesh.normal_corners = std::move(triangles.normal_corners);
  mesh.texture_coordinates = std::move(triangles.texture_coordinates);
  mesh.texture_corners = std::move(triangles.texture_corners);
  return mesh;
}

PolygonMesh tessellated(const ParametricSurface& surface, const ConvertOptions& options, const SourceLocation& where,
                        Warnings& warnings) {
  if (options.rate) return polygons(tessellate_uniformly(surface, *options.rate));
  const ViewRates found = rates_for_distance(surface, *options.tolerance);
  if (found.coarse_faces > 0)
    warnings.push_back({where,
                        fmt::format("faces that stay coarser than the tolerance of {}, at {} segments a side",
                                    *options.tolerance, kLargestViewRate),
                        static_cast<std::int64_t>(found.coarse_faces)});
  return polygons(tessellate(surface, found.rates));
}

PolygonMesh converted(const ConvertOptions& options, Warnings& warnings) {
  const SourceLocation where{options.input, 0, {}};
  if (is_patch_file_name(options.input)) {
    std::vector<SurfacePatch> patches;
    for (const BezierPatch& patch : read_patch_file(options.input, warnings)) patches.emplace_back(patch);
    return tessellated(PatchSurface(std::move(patches), {}, where, warnings), options, where, warnings);
  }
  PolygonMesh mesh = read_mesh_file(options.input, warnings);
  if (!options.refines() && !options.tessellates()) return mesh;
  SubdivisionRules given;
  given.scheme = options.scheme;
  const SubdivisionRules rules = joined(mesh.subdivision.value_or(SubdivisionRules{}), given);
  if (options.tessellates())
    return tessellated(*make_subdivision_surface(mesh, rules, where, warnings), options, where, warnings);
  return refine_uniformly(mesh, rules, options.levels.value_or(0),
                          options.limit ? RefinedPoints::limit : RefinedPoints::control, where, warnings);
}

/// The file's bytes.
std::string written(const PolygonMesh& mesh, const ConvertOptions& options, Warnings& warnings) {
  if (ends_in(options.output, ".obj")) return obj_text(mesh);
  if (mesh.subdivision)
    warnings.push_back({{options.output, 0, {}}, "subdivision tags left out: PLY has no place for them"});
  return ply_bytes(mesh);
}

}  // namespace

int convert_command(const Words& words) {
  const std::optional<ConvertOptions> options = parse_convert_options(words);
  if (!options) return kSuccess;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(options->threads));
  tbb::task_arena arena(options->threads);
  arena.execute([&] {
    Warnings warnings;
    const PolygonMesh mesh = converted(*options, warnings);
    const std::string bytes = written(mesh, *options, warnings);
    write_file_atomically(options->output, bytes.data(), bytes.size());
    if (!options->quiet) print_warnings(warnings, true);
  });
  return kSuccess;
}

}  // namespace raytree::app
