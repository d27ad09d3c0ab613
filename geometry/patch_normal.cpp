#include "geometry/patch_normal.h"

namespace raytree {

Vec3d leading_normal(const TangentSeries& tangents, double scale) {
  const VectorOf<PowerSeries> normal = tangents.du.cross(tangents.dv);
  for (std::size_t i = 0; i < PowerSeries::kTerms; ++i) {
    const Vec3d term(normal.x.c[i], normal.y.c[i], normal.z.c[i]);
    if (term.length() > kVanishedNormal * scale * scale) return term;
  }
  return {0, 0, 0};
}

Vec3d gouraud_normal(const Vec3d& at_low, const Vec3d& at_high, bool edge_along_u, bool far_edge) {
  // Inside, close to the edge v = 0, P_u is about v (P_v at the high end - P_v at the low end), so that P_u x P_v turns
  // from the high end's tangent to the low one's; at v = 1, and with the parameters exchanged, the other way.
  return edge_along_u != far_edge ? at_high.cross(at_low) : at_low.cross(at_high);
}

}  // namespace raytree
