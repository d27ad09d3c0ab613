// Scenes of one round shape made of facets, seen from straight ahead: what the tests of shading share.
#pragma once

#include <cmath>

#include "geometry/angle.h"
#include "renderer/scene_description.h"
#include "tests/renderer/test_scenes.h"

namespace raytree::test {

/// An open cylinder about y, radius 1, 4 high, one of its edges toward x = 1 before it is turned.
inline ShapeDescription faceted_cylinder(int sides, ShadingMethod shading, double turned_degrees = 0) {
  ConeShape cone;
  cone.base = {0, -2, 0}, cone.apex = {0, 2, 0};
  cone.base_radius = cone.apex_radius = 1;
  cone.sides = sides;
  ShapeDescription result = shape(cone, "paint");
  result.shading = shading;
  result.transform.rotate(Vec3d(0, turned_degrees * kDegree, 0));
  return result;
}

inline ShapeDescription faceted_sphere(int sides, int stacks, ShadingMethod shading) {
  SphereShape sphere;
  sphere.sides = sides, sphere.stacks = stacks;
  ShapeDescription result = shape(sphere, "paint");
  result.shading = shading;
  return result;
}

/// The shape in white matte paint in the light of a lamp at the viewer, who is at infinity toward z, `width` x `height`
/// pixels that show `window` units up and down.
inline SceneDescription headlit_scene(ShapeDescription shape, int width, int height, double window) {
  SceneDescription scene = dark_scene(height, front_camera(window));
  scene.image = {width, height};
  scene.materials = {material("paint", Rgb(1))};
  scene.lights = {directional_light({0, 0, -1})};
  scene.shapes = {std::move(shape)};
  return scene;
}

/// The same with a white highlight (N.H)^n alone, which is (N.z)^n here.
inline SceneDescription highlit_scene(ShapeDescription shape, int width, int height, double window, double exponent) {
  SceneDescription scene = headlit_scene(std::move(shape), width, height, window);
  scene.materials = {material("paint", Rgb(0))};
  scene.materials[0].highlight.weight = Rgb(1);
  scene.materials[0].highlight.exponent = exponent;
  scene.render.highlights = HighlightForm::halfway;
  return scene;
}

/// Green of all pixels, row by row.
inline std::vector<float> green(const SceneDescription& scene) {
  const Film film = rendered(scene).film;
  const float* plane = film.plane(ChannelGroup::color, 1);
  return {plane, plane + std::size_t(scene.image.width) * std::size_t(scene.image.height)};
}

inline float largest(const std::vector<float>& values) {
  float result = 0;
  for (const float value : values) result = std::max(result, value);
  return result;
}

inline double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double result = 0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(double(a[i]) - double(b[i])));
  return result;
}

}  // namespace raytree::test
