#include "renderer/ray_tree.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "geometry/ray_batch.h"
#include "geometry/stopwatch.h"
#include "geometry/surface_batch.h"
#include "geometry/true_surfaces.h"
#include "renderer/facet_shading.h"
#include "renderer/features.h"
#include "renderer/media.h"
#include "renderer/ray_queue.h"
#include "renderer/rough_surface.h"
#include "renderer/shading.h"
#include "renderer/shading_batch.h"
#include "renderer/shadow_path.h"

namespace raytree {
namespace {

/// Whether any material can be other than plain.
constexpr bool kAnyInvolved = kFeatures.patterns || kFeatures.bumps || kFeatures.media || kFeatures.absorption ||
                              kFeatures.rough_surfaces || kFeatures.one_sided_surfaces;

static_assert(kBatchSize <= std::size_t(1) << 16, "a ray's sample is a 16-bit number");

/// What a batch spawns, before it joins the pending rays: by kind, so that neighbours in a packet run much the same
/// way. With the rays' paths where some surface is rough.
struct NewRays {
  SpawnedRays reflected, refracted;
  SpawnedRays passed;  ///< that met a surface which separates nothing, or the back of a one-sided one
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
        pending((4 + (tracks_paths() ? 2 * static_cast<std::size_t>(settings.rough_samples) : 0)) * kBatchSize),
        points(kBatchSize) {
    shadow_rays.sample = shadow_samples.data();
    if (tracks_paths()) pending_paths.reserve(pending.capacity());
    passes_rays = tracks_media();
    for (const Material& material : scene.materials) {
      wants_texture |= material.needs_texture;
      passes_rays |= material.one_sided;
    }
    instanced = !scene.shapes->instances.empty();
    ambients.resize(kBatchSize);
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
  void begin_samples(std::span<const Vec2f> positions);
  bool tracks_media() const { return kFeatures.media && scene.tracks_media; }
  bool follows_shadows() const { return kFeatures.transparent_shadows && scene.transparent_shadows; }
  bool tracks_paths() const { return kFeatures.rough_surfaces && scene.rough_surfaces; }
  bool shades_facets() const { return kFeatures.facet_shading && scene.shades_facets; }
  bool stopped() const { return stop != nullptr && stop->load(std::memory_order_relaxed); }
  void trace_batch(Coherence coherence, bool eye);
  void find_hits();
  void collect_points(bool eye);
  void prefetch_triangles(const ShapeSet& shapes) const;
  /// Indices in the batch of what is shaded: of the rays that hit, less those whose surface separates nothing.
  std::span<const std::uint32_t> batch_points() const { return {points.data(), point_count}; }
  TreePath& path(std::size_t i) { return pending_paths[pending.size() + i]; }
  ShadingPoint shading_point(std::size_t i) const { return shading.point(rays, i); }
  /// To the side of the geometric normal that the ray came from, or to the other.
  Vec3f child_origin(std::size_t i, bool behind) const {
    const Vec3f normal = shading.surfaces.geometric_normal[i];
    return shading.surfaces.position[i] + (behind ? -normal : normal) * shading.surfaces.clearance[i];
  }
  void find_eye_media(std::span<const Vec2f> positions);
  void add_background();
  template <bool kInstances>
  bool find_materials();
  void involve_points(bool eye);
  void attenuate_points();
  Rgb plain_ambient(std::size_t i) const {
    const Material& material = *shading.materials[i];
    return material.ambient_as_diffuse ? shading.diffuse(i) : material.ambient.even;
  }
  template <class AmbientAt>
  void add_ambient(AmbientAt&& ambient_at);
  bool passes(std::size_t i, const Hit& hit);
  void go_on_behind(std::size_t i, MediaId media_behind);
  Rgb escaping_weight(std::size_t i) const { return batch.weight(i) * media->transmitted(batch.media[i], kInfinity); }
  void add_lights();
  template <bool kFacets>
  void add_lights_to_points();
  void add_facets();
  void follow_shadows(std::size_t count);
  void bend_normals();
  void spawn();
  unsigned spawn_specially(std::size_t i);
  unsigned spawn_on_path(std::size_t i, const ShadingPoint& point, float relative_index, MediaId before, MediaId after);
  unsigned spawn_children(std::size_t i, const Branches& children, float& allowance, MediaId before, MediaId after,
                          NewRays& out);
  void cut(std::uint32_t sample, const Rgb& bound);
  void add_children(RayKind kind, SpawnedRays& children);
  void add_rays_on_paths();
  void record_first_hits();

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
  std::vector<std::uint16_t> shadow_samples;
  std::vector<Rgb> shadow_light;  ///< what a shadow ray brings when nothing is in its way

  RayQueue pending;  ///< the newest rays are traced first
  RayArrays batch;   ///< that is under way: what `rays` is of
  std::vector<std::uint32_t> points;
  std::size_t point_count = 0;
  ShadingBatch shading;
  std::vector<Rgb> ambients;  ///< of the points' ambient light, where some material is not plain
  NewRays new_rays;           ///< of the batch under way

  // Where surfaces are rough, paths beside rays:
  std::vector<TreePath> pending_paths;  ///< behind those of `pending` the batch's
  NewRays split_rays;                   ///< that have a rough bounce behind them; these lie on top of new_rays

  bool wants_texture = false;
  SampleWindow eye_window;   ///< of the chunk's eye rays
  bool instanced = false;    ///< the scene has instances
  bool passes_rays = false;  ///< eye rays may go on behind what they met

  /// Where some facets are shaded in a way of their own.
  std::optional<FacetShading> facets;

  /// Where something transmits and shadows show it.
  std::optional<ShadowPaths> shadow_paths;

  // Where media are tracked:
  std::optional<MediaTable> media;
  std::vector<Solid> eye_solids;  ///< that a perspective eye lies in
  bool knows_eye_solids = false;
  std::vector<MediaBoundary> boundaries;  ///< [rays.size] what each point separates
  std::vector<MediaId> shadow_media;      ///< that shadow rays start in
};

/// The eye rays become the first batch.
void SampleTracer::State::begin_samples(std::span<const Vec2f> positions) {
  pending.clear();
  batch.size = positions.size();
  scene.camera.rays(positions, {batch.origin_x, batch.origin_y, batch.origin_z},
                    {batch.direction_x, batch.direction_y, batch.direction_z});
  for (float* weights : {batch.weight_r, batch.weight_g, batch.weight_b}) std::fill_n(weights, batch.size, 1.0f);
  std::fill_n(batch.allowance, batch.size, static_cast<float>(settings.cutoff));
  std::fill_n(batch.level, batch.size, 1u);
  std::fill_n(batch.media, batch.size, kNoMedia);
  std::iota(batch.sample, batch.sample + batch.size, std::uint16_t(0));
  if (tracks_media()) find_eye_media(positions);
  if (tracks_paths()) {
    pending_paths.clear();
    for (const Vec2f& position : positions) pending_paths.push_back(TreePath::of_eye(position));
  }
  std::fill_n(results.radiance.begin(), positions.size(), Rgb());
  std::fill(results.truncation.begin(), results.truncation.end(), Rgb());
  std::fill(results.ray_counts.begin(), results.ray_counts.end(), 1u);
  std::fill(results.first_hits.begin(), results.first_hits.end(), FirstHit());
  statistics.rays[static_cast<int>(RayKind::primary)] += positions.size();
  statistics.samples += positions.size();
  statistics.deepest_level = std::max(statistics.deepest_level, 1);
}

/// Traces the eye rays of up to kBatchSize samples and all that grows from them. False: stopped.
bool SampleTracer::State::trace(std::span<const Vec2f> positions, float spacing) {
  eye_window = {&scene.camera, spacing, settings.antialias.method == Antialiasing::Method::whitted};
  begin_samples(positions);
  trace_batch(Coherence::coherent, true);
  while (!pending.empty()) {
    if (stopped()) return false;
    pending.pop(batch);
    const std::uint32_t deepest = *std::max_element(batch.level, batch.level + batch.size);
    statistics.deepest_level = std::max(statistics.deepest_level, static_cast<int>(deepest));
    if (kFeatures.ray_count_channel && records.ray_counts)
      for (std::size_t i = 0; i < batch.size; ++i) ++results.ray_counts[batch.sample[i]];
    trace_batch(Coherence::mixed, false);
  }
  return !stopped();
}

void SampleTracer::State::trace_batch(Coherence coherence, bool eye) {
  const auto start = Clock::now();
  batch.copy_to(rays);
  scene.intersector->intersect(rays, coherence, hits);
  const auto hit = Clock::now();
  const double intersection_before = statistics.intersection_seconds;
  find_hits();
  collect_points(eye);
  add_lights();
  spawn();
  if (tracks_paths()) add_rays_on_paths();
  add_children(RayKind::reflected, new_rays.reflected);
  add_children(RayKind::refracted, new_rays.refracted);
  add_children(RayKind::refracted, new_rays.passed);
  const double shadow_seconds = statistics.intersection_seconds - intersection_before;
  statistics.shading_seconds += seconds_since(hit) - shadow_seconds;
  statistics.intersection_seconds += std::chrono::duration<double>(hit - start).count();
}

void SampleTracer::State::add_children(RayKind kind, SpawnedRays& children) {
  if (children.empty()) return;
  statistics.rays[static_cast<int>(kind)] += children.size();
  children.move_to(pending);
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

/// Finds which rays hit and where, and adds the background for the others.
void SampleTracer::State::find_hits() {
  point_count = 0;
  for (std::size_t i = 0; i < rays.size; ++i)
    if (hits.geometry[i] != kNoGeometry) points[point_count++] = static_cast<std::uint32_t>(i);
  if (point_count < rays.size) add_background();
  prefetch_triangles(*scene.shapes);
  find_surfaces(*scene.shapes, rays, hits, wants_texture, shading.surfaces);
  if (scene.sphere_pixels > 0) move_to_true_surfaces(*scene.shapes, scene.sphere_pixels, rays, hits, shading.surfaces);
  if (shades_facets()) add_facets();
  shading.turn_to_rays(rays);
}

void SampleTracer::State::add_background() {
  const bool media_matter = tracks_media();
  for (std::size_t i = 0; i < rays.size; ++i) {
    if (hits.geometry[i] != kNoGeometry) continue;
    // A ray that is not finite misses everything: its sample becomes NaN, and so is counted and reported.
    const Vec3f direction = rays.direction(i), poison = (rays.origin(i) + direction) * 0.0f;
    const Rgb light = scene.background.along(direction);
    results.radiance[batch.sample[i]] +=
        (media_matter ? escaping_weight(i) : batch.weight(i)) * light + Rgb(poison.x + poison.y + poison.z);
  }
}

/// Looks up the materials of the hits, takes what the way to them took, and adds ambient light. What a scene may lack
/// has loops of its own, so that the others have no call in them.
void SampleTracer::State::collect_points(bool eye) {
  const bool plain = kFeatures.instances && instanced ? find_materials<true>() : find_materials<false>();
  if (kAnyInvolved && !plain) involve_points(eye);
  if (kFeatures.distance_attenuation && settings.distance_attenuation > 0) attenuate_points();
  if (kAnyInvolved && !plain)
    add_ambient([this](std::size_t i) { return ambients[i]; });
  else
    add_ambient([this](std::size_t i) { return plain_ambient(i); });
  if (eye)
    statistics.eye_hits += point_count;
  else if (passes_rays)
    for (const std::uint32_t i : batch_points()) statistics.eye_hits += batch.level[i] == 1;
  if (kFeatures.first_hit_channels && records.first_hits) record_first_hits();
}

/// Whether all materials of the batch are plain ones.
template <bool kInstances>
bool SampleTracer::State::find_materials() {
  const ShapeSet& shapes = *scene.shapes;
  const Material* const materials = scene.materials.data();
  const GeometryId* const geometries = hits.geometry;
  const std::uint32_t* const primitives = hits.primitive;
  bool plain = true;
  for (const std::uint32_t i : batch_points()) {
    std::uint32_t index;
    if constexpr (kInstances)
      index = scene.material_at(hits[i]);
    else
      index = scene.own_material(shapes, shapes.shape_of(geometries[i], primitives[i]), geometries[i], primitives[i]);
    shading.set_material(i, materials[index]);
    if (kAnyInvolved) plain &= materials[index].is_plain;
  }
  return plain;
}

/// What patterns, bumps, absorption and media do to the points. Those that separate nothing are points no longer.
[[gnu::noinline]] void SampleTracer::State::involve_points(bool eye) {
  const SampleWindow window = eye ? eye_window : SampleWindow();
  std::size_t count = 0;
  for (const std::uint32_t i : batch_points()) {
    const Material& material = *shading.materials[i];
    if (material.is_varied) {
      ShadingPoint point = shading_point(i);
      vary(point, window);
      shading.set_varied(i, point);
    }
    ambients[i] = !material.ambient_as_diffuse && material.ambient.varies() ? varied_ambient(shading_point(i), window)
                                                                            : plain_ambient(i);
    if (material.takes_on_the_way && passes(i, hits[i])) continue;
    points[count++] = i;
  }
  point_count = count;
}

[[gnu::noinline]] void SampleTracer::State::attenuate_points() {
  const auto rate = static_cast<float>(settings.distance_attenuation);
  for (const std::uint32_t i : batch_points())
    if (batch.level[i] > 1)
      batch.set_weight(i, batch.weight(i) * segment_attenuation(rate, shading.surfaces.distance[i]));
}

template <class AmbientAt>
void SampleTracer::State::add_ambient(AmbientAt&& ambient_at) {
  const Rgb light = scene.ambient;
  for (const std::uint32_t i : batch_points())
    results.radiance[batch.sample[i]] += batch.weight(i) * light * ambient_at(i);
}

/// The sets of the chunk's eye rays. Parallel eye rays start in places of their own.
[[gnu::noinline]] void SampleTracer::State::find_eye_media(std::span<const Vec2f> positions) {
  media->clear();
  if (scene.camera.is_perspective()) {
    if (!knows_eye_solids) eye_solids = solids_around_eye(scene, scene.camera.position(), scene.camera.forward());
    knows_eye_solids = true;
    std::fill_n(batch.media, positions.size(), media->set_of(eye_solids));
  } else {
    for (std::size_t i = 0; i < positions.size(); ++i)
      batch.media[i] = media->set_of(solids_around(scene, batch.origin(i), batch.direction(i)));
  }
}

/// Takes what was absorbed on the way to a point and says what its surface separates. True: nothing; the ray goes on
/// behind it, at its level.
[[gnu::noinline]] bool SampleTracer::State::passes(std::size_t i, const Hit& hit) {
  const bool leaving = shading.leaving[i] != 0;
  const float distance = shading.surfaces.distance[i];
  const Material& material = *shading.materials[i];
  if (kFeatures.one_sided_surfaces && material.one_sided && leaving) {
    if (tracks_media()) batch.set_weight(i, batch.weight(i) * media->transmitted(batch.media[i], distance));
    ++statistics.rays_through_backs;
    go_on_behind(i, batch.media[i]);
    return true;
  }
  if (!tracks_media()) {
    if (material.absorbs && leaving)
      batch.set_weight(i, batch.weight(i) * transmitted_share(material.absorption, distance));
    return false;
  }
  MediaBoundary& boundary = boundaries[i];
  boundary = media->boundary(batch.media[i], solid_at(scene, hit), leaving);
  batch.set_weight(i, batch.weight(i) * media->transmitted(boundary.before, distance));
  if (boundary.passes) go_on_behind(i, boundary.after);
  return boundary.passes;
}

void SampleTracer::State::go_on_behind(std::size_t i, MediaId media_behind) {
  if (records.first_hits && batch.level[i] == 1)
    results.first_hits[batch.sample[i]].distance += shading.surfaces.distance[i];
  const TreePath own = tracks_paths() ? path(i) : TreePath();
  NewRays& out = own.is_split ? split_rays : new_rays;
  if (tracks_paths()) out.passed_paths.push_back(own);
  out.passed.push(child_origin(i, true), rays.direction(i),
                  {batch.weight(i), batch.allowance[i], batch.level[i], batch.sample[i], media_behind});
}

/// The vertices of the batch's triangles lie anywhere in memory: all are asked for before the first is used.
void SampleTracer::State::prefetch_triangles(const ShapeSet& shapes) const {
  const bool any_instances = kFeatures.instances && instanced;
  if (shapes.meshes.empty() && !any_instances) return;
  const auto for_each_triangle = [&](auto&& function) {
    for (const std::uint32_t i : batch_points()) {
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

[[gnu::noinline]] void SampleTracer::State::add_facets() {
  facets->begin_batch();
  for (const std::uint32_t i : batch_points()) {
    SurfacePoint point = shading.surfaces[i];
    facets->add(i, hits[i], rays.direction(i), batch.level[i] == 1, point);
    shading.surfaces.set(i, point);
  }
}

void SampleTracer::State::add_lights() {
  if (point_count == 0) return;
  if (shades_facets())
    add_lights_to_points<true>();
  else
    add_lights_to_points<false>();
}

/// kFacets: some facets are shaded in a way of their own.
template <bool kFacets>
void SampleTracer::State::add_lights_to_points() {
  const bool media_matter = tracks_media();
  for (const Light& light : scene.lights) {
    std::size_t count = 0;
    if (!kFacets) shading.meet(rays, light, settings.highlights);
    for (const std::uint32_t i : batch_points()) {
      const Material& material = *shading.materials[i];
      if (!kFacets && !shading.is_before_light(i)) continue;
      if (!material.has_diffuse && !material.has_highlight) continue;
      LocalLight local = kFacets ? facets->light(i, shading_point(i), light, settings.highlights)
                                 : local_light(shading.meeting(i), material, shading.diffuse(i), light);
      if (!local.lit) continue;
      Rgb shadowed = local.diffuse;
      if (settings.shadowed_highlights)
        shadowed += local.highlight;
      else
        results.radiance[batch.sample[i]] += batch.weight(i) * local.highlight;
      if (is_black(shadowed)) continue;
      if (!settings.shadows) {
        results.radiance[batch.sample[i]] += batch.weight(i) * shadowed;
        continue;
      }
      const Vec3f origin = kFacets ? facets->shadow_origin(i, shading_point(i), light, local) : child_origin(i, false);
      shadow_rays.set(count, origin, local.direction, local.distance);
      shadow_samples[count] = batch.sample[i];
      shadow_light[count] = batch.weight(i) * shadowed;
      if (media_matter) shadow_media[count] = boundaries[i].before;
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

[[gnu::noinline]] void SampleTracer::State::bend_normals() {
  for (const std::uint32_t i : batch_points()) {
    ShadingPoint point = shading_point(i);
    facets->bend(i, point);
    shading.surfaces.shading_normal.set(i, point.surface.shading_normal);
  }
}

void SampleTracer::State::spawn() {
  if (shades_facets()) bend_normals();
  std::uint64_t branches_at_limit = 0;
  bool has_branched = false;
  for (const std::uint32_t i : batch_points()) {
    const Material& material = *shading.materials[i];
    if (!material.has_reflection && !material.has_transmission) continue;
    if ((kFeatures.special_optics || kFeatures.media || kFeatures.rough_surfaces) && material.special_optics) {
      branches_at_limit += spawn_specially(i);
    } else {
      if (!has_branched) shading.branch(rays);
      has_branched = true;
      float share = batch.allowance[i];
      branches_at_limit += spawn_children(i, shading.branches(i), share, kNoMedia, kNoMedia, new_rays);
    }
  }
  statistics.branches_at_depth_limit += branches_at_limit;
}

/// Out of the way of what most scenes are made of.
[[gnu::noinline]] unsigned SampleTracer::State::spawn_specially(std::size_t i) {
  const ShadingPoint point = shading_point(i);
  float share = batch.allowance[i];
  if (tracks_media()) {
    const MediaBoundary& boundary = boundaries[i];
    if (tracks_paths()) return spawn_on_path(i, point, boundary.relative_index, boundary.before, boundary.after);
    return spawn_children(i, branches_between(point, boundary.relative_index), share, boundary.before, boundary.after,
                          new_rays);
  }
  if (tracks_paths()) return spawn_on_path(i, point, plain_relative_index(point), kNoMedia, kNoMedia);
  return spawn_children(i, branches(point), share, kNoMedia, kNoMedia, new_rays);
}

/// In a scene with rough surfaces. The first rough point on a way down the tree is met by rough_samples facets, each of
/// which has an equal part of the ray's weight and of its allowance, and what one leaves of its part passes to the
/// others; so what is cut below the ray stays within its allowance. Later ones are met by one facet.
unsigned SampleTracer::State::spawn_on_path(std::size_t i, const ShadingPoint& point, float relative_index,
                                            MediaId before, MediaId after) {
  const TreePath path = this->path(i);
  const bool rough = point.material->rough, splits = rough && !path.is_split;
  const std::uint32_t samples = static_cast<std::uint32_t>(settings.rough_samples), count = splits ? samples : 1;
  const float share = 1 / static_cast<float>(count);
  NewRays& out = rough || path.is_split ? split_rays : new_rays;
  float rest = batch.allowance[i];
  unsigned at_limit = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t index = splits ? k : path.index;
    Branches children = rough ? rough_branches(point, relative_index, path.key, index, samples)
                              : branches_between(point, relative_index);
    children.reflected_weight *= share;
    children.refracted_weight *= share;
    float part = rest / static_cast<float>(count - k);
    rest -= part;
    at_limit += spawn_children(i, children, part, before, after, out);
    rest += part;
    TreePath own = path;
    own.index = static_cast<std::uint16_t>(index);
    own.is_split |= rough;
    if (out.reflected_paths.size() < out.reflected.size()) out.reflected_paths.push_back(own.child(false));
    if (out.refracted_paths.size() < out.refracted.size()) out.refracted_paths.push_back(own.child(true));
  }
  return at_limit;
}

/// `share`: what may be cut below the two children; what they leave of it is left. `before`, `after`: the media that
/// the reflected and the refracted ray are in. Returns how many branches the tree's depth ended.
[[gnu::always_inline]] inline unsigned SampleTracer::State::spawn_children(std::size_t i, const Branches& children,
                                                                           float& share, MediaId before, MediaId after,
                                                                           NewRays& out) {
  const Rgb own_weight = batch.weight(i);
  const Rgb reflected_weight = own_weight * children.reflected_weight;
  const Rgb refracted_weight = own_weight * children.refracted_weight;
  const bool reflects = !is_black(reflected_weight), refracts = !is_black(refracted_weight);
  const std::uint32_t own_level = batch.level[i];
  if (static_cast<int>(own_level) >= settings.depth) return unsigned(reflects) + unsigned(refracts);
  const Rgb below = scene.bound(settings.depth - static_cast<int>(own_level) - 1);
  const Rgb reflected_bound = reflected_weight * below, refracted_bound = refracted_weight * below;
  const Shares shares = divided_allowance(share, max_channel(reflected_bound), max_channel(refracted_bound));
  // Unless both are cut, one of them takes all that the other leaves.
  share = shares.cuts_reflected && shares.cuts_refracted
              ? std::max(0.0f, share - max_channel(reflected_bound) - max_channel(refracted_bound))
              : 0.0f;
  if (reflects) {
    if (shares.cuts_reflected)
      cut(batch.sample[i], reflected_bound);
    else
      out.reflected.push(child_origin(i, false), children.reflected,
                         {reflected_weight, shares.reflected, own_level + 1, batch.sample[i], before});
  }
  if (refracts) {
    if (shares.cuts_refracted)
      cut(batch.sample[i], refracted_bound);
    else
      out.refracted.push(child_origin(i, true), children.refracted,
                         {refracted_weight, shares.refracted, own_level + 1, batch.sample[i], after});
  }
  return 0;
}

void SampleTracer::State::cut(std::uint32_t sample, const Rgb& bound) {
  if (kFeatures.truncation_channel && records.truncation) results.truncation[sample] += bound;
  ++statistics.branches_cut;
}

[[gnu::noinline]] void SampleTracer::State::record_first_hits() {
  const ShapeSet& shapes = *scene.shapes;
  for (const std::uint32_t i : batch_points()) {
    if (batch.level[i] != 1) continue;
    const Hit hit = hits[i];
    const std::uint32_t object = instanced && hit.instance != kNoInstance
                                     ? shapes.instances[hit.instance].object
                                     : shapes.shape_of(hit.geometry, hit.primitive);
    const auto material = static_cast<std::uint32_t>(shading.materials[i] - scene.materials.data());
    FirstHit& first = results.first_hits[batch.sample[i]];
    // What the eye ray has passed through is in the distance already.
    first = {first.distance + shading.surfaces.distance[i], shading.surfaces.shading_normal[i], shading.diffuse(i),
             object + 1, material + 1};
  }
}

SampleTracer::SampleTracer(const Scene& scene, const SampleRecords& records, const std::atomic<bool>* stop)
    : state_(std::make_unique<State>(scene, records, stop)), results_(&state_->results) {}
SampleTracer::~SampleTracer() = default;
SampleTracer::SampleTracer(SampleTracer&&) noexcept = default;

bool SampleTracer::trace(std::span<const Vec2f> positions, float spacing) { return state_->trace(positions, spacing); }
RenderStatistics& SampleTracer::statistics() { return state_->statistics; }
const RenderStatistics& SampleTracer::statistics() const { return state_->statistics; }

}  // namespace raytree
