#include "app/truth.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/suggestion.h"
#include "app/usage.h"
#include "geometry/sphere_bounded_intersector.h"
#include "geometry/triangle_reference.h"

namespace raytree::app {

void add_truth_flag(CLI::App& command, std::string& truth) {
  command
      .add_option(
          "--truth", truth,
          "spheres: Whitted's bounding-sphere tracer in double, which knows polygons and limit surfaces (default); "
          "triangles: the fast tracer's own, in double")
      ->type_name("NAME");
}

void check_truth(const std::string& truth) {
  if (!truth.empty() && truth != kTriangleTruth && truth != kSphereTruth)
    throw usage_error(fmt::format("--truth: \"{}\" is none of: triangles, spheres{}", truth,
                                  did_you_mean(truth, {kTriangleTruth, kSphereTruth})));
}

bool truth_needs_sources(const std::string& truth) { return truth != kTriangleTruth; }

std::string truth_for(const std::string& truth, const Scene& scene) {
  if (!truth.empty()) return truth;
  return scene.description.render.tessellation.rate > 0 ? kTriangleTruth : kSphereTruth;
}

std::unique_ptr<const ReferenceTracer> make_truth(const std::string& truth, const Scene& scene,
                                                  const std::atomic<bool>* stop) {
  if (truth == kTriangleTruth) return std::make_unique<TriangleReference>(*scene.shapes);
  SphereBoundedOptions options;
  options.stop = stop;
  return std::make_unique<SphereBoundedIntersector>(*scene.shapes, options);
}

benchmarks::FacetTolerance facet_tolerance(const std::string& truth, const Scene& scene) {
  if (truth == kTriangleTruth) return {};
  const TessellationSettings& asked = scene.description.render.tessellation;
  if (asked.rate > 0)
    throw usage_error("--truth spheres: facets of a given rate have no tolerance to be compared with");
  return {asked.tolerance, kDefaultSpherePixels};
}

}  // namespace raytree::app
