#include "benchmarks/stability/map_cells.h"

#include <algorithm>
#include <cmath>

#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "geometry/triangle_reference.h"
#include "renderer/optics.h"

namespace raytree::benchmarks {
namespace {

/// No direction of the axes and no coordinate 0: nothing cancels by luck.
Vec3d map_normal() { return unit(Vec3d(0.48, 0.77, 0.42)); }
Vec3d map_along() { return unit(map_normal().cross(Vec3d(0.3, 0.1, 0.9))); }
Vec3d map_place(double offset) { return unit(Vec3d(0.7, -0.4, 0.6)) * offset; }

/// The renderer's places of hits beside the truth's: a surface that is passed by, or met where none is, by more than a
/// hundredth of the size along the ray.
void count_against_truth(const ShapeSet& shapes, double size, const std::vector<ProbeRay>& rays,
                         const std::vector<Hit>& hits, CellCounts& counts) {
  const TriangleReference truth(shapes);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const ReferenceHit found = truth.nearest(Vec3d(rays[i].origin), Vec3d(rays[i].direction), kInfinity);
    double fast = kInfinity;
    if (hits[i].geometry != kNoGeometry) {
      const SurfacePoint point = surface_at(shapes, rays[i].origin, rays[i].direction, hits[i], false);
      fast = (Vec3d(point.position) - Vec3d(rays[i].origin)).dot(unit(Vec3d(rays[i].direction)));
    }
    const double slack = size / 100;
    ++counts.asked;
    counts.misses += found.hit() && fast > found.distance + slack;
    counts.false_hits += fast < (found.hit() ? found.distance : double(kInfinity)) - slack;
  }
}

/// Rays from each hit, to directions that `leave` yields for the side that the ray came from: those that meet the very
/// triangle that they left.
template <class Leave>
void count_self_hits(const StabilityRun& run, const ShapeSet& shapes, const EmbreeIntersector& tracer,
                     const std::vector<ProbeRay>& rays, const std::vector<Hit>& hits, Leave&& leave,
                     CellCounts& counts) {
  std::vector<ProbeRay> leaving;
  std::vector<const Hit*> from;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].geometry == kNoGeometry) continue;
    const SurfacePoint point = surface_at(shapes, rays[i].origin, rays[i].direction, hits[i], false);
    const Vec3f n =
        point.geometric_normal.dot(rays[i].direction) < 0 ? point.geometric_normal : -point.geometric_normal;
    for (int k = 0; k < 2; ++k) {
      leaving.push_back({departed_as_rendered(run, point, n), leave(n)});
      from.push_back(&hits[i]);
    }
  }
  const auto back = hits_of(tracer, leaving);
  counts.left += back.size();
  for (std::size_t i = 0; i < back.size(); ++i)
    counts.self_hits += back[i].geometry == from[i]->geometry && back[i].primitive == from[i]->primitive;
}

Vec3d inside_of(const ShapeSet& shapes, std::size_t triangle, ProbeRandom& random) {
  double u = random.uniform(0.02, 0.96), v = random.uniform(0.02, 0.96);
  if (u + v > 0.98) u = 0.98 - u, v = 0.98 - v;
  u = std::max(u, 0.01), v = std::max(v, 0.01);
  return corner_of(shapes, triangle, 0) * (1 - u - v) + corner_of(shapes, triangle, 1) * u +
         corner_of(shapes, triangle, 2) * v;
}

constexpr int kMapSides = 24, kMapStacks = 12;

}  // namespace

CellCounts scale_cell(const StabilityRun& run, double size, double offset, std::size_t rays, std::uint64_t seed) {
  ProbeRandom random(seed);
  const Vec3d center = map_place(offset * size);
  const ShapeSet ball = ball_of_triangles(kMapSides, kMapStacks, size, center);
  const EmbreeIntersector tracer(ball, run.tracer_options());
  std::vector<ProbeRay> asked;
  for (std::size_t i = 0; i < rays; ++i)
    asked.push_back(ray_to(center + random.direction() * (3 * size),
                           inside_of(ball, random.below(ball.meshes[0].mesh.triangle_count()), random)));
  const auto hits = hits_of(tracer, asked);
  CellCounts counts;
  count_against_truth(ball, size, asked, hits, counts);
  count_self_hits(
      run, ball, tracer, asked, hits, [&](const Vec3f& n) { return random.leaving(n); }, counts);
  return counts;
}

CellCounts grazing_cell(const StabilityRun& run, double angle, double distance, std::size_t rays, std::uint64_t seed) {
  ProbeRandom random(seed);
  const Vec3d n = map_normal(), x = map_along(), y = n.cross(x), place = map_place(1);
  const ShapeSet quad = quad_of_triangles(place - (x + y) * 0.5, x, y);
  const EmbreeIntersector tracer(quad, run.tracer_options());
  const auto low = [&](const Vec3d& up) {
    const double azimuth = random.uniform(0, 2 * kPi);
    return (x * std::cos(azimuth) + y * std::sin(azimuth)) * std::cos(angle) + up * std::sin(angle);
  };
  std::vector<ProbeRay> asked;
  for (std::size_t i = 0; i < rays; ++i) {
    const Vec3d target = place + x * random.uniform(-0.45, 0.45) + y * random.uniform(-0.45, 0.45);
    asked.push_back(ray_to(target + low(n) * distance, target));
  }
  const auto hits = hits_of(tracer, asked);
  CellCounts counts;
  count_against_truth(quad, 1, asked, hits, counts);
  count_self_hits(
      run, quad, tracer, asked, hits, [&](const Vec3f& side) { return Vec3f(unit(low(Vec3d(side)))); }, counts);
  return counts;
}

CellCounts slab_cell(const StabilityRun& run, double thickness, double offset, std::size_t rays, std::uint64_t seed) {
  ProbeRandom random(seed);
  const Vec3d n = map_normal(), x = map_along(), y = n.cross(x), place = map_place(offset);
  ShapeSet slab = quad_of_triangles(place - (x + y) * 0.5, x, y);
  // The second sheet is larger: no ray leaves the slab through its sides.
  ShapeSet second = quad_of_triangles(place - n * thickness - (x + y) * 1.0, x * 2.0, y * 2.0);
  slab.meshes.push_back(std::move(second.meshes[0]));
  const EmbreeIntersector tracer(slab, run.tracer_options());
  std::vector<ProbeRay> asked;
  for (std::size_t i = 0; i < rays; ++i) {
    const Vec3d target = place + x * random.uniform(-0.45, 0.45) + y * random.uniform(-0.45, 0.45);
    const double azimuth = random.uniform(0, 2 * kPi), steep = random.uniform(0.5, 1);
    const Vec3d back = n * steep + (x * std::cos(azimuth) + y * std::sin(azimuth)) * std::sqrt(1 - steep * steep);
    asked.push_back(ray_to(target + back * 3.0, target));
  }
  const auto hits = hits_of(tracer, asked);
  std::vector<ProbeRay> through, mirrored;
  CellCounts counts;
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (hits[i].geometry != kFirstMeshGeometry) {  // the sheets are not in order any more
      ++counts.asked, ++counts.misses;
      continue;
    }
    const SurfacePoint point = surface_at(slab, asked[i].origin, asked[i].direction, hits[i], false);
    const Vec3f side = point.geometric_normal;
    through.push_back({departed_as_rendered(run, point, -side), asked[i].direction});
    mirrored.push_back({departed_as_rendered(run, point, side), reflected_direction(asked[i].direction, side)});
    first.push_back(hits[i].primitive);
  }
  const auto behind = hits_of(tracer, through), before = hits_of(tracer, mirrored);
  for (std::size_t i = 0; i < behind.size(); ++i) {
    ++counts.asked, counts.left += 2;
    const auto is_own = [&](const Hit& hit) { return hit.geometry == kFirstMeshGeometry && hit.primitive == first[i]; };
    counts.self_hits += is_own(behind[i]) + is_own(before[i]);
    counts.misses += behind[i].geometry != kFirstMeshGeometry + 1;
    counts.false_hits += before[i].geometry != kNoGeometry && !is_own(before[i]);
  }
  return counts;
}

CellCounts critical_cell(const StabilityRun& run, double index, double distance, std::size_t rays, std::uint64_t seed) {
  ProbeRandom random(seed);
  const Vec3d n = map_normal(), x = map_along(), y = n.cross(x), place = map_place(1);
  const ShapeSet quad = quad_of_triangles(place - (x + y) * 0.5, x, y);
  const EmbreeIntersector tracer(quad, run.tracer_options());
  // Of the index as single precision holds it.
  const double critical = std::asin(1 / double(static_cast<float>(index)));
  std::vector<ProbeRay> asked;
  for (std::size_t i = 0; i < rays; ++i) {
    const Vec3d target = place + x * random.uniform(-0.4, 0.4) + y * random.uniform(-0.4, 0.4);
    const double azimuth = random.uniform(0, 2 * kPi);
    const double angle = critical + (i % 2 == 0 ? distance : -distance) * random.uniform(0.5, 1);
    const Vec3d back = -n * std::cos(angle) + (x * std::cos(azimuth) + y * std::sin(azimuth)) * std::sin(angle);
    asked.push_back(ray_to(target + back * 2.0, target));
  }
  const auto hits = hits_of(tracer, asked);
  CellCounts counts;
  std::vector<ProbeRay> passing;
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (hits[i].geometry == kNoGeometry) continue;
    ++counts.asked;
    const SurfacePoint point = surface_at(quad, asked[i].origin, asked[i].direction, hits[i], false);
    // Both see the ray as it is and the triangle as it is; the renderer in single precision.
    const Vec3f side = -point.geometric_normal;
    const auto fast = refracted_direction(asked[i].direction, side, static_cast<float>(index));
    const Vec3d a = corner_of(quad, hits[i].primitive, 0);
    const Vec3d exact =
        -unit((corner_of(quad, hits[i].primitive, 1) - a).cross(corner_of(quad, hits[i].primitive, 2) - a));
    const bool passes =
        refracted_direction(unit(Vec3d(asked[i].direction)), exact, double(static_cast<float>(index))).has_value();
    counts.misses += passes && !fast;
    counts.false_hits += !passes && fast;
    if (!fast) continue;
    passing.push_back({departed_as_rendered(run, point, -side), *fast});
    left.push_back(hits[i].primitive);
  }
  const auto back = hits_of(tracer, passing);
  counts.left = back.size();
  for (std::size_t i = 0; i < back.size(); ++i)
    counts.self_hits += back[i].geometry != kNoGeometry && back[i].primitive == left[i];
  return counts;
}

CellCounts aimed_cell(const StabilityRun& run, MapAim aim, int sides, std::size_t rays, std::uint64_t seed) {
  ProbeRandom random(seed);
  const Vec3d center = map_place(1);
  const ShapeSet ball = ball_of_triangles(sides, sides / 2, 1, center);
  const EmbreeIntersector tracer(ball, run.tracer_options());
  std::vector<ProbeRay> asked;
  for (std::size_t i = 0; i < rays; ++i) {
    const std::size_t triangle = random.below(ball.meshes[0].mesh.triangle_count()), c = random.below(3);
    const Vec3d a = corner_of(ball, triangle, c), b = corner_of(ball, triangle, c + 1);
    const double s = random.uniform(0.02, 0.98);
    Vec3d target = a;
    if (aim == MapAim::faces) target = inside_of(ball, triangle, random);
    if (aim == MapAim::edges || aim == MapAim::near_edges) target = a * (1 - s) + b * s;
    if (aim == MapAim::near_edges || aim == MapAim::near_corners) target += random.in_cube(1e-4);
    asked.push_back(ray_to(center + random.in_cube(0.3), target));
  }
  const auto hits = hits_of(tracer, asked);
  CellCounts counts;
  count_against_truth(ball, 1, asked, hits, counts);
  count_self_hits(
      run, ball, tracer, asked, hits, [&](const Vec3f& n) { return random.leaving(n); }, counts);
  return counts;
}

}  // namespace raytree::benchmarks
