// The second truth: Woop's test in double passes nothing through edges and vertices, closed forms hold, and what is
// found does not depend on how it is looked for.
#include "geometry/triangle_reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tests/random.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using test::Random;

MeshEntry globe(double radius, int columns, int rows) {
  const auto polygons = test::globe_mesh(radius, columns, rows);
  MeshEntry entry;
  entry.mesh.positions.assign(polygons->positions.begin(), polygons->positions.end());
  entry.mesh.corners.assign(polygons->corners.begin(), polygons->corners.end());
  return entry;
}

Instance placed(std::uint32_t group, const Vec3d& at, double scale, double turn) {
  Instance instance;
  const double c = std::cos(turn) * scale, s = std::sin(turn) * scale;
  const double rows[4][3] = {{c, 0, -s}, {0, scale * 1.5, 0}, {s, 0, c}, {at.x, at.y, at.z}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j) instance.to_scene[i][j] = static_cast<float>(rows[i][j]);
  instance.group = group;
  return instance;
}

/// Something of each kind, in the scene and in a group.
ShapeSet everything() {
  ShapeSet shapes;
  Random random(1);
  const auto add_round = [&](BoundedShapes& list, int count) {
    for (int i = 0; i < count; ++i) {
      const Vec3f p(random.in_cube(4)), q(random.in_cube(4));
      list.spheres.center_radius.push_back({p.x, p.y, p.z, float(random.uniform(0.05, 0.5))});
      list.spheres.shape.push_back(0);
      list.discs.center_radius.push_back({q.x, q.y, q.z, float(random.uniform(0.05, 0.5))});
      list.discs.normal.push_back(Vec3f(random.direction()));
      list.discs.shape.push_back(0);
      list.cones.base_radius.push_back({p.x, q.y, p.z, 0.3f});
      list.cones.apex_radius.push_back({p.x, q.y + 0.5f, q.z, 0.1f});
      list.cones.shape.push_back(0);
    }
  };
  add_round(shapes, 20);
  shapes.meshes.push_back(globe(1.5, 24, 12));
  shapes.planes.push_back({{0, -4, 0}, {0, 1, 0}, 0});
  shapes.groups.resize(1);
  add_round(shapes.groups[0], 5);
  shapes.groups[0].meshes.push_back(globe(1, 12, 8));
  for (int i = 0; i < 10; ++i) shapes.instances.push_back(placed(0, random.in_cube(5), 0.3, i));
  return shapes;
}

bool same_bits(const ReferenceHit& a, const ReferenceHit& b) {
  return a.geometry == b.geometry && a.primitive == b.primitive && a.instance == b.instance && a.face == b.face &&
         std::memcmp(&a.distance, &b.distance, sizeof(double)) == 0 &&
         std::memcmp(&a.u, &b.u, 2 * sizeof(double)) == 0 && std::memcmp(&a.normal, &b.normal, sizeof(Vec3d)) == 0;
}

TEST(TriangleReference, HierarchyAndLinearSearchAgreeToTheBit) {
  const ShapeSet shapes = everything();
  const TriangleReference fast(shapes), plain(shapes, TriangleReference::Search::linear);
  Random random(2);
  int hits = 0, of_instances = 0, differing = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3d origin = random.in_cube(6), direction = random.direction() * random.uniform(0.5, 2);
    // At vertices, where ties are; along axes, where slabs divide by zero.
    if (i % 4 == 1) direction = Vec3d(shapes.meshes[0].mesh.positions[i % 200]) - origin;
    if (i % 4 == 2) direction = Vec3d(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (i % 8 < 4 ? 1 : -1);
    const double most = i % 5 == 0 ? random.uniform(0, 5) : std::numeric_limits<double>::infinity();
    const ReferenceHit a = fast.nearest(origin, direction, most), b = plain.nearest(origin, direction, most);
    differing += !same_bits(a, b);
    hits += a.hit();
    of_instances += a.instance != kNoInstance;
    if (a.hit()) {
      EXPECT_LE(a.distance, most);
      EXPECT_NEAR(a.normal.length(), 1, 1e-12);
    }
  }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(hits, 10000);
  EXPECT_GT(of_instances, 500);
}

TEST(TriangleReference, NothingPassesBetweenTriangles) {
  // From inside a closed mesh, at its vertices and at points of its edges.
  for (const double center : {0.0, 1000.0}) {
    ShapeSet shapes;
    shapes.meshes.push_back(globe(1, 60, 30));
    TriangleMesh& mesh = shapes.meshes[0].mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i] += Vec3f(static_cast<float>(center));
    const TriangleReference truth(shapes);
    Random random(3);
    int missed = 0;
    for (int i = 0; i < 100000; ++i) {
      const Vec3d origin = Vec3d(center) + random.in_cube(0.4);
      const std::size_t corner = static_cast<std::size_t>(random.uniform(0, double(mesh.triangle_count()))) * 3;
      const Vec3d a(mesh.positions[mesh.corners[corner]]), b(mesh.positions[mesh.corners[corner + 1]]);
      const double share = i % 3 == 0 ? 0 : i % 3 == 1 ? 0.5 : random.uniform(0, 1);
      const Vec3d direction = a + (b - a) * share - origin;
      const ReferenceHit hit = truth.nearest(origin, direction, std::numeric_limits<double>::infinity());
      missed += !hit.hit();
      if (hit.hit()) {
        EXPECT_NEAR(hit.distance, 1, 1e-9);
      }
    }
    EXPECT_EQ(missed, 0) << "center " << center;
  }
}

TEST(TriangleReference, ShapesAreMetWhereClosedFormsSay) {
  ShapeSet shapes;
  shapes.spheres.center_radius.push_back({0, 0, 0, 1});
  shapes.spheres.shape.push_back(0);
  shapes.discs.center_radius.push_back({0, 0, 5, 1});
  shapes.discs.normal.push_back({0, 0, 1});
  shapes.discs.shape.push_back(0);
  shapes.cones.base_radius.push_back({10, 0, 0, 2});
  shapes.cones.apex_radius.push_back({10, 3, 0, 2});
  shapes.cones.shape.push_back(0);
  shapes.planes.push_back({{0, -3, 0}, {0, 1, 0}, 0});
  const TriangleReference truth(shapes);
  const auto expect = [&](const Vec3d& origin, const Vec3d& direction, GeometryId geometry, double distance,
                          const Vec3d& normal) {
    const ReferenceHit hit = truth.nearest(origin, direction, std::numeric_limits<double>::infinity());
    ASSERT_EQ(hit.geometry, geometry);
    EXPECT_NEAR(hit.distance, distance, 1e-15 * std::max(1.0, distance));
    EXPECT_NEAR((hit.normal - normal).length(), 0, 1e-14);
    EXPECT_EQ(hit.face, kNoFace);
    // Distances count in lengths of the direction.
    EXPECT_DOUBLE_EQ(truth.nearest(origin, direction * 4, 1e9).distance * 4, hit.distance);
  };
  const double half = std::sqrt(0.75);
  expect({0.5, 0, -8}, {0, 0, 1}, kSphereGeometry, 8 - half, {0.5, 0, -half});
  expect({0.5, 0, 0}, {0, 0, 1}, kSphereGeometry, half, {0.5, 0, half});
  expect({0.9, 0, 7}, {0, 0, -1}, kDiscGeometry, 2, {0, 0, 1});
  expect({10, 1, -6}, {0, 0, 1}, kConeGeometry, 4, {0, 0, -1});
  expect({10, 1, 0}, {1, 0, 0}, kConeGeometry, 2, {1, 0, 0});
  expect({20, 1, 0}, {0, -0.6, 0.8}, kPlaneGeometry, 4 / 0.6, {0, 1, 0});
  EXPECT_FALSE(truth.nearest({0, 0, -8}, {0, 0, 1}, 6.9).hit());
  EXPECT_TRUE(truth.nearest({0, 0, -8}, {0, 0, 1}, 7).hit());
}

TEST(TriangleReference, InstancesAreWhereTheirMatrixPutsThem) {
  ShapeSet shapes;
  shapes.groups.resize(1);
  shapes.groups[0].meshes.push_back(globe(1, 24, 12));
  Instance mirrored = placed(0, {3, 0, 0}, 2, 0.5);
  for (float& x : mirrored.to_scene[0]) x = -x;
  shapes.instances.push_back(mirrored);
  // The same triangles, moved.
  ShapeSet moved;
  moved.meshes.push_back(globe(1, 24, 12));
  TriangleMesh& mesh = moved.meshes[0].mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f p = mesh.positions[i];
    mesh.positions[i] = mirrored.axis(0) * p.x + mirrored.axis(1) * p.y + mirrored.axis(2) * p.z + mirrored.origin();
  }
  const TriangleReference inside(shapes), outside(moved);
  Random random(4);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d origin = random.in_cube(8), direction = (Vec3d(3, 0, 0) + random.in_cube(1.2) - origin).normalized();
    const ReferenceHit a = inside.nearest(origin, direction, 1e9), b = outside.nearest(origin, direction, 1e9);
    if (a.primitive != b.primitive || !a.hit()) continue;
    ++hits;
    EXPECT_EQ(a.instance, 0u);
    EXPECT_NEAR(a.distance, b.distance, 1e-4);
    // Mirroring turns the triangle over; its outside stays outside.
    EXPECT_NEAR((a.normal + b.normal).length(), 0, 1e-4);
  }
  EXPECT_GT(hits, 1500);
}

}  // namespace
}  // namespace raytree
