// What patterns and bumps make of a hit: apart from shading.h, so that a scene without them pays one test of a flag.
#include "renderer/shading.h"

#include <cmath>

#include "renderer/bump.h"

namespace raytree {

Footprint footprint_of(const ShadingPoint& point, const SampleWindow& window) {
  if (window.camera == nullptr) return {};
  const Vec3f& normal = point.surface.geometric_normal;
  const float cosine = -point.direction.dot(normal);
  if (!(cosine > 0)) return {};
  Vec3f right, up;
  window.camera->pixel_edges(point.direction, point.surface.distance, right, up);
  // Along the ray until they lie in the plane that touches the surface.
  const auto laid_down = [&](const Vec3f& edge) {
    return (edge + point.direction * (edge.dot(normal) / cosine)) * window.spacing;
  };
  return {laid_down(right), laid_down(up), window.leaves_edges};
}

void vary(ShadingPoint& point, const SampleWindow& window) {
  const Material& material = *point.material;
  const Footprint footprint = footprint_of(point, window);
  point.diffuse = material.diffuse.at(point.surface, footprint);
  if (kFeatures.bumps && material.bump) {
    SurfacePoint& surface = point.surface;
    const double width = std::sqrt(std::max<double>(footprint.edge.dot(footprint.edge),  //
                                                    footprint.other_edge.dot(footprint.other_edge)));
    surface.shading_normal = material.bump->bent(surface.shading_normal, surface.geometric_normal, -point.direction,
                                                 point.leaving, surface.position, width);
  }
}

Rgb varied_ambient(const ShadingPoint& point, const SampleWindow& window) {
  return point.material->ambient.at(point.surface, footprint_of(point, window));
}

}  // namespace raytree
