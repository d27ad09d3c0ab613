#include "renderer/ray_tree.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "geometry/stopwatch.h"
#include "geometry/surface_batch.h"
#include "geometry/true_surfaces.h"
#include "renderer/ray_tree_state.h"

namespace raytree {
namespace {

/// Whether any material can be other than plain.
constexpr bool kAnyInvolved = kFeatures.patterns || kFeatures.bumps || kFeatures.media || kFeatures.absorption ||
                              kFeatures.rough_surfaces || kFeatures.one_sided_surfaces;

static_assert(kBatchSize <= std::size_t(1) << 16, "a ray's sample is a 16-bit number");

}  // namespace

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
  rays.size = batch.size;
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
  CheckerCells cells(shading, rays, window);
  std::size_t count = 0;
  for (const std::uint32_t i : batch_points()) {
    const Material& material = *shading.materials[i];
    const std::optional<ObjectFrame> moved = scene.frame_at(hits[i], material);
    const ObjectFrame* const frame = moved ? &*moved : nullptr;
    const std::int32_t cell = kFeatures.patterns && material.in_cells ? cells.at(i) : 0;
    if (cell != 0) {
      shading.set_diffuse(i, cell > 0 ? material.diffuse.even : material.diffuse.odd);
    } else if (material.is_varied) {
      ShadingPoint point = shading_point(i);
      vary(point, window, frame);
      shading.set_varied(i, point);
    }
    ambients[i] = !material.ambient_as_diffuse && material.ambient.varies()
                      ? varied_ambient(shading_point(i), window, frame)
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
