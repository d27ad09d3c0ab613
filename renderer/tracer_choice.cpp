#include "renderer/tracer_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/error.h"
#include "geometry/quad_pairs.h"

namespace raytree {
namespace {

/// One core, rays of a frame as they come, at a million triangles; a doubling of triangles adds a twentieth.
constexpr double kSecondsPerRay = 120e-9;

double seconds_per_ray(double primitives) {
  return kSecondsPerRay * std::max(0.25, 1 + 0.05 * std::log2(std::max(1.0, primitives) / 1e6));
}

/// Primitives that a kind is built over, as triangles that all have partners.
double units_of(const HierarchyCost& cost, const HierarchyDemand& demand) {
  if (cost.primitives == EmbreeOptions::Primitives::triangles) return static_cast<double>(demand.primitives);
  return 2 * static_cast<double>(demand.quads);
}

double bytes_of(const HierarchyCost& cost, const HierarchyDemand& demand) {
  return cost.bytes * units_of(cost, demand);
}

double total_seconds(const HierarchyCost& cost, const HierarchyDemand& demand) {
  return cost.build_seconds * units_of(cost, demand) / 1e6 +
         demand.rays * seconds_per_ray(static_cast<double>(demand.primitives)) / cost.speed;
}

}  // namespace

const std::vector<HierarchyCost>& hierarchy_costs() {
  using Quality = EmbreeOptions::Quality;
  using Primitives = EmbreeOptions::Primitives;
  static const std::vector<HierarchyCost> costs = {
      {"balanced", Primitives::triangles, Quality::medium, false, 65, 0.58, 1.0, true},
      {"quads", Primitives::quads, Quality::medium, false, 54, 0.25, 0.95, true},
      {"quick", Primitives::triangles, Quality::low, false, 95, 0.15, 0.75, false},
      {"compact", Primitives::triangles, Quality::medium, true, 34, 0.42, 0.75, true},
      {"compact-quads", Primitives::quads, Quality::medium, true, 31, 0.23, 0.73, true},
  };
  return costs;
}

HierarchyDemand hierarchy_demand(const ShapeSet& shapes, std::uint64_t primitives, double rays,
                                 std::uint64_t memory_allowed) {
  HierarchyDemand demand{primitives, primitives / 2, rays, memory_allowed};
  const bool worth_counting = choose_hierarchy(demand).chosen->primitives == EmbreeOptions::Primitives::quads;
  demand.quads = primitives;
  if (!worth_counting) return demand;
  const auto join = [&](const BoundedShapes& bounded) {
    for (const MeshEntry& entry : bounded.meshes)
      demand.quads -= entry.mesh.triangle_count() - estimate_joined_quads(entry.mesh.corners);
  };
  join(shapes);
  for (const BoundedShapes& group : shapes.groups) join(group);
  return demand;
}

HierarchyChoice choose_hierarchy(const HierarchyDemand& demand) {
  const std::vector<HierarchyCost>& costs = hierarchy_costs();
  const HierarchyCost* best = nullptr;
  for (const HierarchyCost& cost : costs) {
    if (!cost.repeatable) continue;
    if (demand.memory_allowed > 0 && bytes_of(cost, demand) > static_cast<double>(demand.memory_allowed)) continue;
    if (best == nullptr || total_seconds(cost, demand) < total_seconds(*best, demand) * (1 - kLeastSaving))
      best = &cost;
  }
  const bool fits = best != nullptr;
  if (!fits)
    best = &*std::min_element(costs.begin(), costs.end(),
                              [&](const auto& a, const auto& b) { return bytes_of(a, demand) < bytes_of(b, demand); });
  HierarchyChoice choice{best, {}};
  choice.reason =
      fmt::format("{} hierarchy for {} primitives and about {:.3g} rays:", best->name, demand.primitives, demand.rays);
  for (const HierarchyCost& cost : costs)
    choice.reason += fmt::format(" {} {:.2f} s of one core, {:.0f} MB{}", cost.name, total_seconds(cost, demand),
                                 bytes_of(cost, demand) / 1e6, &cost == &costs.back() ? "" : ";");
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
  const double per_hit = 1 + (scene.render.shadows ? static_cast<double>(scene.lights.size()) : 0);
  const auto branches = [](const MaterialDescription& m) {
    return std::max({m.reflection.r, m.reflection.g, m.reflection.b, m.transmission.r, m.transmission.g,
                     m.transmission.b}) > 0;
  };
  const bool tree = scene.render.depth > 1 && std::any_of(scene.materials.begin(), scene.materials.end(), branches);
  return pixels * samples * per_hit * (tree ? 2 : 1);
}

}  // namespace raytree
