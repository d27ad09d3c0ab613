#include "benchmarks/reference_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "renderer/builtin_scenes.h"
#include "renderer/mesh_scene.h"
#include "renderer/scene_reader.h"

namespace raytree::benchmarks {
namespace {

void add_shape(SceneDescription& scene, const char* name, ShapeKind kind, const Vec3d& shift) {
  ShapeDescription shape;
  shape.name = name;
  shape.kind = std::move(kind);
  shape.transform.translate(shift);
  scene.shapes.push_back(std::move(shape));
}

}  // namespace

SceneDescription reference_scene() {
  SceneDescription scene = builtin_scene("spheres-1980");
  scene.image = {1280, 960};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

SceneDescription reference_scene_with_mesh() {
  SceneDescription scene = reference_scene();
  scene.name += " with a terrain of 1M triangles";
  TerrainShape terrain;
  terrain.triangles = 1'000'000;
  terrain.size = 12;
  terrain.height = 2.5;
  add_shape(scene, "terrain", terrain, {0, 0, -8});
  return scene;
}

SceneDescription terrain_scene(std::int64_t triangles) {
  SceneDescription scene = builtin_scene(kTerrainSceneName);
  scene.image = {1920, 1080};
  set_scene_value(scene, kTerrainCountPath, std::to_string(triangles));
  return scene;
}

SceneDescription reference_mesh_alone() {
  SceneDescription scene = reference_scene_with_mesh();
  std::erase_if(scene.shapes, [](const ShapeDescription& shape) {
    return !std::holds_alternative<MeshShape>(shape.kind) && !std::holds_alternative<TerrainShape>(shape.kind);
  });
  scene.name += ", triangles alone";
  return scene;
}

SceneDescription bare_terrain(std::int64_t triangles) {
  SceneDescription scene = terrain_scene(triangles);
  scene.name = fmt::format("terrain of {} triangles, no lake, from above", triangles);
  scene.image = {800, 600};
  std::erase_if(scene.shapes, [](const ShapeDescription& shape) { return shape.name == "water"; });
  CameraDescription& camera = scene.cameras[0];
  camera.position = {0, 7, 3.5}, camera.target = {0, 0.6, 0.3}, camera.field_of_view = 45;
  return scene;
}

SceneDescription scattered_triangles(int count) {
  auto mesh = std::make_shared<PolygonMesh>();
  std::mt19937 random(1980);
  const auto within = [&](double half) { return half * (2 * 0x1p-32 * static_cast<double>(random()) - 1); };
  const double half = 0.6 * std::cbrt(8.0 / count);  // of the box that holds a triangle; the cube's is 1
  for (int i = 0; i < count; ++i) {
    const double x = within(1), y = within(1), z = within(1);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double dx = within(half), dy = within(half), dz = within(half);
      mesh->positions.push_back(Vec3f(Vec3d(x + dx, y + dy, z + dz)));
      mesh->corners.push_back(3 * static_cast<std::uint32_t>(i) + k);
    }
  }
  mesh->face_sizes.assign(static_cast<std::size_t>(count), 3);
  SceneDescription scene = mesh_scene(mesh, "scattered");
  scene.name = fmt::format("{} scattered triangles", count);
  scene.image = {1280, 960};
  return scene;
}

SceneDescription dented_ball(std::int64_t triangles) {
  const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 12)));
  const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  auto mesh = std::make_shared<PolygonMesh>();
  for (int side = 0; side < 6; ++side) {
    const double sign = side < 3 ? 1 : -1;
    const Vec3d &out = axes[side % 3], &right = axes[(side + 1) % 3], &up = axes[(side + 2) % 3];
    const auto first = static_cast<std::uint32_t>(mesh->positions.size());
    for (std::uint32_t j = 0; j <= cells; ++j)
      for (std::uint32_t i = 0; i <= cells; ++i) {
        const Vec3d point = (out + right * (2.0 * i / cells - 1) + up * (2.0 * j / cells - 1)) * sign;
        const Vec3d at = point / point.length();
        const double dents = std::sin(7 * at.x) * std::sin(6 * at.y + 1) * std::sin(8 * at.z + 2);
        mesh->positions.push_back(Vec3f(at * (1 + 0.1 * dents)));
      }
    for (std::uint32_t j = 0; j < cells; ++j)
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t corner = first + j * (cells + 1) + i, above = corner + cells + 1;
        // Outward on either side of the cube: the sign turns a side's two directions and its normal alike.
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          mesh->corners.push_back(a);
          mesh->corners.push_back(sign > 0 ? b : c);
          mesh->corners.push_back(sign > 0 ? c : b);
        };
        add(corner, corner + 1, above + 1);
        add(corner, above + 1, above);
      }
  }
  mesh->face_sizes.assign(mesh->corners.size() / 3, 3);
  SceneDescription scene = mesh_scene(mesh, "ball");
  scene.name = fmt::format("dented ball of {} triangles", mesh->face_sizes.size());
  std::erase_if(scene.shapes, [](const ShapeDescription& shape) { return shape.name != "object"; });
  scene.image = {800, 600};
  CameraDescription& camera = scene.cameras[0];
  camera.position = {0, 0, 3.5}, camera.target = {0, 0, 0}, camera.field_of_view = 50;
  return scene;
}

SceneDescription instances_scene(int edge) {
  SceneDescription scene;
  scene.name = "instances";
  scene.image = {1280, 960};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  CameraDescription camera;
  camera.name = "main";
  camera.position = Vec3d(-0.3, 0.4, 1.3) * edge;
  camera.target = {0, 0, 0};
  scene.cameras.push_back(camera);
  LightDescription sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{{-1, -1, -1}};
  scene.lights.push_back(sun);
  GroupDescription group;
  group.name = "hill";
  TerrainShape terrain;
  terrain.triangles = 1'000'000;
  terrain.size = 1;
  terrain.height = 0.4;
  ShapeDescription hill;
  hill.name = "hill";
  hill.kind = terrain;
  group.shapes.push_back(hill);
  scene.groups.push_back(group);
  for (int z = 0; z < edge; ++z)
    for (int x = 0; x < edge; ++x) {
      ShapeDescription use;
      use.name = fmt::format("hill {} {}", x, z);
      use.kind = InstanceShape{"hill"};
      Matrix44d scale, turn, place;
      scale.setScale(1.1 + 0.07 * ((3 * x + 5 * z) % 7));
      turn.rotate(Vec3d(0.05 * ((x + 2 * z) % 5), 0.7 * x + 1.3 * z, 0));
      place.setTranslation(Vec3d(x - edge / 2, 0.03 * ((7 * x + 3 * z) % 11), z - edge / 2));
      use.transform = scale * turn * place;
      scene.shapes.push_back(use);
    }
  return scene;
}

SceneDescription trivial_scene() {
  SceneDescription scene;
  scene.name = "trivial";
  scene.image = {64, 64};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  CameraDescription camera;
  camera.name = "main";
  scene.cameras.push_back(camera);
  LightDescription sun;
  sun.name = "sun";
  sun.kind = DirectionalLight{{-1, -1, -1}};
  scene.lights.push_back(sun);
  add_shape(scene, "ball", SphereShape{}, {0, 0, 0});
  return scene;
}

std::string picture_text(const Scene& scene, int threads) {
  return fmt::format("{}, {}x{}, {} thread{}", scene.description.name, scene.description.image.width,
                     scene.description.image.height, threads, threads == 1 ? "" : "s");
}

Scene prepared(SceneDescription description) {
  Warnings warnings;
  return prepare(std::move(description), PrepareOptions(), warnings);
}

}  // namespace raytree::benchmarks
