#include "geometry/polygon_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace raytree {

Bounds3d bounds(const PolygonMesh& mesh) {
  using Range = tbb::blocked_range<std::size_t>;
  const Imath::Box3f relative = tbb::parallel_reduce(
      Range(0, mesh.positions.size(), 65536), Imath::Box3f(),
      [&](const Range& range, Imath::Box3f box) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) box.extendBy(mesh.positions[i]);
        return box;
      },
      [](Imath::Box3f a, const Imath::Box3f& b) {
        a.extendBy(b);
        return a;
      });
  if (relative.isEmpty()) return {};
  return {Vec3d(relative.min) + mesh.origin, Vec3d(relative.max) + mesh.origin};
}

std::size_t memory_bytes(const PolygonMesh& mesh) {
  const auto bytes = [](const auto& array) { return array.size() * sizeof(array[0]); };
  return bytes(mesh.positions) + bytes(mesh.face_sizes) + bytes(mesh.corners) + bytes(mesh.normals) +
         bytes(mesh.normal_corners) + bytes(mesh.texture_coordinates) + bytes(mesh.texture_corners);
}

}  // namespace raytree
