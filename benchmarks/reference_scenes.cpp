#include "benchmarks/reference_scenes.h"

#include <memory>
#include <utility>

namespace raytree::benchmarks {
namespace {

void add_shape(SceneDescription& scene, const char* name, const char* material, ShapeKind kind,
               const Vec3d& shift = Vec3d(0, 0, 0)) {
  ShapeDescription shape;
  shape.name = name;
  shape.material = material;
  shape.kind = std::move(kind);
  shape.transform.translate(shift);
  scene.shapes.push_back(std::move(shape));
}

void add_camera(SceneDescription& scene, const Vec3d& position, const Vec3d& target, double field_of_view) {
  CameraDescription camera;
  camera.name = "main";
  camera.position = position;
  camera.target = target;
  camera.field_of_view = field_of_view;
  scene.cameras.push_back(camera);
}

void add_sun(SceneDescription& scene, const Vec3d& direction) {
  LightDescription sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{direction};
  scene.lights.push_back(sun);
}

}  // namespace

SceneDescription reference_scene() {
  SceneDescription scene;
  scene.name = "spheres-1980";
  scene.image = {1280, 960};
  scene.render.depth = 6;
  scene.background = GradientBackground{};
  add_camera(scene, {0, 1.6, 6}, {0, 0.9, 0}, 45);
  add_sun(scene, {-1, -2, -1});

  MaterialDescription floor;
  floor.name = "floor";
  CheckerPattern checker;
  checker.even = {0.9f, 0.1f, 0.1f};
  checker.odd = {0.9f, 0.85f, 0.1f};
  floor.diffuse = checker;
  MaterialDescription glass;
  glass.name = "glass";
  glass.diffuse = Rgb(0);
  glass.highlight = {Rgb(0.6f), 60};
  glass.reflection = Rgb(0.1f);
  glass.transmission = Rgb(0.85f);
  glass.index_of_refraction = 1.3;
  MaterialDescription mirror;
  mirror.name = "mirror";
  mirror.diffuse = Rgb(0.1f);
  mirror.highlight = {Rgb(0.6f), 60};
  mirror.reflection = Rgb(0.8f);
  scene.materials = {floor, glass, mirror};

  MeshShape board;
  board.normals = NormalSource::flat;
  board.mesh = std::make_shared<PolygonMesh>();
  board.mesh->positions.assign({Vec3f(-8, 0, -16), Vec3f(-8, 0, 4), Vec3f(8, 0, 4), Vec3f(8, 0, -16)});
  board.mesh->corners.assign({0u, 1u, 2u, 0u, 2u, 3u});
  add_shape(scene, "board", "floor", board);
  add_shape(scene, "glass", "glass", SphereShape{{-0.6, 1.5, 1.5}, 1});
  add_shape(scene, "mirror", "mirror", SphereShape{{0.9, 1.0, -0.5}, 1});
  return scene;
}

SceneDescription reference_scene_with_mesh() {
  SceneDescription scene = reference_scene();
  scene.name += " with a terrain of 1M triangles";
  TerrainShape terrain;
  terrain.triangles = 1'000'000;
  terrain.size = 14;
  terrain.height = 3;
  add_shape(scene, "terrain", "", terrain, {0, 0, -9});
  return scene;
}

SceneDescription terrain_scene(std::int64_t triangles) {
  SceneDescription scene;
  scene.name = kTerrainSceneName;
  scene.image = {1920, 1080};
  scene.background = GradientBackground{};
  add_camera(scene, {0, 4.5, 8}, {0, 0.6, 0}, 40);
  add_sun(scene, {-1, -1, -0.5});
  TerrainShape terrain;
  terrain.triangles = triangles;
  add_shape(scene, "terrain", "", terrain);
  return scene;
}

SceneDescription trivial_scene() {
  SceneDescription scene;
  scene.name = "trivial";
  scene.image = {64, 64};
  add_camera(scene, {0, 0, 5}, {0, 0, 0}, 40);
  add_sun(scene, {-1, -1, -1});
  add_shape(scene, "ball", "", SphereShape{});
  return scene;
}

Scene prepared(SceneDescription description) {
  Warnings warnings;
  return prepare(std::move(description), PrepareOptions(), warnings);
}

}  // namespace raytree::benchmarks
