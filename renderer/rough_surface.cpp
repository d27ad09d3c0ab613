// See rough_surface.h.
#include "renderer/rough_surface.h"

#include <cmath>
#include <numbers>

#include "renderer/low_discrepancy.h"

namespace raytree {
float plain_relative_index(const ShadingPoint& point) {
  const Material& material = *point.material;
  return point.leaving && !material.thin ? material.inverse_index : material.index;
}

TreePath TreePath::of_eye(const Vec2f& position) {
  const auto lattice = [](float x) { return static_cast<std::uint64_t>(std::llround(double(x) * 65536)); };
  return {mixed_key(lattice(position.x), lattice(position.y)), 0, 0};
}

TreePath TreePath::child(bool refracted) const { return {mixed_key(key, refracted ? 11 : 7), index, is_split}; }

TangentFrame tangent_frame(const Vec3f& normal) {
  // Across the axis that the normal is farthest from.
  const Vec3f size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  const Vec3f axis = size.x <= size.y && size.x <= size.z ? Vec3f(1, 0, 0)
                     : size.y <= size.z                   ? Vec3f(0, 1, 0)
                                                          : Vec3f(0, 0, 1);
  const Vec3f tangent = unit(normal.cross(axis));
  return {tangent, normal.cross(tangent)};
}

Vec3f facet_normal(const Vec3f& normal, const TangentFrame& frame, const Vec2f& slopes) {
  return unit(normal - frame.tangent * slopes.x - frame.bitangent * slopes.y);
}

bool facet_serves(const ShadingPoint& point, const Vec3f& facet, float relative_index) {
  const float cosine = -point.direction.dot(facet);
  if (!(cosine > 0)) return false;
  const Material& material = *point.material;
  const Vec3f& side = point.surface.geometric_normal;
  if (material.has_reflection && !(reflected_direction(point.direction, facet).dot(side) > 0)) return false;
  if (material.has_transmission && !material.thin) {
    const auto refracted = refracted_direction(point.direction, facet, 1 / relative_index);
    if (refracted && !(refracted->dot(side) < 0)) return false;
  }
  return true;
}

Vec3f thin_scattered(const Vec3f& direction, const Vec3f& normal, const TangentFrame& frame, const Vec2f& slopes,
                     float relative_index) {
  const float cosine = -direction.dot(normal);
  const auto inside = refracted_cosine(std::min(cosine, 1.0f), 1 / relative_index);
  if (!inside) return direction;
  const float reach = std::numbers::sqrt2_v<float> * (relative_index * *inside - cosine);
  const Vec3f along = direction + normal * cosine + (frame.tangent * slopes.x + frame.bitangent * slopes.y) * reach;
  const float square = along.dot(along);
  return square < 1 ? unit(along - normal * std::sqrt(1 - square)) : direction;
}

Branches rough_branches(const ShadingPoint& point, float relative_index, std::uint32_t key, std::uint32_t index,
                        std::uint32_t count) {
  const Vec3f normal = incidence(point).normal;
  const TangentFrame frame = tangent_frame(normal);
  const float roughness = point.material->roughness;
  Vec2f slopes;
  Vec3f facet;
  for (int draw = 0; draw < kFacetDraws; ++draw) {
    slopes = Vec2f(normal_deviates(low_discrepancy_point(index + static_cast<std::uint32_t>(draw) * count, key))) *
             roughness;
    facet = facet_normal(normal, frame, slopes);
    if (facet_serves(point, facet, relative_index)) break;
  }
  ShadingPoint met = point;
  met.surface.shading_normal = facet;
  Branches children = branches_between(met, relative_index);
  if (point.material->thin)
    children.refracted = kept_on_side(thin_scattered(point.direction, normal, frame, slopes, relative_index),
                                      -point.surface.geometric_normal);
  return children;
}

}  // namespace raytree
