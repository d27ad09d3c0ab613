#include "renderer/tracer_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/error.h"
#include "geometry/lattice_grids.h"
#include "geometry/quad_pairs.h"

namespace raytree {
namespace {

/// One core, rays of a frame as they come, at a million triangles; a doubling of triangles adds a twentieth.
constexpr double kSecondsPerRay = 120e-9;

double seconds_per_ray(double primitives) {
  return kSecondsPerRay * std::max(0.25, 1 + 0.05 * std::log2(std::max(1.0, primitives) / 1e6));
}

/// Triangles of a grid that has all its cells.
constexpr double kTrianglesOfGrid = 2.0 * kMostGridCells * kMostGridCells;

/// Tracing's speed as grids lose their cells, down to none. Measured: .78 with all of them, .69 with three quarters, as
/// terrains have that are halved as suits each cell, .5 with one of four.
constexpr double kSpeedOfEmptyGrids = 0.42;

constexpr double kLeastLead = 0.05;

using Primitives = EmbreeOptions::Primitives;

std::uint64_t grids_of(const HierarchyDemand& demand) { return demand.grids > 0 ? demand.grids : demand.primitives; }

/// Primitives that a kind is built over, as triangles that all have partners, or fill grids.
double units_of(const HierarchyCost& cost, const HierarchyDemand& demand) {
  if (cost.primitives == Primitives::grids) return kTrianglesOfGrid * static_cast<double>(grids_of(demand));
  if (cost.primitives == Primitives::quads) return 2 * static_cast<double>(demand.quads);
  return static_cast<double>(demand.primitives);
}

double speed_of(const HierarchyCost& cost, const HierarchyDemand& demand) {
  if (cost.primitives != Primitives::grids || demand.primitives == 0) return cost.speed;
  const double filled = std::min(1.0, static_cast<double>(demand.primitives) / units_of(cost, demand));
  return kSpeedOfEmptyGrids + (cost.speed - kSpeedOfEmptyGrids) * filled;
}

double total_seconds(const HierarchyCost& cost, const HierarchyDemand& demand) {
  return cost.build_seconds * units_of(cost, demand) / 1e6 +
         demand.rays * seconds_per_ray(static_cast<double>(demand.primitives)) / speed_of(cost, demand);
}

/// Calls with each mesh's triangles.
template <class Function>
void for_each_mesh(const ShapeSet& shapes, Function&& function) {
  const auto look = [&](const BoundedShapes& bounded) {
    for (const MeshEntry& entry : bounded.meshes) function(entry.mesh.corners);
  };
  look(shapes);
  for (const BoundedShapes& group : shapes.groups) look(group);
}

}  // namespace

double hierarchy_bytes(const HierarchyCost& cost, const HierarchyDemand& demand) {
  const double bytes = cost.bytes * units_of(cost, demand);
  if (cost.primitives != Primitives::grids) return bytes;
  const std::uint64_t points = demand.grids > 0 ? demand.grid_points : 4 * grids_of(demand);
  return bytes + double(sizeof(Vec3f)) * static_cast<double>(points);
}

const std::vector<HierarchyCost>& hierarchy_costs() {
  using Quality = EmbreeOptions::Quality;
  static const std::vector<HierarchyCost> costs = {
      {"balanced", Primitives::triangles, Quality::medium, false, 65, 0.58, 1.0, true},
      {"quads", Primitives::quads, Quality::medium, false, 54, 0.25, 0.95, true},
      {"grids", Primitives::grids, Quality::medium, false, 10, 0.075, 0.78, true},
      {"quick", Primitives::triangles, Quality::low, false, 95, 0.15, 0.75, false},
      {"compact", Primitives::triangles, Quality::medium, true, 34, 0.42, 0.75, true},
      {"compact-quads", Primitives::quads, Quality::medium, true, 31, 0.23, 0.73, true},
  };
  return costs;
}

HierarchyDemand hierarchy_demand(const ShapeSet& shapes, std::uint64_t primitives, double rays,
                                 std::uint64_t memory_allowed) {
  HierarchyDemand demand{primitives, primitives / 2, rays, memory_allowed};
  demand.grids = static_cast<std::uint64_t>(static_cast<double>(primitives) / kTrianglesOfGrid) + 1;
  const auto best = [&] { return choose_hierarchy(demand).chosen->primitives; };
  const bool may_be_grids = best() == Primitives::grids;
  demand.grids = 0;
  if (may_be_grids) {
    std::uint64_t triangles = 0, of_lattices = 0;
    GridCounts sum;
    for_each_mesh(shapes, [&](std::span<const std::uint32_t> corners) {
      const GridCounts counts = count_grids(corners);
      triangles += corners.size() / 3, of_lattices += counts.lattice_triangles;
      sum.grids += counts.grids, sum.points += counts.points;
    });
    if (of_lattices > 0)
      demand.grids = sum.grids + (primitives - std::min(primitives, triangles)), demand.grid_points = sum.points;
    if (best() == Primitives::grids) {
      demand.quads = primitives - of_lattices / 2;  // all in lattices have partners
      return demand;
    }
  }
  const bool may_be_quads = best() == Primitives::quads;
  demand.quads = primitives;
  if (may_be_quads)
    for_each_mesh(shapes, [&](std::span<const std::uint32_t> corners) {
      demand.quads -= corners.size() / 3 - estimate_joined_quads(corners);
    });
  return demand;
}

HierarchyChoice choose_hierarchy(const HierarchyDemand& demand) {
  const std::vector<HierarchyCost>& costs = hierarchy_costs();
  const HierarchyCost* best = nullptr;
  double most_seconds = 0;  ///< that a later kind must stay below
  for (const HierarchyCost& cost : costs) {
    if (!cost.repeatable) continue;
    if (demand.memory_allowed > 0 && hierarchy_bytes(cost, demand) > static_cast<double>(demand.memory_allowed))
      continue;
    const double seconds = total_seconds(cost, demand);
    if (best != nullptr && seconds >= most_seconds) continue;
    // Those after the first one must save kLeastSaving of its time, and be quicker than each other by more than figures
    // are sure.
    most_seconds = seconds * (1 - (best == nullptr ? kLeastSaving : kLeastLead));
    best = &cost;
  }
  const bool fits = best != nullptr;
  if (!fits)
    best = &*std::min_element(costs.begin(), costs.end(), [&](const auto& a, const auto& b) {
      return hierarchy_bytes(a, demand) < hierarchy_bytes(b, demand);
    });
  HierarchyChoice choice{best, {}};
  choice.reason =
      fmt::format("{} hierarchy for {} primitives and about {:.3g} rays:", best->name, demand.primitives, demand.rays);
  for (const HierarchyCost& cost : costs)
    choice.reason += fmt::format(" {} {:.2f} s of one core, {:.0f} MB{}", cost.name, total_seconds(cost, demand),
                                 hierarchy_bytes(cost, demand) / 1e6, &cost == &costs.back() ? "" : ";");
  if (!fits) choice.reason += " (more than the memory allowed)";
  return choice;
}

HierarchyChoice hierarchy_named(const std::string& name) {
  std::string names;
  for (const HierarchyCost& cost : hierarchy_costs()) {
    if (cost.name == name) return {&cost, std::string(cost.name) + " hierarchy, as asked for"};
    names += (names.empty() ? "" : ", ") + std::string(cost.name);
  }
  throw Error(ErrorKind::bad_input, {}, "no kind of hierarchy \"" + name + "\"; there are: " + names);
}

double expected_rays(const SceneDescription& scene) {
  const double pixels = double(scene.image.width) * double(scene.image.height);
  const Antialiasing& antialias = scene.render.antialias;
  // Whitted's corners are shared by pixels; most pictures divide a few pixels in a hundred.
  constexpr double kAdaptiveSamples = 1.5;
  double samples = 1;
  if (antialias.method == Antialiasing::Method::grid) samples = double(antialias.grid_size) * antialias.grid_size;
  if (antialias.method == Antialiasing::Method::whitted)
    samples = std::max(kAdaptiveSamples, std::pow(4.0, scene.render.adaptive.minimum_level));
  // Surfaces that face away from a light and rays that leave the scene ask for none: .47 to .62 in six scenes.
  constexpr double kShadowShare = 0.6;
  const double per_hit = 1 + (scene.render.shadows ? kShadowShare * static_cast<double>(scene.lights.size()) : 0);
  const auto branches = [](const MaterialDescription& m) {
    return std::max({m.reflection.r, m.reflection.g, m.reflection.b, m.transmission.r, m.transmission.g,
                     m.transmission.b}) > 0;
  };
  const bool tree = scene.render.depth > 1 && std::any_of(scene.materials.begin(), scene.materials.end(), branches);
  return pixels * samples * per_hit * (tree ? 2 : 1);
}

}  // namespace raytree
