// Local light of a batch's points, and the shadow rays that it takes.
#include "geometry/stopwatch.h"
#include "renderer/ray_tree_state.h"

namespace raytree {

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

}  // namespace raytree
