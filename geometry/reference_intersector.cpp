#include "geometry/reference_intersector.h"

namespace raytree {
namespace {

/// Finite, with a direction, and with an end that does not lie behind its origin (NaN fails the comparison).
bool is_traceable(const RayBatch& rays, std::size_t i) {
  const Vec3f o = rays.origin(i), d = rays.direction(i);
  // x * 0 is 0 for finite x and NaN else.
  const float poison = o.x * 0 + o.y * 0 + o.z * 0 + d.x * 0 + d.y * 0 + d.z * 0;
  return poison == 0 && d != Vec3f(0, 0, 0) && rays.max_distance[i] >= 0;
}

}  // namespace

void intersect_one_by_one(const ReferenceTracer& tracer, const RayBatch& rays, HitBatch& hits) noexcept {
  hits.begin_instances();
  for (std::size_t i = 0; i < rays.size; ++i) {
    Hit hit;
    hit.distance = rays.max_distance[i];
    if (is_traceable(rays, i)) {
      const double most = double(rays.max_distance[i]);
      const ReferenceHit found = tracer.nearest(Vec3d(rays.origin(i)), Vec3d(rays.direction(i)), most);
      if (found.hit())
        hit = {found.geometry,
               found.primitive,
               static_cast<float>(found.u),
               static_cast<float>(found.v),
               static_cast<float>(found.distance),
               found.instance};
    }
    hits.set(i, hit);
  }
}

void occluded_one_by_one(const ReferenceTracer& tracer, const RayBatch& rays, std::uint8_t* occluded) noexcept {
  for (std::size_t i = 0; i < rays.size; ++i)
    occluded[i] = is_traceable(rays, i) &&
                  tracer.is_occluded(Vec3d(rays.origin(i)), Vec3d(rays.direction(i)), double(rays.max_distance[i]));
}

}  // namespace raytree
