// Which optional parts of the renderer are compiled in. All of them, but in the variant that the benchmark `idle`
// builds to show that a part which a scene does not use costs next to nothing.
#pragma once

namespace raytree {

#ifdef RAYTREE_WITHOUT_OPTIONAL_FEATURES
inline constexpr bool kOptionalFeatures = false;
#else
inline constexpr bool kOptionalFeatures = true;
#endif

struct Features {
  bool distance_attenuation = kOptionalFeatures;
  bool fresnel = kOptionalFeatures;
  bool patterns = kOptionalFeatures;  ///< colors that vary over the surface
  bool bumps = kOptionalFeatures;     ///< normals that follow a height
  bool gradient_background = kOptionalFeatures;
  bool first_hit_channels = kOptionalFeatures;
  bool ray_count_channel = kOptionalFeatures;
  bool truncation_channel = kOptionalFeatures;
  bool uneven_lights = kOptionalFeatures;  ///< falloff and cones
  bool halfway_highlights = kOptionalFeatures;
  bool instances = kOptionalFeatures;
  bool tabled_highlights = kOptionalFeatures;  ///< weights by angle
  bool transparent_shadows = kOptionalFeatures;
  bool absorption = kOptionalFeatures;
  bool special_optics = kOptionalFeatures;  ///< thin sheets and conductors
  bool media = kOptionalFeatures;           ///< overlapping media by priority
  bool rough_surfaces = kOptionalFeatures;  ///< perturbed normals
  bool one_sided_surfaces = kOptionalFeatures;
  bool facet_shading = kOptionalFeatures;  ///< interpolated light, true normals, and what keeps shadows and rays right
};
inline constexpr Features kFeatures;

}  // namespace raytree
