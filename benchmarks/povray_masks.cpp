// Row povray-masks: POV-Ray as a renderer that shares no line with ours sees five scenes: which pixels show something,
// at which distance, and whether a light reaches it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "benchmarks/povray_run.h"
#include "benchmarks/reference_scenes.h"
#include "benchmarks/row_bounds.h"
#include "renderer/render.h"
#include "renderer/spd_scenes.h"

namespace raytree::benchmarks {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr std::int64_t kTerrainTriangles = 50'000;
/// Samples to a pixel and axis, the middle one at its center: what changes between them makes the pixel an edge.
constexpr int kFine = 5;

MaterialDescription white(const std::string& name) {
  MaterialDescription material;
  material.name = name;
  material.diffuse = Rgb(1);
  return material;
}

/// Cylinders, cones, discs and a plane, which no built-in scene holds together in their exact forms.
SceneDescription round_shapes() {
  SceneDescription scene;
  scene.name = "cones, cylinders and discs";
  CameraDescription camera;
  camera.position = {3, 5, 9};
  camera.target = {0, 0.8, 0};
  camera.field_of_view = 36;
  scene.cameras = {camera};
  LightDescription light;
  light.kind = PointLight{{-6, 9, 5}};
  scene.lights = {light};
  scene.materials = {white("white")};
  const auto add = [&](ShapeKind kind) {
    ShapeDescription& shape = scene.shapes.emplace_back();
    shape.name = "shape " + std::to_string(scene.shapes.size());
    shape.material = "white";
    shape.kind = std::move(kind);
  };
  add(PlaneShape{});
  add(ConeShape{{-2, 0, 0}, {-2, 2.2, 0}, 0.9, 0});
  add(ConeShape{{0.2, 0, -1.5}, {0.2, 1.8, -1.5}, 0.7, 0.7});
  add(DiscShape{{0.2, 1.8, -1.5}, {0, 1, 0}, 0.7});
  add(ConeShape{{2, 0, 0.4}, {2.4, 1.4, 0.2}, 0.9, 0.4});
  add(DiscShape{{0, 0.9, 1.4}, {0.3, 0.5, 1}, 0.6});
  add(SphereShape{{-0.9, 0.4, 2.2}, 0.4});
  return scene;
}

/// Opaque, white, flat, under its first light alone; small.
SceneDescription masked(SceneDescription scene) {
  scene.image = {kWidth, kHeight};
  scene.lights.resize(1);
  scene.ambient = Rgb();
  scene.background = ConstantBackground{};
  RenderSettings& render = scene.render;
  render.depth = 1;
  render.antialias = {Antialiasing::Method::none, 1};
  render.transparent_shadows = false;
  render.facets.shading = ShadingMethod::flat;
  if (scene.materials.empty()) scene.materials.push_back({});
  for (MaterialDescription& material : scene.materials) material = white(material.name);
  return scene;
}

std::vector<SceneDescription> scenes() {
  std::vector<SceneDescription> result;
  result.push_back(reference_scene());
  result.push_back(reference_scene_with_mesh());
  for (ShapeDescription& shape : result.back().shapes)
    if (auto* terrain = std::get_if<TerrainShape>(&shape.kind)) terrain->triangles = kTerrainTriangles;
  result.back().name = "spheres-1980 with a terrain of 50,000 triangles";
  result.push_back(round_shapes());
  result.push_back(spd_scene(SpdDatabase::gears, 3));
  result.push_back(spd_scene(SpdDatabase::rings, 3));
  for (SceneDescription& scene : result) scene = masked(std::move(scene));
  return result;
}

/// What our fine samples see.
struct FineView {
  Film film;
  int width;

  std::size_t center(int x, int y) const {
    return static_cast<std::size_t>(kFine * y + kFine / 2) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(kFine * x + kFine / 2);
  }
  std::uint32_t object(std::size_t i) const { return film.id_plane(ChannelGroup::object_id)[i]; }
  float depth(std::size_t i) const { return film.plane(ChannelGroup::depth, 0)[i]; }
  /// As a picture of 16 bits has it.
  bool lit(std::size_t i) const { return film.plane(ChannelGroup::color, 0)[i] * kLargest16 >= 0.5f; }

  /// Whether silhouettes, jumps of the distance or borders of shadows pass within a pixel of sample i.
  bool is_edge(std::size_t i) const {
    for (int dy = -kFine; dy <= kFine; ++dy)
      for (int dx = -kFine; dx <= kFine; ++dx) {
        const std::size_t k = i + static_cast<std::size_t>(dy * width + dx);
        if (object(k) != object(i) || lit(k) != lit(i) || std::abs(depth(k) - depth(i)) > 0.02f * depth(i)) return true;
      }
    return false;
  }
};

FineView fine_view(Scene& scene) {
  const ImageDescription image = scene.description.image;
  const CameraDescription& camera = scene.description.cameras.front();
  const auto set_size = [&](int factor) {
    scene.description.image = {factor * image.width, factor * image.height};
    scene.camera = Camera(camera, factor * image.width, factor * image.height, scene.shapes->origin, {});
  };
  set_size(kFine);
  RenderOptions options;
  options.channels = {ChannelGroup::color, ChannelGroup::depth, ChannelGroup::object_id};
  Film film = render(scene, options).film;
  set_size(1);
  return {std::move(film), kFine * image.width};
}

/// Differing pixels.
struct Differences {
  std::size_t silhouette = 0, distance = 0, shadow = 0;
  std::size_t any = 0;
};

Figure compare(const MeasureContext& context, Scene& scene) {
  context.progress("povray-masks: " + scene.description.name);
  const FineView ours = fine_view(scene);
  float farthest = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (ours.object(ours.center(x, y)) != 0) farthest = std::max(farthest, ours.depth(ours.center(x, y)));
  // Nearness 0 must mean that nothing was hit; distances come as levels of 16 bits.
  const double reach = 1.05 * farthest, tolerance = 1.5 * reach / kLargest16;
  const auto theirs = [&](PovrayPicture kind, const char* name) {
    const Povray povray(context, scene, kind, reach, name);
    povray.run({"-A"});
    return povray.picture();
  };
  const Picture nearness = theirs(PovrayPicture::nearness, "nearness"), light = theirs(PovrayPicture::lit, "lit");

  Differences away, along;  // from edges and along them
  std::size_t compared = 0, edges = 0, shadowed = 0;
  for (int y = 1; y + 1 < kHeight; ++y)
    for (int x = 1; x + 1 < kWidth; ++x) {
      const std::size_t i = ours.center(x, y),
                        pixel = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      const bool edge = ours.is_edge(i), hit = ours.object(i) != 0;
      const bool silhouette = hit != (nearness[pixel] > 0);
      const bool distance = hit && !silhouette && std::abs((1 - nearness[pixel]) * reach - ours.depth(i)) > tolerance;
      const bool shadow = ours.lit(i) != (light[pixel] > 0);
      ++(edge ? edges : compared);
      shadowed += !edge && hit && !ours.lit(i);
      Differences& sum = edge ? along : away;
      sum.silhouette += silhouette;
      sum.distance += distance;
      sum.shadow += shadow;
      sum.any += silhouette || distance || shadow;
    }
  const double share = 100 * static_cast<double>(away.any) / static_cast<double>(compared);
  Figure figure;
  figure.row = "povray-masks";
  figure.what = fmt::format("pixels away from edges that POV-Ray sees otherwise, {}, {}x{}", scene.description.name,
                            kWidth, kHeight);
  figure.unit = "%";
  figure.measured = {share, share, share, 1};
  figure.kind = BoundKind::at_most;
  figure.bound = kMostMaskDiffering;
  figure.note = fmt::format(
      "{} pixels compared, {} of them in shadow or turned away: {} differ in hit or miss, {} in distance (by more than "
      "{:.2g}), {} in light or shadow; of {} pixels along edges {}, {} and {}",
      compared, shadowed, away.silhouette, away.distance, tolerance, away.shadow, edges, along.silhouette,
      along.distance, along.shadow);
  return figure;
}

}  // namespace

std::vector<Figure> measure_povray_masks(const MeasureContext& context) {
  std::vector<Figure> figures;
  for (SceneDescription& description : scenes()) {
    Scene scene = prepared(std::move(description));
    figures.push_back(compare(context, scene));
  }
  return figures;
}

}  // namespace raytree::benchmarks
