#include "benchmarks/bench_standard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>

#include "benchmarks/reference_scenes.h"
#include "geometry/angle.h"
#include "renderer/builtin_scenes.h"
#include "renderer/mesh_scene.h"

namespace raytree::benchmarks {
namespace {

constexpr int kScatteredSpheres = 20000;

StandardScene builtin(const char* name, double weight, double seconds) {
  return {name, weight, seconds, [name](Warnings&) { return builtin_scene(name); }};
}

StandardScene terrain(std::int64_t triangles, const char* name, double weight, double seconds) {
  return {name, weight, seconds, [=](Warnings&) {
            SceneDescription scene = terrain_scene(triangles);
            scene.name = name;
            return scene;
          }};
}

SceneDescription scattered_spheres() {
  SceneDescription scene = trivial_scene();
  scene.name = "scattered spheres";
  scene.image = {1280, 960};
  scene.shapes.clear();
  scene.cameras[0].position = {0, 4, 18};
  scene.cameras[0].target = {0, 0, 0};
  std::mt19937 random(1980);
  const auto share = [&] { return static_cast<double>(random()) * 0x1p-32; };
  for (int i = 0; i < kScatteredSpheres; ++i) {
    ShapeDescription sphere;
    sphere.name = fmt::format("sphere {}", i);
    const double x = 16 * share() - 8, y = 8 * share() - 4, z = 16 * share() - 8;
    sphere.kind = SphereShape{{x, y, z}, 0.05 + 0.1 * share()};
    scene.shapes.push_back(std::move(sphere));
  }
  return scene;
}

/// A knotted torus of quads as the cage of a Catmull-Clark surface.
SceneDescription catmull_clark() {
  constexpr std::uint32_t kAround = 48, kAcross = 12;
  auto cage = std::make_shared<PolygonMesh>();
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double a = 2 * kPi * i / kAround, b = 2 * kPi * j / kAcross + 1.5 * a * 2;
      const double r = 3 + (1 + 0.25 * std::cos(3 * a)) * std::cos(b);
      cage->positions.push_back(Vec3f(Vec3d(r * std::cos(a), std::sin(b) + 0.6 * std::sin(3 * a), -r * std::sin(a))));
    }
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < kAcross; ++j)
      for (const auto& [di, dj] : {std::pair(0u, 0u), {1u, 0u}, {1u, 1u}, {0u, 1u}})
        cage->corners.push_back((i + di) % kAround * kAcross + (j + dj) % kAcross);
  cage->face_sizes.assign(std::size_t(kAround) * kAcross, 4);
  SceneDescription scene = mesh_scene(cage, "catmull-clark");
  scene.name = "catmull-clark";
  for (ShapeDescription& shape : scene.shapes)
    if (auto* mesh = std::get_if<MeshShape>(&shape.kind); mesh != nullptr && mesh->mesh == cage)
      mesh->subdivision = SubdivisionRules();
  scene.image = {1280, 960};
  return scene;
}

}  // namespace

std::vector<StandardScene> standard_scenes(const std::vector<std::string>& mesh_files) {
  std::vector<StandardScene> scenes;
  scenes.push_back(builtin("spd-balls", 1, 0.03));
  scenes.push_back(builtin("spd-tree", 1, 0.03));
  scenes.push_back({"scattered spheres", 1, 0.3, [](Warnings&) { return scattered_spheres(); }});
  scenes.push_back({"catmull-clark", 1, 0.5, [](Warnings&) { return catmull_clark(); }});
  scenes.push_back(builtin("forest", 1, 0.5));
  scenes.push_back(terrain(100'000, "terrain of 0.1 M", 1, 0.2));
  scenes.push_back(terrain(1'000'000, "terrain of 1 M", 2, 1));
  std::vector<std::string> files = mesh_files;
  std::error_code none;
  if (std::filesystem::is_regular_file(kDragonFile, none)) files.emplace_back(kDragonFile);
  for (const std::string& file : files)
    scenes.push_back({file, 2, 1, [file](Warnings& warnings) { return mesh_scene(file, warnings); }});
  scenes.push_back(terrain(10'000'000, "terrain of 10 M", 4, 9));
  return scenes;
}

}  // namespace raytree::benchmarks
