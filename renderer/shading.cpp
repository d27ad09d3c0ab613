// What only some materials need: patterns and bumps at a hit, metals, thin sheets, overlapping media. Apart from
// shading.h, so that a scene without them pays one test of a flag.
#include "renderer/shading.h"

#include <cmath>

#include "renderer/bump.h"

namespace raytree {
namespace {

/// Schlick 1994: F = F_0 + (1 - F_0) (1 - cos i)^5 for each channel, F_0 = k_s. A k_s above 1 stays what it is.
Branches conductor_branches(const ShadingPoint& point) {
  const auto [normal, cosine] = incidence(point);
  const float rest = std::max(0.0f, 1 - cosine), square = rest * rest, grazing = square * square * rest;
  const Rgb& k_s = point.material->reflection;
  Branches result;
  result.reflected = kept_on_side(reflected_direction(point.direction, normal), point.surface.geometric_normal);
  result.reflected_weight = k_s + max(Rgb(), Rgb(1) - k_s) * grazing;
  return result;
}

/// Both faces of the sheet lie in one place. What enters is reflected to and fro between them, each time losing (1 - F)
/// to the outside: reflected in all F + (1 - F)^2 F (1 + F^2 + F^4 + ...) = 2F / (1 + F), transmitted what is left,
/// (1 - F) / (1 + F). F is the same inside and outside; at total reflection it is 1, and so is the sum.
Branches thin_branches(const ShadingPoint& point, float index) {
  const Material& material = *point.material;
  const auto [normal, cosine] = incidence(point);
  float reflectance = 1, transmittance = 1;
  if (kFeatures.fresnel && material.fresnel) {
    const float one_face = fresnel_reflectance(std::min(cosine, 1.0f), index);
    reflectance = 2 * one_face / (1 + one_face);
    transmittance = 1 - reflectance;
  }
  Branches result;
  result.refracted = point.direction;
  result.refracted_weight = material.transmission * transmittance;
  if (material.has_reflection) {
    result.reflected = kept_on_side(reflected_direction(point.direction, normal), point.surface.geometric_normal);
    result.reflected_weight = material.reflection * reflectance;
  }
  return result;
}

/// The same point where the shading normal alone counts, turned to the viewer: nothing keeps its children on a side.
ShadingPoint without_facet(const ShadingPoint& point) {
  ShadingPoint free = point;
  SurfacePoint& surface = free.surface;
  if (point.direction.dot(surface.shading_normal) > 0) surface.shading_normal = -surface.shading_normal;
  surface.geometric_normal = surface.shading_normal;
  return free;
}

Branches branches_by_kind(const ShadingPoint& point, float index) {
  const Material& material = *point.material;
  if (material.conductor) return conductor_branches(point);
  return material.thin ? thin_branches(point, index) : plain_branches(point);
}

}  // namespace

[[gnu::noinline]] Branches special_branches(const ShadingPoint& point, float index) {
  if (point.material->free_reflections) return branches_by_kind(without_facet(point), index);
  return branches_by_kind(point, index);
}

[[gnu::noinline]] Branches branches_between(const ShadingPoint& point, float relative_index) {
  if (point.material->thin || point.material->conductor) return special_branches(point, relative_index);
  if (point.material->free_reflections)
    return dielectric_branches(without_facet(point), relative_index, 1 / relative_index);
  return dielectric_branches(point, relative_index, 1 / relative_index);
}

Footprint footprint_of(const ShadingPoint& point, const SampleWindow& window) {
  if (window.camera == nullptr) return {};
  return footprint_of(*window.camera, point.direction, point.surface.geometric_normal, point.surface.distance,
                      window.spacing, window.leaves_edges);
}

void vary(ShadingPoint& point, const SampleWindow& window, const ObjectFrame* frame) {
  const Material& material = *point.material;
  const Footprint footprint = footprint_of(point, window);
  point.diffuse = material.diffuse.at(point.surface, footprint, frame);
  if (kFeatures.bumps && material.bump) {
    SurfacePoint& surface = point.surface;
    surface.shading_normal = material.bump->bent(surface.shading_normal, surface.geometric_normal, -point.direction,
                                                 point.leaving, surface.position, footprint, frame);
  }
}

Rgb varied_ambient(const ShadingPoint& point, const SampleWindow& window, const ObjectFrame* frame) {
  return point.material->ambient.at(point.surface, footprint_of(point, window), frame);
}

}  // namespace raytree
