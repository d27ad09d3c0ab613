#include "renderer/shading_batch.h"

#include <algorithm>
#include <limits>

namespace raytree {
namespace {

using ConstVec3Lanes = Vec3Pointers<const float>;

ConstVec3Lanes block_of(const Vec3Array& array, std::size_t first) {
  return {array.x + first, array.y + first, array.z + first};
}
ConstVec3Lanes directions_of(const RayBatch& rays, std::size_t first) {
  return {rays.direction_x + first, rays.direction_y + first, rays.direction_z + first};
}

}  // namespace

void ShadingBatch::turn_to_rays(const RayBatch& rays) {
  for (std::size_t first = 0; first < rays.size; first += kLanes) {
    const ConstVec3Lanes direction = directions_of(rays, first), facet = block_of(surfaces.geometric_normal, first),
                         shading = block_of(surfaces.shading_normal, first);
    Vec3Lanes turned_facet, turned_shading;
    std::uint32_t from_behind[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
      const Vec3f g = facet[i], s = shading[i];
      const bool leaves = direction[i].dot(g) > 0;
      from_behind[i] = leaves;
      turned_facet.set(i, {leaves ? -g.x : g.x, leaves ? -g.y : g.y, leaves ? -g.z : g.z});
      turned_shading.set(i, {leaves ? -s.x : s.x, leaves ? -s.y : s.y, leaves ? -s.z : s.z});
    }
    surfaces.geometric_normal.store(first, turned_facet);
    surfaces.shading_normal.store(first, turned_shading);
    store_lanes(from_behind, leaving + first);
  }
}

ShadingPoint ShadingBatch::point(const RayBatch& rays, std::size_t i) const {
  ShadingPoint point;
  point.surface = surfaces[i];
  point.direction = rays.direction(i);
  point.material = materials[i];
  point.diffuse = diffuse_[i];
  point.leaving = leaving[i] != 0;
  return point;
}

void ShadingBatch::set_varied(std::size_t i, const ShadingPoint& point) {
  diffuse_[i] = point.diffuse;
  surfaces.shading_normal.set(i, point.surface.shading_normal);
}

SampleLanes ShadingBatch::samples(const RayBatch& rays, const SampleWindow& window, std::size_t first) const {
  const ConstVec3Lanes direction = directions_of(rays, first), facet = block_of(surfaces.geometric_normal, first),
                       position = block_of(surfaces.position, first);
  SampleLanes samples = {};
  for (std::size_t i = 0; i < kLanes; ++i) samples.position.set(i, position[i]);
  if (window.camera == nullptr) return samples;
  const Camera camera = *window.camera;  // which nothing that is written can change
  const float* const distance = surfaces.distance + first;
  const float spacing = window.spacing;
  const bool leaves_edges = window.leaves_edges;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Footprint footprint = footprint_of(camera, direction[i], facet[i], distance[i], spacing, leaves_edges);
    samples.edge.set(i, footprint.edge);
    samples.other_edge.set(i, footprint.other_edge);
    samples.leaves_edges[i] = footprint.leaves_edges;
  }
  return samples;
}

template <HighlightForm form>
void ShadingBatch::meet_block(const RayBatch& rays, std::size_t first) {
  const ConstVec3Lanes ray = directions_of(rays, first), facet = block_of(surfaces.geometric_normal, first),
                       normal = block_of(surfaces.shading_normal, first), to_light = block_of(light_direction_, first);
  Lanes cosine, highlight;
  std::uint32_t before[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const LightMeeting meeting = light_meeting<form>(normal[i], facet[i], ray[i], to_light[i], 0);
    cosine[i] = meeting.cosine, highlight[i] = meeting.highlight, before[i] = meeting.is_before_both;
  }
  store_lanes(cosine, light_cosine_ + first);
  store_lanes(highlight, light_highlight_ + first);
  store_lanes(before, before_light_ + first);
}

void ShadingBatch::face(const Light& light, std::size_t first) {
  const ConstVec3Lanes position = block_of(surfaces.position, first);
  const Vec3f place = light.place;
  Vec3Lanes direction;
  Lanes distance;
  if (light.directional) {
    direction.fill(place);
    std::fill_n(distance, kLanes, std::numeric_limits<float>::infinity());
  } else {
    for (std::size_t i = 0; i < kLanes; ++i) direction.set(i, direction_to(place, position[i], distance[i]));
  }
  light_direction_.store(first, direction);
  store_lanes(distance, light_distance_ + first);
}

void ShadingBatch::meet(const RayBatch& rays, const Light& light, HighlightForm form) {
  for (std::size_t first = 0; first < rays.size; first += kLanes) {
    face(light, first);
    if (!kFeatures.halfway_highlights || form == HighlightForm::reflected)
      meet_block<HighlightForm::reflected>(rays, first);
    else
      meet_block<HighlightForm::halfway>(rays, first);
  }
}

void ShadingBatch::branch(const RayBatch& rays) {
  for (std::size_t first = 0; first < rays.size; first += kLanes) {
    const ConstVec3Lanes ray = directions_of(rays, first), facet = block_of(surfaces.geometric_normal, first),
                         normal = block_of(surfaces.shading_normal, first);
    const float *eta = eta_ + first, *relative_index = relative_index_ + first;
    Vec3Lanes reflected, refracted;
    Lanes reflectance;
    std::uint32_t refracts[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
      const Vec3f direction = ray[i], side = facet[i];
      const Incidence about = incidence(direction, normal[i], side);
      const Refraction through = refraction(direction, about, side, relative_index[i], eta[i]);
      reflected.set(i, reflected_ray(direction, about, side));
      refracted.set(i, through.direction);
      reflectance[i] = through.reflectance, refracts[i] = through.is_possible;
    }
    reflected_.store(first, reflected);
    refracted_.store(first, refracted);
    store_lanes(reflectance, reflectance_ + first);
    store_lanes(refracts, refracts_ + first);
  }
}

}  // namespace raytree
