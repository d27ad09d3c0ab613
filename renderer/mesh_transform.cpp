#include "renderer/mesh_transform.h"

#include <utility>

#include "geometry/buffer.h"
#include "geometry/surface.h"

namespace raytree {
namespace {

/// Normals go by the inverse transpose of the linear part.
Vec3d transformed_normal(const Vec3d& normal, const Matrix44d& inverse_transpose) {
  return unit(transformed_vector(normal, inverse_transpose));
}

}  // namespace

void transform_mesh(TriangleMesh& mesh, const Matrix44d& m) {
  if (m == Matrix44d()) return;
  mesh.origin = mesh.origin * m;
  for_each_index(mesh.positions.size(),
                 [&](std::size_t i) { mesh.positions[i] = Vec3f(transformed_vector(Vec3d(mesh.positions[i]), m)); });
  const Matrix44d inverse_transpose = m.inverse().transposed();
  for_each_index(mesh.normals.size(), [&](std::size_t i) {
    mesh.normals[i] = Vec3f(transformed_normal(Vec3d(mesh.normals[i]), inverse_transpose));
  });
  if (!mirrors(m)) return;
  // A mirrored triangle is wound the other way round.
  const auto reverse = [](Buffer<std::uint32_t>& corners) {
    for_each_index(corners.size() / 3, [&](std::size_t i) { std::swap(corners[3 * i + 1], corners[3 * i + 2]); });
  };
  // Arrays indexed per position are reversed with the corners.
  reverse(mesh.corners);
  reverse(mesh.normal_corners);
  reverse(mesh.texture_corners);
}

}  // namespace raytree
