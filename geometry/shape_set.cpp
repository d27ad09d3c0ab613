#include "geometry/shape_set.h"

#include "geometry/buffer.h"
#include "geometry/facet_record.h"
#include "geometry/mesh_source.h"

namespace raytree {

namespace {

std::size_t bounded_bytes(const BoundedShapes& shapes) {
  std::size_t sum = array_bytes(shapes.spheres.center_radius) + array_bytes(shapes.spheres.shape) +
                    array_bytes(shapes.discs.center_radius) + array_bytes(shapes.discs.normal) +
                    array_bytes(shapes.discs.shape) + array_bytes(shapes.cones.base_radius) +
                    array_bytes(shapes.cones.apex_radius) + array_bytes(shapes.cones.shape);
  for (const MeshEntry& entry : shapes.meshes) {
    const TriangleMesh& mesh = entry.mesh;
    sum += array_bytes(mesh.positions) + array_bytes(mesh.corners) + array_bytes(mesh.normals) +
           array_bytes(mesh.normal_corners) + array_bytes(mesh.texture_coordinates) +
           array_bytes(mesh.texture_corners) + array_bytes(mesh.triangle_faces) + array_bytes(entry.triangle_tags);
    if (entry.facets) sum += entry.facets->memory_bytes();
    if (entry.source) sum += entry.source->memory_bytes();
  }
  return sum;
}

}  // namespace

std::size_t memory_bytes(const ShapeSet& shapes) {
  std::size_t sum = bounded_bytes(shapes) + array_bytes(shapes.planes) + array_bytes(shapes.instances);
  for (const BoundedShapes& group : shapes.groups) sum += bounded_bytes(group);
  return sum;
}

}  // namespace raytree
