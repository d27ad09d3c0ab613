// Meshes that benchmarks make.
#include "benchmarks/reference_scenes.h"

#include <gtest/gtest.h>

#include <variant>

namespace raytree::benchmarks {
namespace {

// All triangles of the ball look outward, and none is without area.
TEST(ReferenceScenes, TheDentedBallIsABall) {
  const SceneDescription scene = dented_ball(3000);
  ASSERT_EQ(scene.shapes.size(), 1u);
  const PolygonMesh& mesh = *std::get<MeshShape>(scene.shapes[0].kind).mesh;
  EXPECT_EQ(mesh.face_sizes.size(), 12u * 16 * 16);
  double volume = 0;
  for (std::size_t face = 0; face < mesh.face_sizes.size(); ++face) {
    const Vec3d a(mesh.positions[mesh.corners[3 * face]]), b(mesh.positions[mesh.corners[3 * face + 1]]),
        c(mesh.positions[mesh.corners[3 * face + 2]]);
    const Vec3d normal = (b - a).cross(c - a);
    EXPECT_GT(normal.dot(a + b + c), 0) << face;
    volume += a.dot(b.cross(c)) / 6;
  }
  // Radii of .9 to 1.1 about 1.
  EXPECT_GT(volume, 4.18879 * 0.9 * 0.9 * 0.9);
  EXPECT_LT(volume, 4.18879 * 1.1 * 1.1 * 1.1);
}

}  // namespace
}  // namespace raytree::benchmarks
