#include "renderer/shadow_path.h"

#include <algorithm>
#include <cmath>

#include "geometry/true_surfaces.h"
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

/// Whether the path ends at what it meets next: the light, or something dark.
bool ends_at(const Scene& scene, MediaTable* media, const Hit& hit, ShadowPath& path) {
  if (hit.geometry == kNoGeometry) {
    if (media != nullptr) path.transmittance *= media->transmitted(path.media, path.distance);
    return true;
  }
  if (scene.materials[scene.material_at(hit)].has_transmission && path.crossings != kMostShadowCrossings) return false;
  path.transmittance = Rgb();
  return true;
}

/// Takes the path through what it meets, the surface at `point`. False: it has ended there.
bool goes_through(const Scene& scene, MediaTable* media, const Hit& hit, const SurfacePoint& point, ShadowPath& path) {
  const Material& material = scene.materials[scene.material_at(hit)];
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

}  // namespace

bool follow_shadow(const Scene& scene, MediaTable* media, const Hit& hit, ShadowPath& path) {
  return !ends_at(scene, media, hit, path) &&
         goes_through(scene, media, hit, hit_surface(scene, path.origin, path.direction, hit), path);
}

ShadowPaths::ShadowPaths(const Scene& scene, std::size_t capacity)
    : scene_(scene),
      rays_(kBatchSize),
      samples_(kBatchSize),
      hits_(kBatchSize),
      surfaces_(std::make_unique<SurfaceBatch>()) {
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
    std::size_t left = 0;
    for (std::size_t first = 0; first < live_.size(); first += kBatchSize)
      left = take_on(first, std::min(kBatchSize, live_.size() - first), left, media);
    live_.resize(left);
  }
}

/// Takes `count` of the live paths, from `first` on, to what they meet and through it. Those that have not ended there
/// go to live_[left] and on; returns where these end.
std::size_t ShadowPaths::take_on(std::size_t first, std::size_t count, std::size_t left, MediaTable* media) {
  for (std::size_t i = 0; i < count; ++i) {
    ShadowPath& path = paths_[live_[first + i]];
    ++path.queries;
    rays_.set(i, path.origin, path.direction, path.distance);
    samples_[i] = path.sample;
  }
  rays_.size = count;
  scene_.intersector->intersect(rays_, Coherence::incoherent, hits_);
  // Only surfaces that are gone through are looked for.
  for (std::size_t i = 0; i < count; ++i)
    if (ends_at(scene_, media, hits_[i], paths_[live_[first + i]])) hits_.geometry[i] = kNoGeometry;
  find_surfaces(*scene_.shapes, rays_, hits_, false, *surfaces_);
  if (scene_.sphere_pixels > 0) move_to_true_surfaces(*scene_.shapes, scene_.sphere_pixels, rays_, hits_, *surfaces_);
  for (std::size_t i = 0; i < count; ++i) {
    if (hits_.geometry[i] == kNoGeometry) continue;
    const std::uint32_t path = live_[first + i];
    if (goes_through(scene_, media, hits_[i], (*surfaces_)[i], paths_[path])) live_[left++] = path;
  }
  return left;
}

}  // namespace raytree
