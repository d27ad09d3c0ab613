#include "benchmarks/stability/ray_probes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "geometry/angle.h"
#include "geometry/faceted_quadric.h"
#include "geometry/triangulation.h"

namespace raytree::benchmarks {
namespace {

/// Waechter and Binder's: far from the axes so many units in the last place along the normal; near them, where ulps
/// vanish, a fixed length.
constexpr float kIntegerSteps = 256, kNearAxis = 1.0f / 32, kNearAxisStep = 1.0f / 65536;

float stepped(float coordinate, float normal) {
  if (std::abs(coordinate) < kNearAxis) return coordinate + kNearAxisStep * normal;
  const auto steps = static_cast<std::int32_t>(kIntegerSteps * normal);
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(coordinate) + (coordinate < 0 ? -steps : steps));
}

}  // namespace

/// SplitMix64 (Steele, Lea and Flood 2014): a counter through a mixing function.
double ProbeRandom::share() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

Vec3d ProbeRandom::direction() {
  const double height = uniform(-1, 1), azimuth = uniform(0, 2 * kPi), across = std::sqrt(1 - height * height);
  return {across * std::cos(azimuth), height, across * std::sin(azimuth)};
}

Vec3f ProbeRandom::leaving(const Vec3f& side) {
  const Vec3d n = unit(Vec3d(side)), d = direction();
  const Vec3d along = unit(d - n * d.dot(n));
  const double height = uniform(0, 1) < 0.5 ? uniform(0, 1) : std::pow(10.0, uniform(-7, 0));
  return Vec3f(unit(along * std::sqrt(1 - height * height) + n * height));
}

std::size_t probe_count(const StabilityRun& run, std::size_t full, std::size_t least) {
  return std::max(least, static_cast<std::size_t>(run.effort * static_cast<double>(full)));
}

ProbeRay ray_to(const Vec3d& origin, const Vec3d& target) {
  const Vec3f from(origin);
  return {from, Vec3f(unit(target - Vec3d(from)))};
}

std::vector<Hit> hits_of(const RayIntersector& tracer, const std::vector<ProbeRay>& rays) {
  RayBatch batch(kBatchSize);
  HitBatch found(kBatchSize);
  std::vector<Hit> hits;
  hits.reserve(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += kBatchSize) {
    batch.size = 0;
    const std::size_t end = std::min(rays.size(), first + kBatchSize);
    for (std::size_t i = first; i < end; ++i) batch.push(rays[i].origin, rays[i].direction, kInfinity);
    tracer.intersect(batch, Coherence::incoherent, found);
    for (std::size_t i = 0; i < batch.size; ++i) hits.push_back(found[i]);
  }
  return hits;
}

Hit hit_of(const RayIntersector& tracer, const ProbeRay& ray) { return hits_of(tracer, {ray})[0]; }

ShapeSet ball_of_triangles(int sides, int stacks, double radius, const Vec3d& center) {
  // About the origin and moved afterwards: corners are rounded once, where they stand.
  PolygonMesh ball = faceted_sphere({0, 0, 0}, 1, sides, stacks);
  ball.normals.clear();
  ball.normal_corners.clear();
  for (Vec3f& p : ball.positions) p = Vec3f(center + Vec3d(p) * radius);
  Warnings warnings;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  shapes.meshes[0].mesh = triangulate(std::move(ball), {}, warnings);
  return shapes;
}

ShapeSet triangle_soup(const std::vector<Vec3f>& corners) {
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh;
  for (const Vec3f& corner : corners) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(corner);
  }
  return shapes;
}

ShapeSet quad_of_triangles(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh;
  for (const Vec3d& p : {place, place + a, place + a + b, place + b}) mesh.positions.push_back(Vec3f(p));
  mesh.corners.assign({0, 1, 2, 0, 2, 3});
  return shapes;
}

ShapeSet spheres_at(const std::vector<Imath::V4f>& center_radius) {
  ShapeSet shapes;
  shapes.spheres.center_radius.assign(center_radius.begin(), center_radius.end());
  shapes.spheres.shape.assign(center_radius.size(), 0);
  return shapes;
}

Vec3d corner_of(const ShapeSet& shapes, std::size_t triangle, std::size_t c) {
  const TriangleMesh& mesh = shapes.meshes[0].mesh;
  return Vec3d(mesh.positions[mesh.corners[3 * triangle + c % 3]]);
}

Vec3f departed(Departure way, const SurfacePoint& point, const Vec3f& normal, const ProbeRay& ray) {
  switch (way) {
    case Departure::none:
      return point.position;
    case Departure::absolute:
      return point.position + normal * kAbsoluteOffset;
    case Departure::waechter_binder:
    case Departure::waechter_binder_t:
      break;
  }
  const Vec3f p = way == Departure::waechter_binder ? point.position : ray.origin + ray.direction * point.distance;
  return {stepped(p.x, normal.x), stepped(p.y, normal.y), stepped(p.z, normal.z)};
}

Vec3f departed_as_rendered(const StabilityRun& run, const SurfacePoint& point, const Vec3f& normal) {
  return run.faults.no_offsets ? point.position : offset_origin(point, normal);
}

ProbeCanvas::ProbeCanvas(int width, int height) {
  image.width = width, image.height = height;
  for (auto& plane : image.planes) plane.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
}

void ProbeCanvas::set(int x, int y, double r, double g, double b) {
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  const double values[3] = {r, g, b};
  for (int c = 0; c < 3; ++c)
    image.planes[c][i] = static_cast<std::uint8_t>(std::lround(255 * std::sqrt(std::clamp(values[c], 0.0, 1.0))));
}

}  // namespace raytree::benchmarks
