// The scene that benchmarks ask: every call comes back, and says the same, whatever is built.
#include "geometry/embree_bench_scene.h"

#include <gtest/gtest.h>

#include "geometry/shape_set.h"
#include "tests/random.h"

namespace raytree {
namespace {

using test::Random;

/// A few spheres and two triangles that make a quad: the smallest scenes are those that Embree 3.13 does not come back
/// from.
ShapeSet handful(Random& random) {
  ShapeSet shapes;
  for (std::size_t i = 0, count = 1 + random.below(5); i < count; ++i) {
    const Vec3f center(random.in_cube(1));
    shapes.spheres.center_radius.push_back({center.x, center.y, center.z, float(random.uniform(0.05, 0.4))});
    shapes.spheres.shape.push_back(0);
  }
  TriangleMesh& mesh = shapes.meshes.emplace_back().mesh;
  const float y = float(random.uniform(-1, 0));
  mesh.positions.assign({{-1, y, -1}, {1, y, -1}, {1, y, 1}, {-1, y, 1}});
  mesh.corners.assign({0, 2, 1, 0, 3, 2});
  return shapes;
}

/// Sixteen by sixteen, in parallel and apart by turns.
void fill_with_packets(RayBatch& rays, Random& random) {
  for (std::size_t packet = 0; rays.size + 16 <= rays.capacity(); ++packet) {
    const Vec3d origin = random.in_cube(2), direction = random.direction();
    const double spread = packet % 2 == 0 ? 0 : 0.2;
    for (int i = 0; i < 16; ++i)
      rays.push(Vec3f(origin + random.in_cube(0.5)), Vec3f((direction + random.direction() * spread).normalized()),
                kInfinity);
  }
}

TEST(EmbreeBenchScene, EveryCallComesBackWithTheSameAnswer) {
  Random random(24);
  RayBatch rays(1024);
  fill_with_packets(rays, random);
  std::vector<std::uint8_t> first(rays.size), other(rays.size);
  for (int trial = 0; trial < 20; ++trial) {
    const ShapeSet shapes = handful(random);
    BenchSceneOptions options;
    options.threads = 1;
    for (const bool compact : {false, true})
      for (const bool robust : {false, true})
        for (const BenchGeometry geometry : {BenchGeometry::triangles, BenchGeometry::quads}) {
          options.compact = compact, options.robust = robust, options.geometry = geometry;
          const EmbreeBenchScene scene(shapes, options);
          scene.occluded(rays, {1, false}, first.data());
          for (const int width : {4, 8, 16}) {
            if (width > EmbreeBenchScene::widest_call()) continue;
            for (const bool coherent : {false, true}) {
              scene.occluded(rays, {width, coherent}, other.data());
              std::size_t differ = 0;
              for (std::size_t i = 0; i < rays.size; ++i) differ += first[i] != other[i];
              // Calls of other widths round otherwise: rays along silhouettes may go either way.
              EXPECT_LE(differ, 1u) << "width " << width << (coherent ? ", coherent" : "") << ", trial " << trial;
            }
          }
        }
  }
}

}  // namespace
}  // namespace raytree
