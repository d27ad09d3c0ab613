// Triangles joined in pairs, and the way back from a point of a quad to the triangle it lies on; the fast tracer over
// quads names the triangles that it names over triangles.
#include "geometry/quad_pairs.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "geometry/embree_intersector.h"
#include "geometry/terrain.h"
#include "tests/random.h"

namespace raytree {
namespace {

using test::Random;

/// A strip of quads in space, each halved one way or the other, with its triangles' corners turned at random and, now
/// and then, a triangle of its own between the halves.
TriangleMesh ragged_strip(Random& random, std::uint32_t quads) {
  TriangleMesh mesh;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::uint32_t corners[3] = {a, b, c};
    for (std::size_t i = 0, turn = random.below(3); i < 3; ++i) mesh.corners.push_back(corners[(i + turn) % 3]);
  };
  for (std::uint32_t i = 0; i < quads; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3f at(Vec3d(2.0 * i, 0, 0));
    for (const Vec3f& corner : {Vec3f(0, 0, 0), Vec3f(1, 0, 0.2f), Vec3f(1.1f, 1, 0), Vec3f(0, 0.9f, 0.1f)})
      mesh.positions.push_back(at + corner);
    const std::uint32_t a = first, b = first + 1, c = first + 2, d = first + 3;
    const bool flip = random.below(2) == 0;
    triangle(a, b, flip ? d : c);
    if (random.below(3) == 0) {
      for (const Vec3f& corner : {Vec3f(0, 3, 0), Vec3f(1, 3, 0), Vec3f(0, 4, 0)})
        mesh.positions.push_back(at + corner);
      triangle(first + 4, first + 5, first + 6);
    }
    if (random.below(8) != 0) triangle(flip ? b : a, c, d);
  }
  return mesh;
}

Vec3d point_of(const TriangleMesh& mesh, const TrianglePoint& point) {
  const std::uint32_t* corners = &mesh.corners[3 * std::size_t(point.triangle)];
  const auto at = [&](int i) { return Vec3d(mesh.positions[corners[i]]); };
  return at(0) * (1.0 - point.u - point.v) + at(1) * double(point.u) + at(2) * double(point.v);
}

TEST(QuadPairs, PointsOfQuadsArePointsOfTheirTriangles) {
  Random random(31);
  const TriangleMesh mesh = ragged_strip(random, 20000);  // several blocks
  const QuadList quads = joined_quads(mesh.corners);
  EXPECT_GT(quads.paired, 15000u);
  EXPECT_EQ(quads.size() + quads.paired, mesh.triangle_count());
  EXPECT_EQ(quads.size(), estimate_joined_quads(mesh.corners)) << "counted, not estimated";
  std::vector<int> met(mesh.triangle_count(), 0);
  for (std::uint32_t quad = 0; quad < quads.size(); ++quad) {
    const std::uint32_t* c = &quads.corners[4 * std::size_t(quad)];
    const auto at = [&](int i) { return Vec3d(mesh.positions[c[i]]); };
    for (const bool second : {false, true}) {
      if (second && c[2] == c[3]) continue;
      // Of the half's own corners; Embree gives the second half's from the quad's far side.
      const double s = random.uniform(0.05, 0.4), t = random.uniform(0.05, 0.4);
      const Vec3d expected =
          second ? at(2) * (1 - s - t) + at(3) * s + at(1) * t : at(0) * (1 - s - t) + at(1) * s + at(3) * t;
      const TrianglePoint found = triangle_point(quads, quad, float(second ? 1 - s : s), float(second ? 1 - t : t));
      ASSERT_LT(found.triangle, mesh.triangle_count());
      ++met[found.triangle];
      ASSERT_LT((point_of(mesh, found) - expected).length(), 1e-6 * (1 + expected.length())) << quad;
    }
  }
  for (std::size_t i = 0; i < met.size(); ++i) ASSERT_EQ(met[i], 1) << "triangle " << i;
}

TEST(QuadPairs, OfManyTrianglesAreEstimated) {
  Random random(33);
  const TriangleMesh mesh = ragged_strip(random, 1'000'000);
  ASSERT_GT(mesh.triangle_count(), 2'000'000u);
  const auto quads = static_cast<double>(joined_quads(mesh.corners).size());
  EXPECT_NEAR(static_cast<double>(estimate_joined_quads(mesh.corners)) / quads, 1, 0.005);
}

TEST(QuadPairs, DependOnNoThreads) {
  Random random(32);
  const TriangleMesh mesh = ragged_strip(random, 30000);
  const QuadList many = joined_quads(mesh.corners);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const QuadList single = joined_quads(mesh.corners);
  EXPECT_EQ(many.corners, single.corners);
  EXPECT_EQ(many.first, single.first);
}

TEST(QuadPairs, ThatFollowEachOtherNeedNoListOfTriangles) {
  const TriangleMesh terrain = make_terrain({60000, 10, 0.6, 0.5, 7});  // several blocks
  const QuadList quads = joined_quads(terrain.corners);
  EXPECT_EQ(2 * quads.paired, terrain.triangle_count());
  EXPECT_EQ(quads.memory_bytes(), quads.size() * (4 * 4 + 1));
  for (std::uint32_t quad = 0; quad < quads.size(); ++quad) ASSERT_EQ(quads.first_triangle(quad), 2 * quad);
  // The same less its first triangle: nothing is where it was.
  const QuadList others = joined_quads(std::span(terrain.corners).subspan(3));
  EXPECT_EQ(others.first.size(), others.size());
  EXPECT_LT(others.paired, quads.paired);
}

/// Rays from above, at the terrain, the same for both tracers.
void expect_same_hits(const ShapeSet& shapes, Random& random, const Vec3f& reach) {
  EmbreeOptions options;
  const EmbreeIntersector triangles(shapes, options);
  options.primitives = EmbreeOptions::Primitives::quads;
  for (const bool compact : {false, true}) {
    options.compact = compact;
    const EmbreeIntersector quads(shapes, options);
    std::size_t met = 0, others = 0;
    for (int batch = 0; batch < 20; ++batch) {
      RayBatch rays(1000);
      HitBatch expected(1000), hits(1000);
      while (rays.size < 1000) {
        const Vec3d direction = random.direction();
        rays.push(Vec3f(float(random.uniform(-1, 1)) * reach.x, reach.y, float(random.uniform(-1, 1)) * reach.z),
                  Vec3f(float(direction.x), -1.5f - float(std::abs(direction.y)), float(direction.z)).normalized(),
                  kInfinity);
      }
      triangles.intersect(rays, Coherence::mixed, expected);
      quads.intersect(rays, Coherence::mixed, hits);
      for (std::size_t i = 0; i < rays.size; ++i) {
        ASSERT_EQ(hits.geometry[i], expected.geometry[i]);
        ASSERT_EQ(hits.instance[i], expected.instance[i]);
        if (hits.geometry[i] == kNoGeometry) continue;
        ++met;
        EXPECT_NEAR(hits.distance[i], expected.distance[i], 1e-5 * (1 + expected.distance[i]));
        const Hit one = quads.intersect_one(rays.origin(i), rays.direction(i), kInfinity);
        // Along a shared edge either triangle is right.
        if (hits.primitive[i] != expected.primitive[i]) {
          const float least = std::min({hits.u[i], hits.v[i], 1 - hits.u[i] - hits.v[i]});
          EXPECT_LT(std::abs(least), 1e-3);
          ++others;
          continue;
        }
        EXPECT_NEAR(hits.u[i], expected.u[i], 2e-4);
        EXPECT_NEAR(hits.v[i], expected.v[i], 2e-4);
        if (one.primitive != hits.primitive[i]) continue;
        EXPECT_NEAR(one.u, hits.u[i], 2e-4);
        EXPECT_EQ(one.instance, hits.instance[i]);
      }
    }
    EXPECT_GT(met, 5000u);
    EXPECT_LT(others, met / 500);
    EXPECT_LT(quads.memory_bytes(), triangles.memory_bytes());
  }
}

TEST(QuadPairs, TracersNameTheSameTriangles) {
  Random random(33);
  TerrainParameters terrain;
  terrain.triangles = 20000;
  ShapeSet shapes;
  shapes.meshes.resize(3);
  shapes.meshes[0].mesh = make_terrain(terrain);
  shapes.meshes[2].mesh = ragged_strip(random, 40);
  const float half = float(terrain.size / 2);
  expect_same_hits(shapes, random, {half, float(2 * terrain.height), half});
}

TEST(QuadPairs, TracersNameTheSameTrianglesOfGroups) {
  Random random(34);
  TerrainParameters terrain;
  terrain.triangles = 5000;
  ShapeSet shapes;
  shapes.groups.resize(2);
  shapes.groups[1].meshes.resize(1);
  shapes.groups[1].meshes[0].mesh = make_terrain(terrain);
  shapes.instances.push_back({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, 1, 0, 0});
  shapes.instances.push_back({{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {0, float(terrain.height), 0}}, 1, 0, 1});
  const float half = float(terrain.size / 2);
  expect_same_hits(shapes, random, {half, float(3 * terrain.height), half});
}

}  // namespace
}  // namespace raytree
