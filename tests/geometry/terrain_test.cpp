// The fractal terrain: the rule of its grid, the shape of the mesh in closed form, normals against differences of the
// positions, one surface at every resolution, the same bits for any number of threads, bad parameters.
#include "geometry/terrain.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "geometry/error.h"

namespace raytree {
namespace {

TerrainParameters terrain(std::int64_t triangles, std::uint32_t seed = 1980) {
  TerrainParameters parameters;
  parameters.triangles = triangles;
  parameters.seed = seed;
  return parameters;
}

TEST(TerrainGrid, MeetsSquaresExactly) {
  for (const std::int64_t n : {1, 2, 3, 10, 71, 1000, 5000}) {
    const TerrainGrid grid = terrain_grid(2 * n * n);
    EXPECT_EQ(grid.columns, n);
    EXPECT_EQ(grid.rows, n);
  }
}

TEST(TerrainGrid, IsTheNearestThatTheRuleAllows) {
  for (std::int64_t triangles = 2; triangles <= 4000; ++triangles) {
    std::int64_t least = triangles;
    for (std::int64_t rows = 1; rows <= 60; ++rows)
      for (std::int64_t columns = rows; columns <= std::max(rows + 1, rows * 105 / 100); ++columns)
        least = std::min(least, std::abs(2 * rows * columns - triangles));
    const TerrainGrid grid = terrain_grid(triangles);
    ASSERT_EQ(std::abs(grid.triangle_count() - triangles), least) << triangles;
    ASSERT_LE(grid.rows, grid.columns) << triangles;
    ASSERT_LE(grid.columns, std::max(grid.rows + 1, grid.rows * 105 / 100)) << triangles;
  }
}

TEST(TerrainGrid, MissesLargeCountsByLessThanHalfAThousandth) {
  for (const std::int64_t base : {1'000'000, 10'000'000, 49'000'000})
    for (std::int64_t triangles = base; triangles < base + 3000; ++triangles)
      ASSERT_LT(double(std::abs(terrain_grid(triangles).triangle_count() - triangles)), 5e-4 * double(triangles));
  EXPECT_EQ(terrain_grid(50'000'000).triangle_count(), 50'000'000);
}

TEST(TerrainGrid, RefusesCountsOutOfRange) {
  for (const std::int64_t count : {std::int64_t(-5), std::int64_t(0), std::int64_t(1), std::int64_t(50'000'001),
                                   std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()})
    EXPECT_THROW(terrain_grid(count), Error) << count;
}

TEST(Terrain, FillsTheSquareWithACheckedMesh) {
  for (const std::int64_t count : {2, 4, 12, 1000, 25'000}) {
    TerrainParameters parameters = terrain(count);
    parameters.size = 6;
    const TerrainGrid grid = terrain_grid(count);
    const TriangleMesh mesh = make_terrain(parameters);
    ASSERT_EQ(mesh.origin, Vec3d(0));
    ASSERT_EQ(std::int64_t(mesh.triangle_count()), grid.triangle_count());
    ASSERT_EQ(std::int64_t(mesh.positions.size()), grid.vertex_count());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_TRUE(mesh.normal_corners.empty() && mesh.texture_coordinates.empty() && mesh.triangle_faces.empty());
    for (std::int64_t row = 0; row <= grid.rows; ++row)
      for (std::int64_t column = 0; column <= grid.columns; ++column) {
        const Vec3f& p = mesh.positions[std::size_t(row * (grid.columns + 1) + column)];
        // Computed in double and rounded once: half an ulp of 3 is 1.2e-7.
        ASSERT_NEAR(p.x, 6 * (double(column) / double(grid.columns) - 0.5), 1.3e-7);
        ASSERT_NEAR(p.z, 6 * (double(row) / double(grid.rows) - 0.5), 1.3e-7);
        ASSERT_TRUE(std::isfinite(p.y));
      }
    // Every triangle looks up and covers half a cell; distinct edges obey Euler's V - E + F = 1 of a disc.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    const double half_cell = 36.0 / double(grid.triangle_count());
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::uint32_t* corner = &mesh.corners[3 * t];
      for (int k = 0; k < 3; ++k) {
        ASSERT_LT(corner[k], mesh.positions.size());
        edges.insert(std::minmax(corner[k], corner[(k + 1) % 3]));
      }
      const Vec3d a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]), c(mesh.positions[corner[2]]);
      const double area = (b - a).cross(c - a).y / 2;
      // Rounding of x and z, 1.2e-7 each, times a cell's edges.
      ASSERT_NEAR(area, half_cell, 4 * 1.3e-7 * 6 / double(grid.rows));
    }
    EXPECT_EQ(std::int64_t(mesh.positions.size()) - std::int64_t(edges.size()) + grid.triangle_count(), 1);
  }
}

TEST(Terrain, HoldsNoMemoryBeyondItsArrays) {
  const TriangleMesh mesh = make_terrain(terrain(100'000));
  EXPECT_EQ(mesh.positions.capacity(), mesh.positions.size());
  EXPECT_EQ(mesh.normals.capacity(), mesh.normals.size());
  EXPECT_EQ(mesh.corners.capacity(), mesh.corners.size());
}

TEST(Terrain, NormalsAreUnitAndFollowCentralDifferences) {
  const TerrainGrid grid = terrain_grid(20'000);
  const TriangleMesh mesh = make_terrain(terrain(20'000));
  const std::size_t stride = std::size_t(grid.columns) + 1;
  const double dx = 2 * 10.0 / double(grid.columns), dz = 2 * 10.0 / double(grid.rows);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    // Three squares, a root and a division in float: below 4 ulp of 1.
    ASSERT_NEAR(Vec3d(mesh.normals[i]).length(), 1, 4 * 1.2e-7);
    ASSERT_GT(mesh.normals[i].y, 0);
  }
  for (std::size_t row = 1; row < std::size_t(grid.rows); ++row)
    for (std::size_t column = 1; column < std::size_t(grid.columns); ++column) {
      const std::size_t i = row * stride + column;
      const double slope_x = (double(mesh.positions[i + 1].y) - mesh.positions[i - 1].y) / dx;
      const double slope_z = (double(mesh.positions[i + stride].y) - mesh.positions[i - stride].y) / dz;
      const Vec3d expected = Vec3d(-slope_x, 1, -slope_z).normalized();
      ASSERT_LT((Vec3d(mesh.normals[i]) - expected).length(), 1e-6) << i;
    }
}

// The border's normals come from the surface beyond the square: the same differences with a grid that reaches further
// are not at hand, but the border must not stand out. A one-sided difference, the usual mistake, turns the normal by
// about half of what neighboring normals differ by; compared here is the mean turn from border to next row with the
// mean turn between inner rows.
TEST(Terrain, BorderNormalsAreAsGoodAsInnerOnes) {
  const TerrainGrid grid = terrain_grid(80'000);
  const TriangleMesh mesh = make_terrain(terrain(80'000));
  const std::size_t stride = std::size_t(grid.columns) + 1;
  const auto mean_turn = [&](std::size_t row) {
    double sum = 0;
    for (std::size_t i = row * stride; i < (row + 1) * stride; ++i)
      sum += (mesh.normals[i] - mesh.normals[i + stride]).length();
    return sum / double(stride);
  };
  double inner = 0;
  for (std::size_t row = 1; row <= 10; ++row) inner += mean_turn(row) / 10;
  EXPECT_LT(mean_turn(0), 1.25 * inner);
  EXPECT_GT(mean_turn(0), 0.75 * inner);
}

TEST(Terrain, HeightIsAboutWhatWasAskedFor) {
  for (const std::uint32_t seed : {0u, 1u, 7u, 1980u, 4294967295u})
    for (const double roughness : {0.1, 0.5, 0.8}) {
      TerrainParameters parameters = terrain(100'000, seed);
      parameters.height = 3;
      parameters.roughness = roughness;
      const TriangleMesh mesh = make_terrain(parameters);
      float lowest = mesh.positions[0].y, highest = lowest;
      for (const Vec3f& p : mesh.positions) {
        lowest = std::min(lowest, p.y);
        highest = std::max(highest, p.y);
      }
      EXPECT_NEAR(lowest, 0, 0.1 * 3) << seed << ' ' << roughness;
      EXPECT_NEAR(highest, 3, 0.1 * 3) << seed << ' ' << roughness;
    }
}

TEST(Terrain, WithoutHeightItIsFlat) {
  TerrainParameters parameters = terrain(500);
  parameters.height = 0;
  const TriangleMesh mesh = make_terrain(parameters);
  for (const Vec3f& p : mesh.positions) ASSERT_EQ(p.y, 0);
  for (const Vec3f& n : mesh.normals) ASSERT_EQ(n, Vec3f(0, 1, 0));
}

TEST(Terrain, ScalesExactly) {
  TerrainParameters small = terrain(5000), large = small;
  large.size *= 4;
  large.height *= 4;
  const TriangleMesh a = make_terrain(small), b = make_terrain(large);
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    ASSERT_EQ(a.positions[i] * 4, b.positions[i]);
    ASSERT_EQ(a.normals[i], b.normals[i]);
  }
}

/// Root mean square height difference of two terrains where their grids of n and k n cells share points.
double difference(const TriangleMesh& coarse, std::size_t n, const TriangleMesh& fine, std::size_t k) {
  double sum = 0;
  for (std::size_t row = 0; row <= n; ++row)
    for (std::size_t column = 0; column <= n; ++column) {
      const double d = double(coarse.positions[row * (n + 1) + column].y) -
                       double(fine.positions[row * k * (k * n + 1) + column * k].y);
      sum += d * d;
    }
  return std::sqrt(sum / double((n + 1) * (n + 1)));
}

// Octaves that a coarse grid cannot show have at most half the amplitude of those before (roughness 0.5), so every
// fourfold refinement leaves at most about a quarter of the difference; half proves that it converges to one surface.
TEST(Terrain, ConvergesToOneSurface) {
  const auto square = [](std::int64_t n) { return make_terrain(terrain(2 * n * n)); };
  const TriangleMesh n32 = square(32), n128 = square(128), n512 = square(512);
  const double first = difference(n32, 32, n512, 16), second = difference(n128, 128, n512, 4);
  EXPECT_GT(second, 0);
  EXPECT_LT(second, 0.5 * first);
  EXPECT_LT(first, 0.1 * 2.2);
}

TEST(Terrain, RougherIsSteeper) {
  double before = 0;
  for (const double roughness : {0.2, 0.4, 0.6, 0.8}) {
    TerrainParameters parameters = terrain(50'000);
    parameters.roughness = roughness;
    const TriangleMesh mesh = make_terrain(parameters);
    double steepness = 0;
    for (const Vec3f& n : mesh.normals) steepness += 1 - double(n.y);
    EXPECT_GT(steepness, 1.05 * before) << roughness;
    before = steepness;
  }
}

TEST(Terrain, SeedsDiffer) {
  const TriangleMesh a = make_terrain(terrain(2000, 1)), b = make_terrain(terrain(2000, 2));
  std::size_t equal = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) equal += a.positions[i].y == b.positions[i].y;
  EXPECT_LT(equal, a.positions.size() / 100);
}

TEST(Terrain, SameBitsForAnyNumberOfThreads) {
  const auto made_with = [](std::size_t threads) {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return make_terrain(terrain(150'001));
  };
  const TriangleMesh one = made_with(1);
  for (const std::size_t threads : {2, 3, 7}) {
    const TriangleMesh other = made_with(threads);
    ASSERT_EQ(one.positions.size(), other.positions.size());
    EXPECT_EQ(std::memcmp(one.positions.data(), other.positions.data(), one.positions.size() * sizeof(Vec3f)), 0);
    EXPECT_EQ(std::memcmp(one.normals.data(), other.normals.data(), one.normals.size() * sizeof(Vec3f)), 0);
    EXPECT_TRUE(one.corners == other.corners);
  }
}

TEST(Terrain, RefusesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refused = [](auto change) {
    TerrainParameters parameters = terrain(100);
    change(parameters);
    try {
      make_terrain(parameters);
      return false;
    } catch (const Error& error) {
      return error.kind() == ErrorKind::bad_input && std::string(error.what()).find("terrain") != std::string::npos;
    }
  };
  for (const std::int64_t bad : {1, 50'000'001}) EXPECT_TRUE(refused([&](auto& p) { p.triangles = bad; })) << bad;
  for (const double bad : {0.0, -1.0, nan, infinity, 1e300})
    EXPECT_TRUE(refused([&](auto& p) { p.size = bad; })) << bad;
  for (const double bad : {-1.0, nan, infinity}) EXPECT_TRUE(refused([&](auto& p) { p.height = bad; })) << bad;
  for (const double bad : {0.0, 1.0, -0.5, nan}) EXPECT_TRUE(refused([&](auto& p) { p.roughness = bad; })) << bad;
}

}  // namespace
}  // namespace raytree
