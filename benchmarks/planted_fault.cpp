#include "benchmarks/planted_fault.h"

namespace raytree::benchmarks {
namespace {

/// Past the surface that is to be overlooked: by more than a distance is rounded.
constexpr float kPast = 1.001f;

bool on_triangle(const Hit& hit) { return hit.geometry >= kFirstMeshGeometry; }

FaultyTracer::Fault dropped_triangles(const ShapeSet&) {
  return [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
    if (!on_triangle(hit) || hit.primitive % 16 != 0) return hit;
    return FaultyTracer::behind(tracer, origin, direction, end, hit.distance * kPast);
  };
}

FaultyTracer::Fault shifted_bound(const ShapeSet& shapes) {
  float low = kInfinity, high = -kInfinity;
  if (!shapes.meshes.empty())
    for (const Vec3f& position : shapes.meshes.front().mesh.positions)
      low = std::min(low, position.x), high = std::max(high, position.x);
  const float end_of_bound = low + 0.75f * (high - low);
  return [end_of_bound](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end,
                        const Hit& hit) {
    const bool of_first_mesh = hit.geometry == kFirstMeshGeometry && hit.instance == kNoInstance;
    if (!of_first_mesh || (origin + direction * hit.distance).x < end_of_bound) return hit;
    return FaultyTracer::behind(tracer, origin, direction, end, hit.distance * kPast);
  };
}

FaultyTracer::Fault wrong_index(const ShapeSet&) {
  return [](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
    Hit wrong = hit;
    if (on_triangle(hit)) wrong.primitive ^= wrong.primitive % 16 == 7 ? 1u : 0u;
    return wrong;
  };
}

FaultyTracer::Fault fixed_epsilon(const ShapeSet&) {
  constexpr float kEpsilon = 1e-2f;
  return [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
    return hit.distance > kEpsilon ? hit : FaultyTracer::behind(tracer, origin, direction, end, kEpsilon);
  };
}

FaultyTracer::Fault wrong_distance(const ShapeSet&) {
  return [](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
    Hit wrong = hit;
    wrong.distance *= 1 + 0x1p-14f;
    return wrong;
  };
}

FaultyTracer::Fault swapped_barycentrics(const ShapeSet&) {
  return [](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
    Hit wrong = hit;
    if (on_triangle(hit)) std::swap(wrong.u, wrong.v);
    return wrong;
  };
}

}  // namespace

Hit FaultyTracer::behind(const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end,
                         float from) {
  RayBatch ray(1);
  HitBatch hits(1);
  ray.push(origin + direction * from, direction, end - from);
  tracer.intersect(ray, Coherence::incoherent, hits);
  Hit next = hits[0];
  next.distance += from;
  return next;
}

void FaultyTracer::intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept {
  tracer_->intersect(rays, coherence, hits);
  for (std::size_t i = 0; i < rays.size; ++i)
    if (hits.geometry[i] != kNoGeometry)
      hits.set(i, fault_(*tracer_, rays.origin(i), rays.direction(i), rays.max_distance[i], hits[i]));
}

void FaultyTracer::occluded(const RayBatch& rays, Coherence, std::uint8_t* occluded) const noexcept {
  HitBatch hits(rays.size);
  intersect(rays, Coherence::incoherent, hits);
  for (std::size_t i = 0; i < rays.size; ++i) occluded[i] = hits.geometry[i] != kNoGeometry;
}

const std::vector<PlantedFault>& planted_faults() {
  static const std::vector<PlantedFault> kFaults = {
      {"dropped-triangles", "every sixteenth triangle of each mesh is not met", dropped_triangles},
      {"shifted-bound", "the first mesh ends at three quarters of its width", shifted_bound},
      {"wrong-index", "of sixteen triangles one is taken for its neighbour", wrong_index},
      {"epsilon", "nothing nearer than 1e-2 is met", fixed_epsilon},
      {"wrong-distance", "distances are off by 2^-14 of themselves", wrong_distance},
      {"swapped-barycentrics", "the barycentrics of triangles are exchanged", swapped_barycentrics}};
  return kFaults;
}

}  // namespace raytree::benchmarks
