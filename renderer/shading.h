// What happens at one hit, by Whitted's eq. 2: the point seen from the ray's side, its light from one source, its
// children. Pure functions; the ray tree (ray_tree.cpp) batches them, the recursion that benchmarks compare with calls
// them one by one.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/surface.h"
#include "renderer/camera.h"
#include "renderer/features.h"
#include "renderer/light.h"
#include "renderer/material.h"
#include "renderer/optics.h"

namespace raytree {

/// A hit ready for shading. Normals are turned to the side that the ray comes from; side is decided by the geometric
/// normal.
struct ShadingPoint {
  SurfacePoint surface;                ///< normals turned to the ray's side
  Vec3f direction;                     ///< of the ray, unit
  const Material* material = nullptr;  ///< set by shading_point()
  Rgb diffuse;                         ///< k_d here
  bool leaving = false;                ///< the ray hit the surface from behind: it is leaving the inside
};

/// What of the picture an eye ray stands for: a square of so many pixels about it. Of rays further down the tree it is
/// not known (no camera): a curved mirror spreads them in ways of its own.
struct SampleWindow {
  const Camera* camera = nullptr;
  float spacing = 1;
  bool leaves_edges = false;  ///< see Footprint
};

/// What the window of a ray of unit `direction` covers of the plane that touches the surface at `distance`; `normal`
/// turned to the ray. Without branches, so that a loop over many points is vectorized.
[[gnu::always_inline]] inline Footprint footprint_of(const Camera& camera, const Vec3f& direction, const Vec3f& normal,
                                                     float distance, float spacing, bool leaves_edges) {
  const float cosine = -direction.dot(normal);
  Vec3f right, up;
  camera.pixel_edges(direction, distance, right, up);
  const bool faces = cosine > 0;
  // Along the ray until they lie in the plane that touches the surface.
  const auto laid_down = [&](const Vec3f& edge) {
    const Vec3f laid = (edge + direction * (edge.dot(normal) / cosine)) * spacing;
    return Vec3f(faces ? laid.x : 0.0f, faces ? laid.y : 0.0f, faces ? laid.z : 0.0f);
  };
  return {laid_down(right), laid_down(up), faces && leaves_edges};
}
/// The same of a point; a mere point where the window has no camera.
Footprint footprint_of(const ShadingPoint& point, const SampleWindow& window);

// `frame`: of the shape that was hit, Scene::frame_at(); null where it has none or its material follows no object.

/// Sets `diffuse` where it varies and bends the shading normal where there is a bump.
void vary(ShadingPoint& point, const SampleWindow& window, const ObjectFrame* frame);

/// The ambient coefficient where it is a varying one of its own.
Rgb varied_ambient(const ShadingPoint& point, const SampleWindow& window, const ObjectFrame* frame);

inline void complete_shading_point(ShadingPoint& point, const Vec3f& direction, const Material& material,
                                   const SampleWindow& window, const ObjectFrame* frame) {
  point.direction = direction;
  point.material = &material;
  point.diffuse = material.diffuse.even;
  point.leaving = direction.dot(point.surface.geometric_normal) > 0;
  if (point.leaving) {
    point.surface.geometric_normal = -point.surface.geometric_normal;
    point.surface.shading_normal = -point.surface.shading_normal;
  }
  if ((kFeatures.patterns || kFeatures.bumps) && material.is_varied) vary(point, window, frame);
}

/// The ambient coefficient.
inline Rgb ambient_of(const ShadingPoint& point, const SampleWindow& window, const ObjectFrame* frame) {
  const Material& material = *point.material;
  if (material.ambient_as_diffuse) return point.diffuse;
  return material.ambient.varies() ? varied_ambient(point, window, frame) : material.ambient.even;
}

inline ShadingPoint shading_point(const SurfacePoint& surface, const Vec3f& direction, const Material& material,
                                  const SampleWindow& window = {}, const ObjectFrame* frame = nullptr) {
  ShadingPoint point;
  point.surface = surface;
  complete_shading_point(point, direction, material, window, frame);
  return point;
}

/// Light of one source as it arrives where nothing is in the way: diffuse and highlight shares apart, since a switch
/// says whether a shadow takes the highlight too.
struct LocalLight {
  Rgb diffuse, highlight;
  Vec3f direction;   ///< unit, to the light
  float distance;    ///< to the light; infinity: directional
  bool lit = false;  ///< the light stands on the side that is seen, by both normals, and shines this way
};

/// How a light stands to a point: what of local_light() depends on directions alone.
struct LightMeeting {
  Vec3f direction;      ///< unit, to the light
  float distance;       ///< to the light; infinity: directional
  float cosine;         ///< N.L
  float highlight;      ///< R.L (Phong 1973, eq. 4.5) or N.H (Whitted 1980, eq. 1)
  bool is_before_both;  ///< the light stands on the side that is seen, by both normals
};

/// What highlights are raised to a power of: `direction`, of the ray, and `to_light` unit. Without branches, as what
/// follows, so that a loop over many points is vectorized.
template <HighlightForm form>
[[gnu::always_inline]] inline float highlight_cosine(const Vec3f& normal, const Vec3f& direction, const Vec3f& to_light,
                                                     float cosine) {
  if constexpr (form == HighlightForm::reflected) {
    const Vec3f mirrored = normal * (2 * cosine) - to_light;
    return -mirrored.dot(direction);
  } else {
    const Vec3f halfway = to_light - direction;
    const float square = halfway.dot(halfway), share = normal.dot(halfway) / std::sqrt(square);
    return square > 0 ? share : 0.0f;
  }
}
template <HighlightForm form>
[[gnu::always_inline]] inline LightMeeting light_meeting(const Vec3f& normal, const Vec3f& geometric_normal,
                                                         const Vec3f& direction, const Vec3f& to_light,
                                                         float distance) {
  const float cosine = normal.dot(to_light);
  return {to_light, distance, cosine, highlight_cosine<form>(normal, direction, to_light, cosine),
          bool((cosine > 0) & (geometric_normal.dot(to_light) > 0))};
}

/// k_d (N.L) and W(i) (R.L)^n or W (N.H)^n, times the light's color. `diffuse`: k_d there.
inline LocalLight local_light(const LightMeeting& meeting, const Material& material, const Rgb& diffuse,
                              const Light& light) {
  LocalLight result;
  result.direction = meeting.direction;
  result.distance = meeting.distance;
  if (!meeting.is_before_both) return result;
  Rgb color = light.color;
  if (kFeatures.uneven_lights && !light.even) {
    const float strength = light.strength(result.direction, result.distance);
    if (!(strength > 0)) return result;
    color *= strength;
  }
  result.lit = true;
  result.diffuse = color * diffuse * std::min(meeting.cosine, 1.0f);
  if (material.has_highlight && meeting.highlight > 0) {
    const Rgb weight = kFeatures.tabled_highlights && material.tabled_highlight
                           ? material.highlight_table.at(meeting.cosine)
                           : material.highlight;
    const float power = meeting.highlight > material.least_highlight
                            ? std::pow(std::min(meeting.highlight, 1.0f), material.exponent)
                            : 0.0f;
    result.highlight = color * weight * power;
  }
  return result;
}
inline LocalLight local_light(const ShadingPoint& point, const Light& light, HighlightForm form) {
  float distance;
  const Vec3f to_light = light.direction_from(point.surface.position, distance);
  const SurfacePoint& surface = point.surface;
  const LightMeeting meeting =
      !kFeatures.halfway_highlights || form == HighlightForm::reflected
          ? light_meeting<HighlightForm::reflected>(surface.shading_normal, surface.geometric_normal, point.direction,
                                                    to_light, distance)
          : light_meeting<HighlightForm::halfway>(surface.shading_normal, surface.geometric_normal, point.direction,
                                                  to_light, distance);
  return local_light(meeting, *point.material, point.diffuse, light);
}

/// Weights and directions of the two children of a hit. A weight of zero: no such child.
struct Branches {
  Rgb reflected_weight, refracted_weight;
  Vec3f reflected, refracted;  ///< unit; set where the weight is not zero
};

/// The normal that R and P are formed about, and its cosine with the ray, in (0, 1].
struct Incidence {
  Vec3f normal;
  float cosine;
};
/// An interpolated normal may lean away from the viewer near a silhouette: there the facet's own serves.
[[gnu::always_inline]] inline Incidence incidence(const Vec3f& direction, const Vec3f& shading, const Vec3f& facet) {
  const float cosine = -direction.dot(shading);
  const bool faces = cosine > 0;
  return {{faces ? shading.x : facet.x, faces ? shading.y : facet.y, faces ? shading.z : facet.z},
          faces ? cosine : -direction.dot(facet)};
}
inline Incidence incidence(const ShadingPoint& point) {
  return incidence(point.direction, point.surface.shading_normal, point.surface.geometric_normal);
}

/// R, kept on the side that the ray comes from.
[[gnu::always_inline]] inline Vec3f reflected_ray(const Vec3f& direction, const Incidence& incidence,
                                                  const Vec3f& side) {
  return kept_on_side(reflected_direction(direction, incidence.normal), side);
}

/// P, kept on the other side, and the share that does not go that way.
struct Refraction {
  Vec3f direction{0, 0, 0};  ///< unit, where there is one
  float reflectance = 1;     ///< F
  bool is_possible = false;  ///< false: total internal reflection
};

/// `relative_index`: of the side that P enters over the side that the ray comes from; `eta` is its inverse. Without
/// branches, so that a loop over many points is vectorized.
[[gnu::always_inline]] inline Refraction refraction(const Vec3f& direction, const Incidence& incidence,
                                                    const Vec3f& side, float relative_index, float eta) {
  const float cosine = std::min(incidence.cosine, 1.0f), square = refracted_cosine_square(cosine, eta);
  Refraction result;
  result.is_possible = square > 0;
  const float refracted_cos = std::sqrt(square > 0 ? square : 0.0f);
  const float reflectance = fresnel_reflectance(cosine, refracted_cos, relative_index);
  result.reflectance = result.is_possible ? reflectance : 1.0f;
  result.direction = kept_on_side(refracted_direction(direction, incidence.normal, eta, cosine, refracted_cos), -side);
  return result;
}

/// Thin sheets and conductors, and any material where media are not told apart. `index`: a thin sheet's over that of
/// what surrounds it.
Branches special_branches(const ShadingPoint& point, float index);

/// R and P with k_s and k_t, or with k_s F and k_t (1 - F). At total internal reflection T = 0; F = 1.
[[gnu::always_inline]] inline Branches weighted_branches(const Material& material, const Vec3f& reflected,
                                                         const Refraction& refraction) {
  Branches result;
  const bool fresnel = kFeatures.fresnel && material.fresnel;
  if (material.has_transmission && refraction.is_possible) {
    result.refracted = refraction.direction;
    result.refracted_weight = fresnel ? material.transmission * (1 - refraction.reflectance) : material.transmission;
  }
  if (material.has_reflection) {
    result.reflected = reflected;
    result.reflected_weight = fresnel ? material.reflection * refraction.reflectance : material.reflection;
  }
  return result;
}
[[gnu::always_inline]] inline Branches dielectric_branches(const ShadingPoint& point, float relative_index, float eta) {
  const Material& material = *point.material;
  const Vec3f& side = point.surface.geometric_normal;
  const Incidence about = incidence(point);
  Vec3f reflected(0, 0, 0);
  Refraction through;
  if (material.has_transmission || (kFeatures.fresnel && material.fresnel))
    through = refraction(point.direction, about, side, relative_index, eta);
  if (material.has_reflection) reflected = reflected_ray(point.direction, about, side);
  return weighted_branches(material, reflected, through);
}

/// The same where the surface separates its material's inside from empty space.
[[gnu::always_inline]] inline Branches plain_branches(const ShadingPoint& point) {
  const Material& material = *point.material;
  const float relative_index = point.leaving ? material.inverse_index : material.index;
  const float eta = point.leaving ? material.index : material.inverse_index;
  return dielectric_branches(point, relative_index, eta);
}

/// The same of any material.
inline Branches branches(const ShadingPoint& point) {
  if (kFeatures.special_optics && point.material->special_optics) return special_branches(point, point.material->index);
  return plain_branches(point);
}

/// The same where it separates media of known indices (media.h): `relative_index` as of dielectric_branches(), for thin
/// sheets as of special_branches().
Branches branches_between(const ShadingPoint& point, float relative_index);

/// Whitted's linear attenuation of a child segment (1980, sec. 2), clamped at 0: max(0, 1 - a t).
inline float segment_attenuation(float rate, float distance) { return std::max(0.0f, 1 - rate * distance); }

}  // namespace raytree
