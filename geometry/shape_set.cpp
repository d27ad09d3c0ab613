#include "geometry/shape_set.h"

#include "geometry/facet_record.h"
#include "geometry/mesh_source.h"

namespace raytree {

namespace {

template <class Array>
std::size_t bytes(const Array& array) {
  return array.size() * sizeof(array[0]);
}

std::size_t bounded_bytes(const BoundedShapes& shapes) {
  std::size_t sum = bytes(shapes.spheres.center_radius) + bytes(shapes.spheres.shape) +
                    bytes(shapes.discs.center_radius) + bytes(shapes.discs.normal) + bytes(shapes.discs.shape) +
                    bytes(shapes.cones.base_radius) + bytes(shapes.cones.apex_radius) + bytes(shapes.cones.shape);
  for (const MeshEntry& entry : shapes.meshes) {
    const TriangleMesh& mesh = entry.mesh;
    sum += bytes(mesh.positions) + bytes(mesh.corners) + bytes(mesh.normals) + bytes(mesh.normal_corners) +
           bytes(mesh.texture_coordinates) + bytes(mesh.texture_corners) + bytes(mesh.triangle_faces) +
           bytes(entry.triangle_tags);
    if (entry.facets) sum += entry.facets->memory_bytes();
    if (entry.source) sum += entry.source->memory_bytes();
  }
  return sum;
}

}  // namespace

std::size_t memory_bytes(const ShapeSet& shapes) {
  std::size_t sum = bounded_bytes(shapes) + bytes(shapes.planes) + bytes(shapes.instances);
  for (const BoundedShapes& group : shapes.groups) sum += bounded_bytes(group);
  return sum;
}

}  // namespace raytree
