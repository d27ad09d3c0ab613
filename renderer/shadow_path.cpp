#include "renderer/shadow_path.h"

#include <algorithm>
#include <cmath>

#include "renderer/hit_surface.h"

namespace raytree {
namespace {

/// Two triangles that share an edge or a vertex may both report a ray that meets it: behind the first, the second is
/// met from the same side once more. No ray crosses a closed mesh twice the same way with nothing in between, and one
/// plane only once; so where one of the two points lies on the other's plane, up to the clearances that the ray was
/// moved by, the crossing is the same.
bool is_same_crossing(const ShadowPath& path, const Hit& hit, bool leaving, const SurfacePoint& point) {
  if (hit.geometry != path.geometry || hit.instance != path.instance || leaving != path.leaving ||
      hit.geometry < kFirstMeshGeometry)
    return false;
  const Vec3f between = point.position - path.position;
  return std::min(std::abs(between.dot(point.geometric_normal)), std::abs(between.dot(path.normal))) <=
         2 * (path.clearance + point.clearance);
}

}  // namespace

bool follow_shadow(const Scene& scene, MediaTable* media, const Hit& hit, ShadowPath& path) {
  if (hit.geometry == kNoGeometry) {
    if (media != nullptr) path.transmittance *= media->transmitted(path.media, path.distance);
    return false;
  }
  const Material& material = scene.materials[scene.material_at(hit)];
  if (!material.has_transmission || path.crossings == kMostShadowCrossings) {
    path.transmittance = Rgb();
    return false;
  }
  const SurfacePoint point = hit_surface(scene, path.origin, path.direction, hit);
  const bool leaving = path.direction.dot(point.geometric_normal) > 0;
  const bool counts = !is_same_crossing(path, hit, leaving, point);
  if (media != nullptr) {
    const MediaBoundary boundary = media->boundary(path.media, solid_at(scene, hit), leaving);
    path.transmittance *= media->transmitted(boundary.before, point.distance);
    if (counts && !boundary.passes) path.transmittance *= material.shadow_transmission;
    path.media = boundary.after;
  } else if (counts) {
    if (kFeatures.absorption && leaving && material.absorbs)
      path.transmittance *= transmitted_share(material.absorption, point.distance);
    path.transmittance *= material.shadow_transmission;
  }
  if (is_black(path.transmittance)) return false;

  ++path.crossings;
  path.geometry = hit.geometry;
  path.instance = hit.instance;
  path.leaving = leaving;
  path.position = point.position;
  path.normal = point.geometric_normal;
  path.clearance = point.clearance;
  const Vec3f next = offset_origin(point, leaving ? point.geometric_normal : -point.geometric_normal);
  path.distance -= (next - path.origin).dot(path.direction);
  path.origin = next;
  return path.distance > 0;
}

ShadowPaths::ShadowPaths(const Scene& scene, std::size_t capacity)
    : scene_(scene), rays_(capacity), samples_(capacity), hits_(capacity) {
  rays_.sample = samples_.data();
  paths_.reserve(capacity);
  live_.reserve(capacity);
}

void ShadowPaths::add(const RayBatch& rays, std::size_t ray, MediaId media) {
  ShadowPath& path = paths_.emplace_back(rays.origin(ray), rays.direction(ray), rays.max_distance[ray], media);
  path.ray = static_cast<std::uint32_t>(ray);
  if (rays.sample != nullptr) path.sample = rays.sample[ray];
}

void ShadowPaths::follow(MediaTable* media) {
  live_.clear();
  for (std::size_t i = 0; i < paths_.size(); ++i) live_.push_back(static_cast<std::uint32_t>(i));
  while (!live_.empty()) {
    for (std::size_t i = 0; i < live_.size(); ++i) {
      ShadowPath& path = paths_[live_[i]];
      ++path.queries;
      rays_.set(i, path.origin, path.direction, path.distance);
      samples_[i] = path.sample;
    }
    rays_.size = live_.size();
    scene_.intersector->intersect(rays_, Coherence::incoherent, hits_);
    std::size_t left = 0;
    for (std::size_t i = 0; i < live_.size(); ++i)
      if (follow_shadow(scene_, media, hits_[i], paths_[live_[i]])) live_[left++] = live_[i];
    live_.resize(left);
  }
}

}  // namespace raytree
