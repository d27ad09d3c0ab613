// The tracer that `validate` and `ray` compare with, by its name on the command line.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "benchmarks/surface_deviation.h"
#include "geometry/reference_tracer.h"
#include "renderer/scene.h"

namespace CLI {
class App;
}

namespace raytree::app {

inline constexpr const char* kTriangleTruth = "triangles";
inline constexpr const char* kSphereTruth = "spheres";

/// Adds --truth.
void add_truth_flag(CLI::App& command, std::string& truth);
/// Throws Error (bad_input) unless it is a name, or empty: not asked for.
void check_truth(const std::string& truth);

/// Whether the scene must keep what its meshes were made of (SceneRun::keep_sources) for this truth.
bool truth_needs_sources(const std::string& truth);

/// The truth asked for; without one kSphereTruth, or kTriangleTruth where surfaces were cut at a given rate, since
/// their facets then have no tolerance.
std::string truth_for(const std::string& truth, const Scene& scene);

/// Over the scene's shapes.
std::unique_ptr<const ReferenceTracer> make_truth(const std::string& truth, const Scene& scene,
                                                  const std::atomic<bool>* stop);

/// By how much its hits may lie off the fast tracer's triangles. Throws Error (bad_input) where nobody asked for a
/// tolerance.
benchmarks::FacetTolerance facet_tolerance(const std::string& truth, const Scene& scene);

}  // namespace raytree::app
