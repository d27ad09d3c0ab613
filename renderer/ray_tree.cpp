#include "renderer/ray_tree.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "renderer/facet_shading.h"
#include "renderer/features.h"
#include "renderer/media.h"
#include "renderer/rough_surface.h"
#include "renderer/shading.h"
#include "renderer/shadow_path.h"

namespace raytree {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// A ray of the tree that waits for its turn.
struct PendingRay {
  Vec3f origin;
  float allowance;  ///< what may still be cut off below it, radiance
  Vec3f direction;
  std::uint16_t sample;  ///< in the chunk
  MediaId media;         ///< that it is in, where media are tracked
  Rgb weight;            ///< of what it brings in its sample
  std::uint32_t level;   ///< the eye ray is 1
};
static_assert(sizeof(PendingRay) == 48);
static_assert(kBatchSize <= std::size_t(1) << 16);

/// A hit of the batch under way, with the context of its ray.
struct BatchPoint {
  ShadingPoint shading;
  Rgb weight;
  float allowance;
  std::uint16_t sample;
  std::uint32_t level;
};

/// What a batch spawns, before it joins the pending rays: by kind, so that neighbours in a packet run much the same
/// way. With the rays' paths where some surface is rough.
struct NewRays {
  std::vector<PendingRay> reflected, refracted;
  std::vector<PendingRay> passed;  ///< that met a surface which separates nothing
  std::vector<TreePath> reflected_paths, refracted_paths, passed_paths;
};

/// What the two children of a hit may cut off below them, and which of them is itself cut.
struct Shares {
  float reflected, refracted;
  bool cuts_reflected, cuts_refracted;
};

/// Divides a ray's allowance over its children, whose bounds are given (0: no such child). The child with the smaller
/// bound is judged first, and what it leaves of its half passes to the other; so the cuts below a ray never exceed its
/// allowance. An absent child takes nothing, since its bound is 0 and leaves all.
inline Shares divided_allowance(float allowance, float reflected_bound, float refracted_bound) {
  const bool reflected_first = reflected_bound <= refracted_bound;
  const float smaller = reflected_first ? reflected_bound : refracted_bound;
  const float larger = reflected_first ? refracted_bound : reflected_bound;
  const float half = allowance / 2;
  const bool cuts_smaller = smaller <= half;
  const float rest = cuts_smaller ? allowance - smaller : half;
  const bool cuts_larger = larger <= rest;
  if (reflected_first) return {half, rest, cuts_smaller, cuts_larger};
  return {rest, half, cuts_larger, cuts_smaller};
}

}  // namespace

struct SampleTracer::State {
  State(const Scene& scene_, const SampleRecords& records_, const std::atomic<bool>* stop_)
      : scene(scene_),
        settings(scene_.description.render),
        records(records_),
        stop(stop_),
        rays(kBatchSize),
        hits(kBatchSize),
        shadow_rays(kBatchSize),
        occluded(kBatchSize + kBatchPadding),
        shadow_samples(kBatchSize),
        shadow_light(kBatchSize),
        eye_rays(kBatchSize),
        hit_rays(kBatchSize),
        points(kBatchSize) {
    const std::size_t split_batches = tracks_paths() ? 2 * static_cast<std::size_t>(settings.rough_samples) : 0;
    pending.reserve((4 + split_batches) * kBatchSize);
    new_rays.reflected.reserve(kBatchSize);
    new_rays.refracted.reserve(kBatchSize);
    if (tracks_paths()) {
      pending_paths.reserve(pending.capacity());
      eye_paths.resize(kBatchSize);
      point_paths.resize(kBatchSize);
    }
    for (const Material& material : scene.materials) wants_texture |= material.needs_texture;
    instanced = !scene.shapes->instances.empty();
    if (shades_facets()) facets.emplace(scene);
    if (follows_shadows()) shadow_paths.emplace(scene, kBatchSize);
    if (tracks_media()) {
      media.emplace(scene);
      boundaries.resize(kBatchSize);
      shadow_media.resize(kBatchSize);
    }
    results.radiance.resize(kBatchSize);
    results.truncation.resize(records.truncation ? kBatchSize : 0);
    results.ray_counts.resize(records.ray_counts ? kBatchSize : 0);
    results.first_hits.resize(records.first_hits ? kBatchSize : 0);
  }

  bool trace(std::span<const Vec2f> positions, float spacing);
  void begin_sample(std::size_t i, const Vec2f& position);
  bool tracks_media() const { return kFeatures.media && scene.tracks_media; }
  bool follows_shadows() const { return kFeatures.transparent_shadows && scene.transparent_shadows; }
  bool tracks_paths() const { return kFeatures.rough_surfaces && scene.rough_surfaces; }
  bool shades_facets() const { return kFeatures.facet_shading && scene.shades_facets; }
  bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void trace_batch(Coherence coherence, bool eye);
  void collect_hits(bool eye);
  void prefetch_triangles(const ShapeSet& shapes) const;
  std::span<const BatchPoint> batch_points() const { return {points.data(), point_count}; }
  void find_eye_media(std::span<const Vec2f> positions);
  bool passes(std::size_t p, const PendingRay& ray, const Hit& hit);
  Rgb escaping_weight(const PendingRay& ray) const { return ray.weight * media->transmitted(ray.media, kInfinity); }
  void add_lights();
  template <bool kFacets>
  void add_lights_to_points();
  void add_facet(std::size_t p, std::size_t i);
  void follow_shadows(std::size_t count);
  void spawn();
  unsigned spawn_specially(const BatchPoint& point);
  unsigned spawn_on_path(const BatchPoint& point, float relative_index, MediaId before, MediaId after);
  unsigned spawn_children(const BatchPoint& point, const Branches& children, float& allowance, MediaId before,
                          MediaId after, NewRays& out);
  void cut(std::uint32_t sample, const Rgb& bound);
  void add_children(RayKind kind, std::vector<PendingRay>& children);
  void add_rays_on_paths();
  void record_first_hit(const BatchPoint& point, std::uint32_t object, std::uint32_t material);

  const Scene& scene;
  const RenderSettings& settings;
  const SampleRecords records;
  const std::atomic<bool>* stop;
  RenderStatistics statistics;
  SampleResults results;

  RayBatch rays;
  HitBatch hits;
  RayBatch shadow_rays;
  std::vector<std::uint8_t> occluded;
  std::vector<std::uint32_t> shadow_samples;
  std::vector<Rgb> shadow_light;  ///< what a shadow ray brings when nothing is in its way

  std::vector<PendingRay> eye_rays;      ///< contexts of the chunk's eye rays
  const PendingRay* contexts = nullptr;  ///< [rays.size] of the batch under way; read before children are spawned
  std::vector<std::uint32_t> hit_rays;   ///< [hit_count] index in the batch of each hit
  std::size_t hit_count = 0;
  std::size_t point_count = 0;      ///< hit_count, less the surfaces that separate nothing
  std::vector<BatchPoint> points;   ///< hits of the batch under way
  std::vector<PendingRay> pending;  ///< the newest rays are traced first
  NewRays new_rays;                 ///< of the batch under way

  // Where surfaces are rough, paths beside rays:
  std::vector<TreePath> pending_paths, eye_paths;
  const TreePath* context_paths = nullptr;  ///< [rays.size] of the batch under way
  std::vector<TreePath> point_paths;        ///< [point_count]
  NewRays split_rays;                       ///< that have a rough bounce behind them; these lie on top of new_rays

  bool wants_texture = false;
  SampleWindow eye_window;  ///< of the chunk's eye rays
  bool instanced = false;   ///< the scene has instances

  /// Where some facets are shaded in a way of their own.
  std::optional<FacetShading> facets;

  /// Where something transmits and shadows show it.
  std::optional<ShadowPaths> shadow_paths;

  // Where media are tracked:
  std::optional<MediaTable> media;
  std::vector<Solid> eye_solids;  ///< that a perspective eye lies in
  bool knows_eye_solids = false;
  std::vector<MediaBoundary> boundaries;  ///< [point_count] what each point separates
  std::vector<MediaId> shadow_media;      ///< that shadow rays start in
};

void SampleTracer::State::begin_sample(std::size_t i, const Vec2f& position) {
  Vec3f origin, direction;
  scene.camera.ray(position.x, position.y, origin, direction);
  rays.set(i, origin, direction, kInfinity);
  eye_rays[i] = {
      origin, static_cast<float>(settings.cutoff), direction, static_cast<std::uint16_t>(i), kNoMedia, Rgb(1), 1};
  results.radiance[i] = Rgb();
}

/// Traces the eye rays of up to kBatchSize samples and all that grows from them. False: stopped.
bool SampleTracer::State::trace(std::span<const Vec2f> positions, float spacing) {
  eye_window = {&scene.camera, spacing, settings.antialias.method == Antialiasing::Method::whitted};
  for (std::size_t i = 0; i < positions.size(); ++i) begin_sample(i, positions[i]);
  if (tracks_media()) find_eye_media(positions);
  std::fill(results.truncation.begin(), results.truncation.end(), Rgb());
  std::fill(results.ray_counts.begin(), results.ray_counts.end(), 1u);
  std::fill(results.first_hits.begin(), results.first_hits.end(), FirstHit());
  if (tracks_paths())
    for (std::size_t i = 0; i < positions.size(); ++i) eye_paths[i] = TreePath::of_eye(positions[i]);
  rays.size = positions.size();
  statistics.rays[static_cast<int>(RayKind::primary)] += positions.size();
  statistics.samples += positions.size();
  statistics.deepest_level = std::max(statistics.deepest_level, 1);
  contexts = eye_rays.data();
  context_paths = eye_paths.data();
  trace_batch(Coherence::coherent, true);
  while (!pending.empty()) {
    if (stopped()) return false;
    const std::size_t count = std::min(kBatchSize, pending.size());
    contexts = pending.data() + pending.size() - count;
    if (tracks_paths()) context_paths = pending_paths.data() + pending.size() - count;
    for (std::size_t i = 0; i < count; ++i) {
      const PendingRay& ray = contexts[i];
      rays.set(i, ray.origin, ray.direction, kInfinity);
      if (kFeatures.ray_count_channel && records.ray_counts) ++results.ray_counts[ray.sample];
    }
    rays.size = count;
    trace_batch(Coherence::mixed, false);
  }
  return !stopped();
}

void SampleTracer::State::trace_batch(Coherence coherence, bool eye) {
  const auto start = Clock::now();
  scene.intersector->intersect(rays, coherence, hits);
  const auto hit = Clock::now();
  const double intersection_before = statistics.intersection_seconds;
  collect_hits(eye);
  if (!eye) pending.resize(pending.size() - rays.size);
  add_lights();
  spawn();
  if (tracks_paths()) add_rays_on_paths();
  add_children(RayKind::reflected, new_rays.reflected);
  add_children(RayKind::refracted, new_rays.refracted);
  if (tracks_media()) add_children(RayKind::refracted, new_rays.passed);
  const double shadow_seconds = statistics.intersection_seconds - intersection_before;
  statistics.shading_seconds += seconds_since(hit) - shadow_seconds;
  statistics.intersection_seconds += std::chrono::duration<double>(hit - start).count();
}

void SampleTracer::State::add_children(RayKind kind, std::vector<PendingRay>& children) {
  if (children.empty()) return;
  statistics.rays[static_cast<int>(kind)] += children.size();
  for (const PendingRay& child : children)
    statistics.deepest_level = std::max(statistics.deepest_level, static_cast<int>(child.level));
  pending.insert(pending.end(), children.begin(), children.end());
  children.clear();
}

/// Adds what the batch spawned with its paths, the rays that have split on top of all that have not.
[[gnu::noinline]] void SampleTracer::State::add_rays_on_paths() {
  pending_paths.resize(pending.size());  // less the batch's own
  const auto move_to_pending = [&](std::vector<TreePath>& paths) {
    pending_paths.insert(pending_paths.end(), paths.begin(), paths.end());
    paths.clear();
  };
  for (NewRays* added : {&new_rays, &split_rays}) {
    add_children(RayKind::reflected, added->reflected);
    add_children(RayKind::refracted, added->refracted);
    add_children(RayKind::refracted, added->passed);
    move_to_pending(added->reflected_paths);
    move_to_pending(added->refracted_paths);
    move_to_pending(added->passed_paths);
  }
}

void SampleTracer::State::collect_hits(bool eye) {
  const ShapeSet& shapes = *scene.shapes;
  const bool media_matter = tracks_media(), facets_matter = shades_facets();
  const SampleWindow window = eye ? eye_window : SampleWindow();
  hit_count = 0;
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (hits.geometry[i] != kNoGeometry) {
      hit_rays[hit_count++] = static_cast<std::uint32_t>(i);
      continue;
    }
    const PendingRay& ray = contexts[i];
    // A ray that is not finite misses everything: its sample becomes NaN, and so is counted and reported.
    const Vec3f poison = (ray.origin + ray.direction) * 0.0f;
    results.radiance[ray.sample] +=
        (media_matter ? escaping_weight(ray) : ray.weight) * scene.background.along(ray.direction) +
        Rgb(poison.x + poison.y + poison.z);
  }
  prefetch_triangles(shapes);

  if (facets_matter) facets->begin_batch();
  std::size_t count = 0;
  for (std::size_t h = 0; h < hit_count; ++h) {
    const std::size_t i = hit_rays[h];
    const PendingRay& ray = contexts[i];
    const Hit hit = hits[i];
    BatchPoint& point = points[count];
    std::uint32_t object, material_index;
    if (kFeatures.instances && instanced && hit.instance != kNoInstance) {
      object = shapes.instances[hit.instance].object;
      material_index = scene.material_at(hit);
      find_instance_surface(shapes, ray.origin, ray.direction, hit, wants_texture, point.shading.surface);
    } else {
      object = shapes.shape_of(hit.geometry, hit.primitive);
      material_index = scene.own_material(shapes, object, hit);
      find_surface(shapes, ray.origin, ray.direction, hit, wants_texture, point.shading.surface);
    }
    if (facets_matter) [[unlikely]]
      add_facet(count, i);
    const Material& material = scene.materials[material_index];
    complete_shading_point(point.shading, ray.direction, material, window);
    point.weight = ray.weight;
    point.allowance = ray.allowance;
    point.sample = ray.sample;
    point.level = ray.level;
    if ((kFeatures.media || kFeatures.absorption || kFeatures.rough_surfaces) && material.takes_on_the_way &&
        passes(count, ray, hit))
      continue;
    if (kFeatures.distance_attenuation && settings.distance_attenuation > 0 && ray.level > 1)
      point.weight *=
          segment_attenuation(static_cast<float>(settings.distance_attenuation), point.shading.surface.distance);
    results.radiance[ray.sample] += point.weight * scene.ambient * ambient_of(point.shading, window);
    if (kFeatures.first_hit_channels && records.first_hits && ray.level == 1)
      record_first_hit(point, object, material_index);
    ++count;
  }
  point_count = count;
}

/// The sets of the chunk's eye rays. Parallel eye rays start in places of their own.
[[gnu::noinline]] void SampleTracer::State::find_eye_media(std::span<const Vec2f> positions) {
  media->clear();
  if (scene.camera.is_perspective()) {
    if (!knows_eye_solids) eye_solids = solids_around(scene, scene.camera.position(), scene.camera.forward());
    knows_eye_solids = true;
    const MediaId set = media->set_of(eye_solids);
    for (std::size_t i = 0; i < positions.size(); ++i) eye_rays[i].media = set;
  } else {
    for (std::size_t i = 0; i < positions.size(); ++i)
      eye_rays[i].media = media->set_of(solids_around(scene, eye_rays[i].origin, eye_rays[i].direction));
  }
}

/// Takes what was absorbed on the way to a point, notes its path, and says what its surface separates. True: nothing;
/// the ray goes on behind it, at its level.
[[gnu::noinline]] bool SampleTracer::State::passes(std::size_t p, const PendingRay& ray, const Hit& hit) {
  BatchPoint& point = points[p];
  const SurfacePoint& surface = point.shading.surface;
  const TreePath path = tracks_paths() ? context_paths[&ray - contexts] : TreePath();
  if (tracks_paths()) point_paths[p] = path;
  if (!tracks_media()) {
    if (point.shading.material->absorbs && point.shading.leaving)
      point.weight *= transmitted_share(point.shading.material->absorption, surface.distance);
    return false;
  }
  MediaBoundary& boundary = boundaries[p];
  boundary = media->boundary(ray.media, solid_at(scene, hit), point.shading.leaving);
  point.weight *= media->transmitted(boundary.before, surface.distance);
  if (!boundary.passes) return false;
  if (records.first_hits && ray.level == 1) results.first_hits[ray.sample].distance += surface.distance;
  NewRays& out = path.is_split ? split_rays : new_rays;
  if (tracks_paths()) out.passed_paths.push_back(path);
  out.passed.push_back({offset_origin(surface, -surface.geometric_normal), ray.allowance, ray.direction, ray.sample,
                        boundary.after, point.weight, ray.level});
  return true;
}

/// The vertices of the batch's triangles lie anywhere in memory: all are asked for before the first is used.
void SampleTracer::State::prefetch_triangles(const ShapeSet& shapes) const {
  const bool any_instances = kFeatures.instances && instanced;
  if (shapes.meshes.empty() && !any_instances) return;
  const auto for_each_triangle = [&](auto&& function) {
    for (std::size_t h = 0; h < hit_count; ++h) {
      const std::size_t i = hit_rays[h];
      if (hits.geometry[i] < kFirstMeshGeometry) continue;
      const BoundedShapes& list = any_instances && hits.instance[i] != kNoInstance
                                      ? shapes.groups[shapes.instances[hits.instance[i]].group]
                                      : shapes;
      function(list.meshes[hits.geometry[i] - kFirstMeshGeometry].mesh, std::size_t(hits.primitive[i]) * 3);
    }
  };
  for_each_triangle([](const TriangleMesh& mesh, std::size_t corner) { __builtin_prefetch(&mesh.corners[corner]); });
  for_each_triangle([](const TriangleMesh& mesh, std::size_t corner) {
    const bool normals = !mesh.normals.empty() && mesh.normal_corners.empty();
    for (std::size_t c = corner; c < corner + 3; ++c) {
      __builtin_prefetch(&mesh.positions[mesh.corners[c]]);
      if (normals) __builtin_prefetch(&mesh.normals[mesh.corners[c]]);
    }
  });
}

/// Point p of the batch, which ray i met, is about to be turned to the ray.
[[gnu::noinline]] void SampleTracer::State::add_facet(std::size_t p, std::size_t i) {
  facets->add(p, hits[i], contexts[i].direction, contexts[i].level == 1, points[p].shading.surface);
}

void SampleTracer::State::add_lights() {
  if (shades_facets())
    add_lights_to_points<true>();
  else
    add_lights_to_points<false>();
}

/// kFacets: some facets are shaded in a way of their own.
template <bool kFacets>
void SampleTracer::State::add_lights_to_points() {
  for (const Light& light : scene.lights) {
    std::size_t count = 0;
    for (const BatchPoint& point : batch_points()) {
      const Material& material = *point.shading.material;
      if (!material.has_diffuse && !material.has_highlight) continue;
      const auto p = static_cast<std::size_t>(&point - points.data());
      LocalLight local = kFacets ? facets->light(p, point.shading, light, settings.highlights)
                                 : local_light(point.shading, light, settings.highlights);
      if (!local.lit) continue;
      Rgb shadowed = local.diffuse;
      if (settings.shadowed_highlights)
        shadowed += local.highlight;
      else
        results.radiance[point.sample] += point.weight * local.highlight;
      if (is_black(shadowed)) continue;
      if (!settings.shadows) {
        results.radiance[point.sample] += point.weight * shadowed;
        continue;
      }
      const Vec3f origin = kFacets ? facets->shadow_origin(p, point.shading, light, local)
                                   : offset_origin(point.shading.surface, point.shading.surface.geometric_normal);
      shadow_rays.set(count, origin, local.direction, local.distance);
      shadow_samples[count] = point.sample;
      shadow_light[count] = point.weight * shadowed;
      if (tracks_media()) shadow_media[count] = boundaries[p].before;
      ++count;
    }
    if (count == 0) continue;
    shadow_rays.size = count;
    const auto start = Clock::now();
    scene.intersector->occluded(shadow_rays, Coherence::coherent, occluded.data());
    statistics.intersection_seconds += seconds_since(start);
    statistics.rays[static_cast<int>(RayKind::shadow)] += count;
    if (follows_shadows() || tracks_media()) follow_shadows(count);
    for (std::size_t i = 0; i < count; ++i)
      if (!occluded[i]) results.radiance[shadow_samples[i]] += shadow_light[i];
    if (kFeatures.ray_count_channel && records.ray_counts)
      for (std::size_t i = 0; i < count; ++i) ++results.ray_counts[shadow_samples[i]];
  }
}

/// Adds what comes through the shadows of what transmits, and takes from the other rays what their medium absorbs.
[[gnu::noinline]] void SampleTracer::State::follow_shadows(std::size_t count) {
  const auto start = Clock::now();
  if (shadow_paths) shadow_paths->clear();
  for (std::size_t i = 0; i < count; ++i) {
    const MediaId set = tracks_media() ? shadow_media[i] : kNoMedia;
    if (occluded[i]) {
      if (shadow_paths) shadow_paths->add(shadow_rays, i, set);
    } else if (tracks_media()) {
      shadow_light[i] *= media->transmitted(set, shadow_rays.max_distance[i]);
    }
  }
  if (!shadow_paths) return;
  shadow_paths->follow(tracks_media() ? &*media : nullptr);
  for (const ShadowPath& path : shadow_paths->paths()) {
    const std::uint32_t sample = shadow_samples[path.ray];
    results.radiance[sample] += shadow_light[path.ray] * path.transmittance;
    statistics.rays[static_cast<int>(RayKind::shadow)] += path.queries;
    if (kFeatures.ray_count_channel && records.ray_counts) results.ray_counts[sample] += path.queries;
  }
  statistics.intersection_seconds += seconds_since(start);
}

void SampleTracer::State::spawn() {
  if (shades_facets())
    for (std::size_t p = 0; p < point_count; ++p) facets->bend(p, points[p].shading);
  std::uint64_t branches_at_limit = 0;
  for (const BatchPoint& point : batch_points()) {
    const Material& material = *point.shading.material;
    if (!material.has_reflection && !material.has_transmission) continue;
    if ((kFeatures.special_optics || kFeatures.media || kFeatures.rough_surfaces) && material.special_optics) {
      branches_at_limit += spawn_specially(point);
    } else {
      float allowance = point.allowance;
      branches_at_limit +=
          spawn_children(point, plain_branches(point.shading), allowance, kNoMedia, kNoMedia, new_rays);
    }
  }
  statistics.branches_at_depth_limit += branches_at_limit;
}

/// Out of the way of what most scenes are made of.
[[gnu::noinline]] unsigned SampleTracer::State::spawn_specially(const BatchPoint& point) {
  float allowance = point.allowance;
  if (tracks_media()) {
    const MediaBoundary& boundary = boundaries[static_cast<std::size_t>(&point - points.data())];
    if (tracks_paths()) return spawn_on_path(point, boundary.relative_index, boundary.before, boundary.after);
    return spawn_children(point, branches_between(point.shading, boundary.relative_index), allowance, boundary.before,
                          boundary.after, new_rays);
  }
  if (tracks_paths()) return spawn_on_path(point, plain_relative_index(point.shading), kNoMedia, kNoMedia);
  return spawn_children(point, branches(point.shading), allowance, kNoMedia, kNoMedia, new_rays);
}

/// In a scene with rough surfaces. The first rough point on a way down the tree is met by rough_samples facets, each of
/// which has an equal part of the ray's weight and of its allowance, and what one leaves of its part passes to the
/// others; so what is cut below the ray stays within its allowance. Later ones are met by one facet.
unsigned SampleTracer::State::spawn_on_path(const BatchPoint& point, float relative_index, MediaId before,
                                            MediaId after) {
  const TreePath path = point_paths[static_cast<std::size_t>(&point - points.data())];
  const bool rough = point.shading.material->rough, splits = rough && !path.is_split;
  const std::uint32_t samples = static_cast<std::uint32_t>(settings.rough_samples), count = splits ? samples : 1;
  const float share = 1 / static_cast<float>(count);
  NewRays& out = rough || path.is_split ? split_rays : new_rays;
  float allowance = point.allowance;
  unsigned at_limit = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t index = splits ? i : path.index;
    Branches children = rough ? rough_branches(point.shading, relative_index, path.key, index, samples)
                              : branches_between(point.shading, relative_index);
    children.reflected_weight *= share;
    children.refracted_weight *= share;
    float part = allowance / static_cast<float>(count - i);
    allowance -= part;
    at_limit += spawn_children(point, children, part, before, after, out);
    allowance += part;
    TreePath own = path;
    own.index = static_cast<std::uint16_t>(index);
    own.is_split |= rough;
    if (out.reflected_paths.size() < out.reflected.size()) out.reflected_paths.push_back(own.child(false));
    if (out.refracted_paths.size() < out.refracted.size()) out.refracted_paths.push_back(own.child(true));
  }
  return at_limit;
}

/// `allowance`: what may be cut below the two children; what they leave of it is left. `before`, `after`: the media
/// that the reflected and the refracted ray are in. Returns how many branches the tree's depth ended.
[[gnu::always_inline]] inline unsigned SampleTracer::State::spawn_children(const BatchPoint& point,
                                                                           const Branches& children, float& allowance,
                                                                           MediaId before, MediaId after,
                                                                           NewRays& out) {
  const Rgb reflected_weight = point.weight * children.reflected_weight;
  const Rgb refracted_weight = point.weight * children.refracted_weight;
  const bool reflects = !is_black(reflected_weight), refracts = !is_black(refracted_weight);
  const int level = static_cast<int>(point.level);
  if (level >= settings.depth) return unsigned(reflects) + unsigned(refracts);
  const Rgb below = scene.bound(settings.depth - level - 1);
  const Rgb reflected_bound = reflected_weight * below, refracted_bound = refracted_weight * below;
  const Shares shares = divided_allowance(allowance, max_channel(reflected_bound), max_channel(refracted_bound));
  // Unless both are cut, one of them takes all that the other leaves.
  allowance = shares.cuts_reflected && shares.cuts_refracted
                  ? std::max(0.0f, allowance - max_channel(reflected_bound) - max_channel(refracted_bound))
                  : 0.0f;
  const SurfacePoint& surface = point.shading.surface;
  if (reflects) {
    if (shares.cuts_reflected)
      cut(point.sample, reflected_bound);
    else
      out.reflected.push_back({offset_origin(surface, surface.geometric_normal), shares.reflected, children.reflected,
                               point.sample, before, reflected_weight, point.level + 1});
  }
  if (refracts) {
    if (shares.cuts_refracted)
      cut(point.sample, refracted_bound);
    else
      out.refracted.push_back({offset_origin(surface, -surface.geometric_normal), shares.refracted, children.refracted,
                               point.sample, after, refracted_weight, point.level + 1});
  }
  return 0;
}

void SampleTracer::State::cut(std::uint32_t sample, const Rgb& bound) {
  if (kFeatures.truncation_channel && records.truncation) results.truncation[sample] += bound;
  ++statistics.branches_cut;
}

void SampleTracer::State::record_first_hit(const BatchPoint& point, std::uint32_t object, std::uint32_t material) {
  const SurfacePoint& surface = point.shading.surface;
  // What the eye ray has passed through is in the distance already.
  const float distance = results.first_hits[point.sample].distance + surface.distance;
  results.first_hits[point.sample] = {distance, surface.shading_normal, point.shading.diffuse, object + 1,
                                      material + 1};
}

SampleTracer::SampleTracer(const Scene& scene, const SampleRecords& records, const std::atomic<bool>* stop)
    : state_(std::make_unique<State>(scene, records, stop)), results_(&state_->results) {}
SampleTracer::~SampleTracer() = default;
SampleTracer::SampleTracer(SampleTracer&&) noexcept = default;

bool SampleTracer::trace(std::span<const Vec2f> positions, float spacing) { return state_->trace(positions, spacing); }
RenderStatistics& SampleTracer::statistics() { return state_->statistics; }
const RenderStatistics& SampleTracer::statistics() const { return state_->statistics; }

}  // namespace raytree
