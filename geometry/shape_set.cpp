#include "geometry/shape_set.h"

namespace raytree {

std::size_t memory_bytes(const ShapeSet& shapes) {
  const auto bytes = [](const auto& array) { return array.size() * sizeof(array[0]); };
  std::size_t sum = bytes(shapes.spheres.center_radius) + bytes(shapes.spheres.shape) +
                    bytes(shapes.discs.center_radius) + bytes(shapes.discs.normal) + bytes(shapes.discs.shape) +
                    bytes(shapes.planes);
  for (const MeshEntry& entry : shapes.meshes) {
    const TriangleMesh& mesh = entry.mesh;
    sum += bytes(mesh.positions) + bytes(mesh.corners) + bytes(mesh.normals) + bytes(mesh.normal_corners) +
           bytes(mesh.texture_coordinates) + bytes(mesh.texture_corners) + bytes(mesh.triangle_faces);
  }
  return sum;
}

}  // namespace raytree
