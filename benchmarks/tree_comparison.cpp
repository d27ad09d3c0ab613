#include "benchmarks/tree_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface.h"

namespace raytree::benchmarks {
namespace {

thread_local TreeLog* current_log = nullptr;

/// How far a ray of the second tree may lie from its like in the first, relative to 1 and to the coordinates: rounding
/// stays far below, other rays of the same sample that are nearer would be taken instead.
constexpr double kLikeness = 0x1p-8;

/// Squared, of origin and direction.
double difference(const ComparedRay& ray, const Vec3f& origin, const Vec3f& direction, double scale) {
  const Vec3d d = Vec3d(ray.direction) - Vec3d(direction), o = Vec3d(ray.origin) - Vec3d(origin);
  return d.dot(d) + o.dot(o) / (scale * scale);
}

/// The ray of the first tree that this one repeats; null where the trees have parted.
TreeRay* like(TreeLog& log, const RayBatch& rays, std::size_t i, bool occlusion, bool follows_shadow) {
  const Vec3f origin = rays.origin(i), direction = rays.direction(i);
  const double scale =
      std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z), std::numeric_limits<float>::min()});
  TreeRay* best = nullptr;
  double least = kLikeness * kLikeness;
  for (const std::uint32_t index : log.by_sample[log.replayed[rays.sample[i]]]) {
    TreeRay& other = log.rays[index];
    if (other.is_taken || other.ray.occlusion != occlusion || other.follows_shadow != follows_shadow) continue;
    const double off = difference(other.ray, origin, direction, scale);
    if (!(off < least)) continue;
    least = off;
    best = &other;
    if (off == 0) break;
  }
  if (best != nullptr) best->is_taken = true;
  return best;
}

void overwrite(const RayBatch& rays, std::size_t i, const ComparedRay& ray) {
  rays.origin_x[i] = ray.origin.x, rays.origin_y[i] = ray.origin.y, rays.origin_z[i] = ray.origin.z;
  rays.direction_x[i] = ray.direction.x, rays.direction_y[i] = ray.direction.y, rays.direction_z[i] = ray.direction.z;
  rays.max_distance[i] = ray.max_distance;
}

ComparedRay ray_of(const RayBatch& rays, std::size_t i, bool occlusion) {
  return {rays.origin(i), rays.direction(i), rays.max_distance[i], occlusion};
}

ReferenceHit true_hit(const ReferenceTracer& truth, const ComparedRay& ray) {
  return truth.nearest(Vec3d(ray.origin), Vec3d(ray.direction), ray.max_distance);
}

bool is_finite(const ComparedRay& ray) {
  const Vec3f &o = ray.origin, &d = ray.direction;
  return std::isfinite(o.x + o.y + o.z) && std::isfinite(d.x + d.y + d.z) && d != Vec3f(0, 0, 0) &&
         ray.max_distance >= 0;
}

/// Reflected or refracted: whether it starts on the side of its parent's surface that the parent came from.
RayKind child_kind(const TreeLog& log, std::uint16_t sample, const Vec3f& origin) {
  RayKind kind = RayKind::reflected;
  float least = std::numeric_limits<float>::infinity();
  for (const std::uint32_t index : log.by_sample[sample]) {
    const TreeRay& parent = log.rays[index];
    if (parent.ray.occlusion || parent.follows_shadow || parent.hit.geometry == kNoGeometry) continue;
    const Vec3f off = origin - parent.position;
    if (!(off.dot(off) < least)) continue;
    least = off.dot(off);
    kind =
        off.dot(parent.normal) * parent.ray.direction.dot(parent.normal) > 0 ? RayKind::refracted : RayKind::reflected;
  }
  return kind;
}

}  // namespace

Hit rounded_hit(const ReferenceHit& found, float max_distance) {
  Hit hit;
  hit.distance = max_distance;
  if (!found.hit()) return hit;
  return {found.geometry,
          found.primitive,
          static_cast<float>(found.u),
          static_cast<float>(found.v),
          static_cast<float>(found.distance),
          found.instance};
}

void TreeTracer::set_log(TreeLog* log) { current_log = log; }

void TreeTracer::note(TreeLog& log, const RayBatch& rays, std::size_t i, TreeRay ray) const {
  ray.sample = rays.sample[i];
  ray.ray = ray_of(rays, i, ray.ray.occlusion);
  if (!ray.ray.occlusion && ray.hit.geometry != kNoGeometry) {
    const SurfacePoint point = surface_at(shapes_, ray.ray.origin, ray.ray.direction, ray.hit, false);
    ray.position = point.position, ray.normal = point.geometric_normal;
  }
  log.by_sample[ray.sample].push_back(static_cast<std::uint32_t>(log.rays.size()));
  log.rays.push_back(ray);
}

template <class Describe>
void TreeTracer::record(TreeLog& log, const RayBatch& rays, Clock::time_point start, Describe&& describe) const {
  log.fast.seconds += seconds_since(start);
  log.fast.rays += rays.size;
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (!log.chosen[rays.sample[i]]) continue;
    TreeRay ray;
    describe(i, ray);
    note(log, rays, i, ray);
  }
}

void TreeTracer::intersect(const RayBatch& rays, Coherence coherence, HitBatch& hits) const noexcept {
  TreeLog* const log = current_log;
  const auto start = Clock::now();
  tracer_.intersect(rays, coherence, hits);
  if (log == nullptr || log->mode == TreeLog::Mode::off || rays.sample == nullptr) return;
  const bool follows_shadow = coherence == Coherence::incoherent;
  if (log->mode == TreeLog::Mode::record) {
    record(*log, rays, start, [&](std::size_t i, TreeRay& ray) {
      ray.hit = hits[i];
      ray.follows_shadow = follows_shadow;
      ray.kind = follows_shadow                     ? RayKind::shadow
                 : coherence == Coherence::coherent ? RayKind::primary
                                                    : child_kind(*log, rays.sample[i], rays.origin(i));
    });
    return;
  }
  hits.begin_instances();
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (const TreeRay* ray = like(*log, rays, i, false, follows_shadow)) {
      overwrite(rays, i, ray->ray);
      const bool agreed = ray->comparison.verdict == RayVerdict::agree;
      Hit hit = agreed ? rounded_hit(ray->found, ray->ray.max_distance) : ray->hit;
      // Weights that go by a surface's parameters lie elsewhere on the facet: its own, at the true distance.
      if (agreed && ray->found.face != kNoFace) hit = ray->hit, hit.distance = static_cast<float>(ray->found.distance);
      hits.set(i, hit);
    } else {
      ++log->diverged;
      const ComparedRay own = ray_of(rays, i, false);
      hits.set(i, rounded_hit(is_finite(own) ? true_hit(truth_, own) : ReferenceHit(), own.max_distance));
    }
  }
}

void TreeTracer::occluded(const RayBatch& rays, Coherence coherence, std::uint8_t* occluded) const noexcept {
  TreeLog* const log = current_log;
  const auto start = Clock::now();
  tracer_.occluded(rays, coherence, occluded);
  if (log == nullptr || log->mode == TreeLog::Mode::off || rays.sample == nullptr) return;
  if (log->mode == TreeLog::Mode::record) {
    record(*log, rays, start, [&](std::size_t i, TreeRay& ray) {
      ray.kind = RayKind::shadow;
      ray.ray.occlusion = true;
      ray.occluded = occluded[i] != 0;
    });
    return;
  }
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (const TreeRay* ray = like(*log, rays, i, true, false)) {
      overwrite(rays, i, ray->ray);
      occluded[i] = ray->comparison.verdict == RayVerdict::agree ? ray->found.hit() : ray->occluded;
    } else {
      ++log->diverged;
      const ComparedRay own = ray_of(rays, i, true);
      occluded[i] = is_finite(own) && true_hit(truth_, own).hit();
    }
  }
}

bool compare_trees(std::span<const Vec2f> positions, const std::vector<std::uint8_t>& chosen, const RayJudge& judge,
                   SampleTracer& samples, TreeLog& log, TreeRadiance& radiance) {
  log.chosen = chosen;
  log.rays.clear();
  log.by_sample.resize(positions.size());
  for (std::vector<std::uint32_t>& rays : log.by_sample) rays.clear();
  log.mode = TreeLog::Mode::record;
  const bool traced = samples.trace(positions, 1);
  log.mode = TreeLog::Mode::off;
  if (!traced) return false;
  const auto copied = [&](std::size_t count) {
    const std::vector<Rgb>& all = samples.results().radiance;
    return std::vector<Rgb>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  };
  radiance.fast = copied(positions.size());

  const auto start = Clock::now();
  for (TreeRay& ray : log.rays)
    if (is_finite(ray.ray)) ray.found = judge.ask_truth(ray.ray);
  log.truth.seconds += seconds_since(start);
  log.truth.rays += log.rays.size();
  for (TreeRay& ray : log.rays) {
    if (!is_finite(ray.ray)) continue;
    ray.comparison = ray.ray.occlusion ? judge.occlusion(ray.ray, ray.occluded, ray.found)
                                       : judge.nearest(ray.ray, ray.hit, ray.found);
  }

  std::vector<Vec2f> again;
  log.replayed.clear();
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (chosen[i]) again.push_back(positions[i]), log.replayed.push_back(static_cast<std::uint16_t>(i));
  radiance.truth.assign(positions.size(), Rgb());
  if (again.empty()) return true;
  log.mode = TreeLog::Mode::replay;
  const bool replayed = samples.trace(again, 1);
  log.mode = TreeLog::Mode::off;
  if (!replayed) return false;
  const std::vector<Rgb> truth = copied(again.size());
  for (std::size_t i = 0; i < again.size(); ++i) radiance.truth[log.replayed[i]] = truth[i];
  return true;
}

}  // namespace raytree::benchmarks
