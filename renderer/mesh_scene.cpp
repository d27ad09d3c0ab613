#include "renderer/mesh_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <variant>

#include "geometry/angle.h"
#include "geometry/mesh_file.h"
#include "geometry/patch_reader.h"
#include "geometry/patch_surface.h"
#include "geometry/tessellation.h"
#include "renderer/mesh_materials.h"
#include "renderer/patch_shape.h"
#include "renderer/suggestion.h"

namespace raytree {
namespace {

constexpr double kFieldOfView =
    28;  // degrees, vertical: a portrait lens; wider ones distort an object that fills the frame

double radians(double degrees) { return degrees * kDegree; }

/// The view's axes; the camera looks along `forward`.
struct ViewAxes {
  Vec3d right, up, forward;
};

ViewAxes view_axes(double azimuth, double elevation) {
  const double a = radians(azimuth), e = radians(elevation);
  const Vec3d forward = -Vec3d(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  const Vec3d right = forward.cross(Vec3d(0, 1, 0)).normalized();
  return {right, right.cross(forward), forward};
}

/// A three-quarter view from slightly above. What lies flat is seen from higher up, and what is thin from right to left
/// rather from its broad side.
ViewAxes choose_view(const Vec3d& extent) {
  const double across = std::max(extent.x, extent.z);
  const double flatness = across > 0 ? std::clamp(1 - extent.y / (0.5 * across), 0.0, 1.0) : 0;
  const double elevation = 13 + 22 * flatness;
  const double azimuth = extent.x < 0.4 * extent.z ? 62 : 28;
  return view_axes(azimuth, elevation);
}

/// The greatest reach of the vertices against the four side planes of the view frustum, relative to `center`.
struct Reach {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double left = kNone, right = -kNone, bottom = kNone, top = -kNone, nearest = kNone;

  void extend(const Vec3d& point, const ViewAxes& axes, double slope_x, double slope_y) {
    const double x = point.dot(axes.right), y = point.dot(axes.up), z = point.dot(axes.forward);
    left = std::min(left, x + slope_x * z);
    right = std::max(right, x - slope_x * z);
    bottom = std::min(bottom, y + slope_y * z);
    top = std::max(top, y - slope_y * z);
    nearest = std::min(nearest, z);
  }
  void extend(const Reach& o) {
    left = std::min(left, o.left), right = std::max(right, o.right);
    bottom = std::min(bottom, o.bottom), top = std::max(top, o.top);
    nearest = std::min(nearest, o.nearest);
  }
};

/// Folds `extend(value, position)` over the positions that faces use, relative to the mesh's origin: a stray vertex
/// must not push the object out of the frame. Only minima and maxima are taken, so the way the range is split does not
/// show.
template <class Value, class Extend, class Join>
Value over_corners(const PolygonMesh& mesh, const Value& none, const Extend& extend, const Join& join) {
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_reduce(
      Range(0, mesh.corners.size(), 65536), none,
      [&](const Range& range, Value value) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
          extend(value, Vec3d(mesh.positions[mesh.corners[i]]));
        return value;
      },
      join);
}

Bounds3d used_bounds(const PolygonMesh& mesh) {
  Bounds3d box = over_corners(
      mesh, Bounds3d(), [](Bounds3d& part, const Vec3d& point) { part.extendBy(point); },
      [](Bounds3d a, const Bounds3d& b) {
        a.extendBy(b);
        return a;
      });
  return {box.min + mesh.origin, box.max + mesh.origin};
}

/// The camera nearest to the mesh that has all its vertices in view. A point at (x, y, z) of the view's axes is seen
/// from c when |x - c.x| <= slope (z - c.z), so the vertices' extremes of x + slope z and x - slope z bound c.z
/// exactly.
CameraDescription fitted_camera(const PolygonMesh& mesh, const Bounds3d& box, const ImageDescription& image) {
  const ViewAxes axes = choose_view(box.size());
  const double half_height = std::tan(radians(kFieldOfView) / 2);
  const double used = 1 - 2 * kMeshSceneMargin;
  const double slope_y = half_height * used, slope_x = slope_y * image.width / image.height;

  const Vec3d center = box.center();
  const Vec3d shift = mesh.origin - center;
  const Reach reach = over_corners(
      mesh, Reach(), [&](Reach& part, const Vec3d& point) { part.extend(point + shift, axes, slope_x, slope_y); },
      [](Reach x, const Reach& y) {
        x.extend(y);
        return x;
      });

  const double depth_x = (reach.left - reach.right) / (2 * slope_x);
  const double depth_y = (reach.bottom - reach.top) / (2 * slope_y);
  // A point, or a line seen end on, has no width to fit: any place well before it serves.
  const double diagonal = box.size().length();
  const double least_distance = diagonal > 0 ? 0.5 * diagonal : 1;
  const double depth = std::min({depth_x, depth_y, reach.nearest - least_distance * 1e-3});
  const Vec3d position = center + axes.right * ((reach.left + reach.right) / 2) +
                         axes.up * ((reach.bottom + reach.top) / 2) + axes.forward * depth;

  CameraDescription camera;
  camera.name = "front";
  camera.position = position;
  camera.target = position + axes.forward * std::max(-depth, least_distance);
  camera.field_of_view = kFieldOfView;
  return camera;
}

Vec3d towards(const ViewAxes& axes, double right, double up, double back) {
  return (axes.right * right + Vec3d(0, up, 0) - Vec3d(axes.forward.x, 0, axes.forward.z).normalized() * back)
      .normalized();
}

/// The scene without its object, which is to be the first shape: all around what fills the space of `mesh`. The first
/// material is meant for it.
SceneDescription surroundings(const PolygonMesh& mesh, const std::string& name, const ImageDescription& image);

/// z up to y up: (x, y, z) becomes (x, z, -y).
Matrix44d z_up_to_y_up() { return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}; }

/// What a surface fills, closely enough to choose a view.
PolygonMesh outline(const ParametricSurface& surface, const Matrix44d& transform) {
  constexpr int kRate = 8;
  TriangleMesh triangles = tessellate_uniformly(surface, kRate);
  PolygonMesh mesh;
  mesh.origin = triangles.origin * transform;
  mesh.corners = std::move(triangles.corners);
  mesh.positions = std::move(triangles.positions);
  for (Vec3f& p : mesh.positions) {
    Vec3d turned;
    transform.multDirMatrix(Vec3d(p), turned);
    p = Vec3f(turned);
  }
  return mesh;
}

SceneDescription patch_scene(const std::string& path, const ImageDescription& image) {
  PatchesShape shape;
  shape.file = path;
  ShapeDescription object;
  object.name = "object";
  object.where = {path, 0, ""};
  object.transform = z_up_to_y_up();
  Warnings said_later;  // prepare() reads the file again
  const PatchSurface surface(surface_patches(shape, "", object.where, said_later), surface_options(shape), object.where,
                             said_later);
  SceneDescription scene = surroundings(outline(surface, object.transform), path, image);
  object.material = scene.materials.front().name;
  object.kind = std::move(shape);
  scene.shapes.insert(scene.shapes.begin(), std::move(object));
  return scene;
}

}  // namespace

SceneDescription mesh_scene(const std::string& path, Warnings& warnings, const ImageDescription& image) {
  if (is_patch_file_name(path)) return patch_scene(path, image);
  auto mesh = std::make_shared<PolygonMesh>(read_mesh_file(path, warnings));
  if (!mesh->material_libraries.empty() && !has_material_library(*mesh, path)) {
    const std::size_t more = mesh->material_libraries.size() - 1;
    warnings.push_back({{path, 0, {}},
                        "material library " + in_quotes(mesh->material_libraries.front()) + " is not there" +
                            (more > 0 ? ", nor are the " + std::to_string(more) + " after it" : "")});
  }
  return mesh_scene(std::move(mesh), path, image);
}

SceneDescription mesh_scene(std::shared_ptr<PolygonMesh> mesh, const std::string& name, const ImageDescription& image) {
  if (mesh->face_count() == 0)
    throw Error(ErrorKind::bad_input, {name, 0, ""}, "the mesh has no faces: there is nothing to render");
  SceneDescription scene = surroundings(*mesh, name, image);
  ShapeDescription object;
  object.name = "object";
  MeshShape shape;
  // A file's own materials count where its libraries are there; faces without one are clay in any case.
  if (has_material_library(*mesh, name))
    shape.file = name;
  else
    object.material = scene.materials.front().name;
  shape.crease_angle = 60;
  shape.mesh = std::move(mesh);
  object.kind = std::move(shape);
  object.where = {name, 0, ""};
  scene.shapes.insert(scene.shapes.begin(), std::move(object));
  return scene;
}

namespace {

SceneDescription surroundings(const PolygonMesh& mesh, const std::string& name, const ImageDescription& image) {
  const Bounds3d box = used_bounds(mesh);
  const ViewAxes axes = choose_view(box.size());
  const double diagonal = std::max(box.size().length(), std::numeric_limits<double>::min());

  SceneDescription scene;
  scene.name = name;
  scene.title = std::filesystem::path(name).filename().string();
  scene.image = image;
  scene.render.depth = 4;
  scene.cameras = {fitted_camera(mesh, box, image)};

  // A warm key that rakes across the front, so that relief shows; a weak fill against it, so that shadows keep form; a
  // cool rim from behind, which parts the object from the ground.
  const Vec3d to_key = towards(axes, -1.1, 1.1, 0.35), to_fill = towards(axes, 0.9, 0.45, 0.5),
              to_rim = towards(axes, 0.8, 0.55, -0.8);
  scene.ambient = Rgb(0.11f, 0.12f, 0.15f);
  scene.lights = {{"key", Rgb(1.15f, 1.02f, 0.85f), DirectionalLight{-to_key}},
                  {"fill", Rgb(0.12f, 0.14f, 0.18f), DirectionalLight{-to_fill}},
                  {"rim", Rgb(0.50f, 0.60f, 0.80f), DirectionalLight{-to_rim}}};

  MaterialDescription clay;  // fired and glazed: it mirrors as glass does, little from the front and all at the rim
  clay.name = "clay";
  clay.diffuse = Rgb(0.55f, 0.22f, 0.11f);
  clay.highlight = {Rgb(0.25f), 50};
  clay.reflection = Rgb(1);
  clay.index_of_refraction = 1.5;
  clay.fresnel = true;

  MaterialDescription floor;
  floor.name = "ground";
  const Rgb floor_color(0.06f, 0.065f, 0.08f);
  floor.diffuse = floor_color;
  floor.reflection = Rgb(0.1f);
  scene.materials = {clay, floor};

  // At the horizon the ground mirrors the horizon: with h = local + k_s h the two meet without an edge. The bright top
  // is out of the picture; the glaze shows it.
  Rgb irradiance = scene.ambient;
  for (const LightDescription& light : scene.lights)
    irradiance += light.color * static_cast<float>(-std::get<DirectionalLight>(light.kind).direction.y);
  const Rgb local = floor_color * irradiance;
  const Rgb horizon = local * (1 / (1 - floor.reflection.r));
  scene.background = GradientBackground{local, horizon, Rgb(0.60f, 0.65f, 0.75f)};

  // The ground touches the lowest vertex; what lies flat on it stays clear of it by a little, since two surfaces at one
  // place have no front.
  const double gap = box.size().y < 1e-3 * diagonal ? 2e-3 * diagonal : 1e-6 * diagonal;
  ShapeDescription ground;
  ground.name = "ground";
  ground.material = floor.name;
  const Vec3d middle = box.center();
  ground.kind = PlaneShape{{middle.x, box.min.y - gap, middle.z}, {0, 1, 0}};
  scene.shapes = {std::move(ground)};
  return scene;
}

}  // namespace

}  // namespace raytree
