#include "geometry/surface.h"

namespace raytree::detail {

void solve_extreme_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, TriangleSolution& solution) {
  solution.normal = Vec3f(unit(Vec3d(b - a).cross(Vec3d(c - a))));
  solution.clearance = clearance(
      solution.normal, {largest_size(a.x, b.x, c.x), largest_size(a.y, b.y, c.y), largest_size(a.z, b.z, c.z)});
}

}  // namespace raytree::detail
