#include "renderer/facet_shading.h"

#include <algorithm>
#include <cmath>

#include "geometry/instance_transform.h"

namespace raytree {
namespace {

/// The list of shapes that a hit's geometry is a number in.
const BoundedShapes& list_of(const ShapeSet& shapes, const Hit& hit) {
  return hit.instance == kNoInstance ? static_cast<const BoundedShapes&>(shapes)
                                     : shapes.groups[shapes.instances[hit.instance].group];
}

/// The plane of the picture's row that an eye ray belongs to. Rays further down the tree have no row; the plane through
/// them and the camera's right stands for it.
ScanPlane scan_plane(const Camera& camera, const Vec3f& direction, bool eye) {
  Vec3f right, up;
  camera.pixel_edges(direction, 1, right, up);
  ScanPlane scan;
  // A ray along the rows has no plane with them.
  const Vec3f normal = direction.cross(right);
  const bool parallel = !(normal.dot(normal) > 1e-6f * right.dot(right));
  scan.along = parallel ? up : right;
  scan.normal = parallel ? direction.cross(up) : normal;
  scan.perspective = eye && camera.is_perspective();
  scan.eye = camera.position();
  scan.forward = camera.forward();
  return scan;
}

Rgb between_none_and(const Rgb& most, const Rgb& light) {
  return {std::clamp(light.r, 0.0f, most.r), std::clamp(light.g, 0.0f, most.g), std::clamp(light.b, 0.0f, most.b)};
}

}  // namespace

Vec3f consistent_normal(const Vec3f& normal, const Vec3f& to_viewer, float least_cosine) {
  // In double: near q = 1 the parts cancel to what a plain mirror gives.
  const Vec3d n(normal), viewer(to_viewer);
  const double c = std::clamp(double(least_cosine), 0.0, 1.0), s = std::sqrt(1 - c * c);
  const double q = (1 - s) / (1 + s), b = viewer.dot(n), g = 1 + q * (b - 1);
  if (!(1 + b > 0)) return normal;
  const double rho = std::sqrt(std::max(0.0, q * (1 + g) / (1 + b)));
  const Vec3d reflected = n * (g + rho * b) - viewer * rho, sum = viewer + reflected;
  const double length = sum.length();
  return length > 1e-9 ? Vec3f(sum / length) : normal;
}

Vec3f terminator_offset(const Vec3f& position, const ShadedCorner* corners, std::size_t count) {
  Vec3f lifted(0, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const float below = std::min(0.0f, (position - corners[i].position).dot(corners[i].normal));
    lifted -= corners[i].normal * (below * corners[i].weight);
  }
  return lifted;
}

void FacetShading::begin_batch() {
  points_.clear();
  corners_.clear();
}

void FacetShading::add(std::size_t p, const Hit& hit, const Vec3f& direction, bool eye, SurfacePoint& surface) {
  // Rays between that missed have no facet.
  points_.resize(p + 1);
  FacetPoint& facet = points_[p] = FacetPoint();
  facet.first = static_cast<std::uint32_t>(corners_.size());
  if (hit.geometry < kFirstMeshGeometry) return;
  const MeshEntry& entry = list_of(*scene_.shapes, hit).meshes[hit.geometry - kFirstMeshGeometry];
  if (entry.facets == nullptr) return;
  const FacetRecord& record = *entry.facets;
  const ShapeShading& shading = scene_.shape_shading[entry.shape];
  facet.interpolates_light = shading.method == ShadingMethod::gouraud;
  facet.seen_by_eye = eye && scene_.camera.is_perspective();
  facet.inverse_half_distance = shading.inverse_half_distance;
  if (shading.method == ShadingMethod::flat) return;

  append_corners(entry.mesh, record, hit, corners_);
  facet.count = static_cast<std::uint32_t>(corners_.size()) - facet.first;
  Vec3f limit = record.surface ? true_normal(entry.mesh, record, hit) : Vec3f(0, 0, 0);
  if (hit.instance != kNoInstance) {
    const InstanceTransform transform(scene_.shapes->instances[hit.instance]);
    for (std::size_t c = facet.first; c < corners_.size(); ++c) {
      corners_[c].position = Vec3f(transform.point(Vec3d(corners_[c].position)));
      corners_[c].normal = Vec3f(unit(transform.normal(Vec3d(corners_[c].normal))));
    }
    if (limit.length2() > 0) limit = Vec3f(unit(transform.normal(Vec3d(limit))));
  }
  interpolate(record, hit, direction, eye, surface, facet);
  if (limit.length2() > 0) surface.shading_normal = limit;
  // As the point's own: toward the ray.
  if (direction.dot(surface.geometric_normal) > 0)
    for (std::size_t c = facet.first; c < corners_.size(); ++c) corners_[c].normal = -corners_[c].normal;
}

/// Sets the corners' weights, and the shading normal by them.
void FacetShading::interpolate(const FacetRecord& record, const Hit& hit, const Vec3f& direction, bool eye,
                               SurfacePoint& surface, const FacetPoint& facet) {
  ShadedCorner* corners = &corners_[facet.first];
  const std::size_t count = facet.count;
  const bool whole = record.interpolation != FacetInterpolation::barycentric &&
                     (count > 3 || record.interpolation == FacetInterpolation::scanline);
  if (!whole) {
    // The triangle's barycentrics, which the surface has interpolated by already.
    const float u = std::clamp(hit.u, 0.0f, 1.0f), v = std::clamp(hit.v, 0.0f, 1 - u);
    corners[0].weight = 1 - u - v, corners[1].weight = u, corners[2].weight = v;
    return;
  }
  positions_.clear();
  for (std::size_t c = 0; c < count; ++c) positions_.push_back(corners[c].position);
  weights_.resize(count);
  const Vec3f& at = surface.position;
  if (record.interpolation == FacetInterpolation::scanline) {
    if (!scanline_weights(positions_, at, scan_plane(scene_.camera, direction, eye), weights_))
      mean_value_weights(positions_, at, weights_);
  } else if (count == 4) {
    bilinear_weights(positions_, at, weights_);
  } else {
    mean_value_weights(positions_, at, weights_);
  }
  Vec3f mean(0, 0, 0);
  for (std::size_t c = 0; c < count; ++c) {
    corners[c].weight = weights_[c];
    mean += corners[c].normal * weights_[c];
  }
  const float square = mean.dot(mean);
  surface.shading_normal = square > 1e-12f ? mean * (1 / std::sqrt(square)) : surface.geometric_normal;
}

/// Gouraud 1971: each corner's light by its own normal, which stands for the facet's too; then their weighted sum. The
/// corner is seen from the eye where the eye is a point and looks at it straight, which makes its light one, whichever
/// pixel asks; else in the ray's direction. k_d is that of the hit, so that patterns keep their edges.
LocalLight FacetShading::interpolated_light(const FacetPoint& facet, const ShadingPoint& point, const Light& light,
                                            HighlightForm form) const {
  LocalLight sum;
  Rgb most_diffuse, most_highlight;
  sum.direction = light.direction_from(point.surface.position, sum.distance);
  for (std::uint32_t c = facet.first; c < facet.first + facet.count; ++c) {
    const ShadedCorner& corner = corners_[c];
    ShadingPoint there = point;
    there.surface.position = corner.position;
    there.surface.geometric_normal = there.surface.shading_normal = corner.normal;
    if (facet.seen_by_eye) there.direction = unit(corner.position - scene_.camera.position());
    const LocalLight arriving = local_light(there, light, form);
    if (!arriving.lit) continue;
    sum.lit = true;
    sum.diffuse += arriving.diffuse * corner.weight;
    sum.highlight += arriving.highlight * corner.weight;
    most_diffuse = max(most_diffuse, arriving.diffuse);
    most_highlight = max(most_highlight, arriving.highlight);
  }
  // Mean value coordinates of concave polygons may be negative, and others beyond 1; light stays between that of
  // corners.
  sum.diffuse = between_none_and(most_diffuse, sum.diffuse);
  sum.highlight = between_none_and(most_highlight, sum.highlight);
  return sum;
}

LocalLight FacetShading::light(std::size_t p, const ShadingPoint& point, const Light& light, HighlightForm form) const {
  const FacetPoint& facet = points_[p];
  if (facet.interpolates_light) return interpolated_light(facet, point, light, form);
  if (facet.count > 0 && settings_.shadow_terminator == ShadowTerminator::offset) {
    // The surface that the vertex normals tell of faces the light where the shading normal does, whatever the facet
    // does; shadow rays tell the rest.
    ShadingPoint smooth = point;
    smooth.surface.geometric_normal = point.surface.shading_normal;
    return local_light(smooth, light, form);
  }
  LocalLight local = local_light(point, light, form);
  if (local.lit && facet.inverse_half_distance > 0) {
    const Vec3f from_eye = point.surface.position - scene_.camera.position();
    const float distance = light.directional ? from_eye.length() : local.distance;
    const float left = 1 / (1 + distance * facet.inverse_half_distance);
    local.diffuse *= left;
    local.highlight *= left;
  }
  return local;
}

Vec3f FacetShading::shadow_origin(std::size_t p, const ShadingPoint& point, const Light& source,
                                  LocalLight& light) const {
  const Vec3f start = offset_origin(point.surface, point.surface.geometric_normal);
  const FacetPoint& facet = points_[p];
  if (facet.count == 0 || settings_.shadow_terminator != ShadowTerminator::offset) return start;
  const Vec3f origin = start + terminator_offset(point.surface.position, &corners_[facet.first], facet.count);
  light.direction = source.direction_from(origin, light.distance);
  return origin;
}

void FacetShading::bend(std::size_t p, ShadingPoint& point) const {
  const FacetPoint& facet = points_[p];
  if (facet.count == 0 || settings_.reflections != FacetReflections::consistent) return;
  float least = 0, lowest = 1;
  bool negative = false;
  for (std::uint32_t c = facet.first; c < facet.first + facet.count; ++c) {
    least += corners_[c].weight * corners_[c].least_cosine;
    lowest = std::min(lowest, corners_[c].least_cosine);
    negative |= corners_[c].weight < 0;
  }
  SurfacePoint& surface = point.surface;
  // A bump, or the true surface, may lean farther than the corners do.
  least = std::min(negative ? lowest : least, surface.shading_normal.dot(surface.geometric_normal));
  surface.shading_normal = consistent_normal(surface.shading_normal, -point.direction, least);
}

}  // namespace raytree
