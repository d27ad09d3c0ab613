// Grids of lattices, and the way back from a point of a grid to the triangle it lies on; the fast tracer over grids
// names the triangles that it names over triangles, and lets no ray through between them.
#include "geometry/lattice_grids.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

#include "geometry/embree_intersector.h"
#include "geometry/error.h"
#include "geometry/terrain.h"
#include "tests/geometry/lattice_meshes.h"

namespace raytree {
namespace {

using test::add_lattice;
using test::add_soup;
using test::Random;

/// Lattices of even and odd sides, what lies between them, and pairs of triangles in no lattice.
TriangleMesh mesh_of_all_kinds(Random& random) {
  TriangleMesh mesh;
  add_soup(random, 9, mesh);
  add_lattice(random, 41, 35, mesh);
  add_lattice(random, 5, 6, mesh);  // too small to be found: pairs
  add_lattice(random, 1, 100, mesh);
  add_soup(random, 30, mesh);
  add_lattice(random, 64, 1, mesh);
  add_lattice(random, 20, 80, mesh);
  return mesh;
}

Vec3d blend(const Vec3f& a, const Vec3f& b, const Vec3f& c, double of_b, double of_c) {
  return Vec3d(a) * (1 - of_b - of_c) + Vec3d(b) * of_b + Vec3d(c) * of_c;
}

Vec3d place_of(const TriangleMesh& mesh, const TrianglePoint& point) {
  const std::uint32_t* corners = &mesh.corners[3 * std::size_t(point.triangle)];
  return blend(mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]], point.u, point.v);
}

TEST(LatticeGrids, PointsOfGridsArePointsOfTheirTriangles) {
  Random random(51);
  const TriangleMesh mesh = mesh_of_all_kinds(random);
  const MeshGrids grids = make_grids(mesh.corners, mesh.positions);
  EXPECT_GT(grids.own.size(), 500u);
  EXPECT_GT(grids.first_pair, 500u);
  EXPECT_GT(grids.copied.size(), grids.first_pair);
  std::vector<int> met(mesh.triangle_count(), 0);
  for (const bool copied : {false, true})
    for (std::size_t grid = 0; grid < (copied ? grids.copied : grids.own).size(); ++grid) {
      const LatticeGrid& tile = (copied ? grids.copied : grids.own)[grid];
      const std::span<const Vec3f> points = copied ? grids.points : mesh.positions;
      const auto at = [&](std::uint32_t x, std::uint32_t y) { return points[tile.first_point + y * tile.stride + x]; };
      const std::uint32_t across = tile.width - 1u, along = tile.height - 1u;
      ASSERT_TRUE(across >= 1 && across <= kMostGridCells && along >= 1 && along <= kMostGridCells);
      for (std::uint32_t y = 0; y < along; ++y)
        for (std::uint32_t x = 0; x < across; ++x)
          for (const bool second : {false, true}) {
            if (second && at(x + 1, y + 1) == at(x, y + 1)) continue;  // a triangle without partner
            const double s = random.uniform(0.05, 0.4), t = random.uniform(0.05, 0.4);
            const Vec3d expected = second ? blend(at(x + 1, y + 1), at(x, y + 1), at(x + 1, y), s, t)
                                          : blend(at(x, y), at(x + 1, y), at(x, y + 1), s, t);
            const double u = (x + (second ? 1 - s : s)) / across, v = (y + (second ? 1 - t : t)) / along;
            const TrianglePoint found =
                triangle_point(grids, mesh.corners, copied, std::uint32_t(grid), float(u), float(v));
            ASSERT_LT(found.triangle, mesh.triangle_count());
            ++met[found.triangle];
            ASSERT_LT((place_of(mesh, found) - expected).length(), 1e-6 * (1 + expected.length()))
                << copied << " " << grid << ", cell " << x << ", " << y << ", half " << second;
          }
    }
  for (std::size_t i = 0; i < met.size(); ++i) ASSERT_EQ(met[i], 1) << "triangle " << i;
}

// A coordinate on the border of two cells, or beyond the grid by a rounding, is a point of the border.
TEST(LatticeGrids, BordersBelongToEitherCell) {
  Random random(52);
  TriangleMesh mesh;
  add_lattice(random, 8, 8, mesh);
  const MeshGrids grids = make_grids(mesh.corners, mesh.positions);
  for (std::uint32_t grid = 0; grid < grids.own.size(); ++grid)
    for (const float u : {-1e-7f, 0.0f, 0.5f, std::nextafter(0.5f, 0.0f), 1.0f, std::nextafter(1.0f, 2.0f)})
      for (const float v : {-1e-7f, 0.0f, 0.5f, std::nextafter(0.5f, 0.0f), 1.0f, std::nextafter(1.0f, 2.0f)}) {
        const LatticeGrid& tile = grids.own[grid];
        const auto point = triangle_point(grids, mesh.corners, false, grid, u, v);
        EXPECT_GE(point.u, 0);
        EXPECT_GE(point.v, 0);
        EXPECT_LE(point.u + point.v, 1 + 1e-6f);
        const Vec3d place = place_of(mesh, point);
        const Vec3f first = mesh.positions[tile.first_point];
        EXPECT_NEAR(place.x, first.x + std::round(u * 2) / 2 * (tile.width - 1) / 8.0, 1e-6);
        EXPECT_NEAR(place.z, first.z + std::round(v * 2) / 2 * (tile.height - 1) / 8.0, 1e-6);
      }
}

TEST(LatticeGrids, AreCountedAsTheyAreMade) {
  TerrainParameters terrain;
  terrain.triangles = 50'000;
  const TriangleMesh mesh = make_terrain(terrain);
  const MeshGrids grids = make_grids(mesh.corners, mesh.positions);
  const GridCounts counts = count_grids(mesh.corners);
  EXPECT_EQ(counts.grids, grids.size());
  EXPECT_EQ(counts.points, grids.points.size());
  EXPECT_LT(double(counts.grids), 0.2 * double(mesh.triangle_count()));
  // A mesh that is no lattice: a grid each pair, as if all had partners.
  Random random(53);
  TriangleMesh soup;
  add_soup(random, 501, soup);
  EXPECT_EQ(count_grids(soup.corners).grids, 251u);
  EXPECT_EQ(make_grids(soup.corners, soup.positions).size(), 501u);
  EXPECT_EQ(make_grids({}, {}).size(), 0u);
}

TEST(LatticeGrids, DependOnNoThreads) {
  Random random(54);
  const TriangleMesh mesh = mesh_of_all_kinds(random);
  const MeshGrids many = make_grids(mesh.corners, mesh.positions);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const MeshGrids single = make_grids(mesh.corners, mesh.positions);
  EXPECT_EQ(many.points, single.points);
  const auto same = [](const Buffer<LatticeGrid>& a, const Buffer<LatticeGrid>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const LatticeGrid& x, const LatticeGrid& y) {
      return x.first_point == y.first_point && x.stride == y.stride && x.width == y.width && x.height == y.height;
    });
  };
  EXPECT_TRUE(same(many.own, single.own));
  EXPECT_TRUE(same(many.copied, single.copied));
}

struct Compared {
  std::size_t met = 0, on_edges = 0;
};

/// The same rays for both tracers: all that they find is the same, but for which of two triangles has their edge.
Compared expect_same_hits(const ShapeSet& shapes, const EmbreeIntersector& triangles, const EmbreeIntersector& grids,
                          const RayBatch& rays, Coherence coherence) {
  HitBatch expected(rays.capacity()), hits(rays.capacity());
  triangles.intersect(rays, coherence, expected);
  grids.intersect(rays, coherence, hits);
  std::vector<std::uint8_t> occluded(rays.capacity() + kBatchPadding), expected_occluded(occluded.size());
  triangles.occluded(rays, coherence, expected_occluded.data());
  grids.occluded(rays, coherence, occluded.data());
  Compared compared;
  for (std::size_t i = 0; i < rays.size; ++i) {
    EXPECT_EQ(hits.geometry[i], expected.geometry[i]);
    EXPECT_EQ(hits.instance[i], expected.instance[i]);
    EXPECT_EQ(occluded[i], expected_occluded[i]);
    EXPECT_EQ(occluded[i] != 0, hits.geometry[i] != kNoGeometry);
    if (hits.geometry[i] == kNoGeometry || hits.geometry[i] != expected.geometry[i]) continue;
    ++compared.met;
    EXPECT_NEAR(hits.distance[i], expected.distance[i], 1e-5 * (1 + expected.distance[i]));
    const InstanceId instance = hits.instance[i];
    const BoundedShapes& space = instance == kNoInstance ? static_cast<const BoundedShapes&>(shapes)
                                                         : shapes.groups[shapes.instances[instance].group];
    const TriangleMesh& mesh = space.meshes[hits.geometry[i] - kFirstMeshGeometry].mesh;
    const Vec3d place = place_of(mesh, {hits.primitive[i], hits.u[i], hits.v[i]});
    const Vec3d expected_place = place_of(mesh, {expected.primitive[i], expected.u[i], expected.v[i]});
    // Along an edge both triangles have the place, as well as rounding of barycentrics tells.
    EXPECT_LT((place - expected_place).length(), 2e-5);
    if (hits.primitive[i] != expected.primitive[i]) {
      EXPECT_LT(std::min({hits.u[i], hits.v[i], 1 - hits.u[i] - hits.v[i]}), 1e-3f);
      ++compared.on_edges;
    }
    const Hit one = grids.intersect_one(rays.origin(i), rays.direction(i), kInfinity);
    if (one.primitive == hits.primitive[i]) {
      EXPECT_NEAR(one.u, hits.u[i], 2e-4);
      EXPECT_NEAR(one.v, hits.v[i], 2e-4);
    }
    EXPECT_EQ(one.geometry, hits.geometry[i]);
    EXPECT_EQ(one.instance, hits.instance[i]);
  }
  return compared;
}

void compare_tracers(const ShapeSet& shapes, Random& random, const Vec3f& least, const Vec3f& most) {
  for (const bool compact : {false, true}) {
    EmbreeOptions options;
    options.compact = compact;
    const EmbreeIntersector triangles(shapes, options);
    options.primitives = EmbreeOptions::Primitives::grids;
    const EmbreeIntersector grids(shapes, options);
    Compared sum;
    for (const Coherence coherence : {Coherence::coherent, Coherence::mixed, Coherence::incoherent})
      for (int batch = 0; batch < 8; ++batch) {
        RayBatch rays(1000);
        while (rays.size < 1000) {
          const Vec3d direction = random.direction();
          rays.push(Vec3f(float(random.uniform(least.x, most.x)), most.y, float(random.uniform(least.z, most.z))),
                    Vec3f(float(direction.x), -1.5f - float(std::abs(direction.y)), float(direction.z)).normalized(),
                    kInfinity);
        }
        const Compared compared = expect_same_hits(shapes, triangles, grids, rays, coherence);
        sum.met += compared.met, sum.on_edges += compared.on_edges;
      }
    EXPECT_GT(sum.met, 5000u);
    EXPECT_LT(sum.on_edges, sum.met / 500);
  }
}

TEST(LatticeGrids, TracersNameTheSameTriangles) {
  Random random(55);
  TerrainParameters terrain;
  terrain.triangles = 20000;
  ShapeSet shapes;
  shapes.meshes.resize(4);  // one of them without triangles
  shapes.meshes[0].mesh = make_terrain(terrain);
  shapes.meshes[2].mesh = mesh_of_all_kinds(random);
  add_soup(random, 50, shapes.meshes[3].mesh);
  const float half = float(terrain.size / 2);
  compare_tracers(shapes, random, {-half, 0, -half}, {half, float(2 * terrain.height), half});
}

TEST(LatticeGrids, TracersNameTheSameTrianglesOfGroups) {
  Random random(56);
  TerrainParameters terrain;
  terrain.triangles = 5000;
  ShapeSet shapes;
  shapes.meshes.resize(2);
  shapes.meshes[1].mesh = mesh_of_all_kinds(random);
  shapes.groups.resize(2);
  shapes.groups[1].meshes.resize(2);
  add_soup(random, 20, shapes.groups[1].meshes[0].mesh);
  shapes.groups[1].meshes[1].mesh = make_terrain(terrain);
  shapes.instances.push_back({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}, 1, 0, 0});
  shapes.instances.push_back({{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {0, float(terrain.height), 0}}, 1, 0, 1});
  const float half = float(terrain.size / 2);
  compare_tracers(shapes, random, {-half, 0, -half}, {half, float(3 * terrain.height), half});
}

TEST(LatticeGrids, TakeLessMemoryThanQuads) {
  TerrainParameters terrain;
  terrain.triangles = 200'000;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  shapes.meshes[0].mesh = make_terrain(terrain);
  const auto bytes = [&](EmbreeOptions::Primitives primitives) {
    EmbreeOptions options;
    options.primitives = primitives;
    return EmbreeIntersector(shapes, options).memory_bytes();
  };
  EXPECT_LT(bytes(EmbreeOptions::Primitives::grids), bytes(EmbreeOptions::Primitives::quads) / 2);
}

// Rays from above and from below, each at a vertex, or a point of an edge, that others surround: cells halved either
// way meet there, grids over the mesh's points and over copied ones, lattices and pairs.
// Embree's robust mode is tight along edges, not at vertices (docs/stability.md).
TEST(LatticeGrids, LetNoRayThroughAtEdgesAndHardlyOneAtVertices) {
  Random random(57);
  TerrainParameters terrain;
  terrain.triangles = 20000;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh = make_terrain(terrain);
  const TerrainGrid grid = terrain_grid(terrain.triangles);
  const auto stride = static_cast<std::uint32_t>(grid.columns + 1);
  // Two triangles in the middle change places: the rows from there on are a lattice of their own, or pairs.
  const std::size_t middle = mesh.triangle_count() / 2 + 20;
  for (int k = 0; k < 3; ++k) std::swap(mesh.corners[3 * middle + k], mesh.corners[3 * (middle + 5) + k]);
  EmbreeOptions options;
  options.primitives = EmbreeOptions::Primitives::grids;
  const EmbreeIntersector grids(shapes, options);
  const MeshGrids made = make_grids(mesh.corners, mesh.positions);
  ASSERT_GE(made.parts.size(), 2u);
  ASSERT_GT(made.copied.size(), made.first_pair);
  std::size_t shot = 0, escaped_at_edges = 0, escaped_at_vertices = 0;
  std::vector<bool> at_vertex;
  RayBatch rays(1024);
  HitBatch hits(1024);
  for (int round = 0; round < 400; ++round) {
    rays.size = 0, at_vertex.clear();
    while (rays.size < 1024) {
      // Inside, so far from the border that a slanted ray which slips through meets nothing else of it.
      const auto i = 2 + static_cast<std::uint32_t>(random.below(std::size_t(grid.columns) - 3));
      const auto j = 2 + static_cast<std::uint32_t>(random.below(std::size_t(grid.rows) - 3));
      const std::uint32_t a = j * stride + i;
      const std::uint32_t others[] = {a + 1, a + stride, a + stride + 1, a + stride - 1};
      const Vec3d from(mesh.positions[a]), to(mesh.positions[others[random.below(4)]]);
      const double along = random.below(2) == 0 ? 0 : random.uniform(0, 1);
      const Vec3d target = from * (1 - along) + to * along;
      const double side = random.below(2) == 0 ? 1 : -1;
      const Vec3d origin = target + Vec3d(random.uniform(-0.3, 0.3), side * 10, random.uniform(-0.3, 0.3));
      at_vertex.push_back(along == 0);
      rays.push(Vec3f(origin), Vec3f((target - Vec3d(Vec3f(origin))).normalized()), kInfinity);
    }
    grids.intersect(rays, round % 2 == 0 ? Coherence::coherent : Coherence::incoherent, hits);
    for (std::size_t i = 0; i < rays.size; ++i) {
      ++shot;
      if (hits.geometry[i] == kNoGeometry) ++(at_vertex[i] ? escaped_at_vertices : escaped_at_edges);
    }
  }
  EXPECT_EQ(escaped_at_edges, 0u) << "of " << shot;
  EXPECT_LE(escaped_at_vertices, shot / 10000);
}

}  // namespace
}  // namespace raytree
