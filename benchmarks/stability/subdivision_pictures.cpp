#include "benchmarks/stability/subdivision_pictures.h"

#include <memory>
#include <utility>

#include "benchmarks/samples/cages.h"
#include "benchmarks/samples/scenes.h"
#include "benchmarks/stability/case_tools.h"

namespace raytree::benchmarks {
namespace {

constexpr int kSurfacePixels = 190;

CameraDescription surface_camera(SurfaceView view) {
  CameraDescription camera = samples::front_camera(3.4);
  camera.up = {0, 0, 1};
  switch (view) {
    case SurfaceView::of_cube:
      camera.position = {4, -6, 4.5};
      camera.height = 3.3;
      break;
    case SurfaceView::of_grid:
      camera.position = {1.5, 1.5, 10};
      camera.target = {1.5, 1.5, 0};
      camera.up = {0, 1, 0};
      break;
    case SurfaceView::of_fan:
      camera.position = {2, -4, 3.2};
      camera.target = {0, 0, 0.6};
      camera.height = 2.4;
      break;
  }
  return camera;
}

}  // namespace

ShapeDescription limit_shape(const PolygonMesh& cage, const SubdivisionRules& rules) {
  ShapeDescription shape = samples::mesh_shape(std::make_shared<PolygonMesh>(cage), "paint");
  std::get<MeshShape>(shape.kind).subdivision = rules;
  return shape;
}

ShapeDescription smooth_shape(PolygonMesh mesh) {
  mesh.normals.clear();
  mesh.normal_corners.clear();
  mesh.subdivision.reset();
  ShapeDescription shape =
      samples::mesh_shape(std::make_shared<PolygonMesh>(std::move(mesh)), "paint", NormalSource::smooth);
  shape.smoothing.emplace().crease_angle = 180;
  return shape;
}

ShapeDescription faces_apart(const PolygonMesh& cage) {
  PolygonMesh apart;
  std::size_t first = 0;
  for (const std::uint32_t size : cage.face_sizes) {
    apart.face_sizes.push_back(size);
    for (std::size_t i = first; i < first + size; ++i) {
      apart.corners.push_back(static_cast<std::uint32_t>(apart.positions.size()));
      apart.positions.push_back(cage.positions[cage.corners[i]]);
    }
    first += size;
  }
  return limit_shape(apart, {});
}

void add_surface_picture(const StabilityRun& run, StabilityResult& result, std::string caption, ShapeDescription shape,
                         SurfaceView view) {
  if (!run.pictures) return;
  SceneDescription scene = samples::dark_scene(kSurfacePixels, surface_camera(view));
  scene.ambient = Rgb(0.12f);
  scene.materials = {samples::material("paint", Rgb(0.65f))};
  scene.lights = {samples::directional_light(view == SurfaceView::of_grid ? Vec3d(0, 0, -1) : Vec3d(-0.5, 1, -1.3))};
  scene.shapes = {std::move(shape)};
  scene.render.antialias = {Antialiasing::Method::grid, 2};
  add_picture(run, result, std::move(caption), std::move(scene));
}

}  // namespace raytree::benchmarks
