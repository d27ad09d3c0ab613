#include "benchmarks/stability/stability_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "benchmarks/stability/map_cells.h"
#include "geometry/angle.h"
#include "renderer/float_mode.h"

namespace raytree::benchmarks {
namespace {

using MapJson = nlohmann::ordered_json;

/// Rays in each cell at full effort, and at the least: one in 4e3 shows, at the least one in 3e2.
constexpr std::size_t kCellRays = 4000, kLeastCellRays = 300;

enum MapPart : std::uint8_t { kMisses, kFalseHits, kSelfHits };

/// The most that a promise allows of a part of a cell; kNothingPromised.
using MapPromise = std::function<double(MapPart part, std::size_t row, std::size_t column)>;

void fill_map(
    StabilityMap& map, const StabilityRun& run,
    const std::function<CellCounts(std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed)>& cell_of,
    const MapPromise& promise) {
  map.rays = probe_count(run, kCellRays, kLeastCellRays);
  map.quantities = {{"misses", {}, {}}, {"false hits", {}, {}}, {"self-hits", {}, {}}};
  for (std::size_t row = 0; row < map.rows.values.size(); ++row)
    for (std::size_t column = 0; column < map.columns.values.size(); ++column) {
      const CellCounts counts = cell_of(row, column, map.rays, 1980 + 100 * row + column);
      map.quantities[kMisses].rates.push_back(counts.rate_of(counts.misses, counts.asked));
      map.quantities[kFalseHits].rates.push_back(counts.rate_of(counts.false_hits, counts.asked));
      map.quantities[kSelfHits].rates.push_back(counts.rate_of(counts.self_hits, counts.left));
      for (const MapPart part : {kMisses, kFalseHits, kSelfHits})
        map.quantities[part].promised.push_back(promise(part, row, column));
    }
  map.envelope = clean_envelope(map);
}

/// "0.1", "90", "1e-6", "3e5": as short as can be.
std::vector<std::string> texts_of(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    const int exponent = value > 0 ? static_cast<int>(std::floor(std::log10(value) + 1e-9)) : 0;
    texts.push_back(exponent > 2 || exponent < -2 ? fmt::format("{:g}e{}", value / std::pow(10.0, exponent), exponent)
                                                  : fmt::format("{:g}", value));
  }
  return texts;
}

constexpr const char* kAgainstTruth =
    "A miss: the surface that the truth in double meets is not met, or is met over a hundredth of the size farther "
    "away. A false hit: one is met where the truth meets none, or nearer by as much. A self-hit: a ray that leaves a "
    "hit meets its triangle again.";

StabilityMap scale_map(const StabilityRun& run) {
  const std::vector<double> sizes{1e-12, 1e-9, 1e-6, 1e-3, 1, 1e3, 1e6, 1e9, 1e12},
      offsets{0, 1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
  StabilityMap map;
  map.name = "scale-offset";
  map.title = "Scale, and distance from the origin";
  map.method = fmt::format("Rays from 3 sizes away at a ball of 528 triangles in scene space. {}", kAgainstTruth);
  map.rows = {"size, units", texts_of(sizes)};
  map.columns = {"distance from the origin, sizes", texts_of(offsets)};
  map.promise =
      "Objects of 1e-6 to 1e12 units, up to 1e4 times as far from the scene's origin as they are large: no misses, no "
      "false hits. From 1e-9 units on, at any distance: no self-hits.";
  fill_map(
      map, run,
      [&](std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed) {
        return scale_cell(run, sizes[row], offsets[column], rays, seed);
      },
      [&](MapPart part, std::size_t row, std::size_t column) {
        const bool safe = part == kSelfHits ? sizes[row] >= 0.99e-9 : sizes[row] >= 0.99e-6 && offsets[column] <= 1e4;
        return safe ? 0 : kNothingPromised;
      });
  return map;
}

StabilityMap grazing_map(const StabilityRun& run) {
  const std::vector<double> distances{1, 1e1, 1e2, 1e3, 1e4, 1e5}, degrees{90, 10, 1, 0.1, 0.01, 0.001, 0.0001};
  StabilityMap map;
  map.name = "grazing-distance";
  map.title = "Grazing rays, and the distance that they come from";
  map.method = fmt::format(
      "Rays at a tilted quad of two triangles, so high over it; they leave it as low as they came. {}", kAgainstTruth);
  map.rows = {"distance of the ray's origin, sizes", texts_of(distances)};
  map.columns = {"angle over the surface, degrees", texts_of(degrees)};
  map.promise =
      "Rays from no farther away than 6e4 sizes times the sine of their angle over the surface: no misses, no false "
      "hits. At any angle and distance: no self-hits.";
  fill_map(
      map, run,
      [&](std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed) {
        return grazing_cell(run, degrees[column] * kDegree, distances[row], rays, seed);
      },
      [&](MapPart part, std::size_t row, std::size_t column) {
        const bool safe = part == kSelfHits || distances[row] <= 6e4 * std::sin(degrees[column] * kDegree);
        return safe ? 0 : kNothingPromised;
      });
  return map;
}

StabilityMap slab_map(const StabilityRun& run) {
  const std::vector<double> offsets{0, 1, 1e1, 1e2, 1e3, 1e4},
      thicknesses{1e-2, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6};
  StabilityMap map;
  map.name = "slab-offset";
  map.title = "Thin slabs, and distance from the origin";
  map.method =
      "Rays through two parallel sheets of two triangles each. A miss: the second sheet is not found behind the first. "
      "A false hit: a ray mirrored by the first meets the second. A self-hit: a ray that leaves the first meets its "
      "triangle again.";
  map.rows = {"distance from the origin, sizes", texts_of(offsets)};
  map.columns = {"thickness, sizes", texts_of(thicknesses)};
  map.promise =
      "Sheets that lie apart by 3e-6 of their size and by 3e-6 of their distance from the scene's origin: no misses, "
      "no false hits. At any thickness: no self-hits.";
  fill_map(
      map, run,
      [&](std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed) {
        return slab_cell(run, thicknesses[column], offsets[row], rays, seed);
      },
      [&](MapPart part, std::size_t row, std::size_t column) {
        const bool safe = part == kSelfHits || thicknesses[column] >= 2.99e-6 * std::max(1.0, offsets[row]);
        return safe ? 0 : kNothingPromised;
      });
  return map;
}

StabilityMap critical_map(const StabilityRun& run) {
  const std::vector<double> indices{1.0003, 1.1, 1.33, 1.5, 2.42}, distances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  StabilityMap map;
  map.name = "index-critical";
  map.title = "Near the critical angle";
  map.method =
      "Rays inside a medium at its border, half of them so far under the critical angle, half above it; the truth "
      "knows the ray and the triangle as they are. A miss: a ray that ought to pass is reflected totally. A false hit: "
      "the "
      "reverse. A self-hit: a ray that passed meets its triangle again.";
  map.rows = {"index of refraction", texts_of(indices)};
  map.columns = {"distance from the critical angle, radians", texts_of(distances)};
  map.promise =
      "Rays 1e-5 radians and more from the critical angle, at indices of 1.1 to 2.42, are told right: no misses, no "
      "false hits. At any index and angle: no self-hits.";
  fill_map(
      map, run,
      [&](std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed) {
        return critical_cell(run, indices[row], distances[column], rays, seed);
      },
      [&](MapPart part, std::size_t row, std::size_t column) {
        const bool safe = part == kSelfHits || (distances[column] >= 0.99e-5 && indices[row] >= 1.1);
        return safe ? 0 : kNothingPromised;
      });
  return map;
}

StabilityMap aimed_map(const StabilityRun& run) {
  const std::vector<int> sides{8, 16, 32, 64, 128};
  StabilityMap map;
  map.name = "edges-corners";
  map.title = "Rays aimed at edges and corners";
  map.method = fmt::format("Rays from inside a closed ball. {}", kAgainstTruth);
  map.rows = {"aim", {"faces", "1e-4 off edges", "1e-4 off corners", "edges", "corners"}};
  map.columns.label = "triangles of the ball";
  for (const int count : sides) map.columns.values.push_back(fmt::format("{}", count * (count - 2)));
  map.promise =
      "Rays at faces and edges, and past corners by 1e-4 of the size: no misses, no false hits. Exactly at a corner of "
      "a fine mesh up to 2 rays in 100 slip through; of the reference tracer none. Anywhere: no self-hits.";
  constexpr MapAim kAims[] = {MapAim::faces, MapAim::near_edges, MapAim::near_corners, MapAim::edges, MapAim::corners};
  fill_map(
      map, run,
      [&](std::size_t row, std::size_t column, std::size_t rays, std::uint64_t seed) {
        return aimed_cell(run, kAims[row], sides[column], rays, seed);
      },
      [&](MapPart part, std::size_t row, std::size_t) {
        return part == kMisses && kAims[row] == MapAim::corners ? 0.02 : 0;
      });
  return map;
}

MapJson json_of(const MapAxis& axis) { return {{"label", axis.label}, {"values", axis.values}}; }

/// NaN becomes null.
MapJson json_of_rates(const std::vector<double>& rates) {
  MapJson json = MapJson::array();
  for (const double rate : rates) json.push_back(std::isnan(rate) ? MapJson() : MapJson(rate));
  return json;
}

}  // namespace

std::vector<StabilityMap> stability_maps(const StabilityRun& run) {
  const FlushDenormals as_while_tracing;
  std::vector<StabilityMap> maps;
  for (const auto& make : {scale_map, grazing_map, slab_map, critical_map, aimed_map}) {
    if (run.stop != nullptr && run.stop->load()) break;
    maps.push_back(make(run));
  }
  return maps;
}

std::string clean_envelope(const StabilityMap& map) {
  const std::size_t columns = map.columns.values.size();
  std::vector<std::size_t> clean;  // [rows] columns from the first on where all rates are 0
  for (std::size_t row = 0; row < map.rows.values.size(); ++row) {
    std::size_t column = 0;
    const auto is_clean = [&] {
      for (const MapQuantity& quantity : map.quantities)
        if (quantity.rates[map.cell(row, column)] > 0) return false;
      return true;
    };
    while (column < columns && is_clean()) ++column;
    clean.push_back(column);
  }
  std::string text = fmt::format("No miss, false hit or self-hit of {} rays a cell ({}: {}): ", map.rays,
                                 map.rows.label, map.columns.label);
  // Neighboring rows that are clean equally far are one entry.
  for (std::size_t row = 0; row < clean.size();) {
    std::size_t end = row + 1;
    while (end < clean.size() && clean[end] == clean[row]) ++end;
    if (row > 0) text += "; ";
    text += map.rows.values[row];
    if (end > row + 1) text += fmt::format(" to {}", map.rows.values[end - 1]);
    text += clean[row] == 0 ? std::string(": nowhere")
            : clean[row] == columns
                ? std::string(": everywhere")
                : fmt::format(": {} to {}", map.columns.values[0], map.columns.values[clean[row] - 1]);
    row = end;
  }
  return text + ".";
}

std::vector<std::string> broken_promises(const StabilityMap& map) {
  std::vector<std::string> broken;
  for (const MapQuantity& quantity : map.quantities)
    for (std::size_t row = 0; row < map.rows.values.size(); ++row)
      for (std::size_t column = 0; column < map.columns.values.size(); ++column) {
        const std::size_t cell = map.cell(row, column);
        // A rate that is NaN breaks nothing: no ray could be asked. Nor does any rate where NaN is promised.
        if (quantity.rates[cell] > quantity.promised[cell])
          broken.push_back(fmt::format("{}: {} at {} {}, {} {}: {:.2g} instead of {:g}", map.name, quantity.name,
                                       map.rows.label, map.rows.values[row], map.columns.label,
                                       map.columns.values[column], quantity.rates[cell], quantity.promised[cell]));
      }
  return broken;
}

std::string stability_maps_json(const std::vector<StabilityMap>& maps) {
  MapJson all = MapJson::array();
  for (const StabilityMap& map : maps) {
    MapJson json{{"name", map.name},          {"title", map.title},        {"method", map.method},
                 {"rays_per_cell", map.rays}, {"rows", json_of(map.rows)}, {"columns", json_of(map.columns)},
                 {"promise", map.promise},    {"envelope", map.envelope},  {"broken", broken_promises(map)}};
    for (const MapQuantity& quantity : map.quantities)
      json["quantities"].push_back({{"name", quantity.name},
                                    {"rates", json_of_rates(quantity.rates)},
                                    {"promised", json_of_rates(quantity.promised)}});
    all.push_back(std::move(json));
  }
  return all.dump(1);
}

}  // namespace raytree::benchmarks
