// Hits on facets that are shaded in another way than by their triangle's normals: Gouraud's interpolated light, true
// normals, polygons and scan lines, the remedies of interpolated normals. The ray tree asks here only in scenes where
// some shape wants it (Scene::shades_facets). One function of light serves all: local_light().
#pragma once

#include <vector>

#include "geometry/facet_record.h"
#include "renderer/scene.h"
#include "renderer/shading.h"

namespace raytree {

/// A direction bent so that it stays above its facet: with I toward the viewer, N the interpolated normal and the
/// cosine between N and the facet's normal at least `least_cosine` in (0, 1], the direction
///   R = (g + rho b) N - rho I,  b = I.N,  g = 1 + q (b - 1),  rho = sqrt(q (1 + g) / (1 + b))
/// is unit and has N.R = g (Reshetov, Soupikov and Mark 2010). q = (1 - s) / (1 + s), s = sqrt(1 - c^2), is the largest
/// share for which no I above the facet, whose b is at least -s, gives an R below it: g >= s. q = 1 is a plain mirror.
/// Returns the normal that mirrors I into R, unit.
Vec3f consistent_normal(const Vec3f& normal, const Vec3f& to_viewer, float least_cosine);

/// What moves a point of a facet onto the surface that its vertex normals tell of: where it lies below the tangent
/// plane of a corner, it is lifted to that plane, by the corner's weight (Hanika 2021, ch. 4 of Ray Tracing Gems II).
/// Normals turned to the side of the viewer.
Vec3f terminator_offset(const Vec3f& position, const ShadedCorner* corners, std::size_t count);

/// Facets of the hits of one batch.
class FacetShading {
 public:
  explicit FacetShading(const Scene& scene) : scene_(scene), settings_(scene.description.render.facets) {}

  void begin_batch();

  /// Before the hit of the batch's ray `p` is turned to the ray and varied: finds its facet and sets the shading
  /// normal. Rays come in their order. `eye`: the ray comes from the camera.
  void add(std::size_t p, const Hit& hit, const Vec3f& direction, bool eye, SurfacePoint& surface);

  /// local_light() by the shape's way of shading.
  LocalLight light(std::size_t p, const ShadingPoint& point, const Light& light, HighlightForm form) const;

  /// Where the point's shadow rays start; `light` then holds their direction and length.
  Vec3f shadow_origin(std::size_t p, const ShadingPoint& point, const Light& source, LocalLight& light) const;

  /// Before children are formed: bends the shading normal where that keeps them above the facet.
  void bend(std::size_t p, ShadingPoint& point) const;

 private:
  struct FacetPoint {
    std::uint32_t first = 0, count = 0;  ///< corners; none: nothing but local_light()
    bool interpolates_light = false;     ///< gouraud
    bool seen_by_eye = false;            ///< from the one point of a perspective camera
    float inverse_half_distance = 0;
  };

  void interpolate(const FacetRecord& record, const Hit& hit, const Vec3f& direction, bool eye, SurfacePoint& surface,
                   const FacetPoint& facet);
  LocalLight interpolated_light(const FacetPoint& facet, const ShadingPoint& point, const Light& light,
                                HighlightForm form) const;

  const Scene& scene_;
  const FacetSettings& settings_;
  std::vector<FacetPoint> points_;     ///< [ray]
  std::vector<ShadedCorner> corners_;  ///< of all of them
  std::vector<Vec3f> positions_;       ///< of the facet under way
  std::vector<float> weights_;
};

}  // namespace raytree
