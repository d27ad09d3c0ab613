// `raytree ray`: one ray, asked of the fast tracer and of the truth. The ray is one that `raytree validate` printed, or
// any other, in scene space.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "app/commands.h"
#include "app/exit_status.h"
#include "app/messages.h"
#include "app/prepared_scene.h"
#include "app/render_options.h"
#include "app/truth.h"
#include "benchmarks/validation.h"
#include "geometry/surface.h"
#include "geometry/triangle_reference.h"

namespace raytree::app {
namespace {

using benchmarks::ComparedRay;
using benchmarks::RayComparison;
using benchmarks::RayJudge;

struct RayOptions {
  SceneFlags scene;
  ComparedRay ray;
  std::string truth;  ///< empty: the scene's default
  bool quiet = false;
};

/// "x,y,z", decimal or hexadecimal.
std::optional<Vec3f> vector_of(const std::string& text) {
  Vec3f result;
  const char* at = text.c_str();
  for (int axis = 0; axis < 3; ++axis) {
    char* end = nullptr;
    result[axis] = std::strtof(at, &end);
    if (end == at || !std::isfinite(result[axis]) || *end != (axis < 2 ? ',' : '\0')) return std::nullopt;
    at = end + 1;
  }
  return result;
}

/// `before`: vectors that stand before the word.
Error no_vector(const std::string& word, std::size_t before) {
  return usage_error(fmt::format("{} \"{}\" is not x,y,z", before == 0 ? "origin" : "direction", word));
}

/// Whether a word is meant for a vector though it begins as a flag does.
bool begins_negative(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word.find(',') != std::string::npos &&
         (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
}

/// Throws Error when a word that stands where the origin or the direction should is no vector; `wrong` holds such words
/// in their order.
void check_vectors(const Words& words, const Words& wrong) {
  if (wrong.empty()) return;
  std::size_t before = 0;  // vectors that stand before the first wrong one
  for (const std::string& word : words) {
    if (word == wrong.front()) break;
    before += vector_of(word) ? 1 : 0;
  }
  throw no_vector(wrong.front(), before);
}

std::optional<RayOptions> parse_ray_options(const Words& words) {
  RayOptions options;
  std::string end;
  Words others_than_vectors;
  CLI::App command(
      "Ask the fast tracer and a slow and plain one in double precision about one ray, and say why they differ.",
      "raytree ray");
  command
      .add_option("SCENE", options.scene.scene,
                  "Scene file (.json), mesh (.obj, .ply), patches (.bpt) or built-in scene (raytree scenes)")
      ->type_name("");
  command
      .add_option("RAY", others_than_vectors,
                  "Origin and direction, x,y,z each, in scene space, as raytree validate prints them")
      ->type_name("")
      ->expected(0, 2);
  command.add_option("--end", end, "Distance at which the ray ends; default: nowhere")->type_name("T");
  add_truth_flag(command, options.truth);
  add_scene_flags(command, options.scene, false);
  add_hierarchy_flags(command, options.scene);
  command.add_flag("--quiet", options.quiet, "No warnings");
  prepare_usage(command);
  // A vector may begin with a minus sign, as flags do.
  std::vector<Vec3f> vectors;
  Words others;
  for (const std::string& word : words)
    if (const std::optional<Vec3f> vector = vector_of(word))
      vectors.push_back(*vector);
    else if (begins_negative(word))
      throw no_vector(word, vectors.size());
    else
      others.push_back(word);
  if (!parse_usage(command, others)) return std::nullopt;
  check_scene_flags(options.scene);
  check_truth(options.truth);
  check_vectors(words, others_than_vectors);
  if (vectors.size() != 2)
    throw usage_error(
        fmt::format("two vectors x,y,z follow the scene, origin and direction; {} given", vectors.size()));
  for (const bool of_direction : {false, true})
    for (int axis = 0; axis < 3; ++axis)
      if (const Vec3f& v = vectors[of_direction ? 1 : 0]; std::abs(v[axis]) > kFarthestRay)
        throw usage_error(fmt::format("the {} {},{},{} has a coordinate beyond 1e18",
                                      of_direction ? "direction" : "origin", v.x, v.y, v.z));
  if (vectors[1] == Vec3f(0, 0, 0)) throw usage_error("the direction is 0,0,0");
  options.ray = {vectors[0], vectors[1], std::numeric_limits<float>::infinity(), false};
  if (!end.empty()) {
    options.ray.max_distance = static_cast<float>(parse_real("--end", end));
    if (options.ray.max_distance < 0) throw usage_error("--end: a ray does not end before it begins");
  }
  return options;
}

std::string surface_text(const Scene& scene, GeometryId geometry, std::uint32_t primitive, InstanceId instance) {
  const ShapeId shape =
      instance != kNoInstance ? scene.shapes->instances[instance].shape : scene.shapes->shape_of(geometry, primitive);
  std::string text =
      fmt::format("\"{}\", geometry {} primitive {}", scene.summary.shapes[shape].name, geometry, primitive);
  if (instance != kNoInstance) text += fmt::format(" instance {}", instance);
  return text;
}

std::string fast_text(const Scene& scene, const ComparedRay& ray, const Hit& hit) {
  if (hit.geometry == kNoGeometry) return "miss\n";
  const SurfacePoint point = surface_at(*scene.shapes, ray.origin, ray.direction, hit, false);
  return fmt::format("{} at {} ({:a}), normal {}\n", surface_text(scene, hit.geometry, hit.primitive, hit.instance),
                     hit.distance, hit.distance, benchmarks::exact(point.geometric_normal));
}

std::string truth_text(const Scene& scene, const ReferenceHit& hit) {
  if (!hit.hit()) return "miss";
  return fmt::format("{} at {} ({:a}), normal {},{},{}", surface_text(scene, hit.geometry, hit.primitive, hit.instance),
                     hit.distance, hit.distance, hit.normal.x, hit.normal.y, hit.normal.z);
}

std::string answers(const Scene& scene, const ComparedRay& ray, const std::string& truth_asked_for) {
  const std::string truth_name = truth_for(truth_asked_for, scene);
  const std::unique_ptr<const ReferenceTracer> truth = make_truth(truth_name, scene, nullptr);
  const TriangleReference facets(*scene.shapes);
  const RayJudge of_facets(*scene.shapes, *scene.intersector, *scene.shapes, facets);
  const RayJudge judge(*scene.shapes, *scene.intersector, *scene.shapes, *truth, facet_tolerance(truth_name, scene),
                       truth_name == kSphereTruth ? &of_facets : nullptr);
  RayBatch rays(1);
  HitBatch hits(1);
  rays.push(ray.origin, ray.direction, ray.max_distance);
  const ReferenceHit found = judge.ask_truth(ray);
  const Vec3d& origin = scene.shapes->origin;
  std::string text = fmt::format("scene     {}, its origin at {},{},{} in the world\n", scene.description.name,
                                 origin.x, origin.y, origin.z);
  text += fmt::format("truth     {}, by {}\n", truth_text(scene, found), truth_name);
  const std::pair<const char*, Coherence> ways[] = {{"fast", Coherence::incoherent}, {"coherent", Coherence::coherent}};
  for (const auto& [name, coherence] : ways) {
    scene.intersector->intersect(rays, coherence, hits);
    const RayComparison comparison = judge.nearest(ray, hits[0], found);
    text += fmt::format("{:<9} {}", name, fast_text(scene, ray, hits[0]));
    text += fmt::format("          {}: {:.3g} ulp; {:.3g} from an edge known to {:.3g}, distance known to {:.3g}\n",
                        benchmarks::kRayVerdictNames[static_cast<std::size_t>(comparison.verdict)],
                        comparison.distance_ulps, comparison.edge_distance, comparison.edge_error,
                        comparison.distance_error);
    std::vector<std::uint8_t> occluded(1 + kBatchPadding);
    scene.intersector->occluded(rays, coherence, occluded.data());
    const RayComparison shadow = judge.occlusion(ray, occluded[0] != 0, found);
    text += fmt::format("          as a shadow ray {}: {}\n", occluded[0] != 0 ? "occluded" : "open",
                        benchmarks::kRayVerdictNames[static_cast<std::size_t>(shadow.verdict)]);
  }
  return text;
}

}  // namespace

int ray_command(const Words& words) {
  const std::optional<RayOptions> options = parse_ray_options(words);
  if (!options) return kSuccess;
  SceneRun run{options->scene, 1, true, options->quiet};
  run.keep_sources = truth_needs_sources(options->truth);
  return with_prepared_scene(
      run, [&](Scene& scene, const Interruption&) { print_result(answers(scene, options->ray, options->truth)); });
}

}  // namespace raytree::app
