// What lies far away: small spheres far from the ray's origin, and scenes far from the world's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_pictures.h"
#include "benchmarks/stability/case_tools.h"
#include "benchmarks/stability/intersection_cases.h"
#include "benchmarks/stability/ray_probes.h"
#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "renderer/render.h"

namespace raytree::benchmarks {
namespace {

/// The quadratic as textbooks have it, in single precision; NaN: no hit.
float naive_sphere_distance(const Vec3f& origin, const Vec3f& direction, float radius) {
  const float b = origin.dot(direction), c = origin.dot(origin) - radius * radius;
  return -b - std::sqrt(b * b - c);
}

struct FarSphereErrors {
  double naive = 0, embree = 0;       ///< worst error of the distance, radii; infinity for a miss
  double place = 0, normal = 0;       ///< of the renderer's point and its normal, radii and degrees
  std::size_t missed = 0, aimed = 0;  ///< by the renderer's tracer
};

/// A sphere of radius 1 about the origin, rays from so far away at its inner nine tenths.
FarSphereErrors far_sphere_errors(const StabilityRun& run, double distance) {
  ProbeRandom random(44);
  const ShapeSet shapes = spheres_at({{0, 0, 0, 1}});
  EmbreeOptions options = run.tracer_options();
  const EmbreeIntersector tracer(shapes, options);
  options.most_few_shapes = 0;  // Embree's own spheres
  const EmbreeIntersector embree(shapes, options);
  FarSphereErrors errors;
  for (std::size_t i = 0; i < probe_count(run, 4000, 1500); ++i) {
    const ProbeRay ray = ray_to(random.direction() * distance, random.direction() * 0.9);
    // What single precision's direction passes the aim by is the ray's own; the truth is the ray as it is.
    const Vec3d o(ray.origin), d = unit(Vec3d(ray.direction));
    const double along = -o.dot(d);
    const Vec3d closest = o + d * along;
    if (closest.length() > 0.9) continue;
    ++errors.aimed;
    const double half_chord = std::sqrt(1 - closest.dot(closest)), truth = along - half_chord;
    const Vec3d normal = closest - d * half_chord;
    const auto worse = [](double& worst, double error) {
      worst = std::isnan(error) ? kInfinity : std::max(worst, error);
    };
    const float naive = naive_sphere_distance(ray.origin, ray.direction, 1);
    worse(errors.naive, std::abs(naive - truth));
    const Hit there = embree.intersect_one(ray.origin, ray.direction, kInfinity);
    worse(errors.embree, there.geometry == kNoGeometry ? double(kInfinity) : std::abs(there.distance - truth));
    const Hit hit = hit_of(tracer, ray);
    if (hit.geometry == kNoGeometry) {
      ++errors.missed;
      continue;
    }
    const SurfacePoint point = surface_at(shapes, ray.origin, ray.direction, hit, false);
    worse(errors.place, (Vec3d(point.position) - normal).length());
    worse(errors.normal, std::asin(std::min(1.0, Vec3d(point.geometric_normal).cross(normal).length())) / kDegree);
  }
  return errors;
}

/// The sphere from 2e3 radii away through a telescope, in light from the side: by the normal at the place that `place`
/// finds along a ray.
template <class Place>
StabilityPicture far_sphere_picture(std::string caption, const Place& place) {
  constexpr int kSize = 160;
  constexpr double kAway = 2e3;
  const Vec3d away = unit(Vec3d(0.3, 0.2, 1)), right = unit(Vec3d(0, 1, 0).cross(away)), up = away.cross(right);
  const Vec3d to_light = unit(right + up * 0.6 + away * 0.7);
  return painted_picture(std::move(caption), kSize, kSize, [&](int x, int y) {
    const double a = (x + 0.5) * 2.2 / kSize - 1.1, b = 1.1 - (y + 0.5) * 2.2 / kSize;
    if (std::hypot(a, b) > 0.99) return kPaperColor;
    const ProbeRay ray = ray_to(away * kAway, right * a + up * b + away * std::sqrt(1 - a * a - b * b));
    const Vec3d found = place(ray);
    if (!std::isfinite(found.length())) return kFaultColor;
    return gray(0.03 + 0.85 * std::max(0.0, unit(found).dot(to_light)));
  });
}

void show_far_sphere(StabilityResult& result, const StabilityRun& run) {
  const ShapeSet shapes = spheres_at({{0, 0, 0, 1}});
  const EmbreeIntersector tracer(shapes, run.tracer_options());
  result.pictures.push_back(far_sphere_picture(
      "A sphere from 2e3 radii away, quadratic in single precision: rings, and no answer (orange)",
      [](const ProbeRay& ray) {
        return Vec3d(ray.origin + ray.direction * naive_sphere_distance(ray.origin, ray.direction, 1));
      }));
  result.pictures.push_back(
      far_sphere_picture("Solved again in double about the closest point", [&](const ProbeRay& ray) {
        const Hit hit = hit_of(tracer, ray);
        if (hit.geometry == kNoGeometry) return Vec3d(kInfinity);
        return Vec3d(surface_at(shapes, ray.origin, ray.direction, hit, false).position);
      }));
}

StabilityResult run_far_sphere(const StabilityRun& run) {
  StabilityResult result;
  StabilityGraph graph{"Places on a sphere of radius 1",
                       "radii away",
                       "worst error, radii",
                       {{"quadratic, single precision", {}}, {"Embree's sphere", {}}, {"solved again in double", {}}}};
  for (const double ratio : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const FarSphereErrors errors = far_sphere_errors(run, 1 / ratio);
    graph.lines[0].points.emplace_back(1 / ratio, errors.naive);
    graph.lines[1].points.emplace_back(1 / ratio, errors.embree);
    graph.lines[2].points.emplace_back(1 / ratio, errors.place);
    const std::string at = fmt::format(", 1e{:.0f} radii away", -std::log10(ratio));
    // b^2 and c are squares of the distance, each rounded a few times; their difference is four times the half chord's
    // square of at least .19, under a root.
    const double u = kRoundoff, squares = 1 / (ratio * ratio);
    if (ratio == 1e-2)
      result.figures.push_back(known_failure("quadratic in single precision", "worst error of the distance, radii" + at,
                                             errors.naive, u * squares, 16 * u * squares,
                                             "2^-24 (d / r)^2: 3e-3 at 1e2 radii, useless from 1e3"));
    result.figures.push_back(known_failure("Embree's sphere", "worst error of the distance, radii" + at, errors.embree,
                                           u / ratio, 8 * u / ratio,
                                           "2.5e-5, 2.4e-4 and 2.7e-2 at 1e2, 1e3 and 1e5 (Embree 3.13.5)"));
    // Half an ulp a coordinate on the sphere, and what double's own closed form is off by: 2^-53 of squares of the
    // distance over the half chord.
    const double bound = 4 * u + 8 * 0x1p-53 * squares / 0.4;
    result.figures.push_back(held("solved again in double about the closest point",
                                  "worst error of the place, radii" + at, errors.place, 0, bound,
                                  "half an ulp a coordinate"));
    result.figures.push_back(
        held("the same", "worst error of the normal, degrees" + at, errors.normal, 0, bound / kDegree, "as the place"));
    result.figures.push_back(
        held("the renderer's tracer", "rays that miss" + at, static_cast<double>(errors.missed), 0, 0, "0"));
  }
  if (run.pictures) {
    result.graphs.push_back(std::move(graph));
    show_far_sphere(result, run);
  }
  return result;
}

/// A tilted plane of 6 units, y = 0.3 x + 0.2 z about `at`, seen from 10 units above; with `wide`, a ball at the
/// world's origin too, so that the scene reaches as far as it lies away. Worst error of the film's depth, scene units.
double depth_error(double translation, bool wide) {
  constexpr int kSize = 32;
  // Not a multiple of anything: nothing is representable by luck.
  const Vec3d at(1.000123 * translation, -0.5000317 * translation, 0.9000713 * translation);
  SceneDescription scene;
  scene.name = "far-scene";
  scene.image = {kSize, kSize};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  CameraDescription camera;
  camera.projection = CameraDescription::Projection::orthographic;
  camera.position = at + Vec3d(0, 10, 0);
  camera.target = at;
  camera.up = {0, 0, -1};
  camera.height = 4;
  scene.cameras = {camera};
  MeshShape mesh;
  mesh.normals = NormalSource::flat;
  mesh.mesh = std::make_shared<PolygonMesh>();
  for (const Vec3d& p : {Vec3d(-3, 0, -3), Vec3d(-3, 0, 3), Vec3d(3, 0, 3), Vec3d(3, 0, -3)})
    mesh.mesh->positions.push_back(Vec3f(Vec3d(p.x, 0.3 * p.x + 0.2 * p.z, p.z)));
  mesh.mesh->corners.assign({0, 1, 2, 0, 2, 3});
  ShapeDescription plane;
  plane.name = "plane";
  plane.kind = std::move(mesh);
  plane.transform.setTranslation(at);
  scene.shapes.push_back(std::move(plane));
  if (wide) {
    ShapeDescription ball;
    ball.name = "ball";
    // As far on the other side: the scene's center is the world's origin.
    ball.kind = SphereShape{-at, 1};
    scene.shapes.push_back(std::move(ball));
  }
  Warnings warnings;
  const Scene prepared = prepare(std::move(scene), {}, warnings);
  RenderOptions options;
  options.channels = {ChannelGroup::depth};
  options.threads = 1;
  const RenderResult result = render(prepared, options);
  double worst = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double px = (x + 0.5 - kSize / 2.0) * 4 / kSize, pz = (y + 0.5 - kSize / 2.0) * 4 / kSize;
      const double truth = 10 - (0.3 * px + 0.2 * pz);
      const float depth = result.film.plane(ChannelGroup::depth, 0)[y * kSize + x];
      worst = std::max(worst, std::abs(depth - truth));
    }
  return worst;
}

/// A ball of facets on a checkered floor, `translation` from the world's origin; with `wide`, something as far on the
/// other side, so that the scene reaches as far as it lies away.
StabilityPicture far_scene_picture(std::string caption, double translation, bool wide) {
  const Vec3d at(1.000123 * translation, -0.5000317 * translation, 0.9000713 * translation);
  SceneDescription scene = samples::dark_scene(180, {});
  scene.cameras[0].position = at + Vec3d(1.5, 2.2, 4);
  scene.cameras[0].target = at;
  CheckerPattern checker;
  checker.size = 0.5;
  checker.offset = {at.x, at.z};
  scene.ambient = Rgb(0.15f);
  scene.lights = {samples::directional_light({-1, -2, -0.7})};
  scene.materials = {samples::material("floor", checker), samples::material("ball", Rgb(0.75f, 0.3f, 0.1f))};
  scene.shapes = {samples::mesh_shape(samples::box_mesh({-3, -1.2f, -3}, {3, -1, 3}), "floor"),
                  samples::mesh_shape(samples::globe_mesh(1, 32, 16), "ball", NormalSource::smooth)};
  for (ShapeDescription& shape : scene.shapes) shape.transform = samples::translation(at);
  if (wide) scene.shapes.push_back(samples::shape(SphereShape{-at, 1}, "ball"));
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  Warnings warnings;
  return stability_picture(std::move(caption), render(prepare(std::move(scene), {}, warnings), {}).film);
}

StabilityResult run_far_scene(const StabilityRun& run) {
  StabilityResult result;
  for (const double translation : {1e3, 1e5, 1e7}) {
    const std::string at = fmt::format(", 1e{:.0f} from the origin", std::log10(translation));
    const std::string quantity = "worst error of the depth, units" + at;
    // Corners and eye are rounded to half an ulp of the translation a coordinate, the distance is made of their
    // differences: at most 4 of them, and on 1024 pixels some of them show.
    if (translation < 1e7)
      result.figures.push_back(known_failure(
          "a scene that reaches as far as it lies away", quantity, depth_error(translation, true),
          kRoundoff * translation / 8, 2 * double(kRoundoff) * translation, "0.3 to 0.4 ulps of the translation"));
    // Corners, eye and distance are about 10 units: 8 half ulps of 16.
    result.figures.push_back(held("scene space about the scene's center", quantity, depth_error(translation, false), 0,
                                  8 * double(kRoundoff) * 16,
                                  "half ulps of the scene's size, whatever the translation"));
  }
  if (run.pictures) {
    result.pictures.push_back(far_scene_picture(
        "2e6 units from the middle of a scene that reaches that far: corners and places are rounded to 1/8 unit", 2e6,
        true));
    result.pictures.push_back(
        far_scene_picture("2e6 units from the world's origin alone, scene space about the scene's center", 2e6, false));
  }
  return result;
}

}  // namespace

std::vector<StabilityCase> place_cases() {
  return {{44, "far-sphere", "Small spheres far away", "a sphere seen from 1e2 to 1e5 radii away",
           "hit points solved again in double; single precision beside it", "Ray Tracing Gems 2019, chapter 7",
           run_far_sphere},
          {45, "far-scene", "Scenes far from the origin", "a tilted plane 1e3 to 1e7 units from the world's origin",
           "everything is moved to the scene's center in double before it becomes single precision",
           "docs/architecture.md, Spaces", run_far_scene}};
}

}  // namespace raytree::benchmarks
