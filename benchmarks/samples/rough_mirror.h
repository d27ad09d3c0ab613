// A rough mirror and what is known of it: quadrature over its facets' slopes, which shares nothing with the renderer
// but Whitted's model (1980, sec. 2).
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "benchmarks/samples/scenes.h"
#include "renderer/shading.h"

namespace raytree::samples {

inline Material rough_mirror(float roughness) {
  Material material;
  material.reflection = Rgb(1);
  material.has_reflection = material.rough = true;
  material.roughness = roughness;
  return material;
}

/// A horizontal surface seen at `degrees` from its normal, which is y.
inline ShadingPoint level_point(const Material& material, double degrees, bool leaving = false) {
  const double angle = degrees * kDegree;
  SurfacePoint surface;
  surface.position = Vec3f(0, 0, 0), surface.texture = Vec2f(0, 0);
  surface.geometric_normal = surface.shading_normal = Vec3f(0, leaving ? -1.0f : 1.0f, 0);
  return shading_point(surface, Vec3f(Vec3d(std::sin(angle), -std::cos(angle), 0)), material);
}

/// The plane y = 0 as a rough mirror, seen at 45 degrees by a parallel camera; 2 units are the picture's height.
inline SceneDescription mirror_plane(int size, double roughness, int samples) {
  CameraDescription camera = front_camera(2);
  camera.position = {0, 5, 5};
  camera.target = {0, 0, 0};
  SceneDescription scene = dark_scene(size, camera);
  scene.render.rough_samples = samples;
  scene.materials = {material("mirror", Rgb(0))};
  scene.materials[0].reflection = Rgb(1);
  scene.materials[0].roughness = roughness;
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 1, 0}}, "mirror")};
  return scene;
}

/// Mirrored directions of a ray onto the plane y = 0, one for each of (2 cells)^2 of a grid over Gaussian slopes up to
/// 6 standard deviations, weighted by the slopes' density. Facets that the ray cannot meet, or that mirror it below the
/// plane, are left out.
class MirroredDirections {
 public:
  explicit MirroredDirections(const Vec3d& direction, double roughness, int cells = 200) {
    double all = 0;
    for (int i = -cells; i < cells; ++i)
      for (int k = -cells; k < cells; ++k) {
        const double x = (i + 0.5) * 6 / cells, z = (k + 0.5) * 6 / cells, weight = std::exp(-(x * x + z * z) / 2);
        const Vec3d facet = Vec3d(-x * roughness, 1, -z * roughness).normalized();
        const Vec3d mirrored = direction - facet * (2 * direction.dot(facet));
        all += weight;
        if (direction.dot(facet) >= 0 || mirrored.y <= 0) continue;
        served_ += weight;
        directions_.emplace_back(mirrored, weight);
      }
    for (auto& [mirrored, weight] : directions_) weight /= served_;
    served_ /= all;
  }

  /// Share of the facets that serve.
  double served() const { return served_; }

  /// Of f(direction) over the facets that serve.
  template <class Function>
  double mean(Function&& f) const {
    double sum = 0;
    for (const auto& [mirrored, weight] : directions_) sum += weight * f(mirrored);
    return sum;
  }

 private:
  std::vector<std::pair<Vec3d, double>> directions_;
  double served_ = 0;
};

}  // namespace raytree::samples
