#include "benchmarks/stability/faceted_scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_tools.h"
#include "geometry/angle.h"

namespace raytree::benchmarks::facets {

ShapeDescription painted(ShapeKind kind, const std::string& name) {
  return samples::shape(std::move(kind), "paint", name);
}

ShapeDescription painted_mesh(std::shared_ptr<PolygonMesh> mesh, NormalSource normals) {
  MeshShape kind;
  kind.normals = normals;
  kind.mesh = std::move(mesh);
  return painted(std::move(kind));
}

LightDescription sunlight(const Vec3d& travels) {
  LightDescription light;
  light.kind = DirectionalLight{travels};
  return light;
}

ShapeDescription faceted_cylinder(int sides, ShadingMethod shading, double turned_degrees) {
  ConeShape cone;
  cone.base = {0, -2, 0}, cone.apex = {0, 2, 0};
  cone.base_radius = cone.apex_radius = 1;
  cone.sides = sides;
  ShapeDescription result = painted(cone);
  result.shading = shading;
  result.transform.rotate(Vec3d(0, turned_degrees * kDegree, 0));
  return result;
}

ShapeDescription faceted_sphere(int sides, int stacks, ShadingMethod shading) {
  SphereShape sphere;
  sphere.sides = sides, sphere.stacks = stacks;
  ShapeDescription result = painted(sphere);
  result.shading = shading;
  return result;
}

std::shared_ptr<PolygonMesh> flat_grid(int cells, double spacing) {
  auto mesh = std::make_shared<PolygonMesh>();
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh->positions.push_back(Vec3f(Vec3d((i - cells / 2.0) * spacing, (j - cells / 2.0) * spacing, 0)));
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      mesh->corners.insert(mesh->corners.end(), {a, a + 1, a + row + 1, a, a + row + 1, a + row});
    }
  return mesh;
}

SceneDescription headlit_scene(ShapeDescription shape, int width, int height, double window) {
  SceneDescription scene = samples::dark_scene(width, samples::front_camera(window));
  scene.image = {width, height};
  scene.materials = {samples::material("paint", Rgb(1))};
  scene.lights = {sunlight({0, 0, -1})};
  scene.shapes = {std::move(shape)};
  return scene;
}

SceneDescription highlit_scene(ShapeDescription shape, int width, int height, double window, double exponent) {
  SceneDescription scene = headlit_scene(std::move(shape), width, height, window);
  scene.materials[0].diffuse = Rgb(0);
  scene.materials[0].highlight.weight = Rgb(1);
  scene.materials[0].highlight.exponent = exponent;
  scene.render.highlights = HighlightForm::halfway;
  return scene;
}

Film film_of(SceneDescription scene, const StabilityRun& run, const ChannelSet& channels) {
  return rendered_for(run, std::move(scene), channels).film;
}

std::vector<float> green_of(SceneDescription scene, const StabilityRun& run) {
  const std::size_t pixels = std::size_t(scene.image.width) * std::size_t(scene.image.height);
  const Film film = film_of(std::move(scene), run);
  const float* plane = film.plane(ChannelGroup::color, 1);
  return {plane, plane + pixels};
}

float largest_of(const std::vector<float>& values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, value);
  return largest;
}

void add_picture(StabilityResult& result, const StabilityRun& run, std::string caption, SceneDescription scene,
                 int width, int height) {
  if (!run.pictures) return;
  scene.image = {width, height};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  benchmarks::add_picture(run, result, std::move(caption), std::move(scene));
}

void add_gray_picture(StabilityResult& result, const StabilityRun& run, std::string caption,
                      const std::vector<float>& values, int width, int height) {
  if (!run.pictures) return;
  std::vector<float> rgb;
  for (const float value : values) rgb.insert(rgb.end(), {value, value, value});
  const DisplayTransform transform(stability_display());
  transform.apply(rgb.data(), static_cast<std::int64_t>(values.size()));
  DisplayImage image;
  image.width = width, image.height = height;
  image.display = transform.display(), image.view = transform.view();
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < values.size(); ++i)
      image.planes[c].push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(rgb[3 * i + c], 0.0f, 1.0f))));
  result.pictures.push_back({std::move(caption), std::move(image)});
}

StabilityFigure predicted_figure(std::string method, std::string quantity, double measured, double predicted,
                                 double error, std::string known, StabilityExpectation expectation) {
  return {std::move(method), std::move(quantity), measured,   predicted - error,
          predicted + error, std::move(known),    expectation};
}

}  // namespace raytree::benchmarks::facets
