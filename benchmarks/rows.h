// The rows of the table, one function and one file each; docs/benchmarks.md says how each is measured and what it does
// not say.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/measurement.h"

namespace raytree::benchmarks {

struct MeasureContext {
  std::filesystem::path programs;                    ///< folder of raytree, raytree_measure and the probes
  std::filesystem::path scratch;                     ///< a folder of our own for files that rows write
  std::function<void(const std::string&)> progress;  ///< one line each
};

std::vector<Figure> measure_floor(const MeasureContext& context);
std::vector<Figure> measure_waves(const MeasureContext& context);
std::vector<Figure> measure_threads(const MeasureContext& context);
std::vector<Figure> measure_start(const MeasureContext& context);
std::vector<Figure> measure_large(const MeasureContext& context);
std::vector<Figure> measure_idle(const MeasureContext& context);
std::vector<Figure> measure_time_split(const MeasureContext& context);
std::vector<Figure> measure_loading(const MeasureContext& context);
std::vector<Figure> measure_povray(const MeasureContext& context);
std::vector<Figure> measure_povray_masks(const MeasureContext& context);
std::vector<Figure> measure_intersection_overhead(const MeasureContext& context);
std::vector<Figure> measure_instances(const MeasureContext& context);
std::vector<Figure> measure_types(const MeasureContext& context);
std::vector<Figure> measure_curved(const MeasureContext& context);
std::vector<Figure> measure_curved_pictures(const MeasureContext& context);
std::vector<Figure> measure_spd(const MeasureContext& context);
std::vector<Figure> measure_naive(const MeasureContext& context);
std::vector<Figure> measure_embree_ratios(const MeasureContext& context);

/// The row's chart as SVG, of the figures that have a place in it. Empty: none has.
std::string naive_chart_svg(const std::vector<Figure>& figures);

struct Row {
  const char* name;
  std::vector<Figure> (*measure)(const MeasureContext&);
  std::string (*chart_svg)(const std::vector<Figure>&) = nullptr;  ///< null: the row has no chart
};
inline constexpr Row kRows[] = {
    {"floor", measure_floor},
    {"waves", measure_waves},
    {"threads", measure_threads},
    {"start", measure_start},
    {"large", measure_large},
    {"idle", measure_idle},
    {"split", measure_time_split},
    {"loading", measure_loading},
    {"bench", measure_intersection_overhead},
    {"ratios", measure_embree_ratios},
    {"instances", measure_instances},
    {"types", measure_types},
    {"curved", measure_curved},
    {"curved-pictures", measure_curved_pictures},
    {"povray", measure_povray},
    {"povray-masks", measure_povray_masks},
    {"spd", measure_spd},
    {"naive", measure_naive, naive_chart_svg},
};

/// What `large` compares with, measured in a process of its own (see large.cpp): generates the terrain, builds over it
/// with Embree alone in a kind of hierarchy, traces the picture's rays by bare calls; JSON of seconds and bytes.
std::string bare_large_json(const std::string& hierarchy);
inline constexpr const char* kBareLargeFlag = "--bare-large";  ///< KIND: makes raytree_measure print it

/// What `instances` says of memory, measured in a process of its own: bytes before and after preparing its scene.
std::string instances_memory_json();
inline constexpr const char* kInstancesMemoryFlag = "--instances-memory";  ///< makes raytree_measure print it

}  // namespace raytree::benchmarks
