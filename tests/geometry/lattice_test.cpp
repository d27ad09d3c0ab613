// Lattices among triangles: found whole, told which way each cell is halved, and nothing else taken for one.
#include "geometry/lattice.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <utility>

#include "geometry/terrain.h"
#include "tests/geometry/lattice_meshes.h"

namespace raytree {
namespace {

using test::add_lattice;
using test::add_soup;
using test::Random;

void expect_lattice(const TriangleMesh& mesh, const Lattice& lattice, std::size_t first_triangle,
                    std::uint32_t first_vertex, std::uint32_t columns, std::uint32_t rows) {
  EXPECT_EQ(lattice.first_triangle, first_triangle);
  EXPECT_EQ(lattice.first_vertex, first_vertex);
  EXPECT_EQ(lattice.stride, columns + 1);
  ASSERT_EQ(lattice.columns, columns);
  ASSERT_EQ(lattice.rows, rows);
  ASSERT_EQ(lattice.rising.size(), lattice.cell_count());
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::uint32_t* corners = &mesh.corners[3 * lattice.triangle(i, j)];
      const auto has = [&](std::uint32_t vertex) { return std::find(corners, corners + 3, vertex) != corners + 3; };
      const std::uint32_t a = lattice.vertex(i, j);
      ASSERT_EQ(lattice.rising[j * columns + i] != 0, has(a + 1) && has(a + lattice.stride)) << i << ", " << j;
    }
}

TEST(Lattice, EveryTerrainIsOne) {
  for (const std::int64_t triangles : {200, 20'000, 300'000}) {
    TerrainParameters terrain;
    terrain.triangles = triangles;
    const TriangleMesh mesh = make_terrain(terrain);
    const TerrainGrid grid = terrain_grid(triangles);
    const std::vector<Lattice> lattices = find_lattices(mesh.corners);
    ASSERT_EQ(lattices.size(), 1u);
    expect_lattice(mesh, lattices[0], 0, 0, std::uint32_t(grid.columns), std::uint32_t(grid.rows));
    EXPECT_TRUE(may_be_lattices(mesh.corners));
  }
}

TEST(Lattice, AreFoundAmongOtherTrianglesHoweverTheirsAreTurned) {
  Random random(41);
  TriangleMesh mesh;
  add_soup(random, 7, mesh);
  add_lattice(random, 40, 30, mesh);
  add_lattice(random, 1, 64, mesh);
  add_soup(random, 200, mesh);
  add_lattice(random, 100, 1, mesh);
  add_lattice(random, 7, 9, mesh);  // too small
  const std::vector<Lattice> lattices = find_lattices(mesh.corners);
  ASSERT_EQ(lattices.size(), 3u);
  expect_lattice(mesh, lattices[0], 7, 21, 40, 30);
  expect_lattice(mesh, lattices[1], 7 + 2400, 21 + 41 * 31, 1, 64);
  expect_lattice(mesh, lattices[2], 7 + 2400 + 128 + 200, 21 + 41 * 31 + 2 * 65 + 600, 100, 1);
}

// A single corner that is another vertex's ends a lattice in its row.
TEST(Lattice, EndWhereACellIsNone) {
  Random random(42);
  for (int round = 0; round < 200; ++round) {
    TriangleMesh mesh;
    add_lattice(random, 20, 50, mesh);
    const auto corner = 6 * 20 * (4 + random.below(46)) + random.below(6 * 20);
    const std::size_t row = corner / (6 * 20);
    // A vertex that the cell does not have, or one that it has: then a triangle has it twice, or both the same three.
    const auto other = static_cast<std::uint32_t>(random.below(mesh.positions.size()));
    if (mesh.corners[corner] == other) continue;
    mesh.corners[corner] = other;
    const std::vector<Lattice> lattices = find_lattices(mesh.corners);
    ASSERT_GE(lattices.size(), 1u);
    EXPECT_EQ(lattices[0].rows, row);
  }
}

TEST(Lattice, SoupsAndStripsAreNone) {
  Random random(43);
  TriangleMesh mesh;
  add_soup(random, 5000, mesh);
  EXPECT_TRUE(find_lattices(mesh.corners).empty());
  EXPECT_FALSE(may_be_lattices(mesh.corners));
  EXPECT_TRUE(find_lattices({}).empty());
  EXPECT_FALSE(may_be_lattices({}));
  // All corners alike.
  std::fill(mesh.corners.begin(), mesh.corners.end(), 0u);
  EXPECT_TRUE(find_lattices(mesh.corners).empty());
}

TEST(Lattice, DependOnNoThreads) {
  TerrainParameters terrain;
  terrain.triangles = 300'000;
  TriangleMesh mesh = make_terrain(terrain);
  std::swap(mesh.corners[mesh.corners.size() - 10], mesh.corners[17]);
  const std::vector<Lattice> many = find_lattices(mesh.corners);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<Lattice> single = find_lattices(mesh.corners);
  ASSERT_EQ(many.size(), single.size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].first_triangle, single[i].first_triangle);
    EXPECT_EQ(many[i].rows, single[i].rows);
    EXPECT_EQ(many[i].rising, single[i].rising);
  }
}

}  // namespace
}  // namespace raytree
