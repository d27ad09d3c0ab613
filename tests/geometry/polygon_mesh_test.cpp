#include "geometry/polygon_mesh.h"

#include <gtest/gtest.h>

namespace raytree {
namespace {

TEST(PolygonMesh, BoundsHoldTheDoubleOrigin) {
  PolygonMesh mesh;
  mesh.origin = {1e6, 0, -1e6};
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1e-3f, 2, 3)});
  const Bounds3d box = bounds(mesh);
  EXPECT_EQ(box.min, Vec3d(1e6, 0, -1e6));
  EXPECT_DOUBLE_EQ(box.max.x, 1e6 + double(1e-3f));
}

}  // namespace
}  // namespace raytree
