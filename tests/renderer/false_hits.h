// Rays that leave a surface, and how many of them meet it again.
#pragma once

#include <cmath>

#include "geometry/embree_intersector.h"
#include "geometry/ray_batch.h"
#include "geometry/surface.h"
#include "tests/random.h"

namespace raytree::test {

/// Random directions and places for rays that leave surfaces.
class RandomRays : public Random {
 public:
  using Random::Random;

  /// To `side`, at heights from upright down to 1e-7 over the surface.
  Vec3f leaving(const Vec3f& side) {
    const Vec3d n = unit(Vec3d(side));
    const Vec3d d = direction();
    const Vec3d along = unit(d - n * d.dot(n));
    const double height = uniform(0, 1) < 0.5 ? uniform(0, 1) : std::pow(10.0, uniform(-7, 0));
    return Vec3f(unit(along * std::sqrt(1 - height * height) + n * height));
  }
};

/// A shape's size, and the largest coordinate of its place.
struct Setting {
  double size, place;
};

inline constexpr Setting kSettings[] = {{1e-4, 0},  {1e-4, 1e-3}, {1e-4, 1}, {1e-2, 0}, {1e-2, 10}, {1, 0},
                                        {1, 1},     {1, 1e3},     {1, 1e5},  {30, 1e4}, {1e3, 0},   {1e3, 1e3},
                                        {1e3, 1e6}, {1e5, 1e5},   {1e6, 0},  {1e6, 1e6}};

struct FalseHits {
  int left = 0;  ///< rays that left a surface
  int false_hits = 0;
};

/// Rays leave a point to both sides, eight of each kind of packet: calls seen(hits, k, direction, side) of each.
template <class Seen>
void leave_to_both_sides(const EmbreeIntersector& intersector, const SurfacePoint& point, RandomRays& random,
                         Seen&& seen) {
  RayBatch rays(8);
  HitBatch hits(8);
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f normal = point.geometric_normal * side;
    rays.size = 0;
    for (int k = 0; k < 8; ++k) rays.push(offset_origin(point, normal), random.leaving(normal), kInfinity);
    for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
      intersector.intersect(rays, coherence, hits);
      for (std::size_t k = 0; k < 8; ++k) seen(hits, k, rays.direction(k), side);
    }
  }
}

/// Shoots rays at primitive after primitive, spawns from the hit to both sides, counts what meets its own primitive.
/// `aim(i)` yields a point of primitive i, `own(hit, point, direction)` says whether a spawned ray's hit is a false
/// one.
template <class Aim, class Own>
FalseHits count_false_hits(const ShapeSet& shapes, int primitives, GeometryId geometry, double size, RandomRays& random,
                           Aim&& aim, Own&& own, const EmbreeOptions& options = {}) {
  const EmbreeIntersector intersector(shapes, options);
  FalseHits count;
  for (int i = 0; i < primitives; ++i) {
    const Vec3d target = aim(i);
    const Vec3f origin(target + random.direction() * size * std::pow(10.0, random.uniform(-1, 1.5)));
    if (Vec3d(origin) == target) continue;
    const Vec3f direction(unit(target - Vec3d(origin)));
    const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
    if (hit.geometry != geometry || hit.primitive != static_cast<std::uint32_t>(i)) continue;
    const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
    leave_to_both_sides(intersector, point, random,
                        [&](const HitBatch& hits, std::size_t k, const Vec3f& leaving, float side) {
                          ++count.left;
                          if (hits.geometry[k] == geometry && hits.primitive[k] == hit.primitive)
                            count.false_hits += own(hits[k], point, leaving, side);
                        });
  }
  return count;
}

}  // namespace raytree::test
