// Small scenes whose picture is known, made of few calls: what tests and the stability suite describe their own with.
#pragma once

#include <Imath/ImathMatrix.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "geometry/angle.h"
#include "renderer/film.h"
#include "renderer/scene_description.h"

namespace raytree::samples {

inline std::size_t pixel_index(const Film& film, int x, int y) {
  return static_cast<std::size_t>(y - film.window().y0) * static_cast<std::size_t>(film.window().width) +
         static_cast<std::size_t>(x - film.window().x0);
}

inline Rgb color_at(const Film& film, int x, int y, ChannelGroup group = ChannelGroup::color) {
  const std::size_t i = pixel_index(film, x, y);
  return {film.plane(group, 0)[i], film.plane(group, 1)[i], film.plane(group, 2)[i]};
}

inline MaterialDescription material(const std::string& name, ColorPattern diffuse) {
  MaterialDescription result;
  result.name = name;
  result.diffuse = diffuse;
  return result;
}

inline ShapeDescription shape(ShapeKind kind, const std::string& material_name, const std::string& name = "shape") {
  ShapeDescription result;
  result.name = name;
  result.material = material_name;
  result.kind = std::move(kind);
  result.where = {"test.json", 1, "shapes." + name};
  return result;
}

inline LightDescription directional_light(const Vec3d& travels, Rgb color = Rgb(1)) {
  LightDescription light;
  light.color = color;
  light.kind = DirectionalLight{travels};
  return light;
}

inline LightDescription point_light(const Vec3d& position, Rgb color = Rgb(1)) {
  LightDescription light;
  light.color = color;
  light.kind = PointLight{position};
  return light;
}

inline LightDescription light_of(std::variant<DirectionalLight, PointLight, SpotLight> kind, Rgb color = Rgb(1)) {
  LightDescription light;
  light.color = color;
  light.kind = std::move(kind);
  return light;
}

/// Looks along -z from `distance` at a window of height `height` about the origin: pixel (x, y)'s center lies at
/// ((x + .5 - size / 2) height / size, (size / 2 - y - .5) height / size).
inline CameraDescription front_camera(double height, double distance = 10) {
  CameraDescription camera;
  camera.projection = CameraDescription::Projection::orthographic;
  camera.position = {0, 0, distance};
  camera.target = {0, 0, 0};
  camera.height = height;
  return camera;
}

/// No light, no ambient light, black background, nothing cut, one sample at each pixel's center, square image: each
/// test adds what it is about.
inline SceneDescription dark_scene(int size, const CameraDescription& camera) {
  SceneDescription scene;
  scene.name = "test.json";
  scene.image = {size, size};
  scene.cameras = {camera};
  scene.ambient = Rgb(0);
  scene.background = ConstantBackground{Rgb(0)};
  scene.render.cutoff = 0;
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

/// White things on black, whose radiance is their share of the pixel; one pixel is one unit, the frame's middle the
/// origin.
inline SceneDescription white_on_black(int size) {
  SceneDescription scene = dark_scene(size, front_camera(size));
  scene.render.antialias.method = Antialiasing::Method::whitted;
  scene.ambient = Rgb(1);
  scene.materials = {material("white", Rgb(1))};
  return scene;
}

// --- meshes ---

inline std::shared_ptr<PolygonMesh> triangles(const std::vector<Vec3f>& positions,
                                              const std::vector<std::uint32_t>& corners) {
  auto mesh = std::make_shared<PolygonMesh>();
  mesh->positions.assign(positions.begin(), positions.end());
  mesh->corners.assign(corners.begin(), corners.end());
  return mesh;
}

inline ShapeDescription mesh_shape(std::shared_ptr<PolygonMesh> mesh, const std::string& material_name,
                                   NormalSource normals = NormalSource::flat, const std::string& name = "mesh") {
  MeshShape kind;
  kind.normals = normals;
  kind.mesh = std::move(mesh);
  return shape(std::move(kind), material_name, name);
}

/// Axis-aligned box, twelve triangles that face out.
inline std::shared_ptr<PolygonMesh> box_mesh(const Vec3f& low, const Vec3f& high) {
  std::vector<Vec3f> positions;
  for (int i = 0; i < 8; ++i)
    positions.push_back({(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z});
  return triangles(positions, {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                               2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6});
}

/// Sphere of `columns` x `rows` cells about the origin, closed, faces out.
inline std::shared_ptr<PolygonMesh> globe_mesh(double radius, int columns, int rows) {
  std::vector<Vec3f> positions{Vec3f(0, static_cast<float>(radius), 0)};
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double polar = kPi * row / rows, azimuth = 2 * kPi * column / columns;
      positions.emplace_back(
          Vec3d(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)) * radius);
    }
  positions.emplace_back(0.0f, static_cast<float>(-radius), 0.0f);
  const auto at = [&](int row, int column) {
    return static_cast<std::uint32_t>(1 + (row - 1) * columns + column % columns);
  };
  const auto last = static_cast<std::uint32_t>(positions.size() - 1);
  std::vector<std::uint32_t> corners;
  for (int column = 0; column < columns; ++column) {
    corners.insert(corners.end(), {0, at(1, column), at(1, column + 1)});
    for (int row = 1; row + 1 < rows; ++row)
      corners.insert(corners.end(), {at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column),
                                     at(row + 1, column + 1), at(row, column + 1)});
    corners.insert(corners.end(), {last, at(rows - 1, column + 1), at(rows - 1, column)});
  }
  return triangles(positions, corners);
}

/// (cells + 1)^2 vertices in the plane z = 0 about the origin, `spacing` apart, facing +z; heights by `height(i, j)`.
template <class Height>
std::shared_ptr<PolygonMesh> grid_mesh(int cells, double spacing, Height&& height) {
  std::vector<Vec3f> positions;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      positions.emplace_back(Vec3d((i - cells / 2.0) * spacing, (j - cells / 2.0) * spacing, height(i, j)));
  std::vector<std::uint32_t> corners;
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j) * row + static_cast<std::uint32_t>(i);
      corners.insert(corners.end(), {a, a + 1, a + row + 1, a, a + row + 1, a + row});
    }
  return triangles(positions, corners);
}

inline Matrix44d translation(const Vec3d& offset) {
  Matrix44d m;
  m.translate(offset);
  return m;
}
inline Matrix44d scaling(const Vec3d& factors) {
  Matrix44d m;
  m.scale(factors);
  return m;
}

}  // namespace raytree::samples
