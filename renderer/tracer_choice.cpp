#include "renderer/tracer_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/error.h"

namespace raytree {
namespace {

/// One core, rays of a frame as they come, at a million triangles; a doubling of triangles adds a twentieth.
constexpr double kSecondsPerRay = 120e-9;

double seconds_per_ray(double primitives) {
  return kSecondsPerRay * std::max(0.25, 1 + 0.05 * std::log2(std::max(1.0, primitives) / 1e6));
}

double total_seconds(const HierarchyCost& cost, const HierarchyDemand& demand) {
  const auto primitives = static_cast<double>(demand.primitives);
  return cost.build_seconds * primitives / 1e6 + demand.rays * seconds_per_ray(primitives) / cost.speed;
}

}  // namespace

const std::vector<HierarchyCost>& hierarchy_costs() {
  using Quality = EmbreeOptions::Quality;
  static const std::vector<HierarchyCost> costs = {
      {"balanced", Quality::medium, false, 62, 0.45, 1.0, true},
      {"quick", Quality::low, false, 95, 0.12, 0.75, false},
      {"compact", Quality::medium, true, 34, 0.45, 0.6, true},
  };
  return costs;
}

HierarchyChoice choose_hierarchy(const HierarchyDemand& demand) {
  const std::vector<HierarchyCost>& costs = hierarchy_costs();
  const auto bytes = [&](const HierarchyCost& cost) { return cost.bytes * static_cast<double>(demand.primitives); };
  const HierarchyCost* best = nullptr;
  for (const HierarchyCost& cost : costs) {
    if (!cost.repeatable) continue;
    if (demand.memory_allowed > 0 && bytes(cost) > static_cast<double>(demand.memory_allowed)) continue;
    if (best == nullptr || total_seconds(cost, demand) < total_seconds(*best, demand) * (1 - kLeastSaving))
      best = &cost;
  }
  const bool fits = best != nullptr;
  if (!fits)
    best =
        &*std::min_element(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.bytes < b.bytes; });
  HierarchyChoice choice{best, {}};
  choice.reason =
      fmt::format("{} hierarchy for {} primitives and about {:.3g} rays:", best->name, demand.primitives, demand.rays);
  for (const HierarchyCost& cost : costs)
    choice.reason += fmt::format(" {} {:.2f} s of one core, {:.0f} MB{}", cost.name, total_seconds(cost, demand),
                                 bytes(cost) / 1e6, &cost == &costs.back() ? "" : ";");
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
