// Shapes and rays for tests of reference tracers: meshes that keep what they were made of, and brute force beside them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "geometry/mesh_source.h"
#include "geometry/polygon_mesh.h"
#include "geometry/shape_set.h"
#include "geometry/triangulation.h"
#include "tests/random.h"

namespace raytree::test {

/// A mesh of polygons, triangulated, with its polygons kept.
inline MeshEntry polygon_entry(PolygonMesh mesh) {
  auto source = std::make_shared<MeshSource>();
  note_polygons(mesh, *source);
  const bool polygons = source->polygon_count() > 0;
  Warnings warnings;
  MeshEntry entry{triangulate(std::move(mesh), {}, warnings), 0, {}, {}, {}};
  if (polygons) entry.source = std::move(source);
  return entry;
}

inline ShapeSet polygon_shapes(PolygonMesh mesh) {
  ShapeSet shapes;
  shapes.meshes.push_back(polygon_entry(std::move(mesh)));
  return shapes;
}

inline void add_sphere(BoundedShapes& shapes, const Vec3f& center, float radius) {
  shapes.spheres.center_radius.push_back({center.x, center.y, center.z, radius});
  shapes.spheres.shape.push_back(0);
}
inline void add_disc(BoundedShapes& shapes, const Vec3f& center, const Vec3f& normal, float radius) {
  shapes.discs.center_radius.push_back({center.x, center.y, center.z, radius});
  shapes.discs.normal.push_back(normal);
  shapes.discs.shape.push_back(0);
}
inline void add_cone(BoundedShapes& shapes, const Vec3f& base, float base_radius, const Vec3f& apex,
                     float apex_radius) {
  shapes.cones.base_radius.push_back({base.x, base.y, base.z, base_radius});
  shapes.cones.apex_radius.push_back({apex.x, apex.y, apex.z, apex_radius});
  shapes.cones.shape.push_back(0);
}

}  // namespace raytree::test
