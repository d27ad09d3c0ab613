#include "benchmarks/ray_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface.h"

namespace raytree::benchmarks {
namespace {

/// Surfaces that one ray may pass in a row, each excused.
constexpr int kMostPassed = 16;

SurfaceId id_of(const Hit& hit) { return {hit.geometry, hit.primitive, hit.instance}; }
SurfaceId id_of(const ReferenceHit& hit) { return {hit.geometry, hit.primitive, hit.instance}; }

double ulp(float x) { return double(std::nextafter(x, std::numeric_limits<float>::infinity())) - double(x); }

/// Why rounding may both find and miss the surface; agree: it may not.
RayVerdict excuse(const SurfaceBounds& bounds) {
  if (bounds.grazing) return RayVerdict::grazing;
  if (std::abs(bounds.distance) <= bounds.distance_error) return RayVerdict::self;
  return bounds.side == SurfaceBounds::Side::uncertain ? RayVerdict::edge : RayVerdict::agree;
}

RayComparison comparison(RayVerdict verdict, const SurfaceBounds& bounds) {
  return {verdict, 0, bounds.edge_distance, bounds.edge_error, bounds.distance_error, bounds.position_error};
}

}  // namespace

ReferenceHit RayJudge::ask_truth(const ComparedRay& ray) const {
  return truth_.nearest(Vec3d(ray.origin), Vec3d(ray.direction), ray.max_distance);
}

Hit RayJudge::ask_tracer(const ComparedRay& ray) const {
  RayBatch rays(1);
  HitBatch hits(1);
  rays.push(ray.origin, ray.direction, ray.max_distance);
  tracer_.intersect(rays, Coherence::incoherent, hits);
  return hits[0];
}

SurfaceBounds RayJudge::bounds_of(const ShapeSet& shapes, const ComparedRay& ray, const SurfaceId& id,
                                  double near) const {
  return surface_bounds(shapes, ray.origin, ray.direction, id, near, arithmetic_);
}

/// The truth's hit, before `end` of the fast tracer's, was not reported. So were all that follow it up to there.
RayComparison RayJudge::missed(const ComparedRay& ray, const ReferenceHit& found, double end, double end_error) const {
  RayComparison first{};
  ReferenceHit next = found;
  for (int passed = 0; passed < kMostPassed; ++passed) {
    const SurfaceBounds bounds = bounds_of(truth_shapes_, ray, id_of(next), next.distance);
    RayVerdict verdict = excuse(bounds);
    if (verdict == RayVerdict::agree && next.distance + bounds.distance_error + end_error >= end)
      verdict = RayVerdict::coplanar;
    if (verdict == RayVerdict::agree) return comparison(RayVerdict::defect, bounds);
    if (passed == 0) first = comparison(verdict, bounds);
    // On behind it: what meets it there is excused alike.
    const double after = next.distance + (std::abs(next.distance) + Vec3d(ray.origin).length()) * 0x1p-40;
    if (!(after < end)) return first;
    next = truth_.nearest(Vec3d(ray.origin) + Vec3d(ray.direction) * after, Vec3d(ray.direction), end - after);
    if (!next.hit()) return first;
    next.distance += after;
  }
  return first;
}

/// The fast tracer found a surface that the truth does not, or finds behind `found`.
RayComparison RayJudge::extra(const ComparedRay& ray, const SurfaceBounds& bounds, const ReferenceHit& found) const {
  RayVerdict verdict = excuse(bounds);
  if (verdict == RayVerdict::agree) {
    double end = ray.max_distance, end_error = 0;
    if (found.hit()) {
      end = found.distance;
      end_error = bounds_of(truth_shapes_, ray, id_of(found), end).distance_error;
    }
    verdict = bounds.distance + bounds.distance_error + end_error >= end ? RayVerdict::coplanar : RayVerdict::defect;
  }
  return comparison(verdict, bounds);
}

RayComparison RayJudge::nearest(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found) const {
  const RayComparison result = nearest_on_facets(ray, hit, found);
  return result.verdict == RayVerdict::defect ? deviating(ray, hit, found, result) : result;
}

/// What rounding does not explain, where the truth knows what facets stand for. The ray is judged in two steps: the
/// fast tracer against the facets in double, which only rounding may excuse; and the facets against what they stand
/// for, which must lie as near each other as was asked, both at what the facets and at what the truth let the ray meet.
RayComparison RayJudge::deviating(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found,
                                  const RayComparison& otherwise) const {
  if (of_facets_ == nullptr) return otherwise;
  const ReferenceHit on_facets = of_facets_->ask_truth(ray);
  const RayComparison rounding = of_facets_->nearest(ray, hit, on_facets);
  if (rounding.verdict != RayVerdict::agree) return rounding;
  const Vec3d origin(ray.origin), direction(ray.direction);
  SurfaceDeviation of_facet, of_found;
  if (on_facets.hit()) {
    of_facet = surface_deviation(truth_shapes_, tolerance_, id_of(on_facets), kNoFace,
                                 origin + direction * on_facets.distance);
    if (of_facet.distance > 0 && !facet_stands_for_surface(truth_shapes_, truth_, id_of(on_facets), on_facets.u,
                                                           on_facets.v, of_facet.distance, nullptr))
      return otherwise;
  }
  if (found.hit()) {
    const Vec3d place = origin + direction * found.distance;
    of_found = surface_deviation(truth_shapes_, tolerance_, id_of(found), found.face, place);
    if (of_found.distance > 0 &&
        !facet_stands_for_surface(truth_shapes_, truth_, id_of(found), found.u, found.v, of_found.distance, &place))
      return otherwise;
  }
  const double off = std::max(of_facet.distance, of_found.distance);
  if (!(off > 0)) return otherwise;
  RayComparison excused = otherwise;
  excused.verdict = of_facet.curved || of_found.curved ? RayVerdict::tessellation : RayVerdict::nonplanar;
  excused.edge_error = off;
  return excused;
}

RayComparison RayJudge::nearest_on_facets(const ComparedRay& ray, const Hit& hit, const ReferenceHit& found) const {
  const bool hits = hit.geometry != kNoGeometry;
  if (!hits && !found.hit()) return {};
  if (!hits) return missed(ray, found, ray.max_distance, 0);
  const SurfaceBounds bounds = bounds_of(shapes_, ray, id_of(hit), hit.distance);
  // No truth is needed to tell wrong weights; where the ray grazes, they have no bound.
  if (hit.geometry >= kFirstMeshGeometry && !bounds.grazing &&
      std::max(std::abs(hit.u - bounds.u), std::abs(hit.v - bounds.v)) > bounds.weight_error)
    return comparison(RayVerdict::defect, bounds);
  // A truth that knows what triangles stand for names one by the surface's parameters: any of the mesh will do.
  if (found.face != kNoFace && found.geometry == hit.geometry && found.instance == hit.instance && !bounds.grazing &&
      id_of(hit) != id_of(found) && std::abs(hit.distance - found.distance) <= bounds.distance_error)
    return {RayVerdict::agree,     std::abs(hit.distance - found.distance) / ulp(hit.distance),
            bounds.edge_distance,  bounds.edge_error,
            bounds.distance_error, bounds.position_error};
  if (found.hit() && id_of(hit) == id_of(found)) {
    const double off = std::abs(hit.distance - found.distance);
    const SurfaceDeviation deviation =
        found.face == kNoFace ? SurfaceDeviation()
                              : surface_deviation(truth_shapes_, tolerance_, id_of(found), found.face,
                                                  Vec3d(ray.origin) + Vec3d(ray.direction) * found.distance);
    const Vec3f normal = surface_at(shapes_, ray.origin, ray.direction, hit, false).geometric_normal;
    if (!bounds.grazing && off <= bounds.distance_error &&
        (deviation.distance > 0 || (Vec3d(normal) - found.normal).length() <= bounds.normal_error))
      return {RayVerdict::agree, off / ulp(hit.distance), bounds.edge_distance,
              bounds.edge_error, bounds.distance_error,   bounds.position_error};
    const SurfaceBounds own = bounds_of(truth_shapes_, ray, id_of(found), found.distance);
    const RayVerdict verdict = excuse(own);
    return comparison(verdict == RayVerdict::agree ? RayVerdict::defect : verdict, own);
  }
  // What the fast tracer says must be what rounding can make of this ray and this surface.
  if (bounds.side == SurfaceBounds::Side::outside ||
      (!bounds.grazing && std::abs(hit.distance - bounds.distance) > bounds.distance_error))
    return comparison(RayVerdict::defect, bounds);
  if (found.hit() && found.distance <= hit.distance) return missed(ray, found, hit.distance, bounds.distance_error);
  return extra(ray, bounds, found);
}

RayComparison RayJudge::occlusion(const ComparedRay& ray, bool occluded, const ReferenceHit& found) const {
  if (occluded == found.hit()) return {};
  if (!occluded) {
    const RayComparison result = missed(ray, found, ray.max_distance, 0);
    return result.verdict == RayVerdict::defect ? deviating(ray, Hit(), found, result) : result;
  }
  // What was in the way is not said: the ray is asked again, alone.
  const Hit hit = ask_tracer(ray);
  if (hit.geometry != kNoGeometry) return nearest(ray, hit, found);
  RayComparison result;
  result.verdict = is_near_outline(ray, 0, ray.max_distance) ? RayVerdict::edge : RayVerdict::defect;
  return result;
}

/// Whether the outline of something that lies `begin` to `end` away is within its bound of the ray: looked for with
/// rays that start beside it.
bool RayJudge::is_near_outline(const ComparedRay& ray, double begin, double end) const {
  const Vec3d direction(ray.direction), start = Vec3d(ray.origin) + direction * begin;
  const Vec3d u = (std::abs(direction.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).cross(direction).normalized();
  const Vec3d v = direction.cross(u);
  const double origin = Vec3d(ray.origin).length();
  const double reach = origin + (std::isfinite(end) ? end : origin);
  for (const double step : {0x1p-24, 0x1p-22, 0x1p-20, 0x1p-18})
    for (const Vec3d& way : {u, -u, v, -v, u + v, u - v, v - u, -u - v}) {
      const ReferenceHit beside = truth_.nearest(start + way * (step * reach), direction, end - begin);
      if (!beside.hit()) continue;
      const SurfaceBounds bounds = bounds_of(truth_shapes_, ray, id_of(beside), begin + beside.distance);
      if (bounds.grazing || bounds.side == SurfaceBounds::Side::uncertain) return true;
    }
  return false;
}

bool RayJudge::is_possible(const ComparedRay& ray, float distance, double share) const {
  const bool hits = distance < kInfinity;
  if (ray.occlusion && hits) return ask_truth(ray).hit() || is_near_outline(ray, 0, ray.max_distance);
  // Nothing that is certain may lie before it.
  const double before = hits ? distance * (1 - share) : double(ray.max_distance);
  const Vec3d origin(ray.origin), direction(ray.direction);
  const ReferenceHit nearer = truth_.nearest(origin, direction, before);
  if (nearer.hit() && missed(ray, nearer, before, 0).verdict == RayVerdict::defect) return false;
  if (!hits) return true;
  // And something must be there, or may be: as it is, past an outline, or where a distance says little.
  const double behind = distance * (1 + share);
  if (truth_.nearest(origin + direction * before, direction, behind - before).hit()) return true;
  if (is_near_outline(ray, before, behind)) return true;
  const ReferenceHit found = ask_truth(ray);
  if (!found.hit()) return false;
  const SurfaceBounds bounds = bounds_of(truth_shapes_, ray, id_of(found), found.distance);
  return bounds.grazing || std::abs(found.distance - distance) <= bounds.distance_error;
}

}  // namespace raytree::benchmarks
