// Spheres, cones, cylinders and discs of a given number of facets: closed where they should be, vertices and normals on
// the surface, caps that fit.
#include "geometry/faceted_quadric.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "geometry/newell.h"
#include "geometry/open_edges.h"
#include "geometry/triangulation.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

TriangleMesh triangles_of(PolygonMesh mesh) {
  Warnings warnings;
  return triangulate(std::move(mesh), {}, warnings);
}

/// Each face's normal points away from `inside`.
void expect_outward(const PolygonMesh& mesh, const Vec3d& axis) {
  std::size_t corner = 0;
  for (const std::uint32_t size : mesh.face_sizes) {
    const Vec3d normal = newell_normal(mesh.positions.data(), &mesh.corners[corner], size);
    Vec3d middle(0, 0, 0);
    for (std::size_t k = 0; k < size; ++k) middle += Vec3d(mesh.positions[mesh.corners[corner + k]]) / double(size);
    if (axis.length() > 0) middle -= axis * middle.dot(axis);
    EXPECT_GT(normal.dot(middle), 0);
    corner += size;
  }
}

TEST(FacetedQuadric, SpheresAreClosedAndTouchTheirSphere) {
  for (const auto& [sides, stacks] : {std::pair(3, 2), std::pair(8, 4), std::pair(16, 9)}) {
    const PolygonMesh mesh = faceted_sphere({5, -2, 1e6}, 2, sides, stacks);
    test::expect_valid(mesh);
    EXPECT_EQ(mesh.positions.size(), std::size_t(sides * (stacks - 1) + 2));
    EXPECT_EQ(mesh.face_count(), std::size_t(sides * stacks));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      EXPECT_NEAR(mesh.positions[v].length(), 2, 1e-6);
      EXPECT_LT((mesh.positions[v] * 0.5f - mesh.normals[v]).length(), 1e-6);
    }
    expect_outward(mesh, {0, 0, 0});
    EXPECT_EQ(count_open_edges(triangles_of(mesh)), 0);
  }
}

TEST(FacetedQuadric, ConesHaveTheNormalsOfTheirHalfPlanes) {
  for (const Cone& cone : {Cone{{1, 2, 3}, {1, 5, 3}, 1, 1}, Cone{{0, 0, 0}, {0, 0, 2}, 1, 0},
                           Cone{{0, 0, 0}, {2, 1, -1}, 0, 0.7}, Cone{{0, 0, 0}, {-3, 0, 0}, 2, 0.5}})
    for (const int stacks : {1, 3}) {
      const int sides = 7;
      const PolygonMesh mesh = faceted_cone(cone, sides, stacks);
      test::expect_valid(mesh);
      const ConeFrame frame(cone);
      EXPECT_EQ(mesh.face_count(), std::size_t(sides * stacks));
      expect_outward(mesh, frame.axis);
      std::size_t at_tip = 0;
      for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
        const Vec3d point = cone.base + Vec3d(mesh.positions[mesh.corners[c]]);
        const Vec3d normal(mesh.normals[mesh.normal_corners[c]]);
        EXPECT_NEAR(normal.length(), 1, 1e-6);
        const double height = (point - cone.base).dot(frame.axis);
        if (std::abs(frame.base_radius + frame.slope * height) < 1e-6) {
          ++at_tip;
          EXPECT_NEAR(normal.dot(frame.axis), -frame.slope / std::hypot(1, frame.slope), 1e-5);
        } else {
          EXPECT_LT((normal - cone_normal(frame, point)).length(), 1e-5);
        }
      }
      EXPECT_EQ(at_tip, cone.base_radius == 0 || cone.apex_radius == 0 ? std::size_t(sides) : 0u);
    }
}

TEST(FacetedQuadric, CapsShareTheVerticesOfTheirCylinder) {
  for (const Vec3d& axis : {Vec3d(0, 3, 0), Vec3d(2, 0, 0), Vec3d(1, 1, -2)}) {
    const int sides = 5;
    std::set<std::array<float, 3>> side_points;
    for (const Vec3f& p : faceted_cone({{0, 0, 0}, axis, 1, 1}, sides, 1).positions) {
      const Vec3f at = p;
      side_points.insert({at.x, at.y, at.z});
    }
    for (const double sign : {-1.0, 1.0}) {
      const PolygonMesh cap = faceted_disc({0, 0, 0}, axis * sign, 1, sides);
      ASSERT_EQ(cap.face_count(), 1u);
      EXPECT_GT(newell_normal(cap.positions.data(), cap.corners.data(), 5).dot(axis * sign), 0);
      for (const Vec3f& p : cap.positions) {
        float nearest = 1;
        for (const auto& q : side_points) nearest = std::min(nearest, (p - Vec3f(q[0], q[1], q[2])).length());
        EXPECT_LT(nearest, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace raytree
