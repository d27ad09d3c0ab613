#include "geometry/mesh_source.h"

#include "geometry/polygon_mesh.h"

namespace raytree {

std::size_t MeshSource::memory_bytes() const {
  return (starts.size() + corners.size() + parameters.faces.size()) * sizeof(std::uint32_t) +
         parameters.corners.size() * sizeof(Vec2f) + patches.size() * sizeof(LimitPatch);
}

void note_polygons(const PolygonMesh& mesh, MeshSource& source) {
  if (mesh.all_triangles()) return;
  source.starts.resize(mesh.face_sizes.size() + 1);
  source.starts[0] = 0;
  for (std::size_t face = 0; face < mesh.face_sizes.size(); ++face)
    source.starts[face + 1] = source.starts[face] + mesh.face_sizes[face];
  source.corners = mesh.corners;
}

void move_patches(MeshSource& source, const Matrix44d& m) {
  for (LimitPatch& patch : source.patches)
    for (Vec3d& point : patch.patch.points) point = point * m;
}

}  // namespace raytree
