// What SampleTracer works on, and the steps of a batch, for the files that implement them: ray_tree.cpp finds hits and
// makes points of them, ray_tree_lights.cpp adds local light, ray_tree_children.cpp spawns reflected and refracted
// rays.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray_batch.h"
#include "renderer/facet_shading.h"
#include "renderer/features.h"
#include "renderer/media.h"
#include "renderer/ray_queue.h"
#include "renderer/ray_tree.h"
#include "renderer/rough_surface.h"
#include "renderer/shading.h"
#include "renderer/shading_batch.h"
#include "renderer/shadow_path.h"

namespace raytree {

/// What a batch spawns, before it joins the pending rays: by kind, so that neighbours in a packet run much the same
/// way. With the rays' paths where some surface is rough.
struct NewRays {
  SpawnedRays reflected, refracted;
  SpawnedRays passed;  ///< that met a surface which separates nothing, or the back of a one-sided one
  std::vector<TreePath> reflected_paths, refracted_paths, passed_paths;
};

struct SampleTracer::State {
  State(const Scene& scene_, const SampleRecords& records_, const std::atomic<bool>* stop_)
      : scene(scene_),
        settings(scene_.description.render),
        records(records_),
        stop(stop_),
        rays(batch.as_batch()),
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

  RayArrays batch = {};  ///< that is under way
  RayBatch rays;         ///< the same as tracers take it
  HitBatch hits;
  RayBatch shadow_rays;
  std::vector<std::uint8_t> occluded;
  std::vector<std::uint16_t> shadow_samples;
  std::vector<Rgb> shadow_light;  ///< what a shadow ray brings when nothing is in its way

  RayQueue pending;  ///< the newest rays are traced first
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

}  // namespace raytree
