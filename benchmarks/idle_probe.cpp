// Renders a scene that uses no optional feature, on one thread, and prints what identifies the picture. Built twice:
// on the renderer as it is (idle_probe), and on one compiled without optional features (idle_probe_minimal).
#include <cstdio>
#include <cstring>
#include <memory>

#include "renderer/render.h"

namespace {

using namespace raytree;

void add_shape(SceneDescription& scene, const char* material, ShapeKind kind) {
  ShapeDescription shape;
  shape.material = material;
  shape.kind = std::move(kind);
  scene.shapes.push_back(std::move(shape));
}

/// Plain colors, shadows, mirror and glass: what every scene may use, and nothing that can be switched off.
SceneDescription plain_scene() {
  SceneDescription scene;
  scene.image = {256, 256};
  scene.render.depth = 6;
  scene.render.antialias = {Antialiasing::Method::none, 1};
  scene.render.transparent_shadows = false;
  scene.background = ConstantBackground{Rgb(0.4f, 0.6f, 0.8f)};
  CameraDescription camera;
  camera.position = {0, 1.6, 6};
  camera.target = {0, 0.9, 0};
  scene.cameras.push_back(camera);
  LightDescription sun;
  sun.kind = DirectionalLight{{-1, -2, -1}};
  scene.lights.push_back(sun);
  MaterialDescription glass;
  glass.name = "glass";
  glass.diffuse = Rgb(0);
  glass.highlight = {Rgb(0.6f), 60};
  glass.reflection = Rgb(0.1f);
  glass.transmission = Rgb(0.85f);
  MaterialDescription mirror;
  mirror.name = "mirror";
  mirror.diffuse = Rgb(0.1f);
  mirror.reflection = Rgb(0.8f);
  scene.materials = {glass, mirror};
  add_shape(scene, "", TerrainShape{20000, 10, 0.6, 0.5, 1980});
  add_shape(scene, "glass", SphereShape{{-0.6, 1.5, 1.5}, 1});
  add_shape(scene, "mirror", SphereShape{{0.9, 1.0, -0.5}, 1});
  return scene;
}

}  // namespace

int main() {
  Warnings warnings;
  PrepareOptions prepare_options;
  prepare_options.threads = 1;
  const Scene scene = prepare(plain_scene(), prepare_options, warnings);
  RenderOptions options;
  options.threads = 1;
  const RenderResult result = render(scene, options);
  // FNV-1a over the pixels' bits: two programs that print the same made the same picture.
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (int c = 0; c < 3; ++c) {
    const float* plane = result.film.plane(ChannelGroup::color, c);
    for (int i = 0; i < 256 * 256; ++i) {
      std::uint32_t bits;
      std::memcpy(&bits, plane + i, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3u;
    }
  }
  std::printf("%016llx %llu rays\n", static_cast<unsigned long long>(hash),
              static_cast<unsigned long long>(result.statistics.total_rays()));
  return 0;
}
