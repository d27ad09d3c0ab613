// The flags that say what traces the rays, and what it builds.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cmath>
#include <string_view>

#include "app/scene_argument.h"
#include "app/suggestion.h"
#include "renderer/tracer_choice.h"

namespace raytree::app {
namespace {

struct NamedTracer {
  std::string_view name;
  Tracer tracer;
};
constexpr NamedTracer kTracers[] = {{"embree", Tracer::embree}, {"spheres", Tracer::spheres}};

using Search = SphereBoundedOptions::Search;
struct NamedSearch {
  std::string_view name;
  Search search;
};
constexpr NamedSearch kSearches[] = {
    {"auto", Search::automatic}, {"linear", Search::linear}, {"hierarchy", Search::hierarchy}};

struct NamedEdges {
  std::string_view name;
  bool watertight;
};
constexpr NamedEdges kEdges[] = {{"watertight", true}, {"fast", false}};

/// The entry of that name.
template <class Entry, std::size_t Count>
const Entry& entry_named(const char* flag, const std::string& text, const Entry (&entries)[Count]) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) {
    if (entry.name == text) return entry;
    names.emplace_back(entry.name);
  }
  throw usage_error(fmt::format("{}: \"{}\" is none of: {}{}", flag, text, joined(names), did_you_mean(text, names)));
}

}  // namespace

void add_hierarchy_flags(CLI::App& command, SceneFlags& flags) {
  command
      .add_option("--hierarchy", flags.hierarchy,
                  "What the tracer builds: balanced, quads, grids, compact, compact-quads or quick; default: by the "
                  "rays expected")
      ->type_name("KIND")
      ->group("Tracing");
  command.add_option("--memory", flags.memory, "Memory allowed for shapes and hierarchy, e.g. 800M or 4G")
      ->type_name("SIZE")
      ->group("Tracing");
}

std::uint64_t parse_memory(const std::string& text) {
  if (text.empty()) return 0;
  constexpr std::string_view kUnits = "KMGT";
  const std::size_t unit = kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(text.back()))));
  const std::optional<double> number =
      real_number(unit == std::string_view::npos ? text : text.substr(0, text.size() - 1));
  const double bytes = number.value_or(0) * std::pow(1024.0, unit == std::string_view::npos ? 0.0 : double(unit) + 1);
  if (!(bytes >= 1) || !(bytes < 0x1p62))
    throw usage_error(fmt::format("--memory: \"{}\" is not a size, for example 800M or 4G", text));
  return static_cast<std::uint64_t>(bytes);
}

void add_intersector_flags(CLI::App& command, SceneFlags& flags) {
  command
      .add_option("--intersector", flags.intersector,
                  "What traces: embree, or spheres: Whitted's bounding spheres of 1980, in double, slow and exact")
      ->type_name("NAME")
      ->group("Tracing");
  command
      .add_option("--edges", flags.edges,
                  "embree: watertight, the default, or fast: rays may slip between triangles that share an edge")
      ->type_name("HOW")
      ->group("Tracing");
  command
      .add_option("--sphere-size", flags.sphere_size,
                  "spheres: curved surfaces are divided down to spheres of that radius in pixels; default: 0.25")
      ->type_name("PIXELS")
      ->group("Tracing");
  command
      .add_option("--sphere-search", flags.sphere_search,
                  "spheres: linear, hierarchy or auto: a hierarchy from 65 objects on; pixels do not depend on it")
      ->type_name("HOW")
      ->group("Tracing");
}

void apply_tracer_flags(const SceneFlags& flags, PrepareOptions& options) {
  if (!flags.hierarchy.empty()) hierarchy_named(flags.hierarchy);
  options.hierarchy = flags.hierarchy;
  options.memory_allowed = parse_memory(flags.memory);
  if (!flags.intersector.empty()) options.tracer = entry_named("--intersector", flags.intersector, kTracers).tracer;
  if (!flags.edges.empty()) options.watertight = entry_named("--edges", flags.edges, kEdges).watertight;
  if (!flags.sphere_size.empty()) {
    options.spheres.sphere_pixels = parse_real("--sphere-size", flags.sphere_size);
    if (!(options.spheres.sphere_pixels >= kLeastSpherePixels))
      throw usage_error(fmt::format("--sphere-size: {} is less than {} pixels", flags.sphere_size, kLeastSpherePixels));
  }
  if (!flags.sphere_search.empty())
    options.spheres.search = entry_named("--sphere-search", flags.sphere_search, kSearches).search;
}

}  // namespace raytree::app
