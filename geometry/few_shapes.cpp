#include "geometry/few_shapes.h"

#include <algorithm>
#include <cstring>

namespace raytree {
namespace {

constexpr std::size_t kBlockRays = 8;  ///< rays that are looked at together, one single-precision register of them
static_assert(kBatchPadding % kBlockRays == 0, "the last block reads into the padding");

/// What the squared distance of a ray from a ball's center may be off by in single precision, as a share of the squared
/// distance D of its origin from there. With u = 2^-24 the center about the origin is off by 2 u per component, its
/// square by 4 u + 3 u D, the part along the ray, squared, by 2 (2 u + 3 u) D, the difference by u D; a direction that
/// is unit to 2^-22 only adds 2^-21 D: less than 2^-19 D in all.
constexpr float kBallSlack = 0x1p-19f;

/// Of a block of rays. Written out as one vector: g++ 12 does not find it in a loop where comparisons yield mask
/// registers (AVX-512), and the test then takes five times as long.
typedef float BlockOfFloats __attribute__((vector_size(kBlockRays * sizeof(float)), aligned(sizeof(float)), may_alias));
typedef std::int32_t BlockOfFlags __attribute__((vector_size(kBlockRays * sizeof(std::int32_t))));
typedef std::int64_t BlockOfFlagPairs __attribute__((vector_size(kBlockRays * sizeof(std::int32_t))));
typedef std::uint32_t BlockOfIds __attribute__((vector_size(kBlockRays * sizeof(std::uint32_t))));
typedef float BlockOfDistances __attribute__((vector_size(kBlockRays * sizeof(float))));

inline const BlockOfFloats& block(const float* values) { return *reinterpret_cast<const BlockOfFloats*>(values); }

/// Whether any of the block's rays may meet the ball; never false for a ray that does, whatever its range. What lies in
/// the padding counts too, which costs time and nothing else.
inline bool may_meet(const Imath::V4f& ball, const RayBatch& rays, std::size_t first) {
  const BlockOfFloats dx = block(rays.direction_x + first), dy = block(rays.direction_y + first),
                      dz = block(rays.direction_z + first);
  const BlockOfFloats x = ball.x - block(rays.origin_x + first), y = ball.y - block(rays.origin_y + first),
                      z = ball.z - block(rays.origin_z + first);
  const BlockOfFloats along = x * dx + y * dy + z * dz, square = x * x + y * y + z * z;
  const float reach = ball.w * ball.w * (1 + kBallSlack);
  // Negated, so that what overflows is looked at again in double.
  const BlockOfFlags may = ~(square - along * along > reach + kBallSlack * square);
  const auto pairs = reinterpret_cast<BlockOfFlagPairs>(may);
  return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

/// Calls visit(geometry, primitive, distance(origin, direction), ball) for each of the few shapes; `ball` holds the
/// shape, or is null where it has no bounds.
template <class Visit>
void for_each(const FewShapes& few, Visit&& visit) {
  const ShapeSet& shapes = *few.shapes;
  for (std::size_t p = 0; p < shapes.planes.size(); ++p)
    visit(
        kPlaneGeometry, static_cast<std::uint32_t>(p),
        [&, p](const Vec3f& origin, const Vec3f& direction) {
          return plane_distance(shapes.planes[p], origin, direction);
        },
        static_cast<const Imath::V4f*>(nullptr));
  if (few.spheres)
    for (std::size_t s = 0; s < shapes.spheres.center_radius.size(); ++s)
      visit(
          kSphereGeometry, static_cast<std::uint32_t>(s),
          [sphere = shapes.spheres.center_radius[s]](const Vec3f& origin, const Vec3f& direction) {
            return sphere_distance(sphere, origin, direction);
          },
          &shapes.spheres.center_radius[s]);
  if (few.discs)
    for (std::size_t d = 0; d < shapes.discs.center_radius.size(); ++d)
      visit(
          kDiscGeometry, static_cast<std::uint32_t>(d),
          [disc = shapes.discs.center_radius[d], normal = shapes.discs.normal[d]](
              const Vec3f& origin, const Vec3f& direction) { return disc_distance(disc, normal, origin, direction); },
          &shapes.discs.center_radius[d]);
}

/// Notes the shape for those rays of a block that it is nearer to than what was found before; a distance below 0 is
/// none.
inline void keep_nearer(GeometryId geometry, std::uint32_t primitive, const float (&distances)[kBlockRays],
                        std::size_t first, FewHits& hits) {
  // Copies of natural alignment: clang takes what it chooses between for that, whatever its type says.
  BlockOfDistances distance, nearest;
  BlockOfIds geometries, primitives;
  std::memcpy(&distance, distances, sizeof(distance));
  std::memcpy(&nearest, hits.distance.data() + first, sizeof(nearest));
  std::memcpy(&geometries, hits.geometry.data() + first, sizeof(geometries));
  std::memcpy(&primitives, hits.primitive.data() + first, sizeof(primitives));
  const BlockOfFlags nearer = (distance >= 0) & (distance < nearest);
  nearest = nearer ? distance : nearest;
  geometries = nearer ? geometry - BlockOfIds{} : geometries;
  primitives = nearer ? primitive - BlockOfIds{} : primitives;
  std::memcpy(hits.distance.data() + first, &nearest, sizeof(nearest));
  std::memcpy(hits.geometry.data() + first, &geometries, sizeof(geometries));
  std::memcpy(hits.primitive.data() + first, &primitives, sizeof(primitives));
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
  for_each(few, [&](GeometryId geometry, std::uint32_t primitive, auto&& distance_to, const Imath::V4f* ball) {
    for (std::size_t first = 0; first < rays.size; first += kBlockRays) {
      if (ball && !may_meet(*ball, rays, first)) continue;
      // Distances first, then what is nearer: in one loop, g++ 12 would turn masks of doubles into masks of floats.
      float distances[kBlockRays];
      for (std::size_t i = 0; i < kBlockRays; ++i)
        distances[i] = distance_to(rays.origin(first + i), rays.direction(first + i));
      keep_nearer(geometry, primitive, distances, first, hits);
    }
  });
}

Hit intersect_few(const FewShapes& few, const Vec3f& origin, const Vec3f& direction, float max_distance) noexcept {
  Hit nearest;
  nearest.distance = max_distance;
  for_each(few, [&](GeometryId geometry, std::uint32_t primitive, auto&& distance_to, const Imath::V4f*) {
    const float distance = distance_to(origin, direction);
    if (distance >= 0 && distance < nearest.distance) nearest = {geometry, primitive, 0, 0, distance};
  });
  return nearest;
}

}  // namespace raytree
