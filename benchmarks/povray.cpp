// Row povray: the same pictures by POV-Ray, one thread of each: tracing alone, a ray, a picture with anti-aliasing of
// equal error, from launch to file; and whether both see the same shapes at the same distance.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <thread>

#include "benchmarks/child_process.h"
#include "benchmarks/povray_run.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "benchmarks/rows.h"
#include "geometry/error.h"
#include "geometry/triangle_reference.h"
#include "renderer/render.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

struct Traced {
  double seconds = 0, rays = 0;
  Film film;
};

Traced traced(Scene& scene, const RenderSettings& settings, ChannelSet channels = {ChannelGroup::color}) {
  scene.description.render = settings;
  RenderOptions options;
  options.threads = 1;
  options.channels = channels;
  RenderResult result = render(scene, options);
  const auto count = [&](RayKind kind) { return static_cast<double>(result.statistics.rays[static_cast<int>(kind)]); };
  return {result.statistics.thread_seconds,
          count(RayKind::primary) + count(RayKind::reflected) + count(RayKind::refracted), std::move(result.film)};
}

/// As the 16-bit file of the other has it: clipped and rounded.
Picture picture_of(const Film& film) {
  Picture result;
  const auto pixels = static_cast<std::size_t>(film.window().width) * static_cast<std::size_t>(film.window().height);
  for (int channel = 0; channel < 3; ++channel) {
    const float* const plane = film.plane(ChannelGroup::color, channel);
    for (std::size_t i = 0; i < pixels; ++i)
      result.push_back(std::round(std::clamp(plane[i], 0.0f, 1.0f) * kLargest16) / kLargest16);
  }
  return result;
}

double root_mean_square_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * double(a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

Figure figure_of(const std::string& what, const Spread& measured, BoundKind kind, double bound,
                 const std::string& note) {
  Figure figure;
  figure.row = "povray";
  figure.what = what;
  figure.measured = measured;
  figure.kind = kind;
  figure.bound = bound;
  figure.note = note;
  return figure;
}

PairLimits few_pairs() {
  PairLimits limits;
  limits.least = 5;
  limits.most = 9;
  return limits;
}

/// Tracing without anti-aliasing: seconds of CPU time over seconds, and the same for one ray.
void measure_tracing(const MeasureContext& context, Scene& scene, const std::string& name,
                     std::vector<Figure>& figures) {
  context.progress("povray: tracing " + scene.description.name);
  const Povray povray(context, scene, PovrayPicture::shaded, 0, name);
  RenderSettings settings = scene.description.render;
  settings.antialias = {Antialiasing::Method::none, 1};
  double their_rays = 0, our_rays = 0;
  const PairedSpread pairs = measure_pairs(
      [&] {
        const PovrayStatistics statistics = povray.trace({"-A"});
        their_rays = statistics.rays;
        return statistics.trace_cpu_seconds;
      },
      [&] {
        const Traced ours = traced(scene, settings);
        our_rays = ours.rays;
        return ours.seconds;
      },
      few_pairs());
  const double share = our_rays / their_rays;
  const std::string note =
      fmt::format("{:.3f} s of CPU time against {:.3f} s; {:.0f} against {:.0f} rays, shadow rays not counted",
                  pairs.a.median, pairs.b.median, their_rays, our_rays);
  figures.push_back(figure_of("POV-Ray's tracing time / ours, no anti-aliasing, " + picture_text(scene, 1), pairs.ratio,
                              BoundKind::at_least, kLeastPovrayTrace, note));
  Spread a_ray = pairs.ratio;
  a_ray.low *= share, a_ray.median *= share, a_ray.high *= share;
  figures.push_back(
      figure_of("the same a ray, " + picture_text(scene, 1), a_ray, BoundKind::at_least, kLeastPovrayRay, ""));
}

/// POV-Ray's recursive anti-aliasing at its default settings, and ours at the fewest rays that are no further from its
/// own converged picture.
Figure adaptive_figure(const MeasureContext& context, Scene& scene, const std::string& name) {
  context.progress("povray: anti-aliasing, " + scene.description.name);
  const std::vector<std::string> theirs{"+A0.3", "+AM2", "+R3", "-J"};
  const Povray povray(context, scene, PovrayPicture::shaded, 0, name);
  RenderSettings settings = scene.description.render;
  povray.run({"+A0.0", "+AM1", "+R9", "-J"});
  const Picture their_truth = povray.picture();
  povray.run(theirs);
  const double their_error = root_mean_square_difference(povray.picture(), their_truth);

  settings.antialias = {Antialiasing::Method::grid, 16};
  const Picture our_truth = picture_of(traced(scene, settings).film);
  settings.antialias = {Antialiasing::Method::whitted, 1};
  RenderSettings best = settings;
  double our_error = 0, least = std::numeric_limits<double>::infinity();
  for (const int levels : {1, 2, 3, 4, 5}) {
    settings.adaptive.levels = levels;
    // The dearer, the less error: the cheapest threshold is found between one that is too large and one that is not.
    double too_large = 0.8, small_enough = 0.0125;
    while (too_large > 1.03 * small_enough) {
      settings.adaptive.threshold = std::sqrt(too_large * small_enough);
      const Traced ours = traced(scene, settings);
      const double error = root_mean_square_difference(picture_of(ours.film), our_truth);
      (error > their_error ? too_large : small_enough) = settings.adaptive.threshold;
      if (error > their_error || ours.rays >= least) continue;
      least = ours.rays;
      our_error = error;
      best = settings;
    }
  }
  const std::string what =
      "POV-Ray's tracing time (+A0.3 +AM2 +R3) / ours, adaptive, at no more error, " + picture_text(scene, 1);
  if (!std::isfinite(least)) {
    Figure figure = figure_of(what, {}, BoundKind::at_least, kLeastPovrayAdaptive, "");
    figure.problem = fmt::format("no setting of ours is within an error of {:.5f}", their_error);
    return figure;
  }
  const PairedSpread pairs = measure_pairs([&] { return povray.trace(theirs).trace_cpu_seconds; },
                                           [&] { return traced(scene, best).seconds; }, few_pairs());
  return figure_of(
      what, pairs.ratio, BoundKind::at_least, kLeastPovrayAdaptive,
      fmt::format("{:.3f} s against {:.3f} s; root mean square error {:.5f} against {:.5f} (threshold {:.3f}, "
                  "levels {}), each to its own picture of 81 and 256 samples a pixel",
                  pairs.a.median, pairs.b.median, their_error, our_error, best.adaptive.threshold,
                  best.adaptive.levels));
}

void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const Vec3d& origin) {
  std::ofstream file(path);
  for (const Vec3f& p : mesh.positions)
    file << fmt::format("v {} {} {}\n", p.x + origin.x, p.y + origin.y, p.z + origin.z);
  for (const Vec3f& n : mesh.normals) file << fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
  for (std::size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
    file << 'f';
    for (std::size_t k = i; k < i + 3; ++k) {
      file << ' ' << mesh.corners[k] + 1;
      if (!mesh.normals.empty())
        file << "//" << (mesh.normal_corners.empty() ? mesh.corners[k] : mesh.normal_corners[k]) + 1;
    }
    file << '\n';
  }
  if (!file.flush()) throw Error(ErrorKind::failure, {path.string(), 0, {}}, "cannot be written");
}

/// The scene as a file whose terrain is an OBJ file beside it: what it was before it was prepared, and its meshes.
std::filesystem::path write_scene_with_mesh_file(const std::filesystem::path& folder, SceneDescription description,
                                                 const Scene& scene) {
  for (std::size_t i = 0; i < description.shapes.size(); ++i) {
    if (!std::holds_alternative<TerrainShape>(description.shapes[i].kind)) continue;
    for (const MeshEntry& entry : scene.shapes->meshes)
      if (entry.shape == i) write_obj(folder / "terrain.obj", entry.mesh, scene.shapes->origin);
    MeshShape mesh;
    mesh.file = "terrain.obj";
    description.shapes[i].kind = mesh;
    description.shapes[i].transform = Matrix44d();
  }
  const std::filesystem::path path = folder / "launch.json";
  std::ofstream file(path);
  file << write_scene(description);
  if (!file.flush()) throw Error(ErrorKind::failure, {path.string(), 0, {}}, "cannot be written");
  return path;
}

/// From launch to file with the mesh, which both read as text; as users run them, on all cores.
Figure launch_figure(const MeasureContext& context, const SceneDescription& description, const Scene& scene) {
  context.progress("povray: launch to picture, " + scene.description.name);
  const Povray povray(context, scene, PovrayPicture::shaded, 0, "launch");
  const std::filesystem::path ours = write_scene_with_mesh_file(context.scratch, description, scene);
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const auto our_run = [&] {
    const ChildResult child =
        run_child({context.programs / "raytree", "render", ours, "--threads", std::to_string(threads), "-o",
                   context.scratch / "launch.png", "--quiet", "--progress", "none"},
                  context.scratch);
    require_success(child, "raytree render");
    return child.wall_seconds;
  };
  const PairedSpread pairs =
      measure_pairs([&] { return povray.run({"-A"}, threads).wall_seconds; }, our_run, few_pairs());
  return figure_of(
      "POV-Ray's time from launch to PNG / ours, " + picture_text(scene, threads), pairs.ratio, BoundKind::at_least,
      kLeastPovrayLaunch,
      fmt::format("{:.2f} s against {:.2f} s; the mesh is text for both (OBJ for us)", pairs.a.median, pairs.b.median));
}

/// Share of the pixels, away from edges, where the two see something at another distance or only one of them sees
/// anything, and the truth does not see what we see. Distances come from POV-Ray as levels of 16 bits: one and a half
/// of them are the tolerance.
Figure distance_figure(const MeasureContext& context, Scene& scene, const std::string& name) {
  context.progress("povray: distances, " + scene.description.name);
  RenderSettings settings = scene.description.render;
  settings.antialias = {Antialiasing::Method::none, 1};
  // Five samples to a pixel and axis, the middle one at its center: what lies between pixels is an edge too.
  constexpr int kFine = 5;
  const ImageDescription image = scene.description.image;
  scene.description.image = {kFine * image.width, kFine * image.height};
  scene.camera =
      Camera(scene.description.cameras.front(), kFine * image.width, kFine * image.height, scene.shapes->origin, {});
  const Film film = traced(scene, settings, {ChannelGroup::depth, ChannelGroup::object_id}).film;
  scene.description.image = image;
  scene.camera = Camera(scene.description.cameras.front(), image.width, image.height, scene.shapes->origin, {});
  const float* const depth = film.plane(ChannelGroup::depth, 0);
  const std::uint32_t* const object = film.id_plane(ChannelGroup::object_id);
  const int width = image.width, height = image.height, fine_width = film.window().width;
  const auto at_center = [&](int x, int y) {
    return static_cast<std::size_t>(kFine * y + kFine / 2) * fine_width +
           static_cast<std::size_t>(kFine * x + kFine / 2);
  };
  float farthest = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (object[at_center(x, y)] != 0) farthest = std::max(farthest, depth[at_center(x, y)]);
  // Nearness 0 must mean that nothing was hit.
  const double reach = 1.05 * farthest, tolerance = 1.5 * reach / kLargest16;

  const Povray povray(context, scene, PovrayPicture::nearness, reach, name);
  povray.run({"-A"});
  const Picture nearness = povray.picture();

  // A third opinion where the two differ: the scene's own shapes in double precision.
  std::optional<TriangleReference> truth;
  const auto truth_sides_with_us = [&](int x, int y, bool hit, float distance) {
    if (!truth) truth.emplace(*scene.shapes);
    Vec3f origin, direction;
    scene.camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, origin, direction);
    const ReferenceHit nearest =
        truth->nearest(Vec3d(origin), Vec3d(direction), std::numeric_limits<double>::infinity());
    return nearest.hit() == hit && (!hit || std::abs(nearest.distance - distance) <= tolerance);
  };

  std::size_t compared = 0, hit_by_one = 0, elsewhere = 0, theirs_alone = 0;
  double largest = 0;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const std::size_t i = at_center(x, y), pixel = static_cast<std::size_t>(y) * width + x;
      bool edge = false;
      for (int dy = -kFine; dy <= kFine; ++dy)
        for (int dx = -kFine; dx <= kFine; ++dx) {
          const std::size_t k = i + static_cast<std::size_t>(dy * fine_width + dx);
          // Within one object an edge is where the distance jumps by more than a slope would have it.
          edge |= object[k] != object[i] || std::abs(depth[k] - depth[i]) > 0.02f * depth[i];
        }
      if (edge) continue;
      ++compared;
      const bool hit = object[i] != 0;
      bool differs = hit != (nearness[pixel] > 0);
      hit_by_one += differs;
      if (hit && !differs) {
        const double off = std::abs((1 - nearness[pixel]) * reach - depth[i]);
        largest = std::max(largest, off);
        differs = off > tolerance;
        elsewhere += differs;
      }
      theirs_alone += differs && truth_sides_with_us(x, y, hit, depth[i]);
    }
  const double share = 100 * static_cast<double>(hit_by_one + elsewhere - theirs_alone) / static_cast<double>(compared);
  Figure figure = figure_of(
      "pixels away from edges where POV-Ray sees another distance, or only one of us a shape, and "
      "the truth in double precision is not with us, " +
          picture_text(scene, 1),
      {share, share, share, 1}, BoundKind::at_most, kMostPovrayDiffering,
      fmt::format("{} pixels compared; hit by one alone {}, at another distance {}; in {} of them the "
                  "truth sees what we see; largest difference {:.2g} of a tolerance of {:.2g} (a "
                  "level and a half of 16 bits)",
                  compared, hit_by_one, elsewhere, theirs_alone, largest, tolerance));
  figure.unit = "%";
  return figure;
}

}  // namespace

std::vector<Figure> measure_povray(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (const bool with_mesh : {false, true}) {
    // Preparing a description consumes its meshes: each scene gets one of its own.
    const auto described = [&] {
      SceneDescription description = with_mesh ? reference_scene_with_mesh() : reference_scene();
      // POV-Ray's clear glass casts no shadow.
      description.render.transparent_shadows = true;
      return description;
    };
    Scene scene = prepared(described());
    const std::string name = with_mesh ? "mesh" : "spheres";
    measure_tracing(context, scene, name, figures);
    figures.push_back(distance_figure(context, scene, name + "-distance"));
    if (with_mesh) figures.push_back(launch_figure(context, described(), scene));
    // Converged pictures take 81 and 256 samples a pixel: a smaller one serves.
    SceneDescription small = described();
    small.image = {320, 240};
    Scene small_scene = prepared(std::move(small));
    figures.push_back(adaptive_figure(context, small_scene, name + "-adaptive"));
  }
  return figures;
}

}  // namespace raytree::benchmarks
