#include "geometry/few_shapes.h"

#include <algorithm>

namespace raytree {
namespace {

/// Calls visit(geometry, primitive, distance(origin, direction)) for each of the few shapes.
template <class Visit>
void for_each(const FewShapes& few, Visit&& visit) {
  const ShapeSet& shapes = *few.shapes;
  for (std::size_t p = 0; p < shapes.planes.size(); ++p)
    visit(kPlaneGeometry, static_cast<std::uint32_t>(p), [&, p](const Vec3f& origin, const Vec3f& direction) {
      return plane_distance(shapes.planes[p], origin, direction);
    });
  if (few.spheres)
    for (std::size_t s = 0; s < shapes.spheres.center_radius.size(); ++s)
      visit(kSphereGeometry, static_cast<std::uint32_t>(s),
            [sphere = shapes.spheres.center_radius[s]](const Vec3f& origin, const Vec3f& direction) {
              return sphere_distance(sphere, origin, direction);
            });
  if (few.discs)
    for (std::size_t d = 0; d < shapes.discs.center_radius.size(); ++d)
      visit(
          kDiscGeometry, static_cast<std::uint32_t>(d),
          [disc = shapes.discs.center_radius[d], normal = shapes.discs.normal[d]](
              const Vec3f& origin, const Vec3f& direction) { return disc_distance(disc, normal, origin, direction); });
}

}  // namespace

void intersect_few(const FewShapes& few, const RayBatch& rays, FewHits& hits) noexcept {
  const std::size_t padded = rays.size + kBatchPadding;
  if (hits.geometry.size() < padded) {
    hits.geometry.resize(padded);
    hits.primitive.resize(padded);
    hits.distance.resize(padded);
  }
  std::fill_n(hits.geometry.begin(), rays.size, kNoGeometry);
  std::copy_n(rays.max_distance, rays.size, hits.distance.begin());
  // Pointers that nothing else writes to, so that the loop over rays is vectorized.
  GeometryId* __restrict geometries = hits.geometry.data();
  std::uint32_t* __restrict primitives = hits.primitive.data();
  float* __restrict distances = hits.distance.data();
  const std::size_t count = rays.size;
  for_each(few, [&](GeometryId geometry, std::uint32_t primitive, auto&& distance_to) {
    for (std::size_t i = 0; i < count; ++i) {
      const float distance = distance_to(rays.origin(i), rays.direction(i));
      const bool nearer = (distance >= 0) & (distance < distances[i]);
      distances[i] = nearer ? distance : distances[i];
      geometries[i] = nearer ? geometry : geometries[i];
      primitives[i] = nearer ? primitive : primitives[i];
    }
  });
}

Hit intersect_few(const FewShapes& few, const Vec3f& origin, const Vec3f& direction, float max_distance) noexcept {
  Hit nearest;
  nearest.distance = max_distance;
  for_each(few, [&](GeometryId geometry, std::uint32_t primitive, auto&& distance_to) {
    const float distance = distance_to(origin, direction);
    if (distance >= 0 && distance < nearest.distance) nearest = {geometry, primitive, 0, 0, distance};
  });
  return nearest;
}

}  // namespace raytree
