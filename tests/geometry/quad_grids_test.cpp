// Quads and grids made of triangles: the same triangles, none lost, none turned over.
#include "geometry/quad_grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace raytree {
namespace {

/// columns x rows quads over a plane, each halved; `flip` halves them the other way.
struct Sheet {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> corners;

  Sheet(std::uint32_t columns, std::uint32_t rows, bool flip) {
    for (std::uint32_t y = 0; y <= rows; ++y)
      for (std::uint32_t x = 0; x <= columns; ++x)
        positions.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(x * y % 3));
    for (std::uint32_t y = 0; y < rows; ++y)
      for (std::uint32_t x = 0; x < columns; ++x) {
        const std::uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
        const auto halves = flip ? std::array{a, b, d, b, c, d} : std::array{a, b, c, a, c, d};
        corners.insert(corners.end(), halves.begin(), halves.end());
      }
  }
};

using Corners = std::array<std::array<float, 3>, 3>;

/// A triangle with its least corner first, wound as it was.
Corners canonical(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  Corners corners = {std::array{a.x, a.y, a.z}, std::array{b.x, b.y, b.z}, std::array{c.x, c.y, c.z}};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::vector<Corners> triangles_of(const Sheet& sheet) {
  std::vector<Corners> list;
  for (std::size_t i = 0; i < sheet.corners.size(); i += 3)
    list.push_back(canonical(sheet.positions[sheet.corners[i]], sheet.positions[sheet.corners[i + 1]],
                             sheet.positions[sheet.corners[i + 2]]));
  std::sort(list.begin(), list.end());
  return list;
}

/// As Embree halves a quad, less triangles without extent.
void add_halves(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, std::vector<Corners>& list) {
  list.push_back(canonical(a, b, d));
  if (c != d) list.push_back(canonical(c, d, b));
}

std::vector<Corners> triangles_of(const QuadList& quads, const Sheet& sheet) {
  std::vector<Corners> list;
  for (std::size_t i = 0; i < quads.corners.size(); i += 4) {
    const auto at = [&](std::size_t k) { return sheet.positions[quads.corners[i + k]]; };
    add_halves(at(0), at(1), at(2), at(3), list);
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<Corners> triangles_of(const GridList& grids) {
  std::vector<Corners> list;
  for (const GridTile& tile : grids.tiles)
    for (std::uint32_t y = 0; y + 1 < tile.height; ++y)
      for (std::uint32_t x = 0; x + 1 < tile.width; ++x) {
        const Vec3f* p = &grids.points[tile.first_point + y * tile.width + x];
        add_halves(p[0], p[1], p[tile.width + 1], p[tile.width], list);
      }
  std::sort(list.begin(), list.end());
  return list;
}

TEST(QuadGrids, HoldTheTrianglesThatTheyWereMadeOf) {
  for (const bool flip : {false, true}) {
    const Sheet sheet(19, 9, flip);
    const QuadList quads = joined_quads(sheet.corners);
    EXPECT_EQ(quads.size(), 19u * 9);
    EXPECT_EQ(quads.paired, 19u * 9);
    EXPECT_EQ(triangles_of(quads, sheet), triangles_of(sheet));
    const GridList grids = joined_grids(quads, sheet.positions);
    EXPECT_EQ(triangles_of(grids), triangles_of(sheet));
    // 19 x 9 quads are two rows of 8 + 8 + 3, or, as the other diagonal runs, their turned image: at most 8 a side.
    EXPECT_EQ(grids.tiles.size(), 6u);
    for (const GridTile& tile : grids.tiles) EXPECT_TRUE(tile.width <= 9 && tile.height <= 9);
  }
}

TEST(QuadGrids, GridsJoinQuadsThatAreHalvedEitherWay) {
  Sheet sheet(16, 8, false);
  const Sheet other(16, 8, true);
  for (std::size_t quad = 0; quad < 16 * 8; quad += 3)
    std::copy_n(other.corners.begin() + static_cast<std::ptrdiff_t>(6 * quad), 6,
                sheet.corners.begin() + static_cast<std::ptrdiff_t>(6 * quad));
  const QuadList quads = joined_quads(sheet.corners);
  EXPECT_EQ(quads.paired, 16u * 8);
  EXPECT_EQ(triangles_of(quads, sheet), triangles_of(sheet));
  const GridList grids = joined_grids(quads, sheet.positions);
  EXPECT_EQ(grids.tiles.size(), 2u);
  EXPECT_EQ(triangles_of(grids).size(), triangles_of(sheet).size());
}

TEST(QuadGrids, TrianglesWithoutAPartnerStay) {
  Sheet sheet(2, 1, false);
  sheet.corners.resize(9);  // one and a half quads
  const QuadList quads = joined_quads(sheet.corners);
  EXPECT_EQ(quads.size(), 2u);
  EXPECT_EQ(quads.paired, 1u);
  EXPECT_EQ(triangles_of(quads, sheet), triangles_of(sheet));
  EXPECT_EQ(triangles_of(joined_grids(quads, sheet.positions)), triangles_of(sheet));
}

TEST(QuadGrids, TrianglesThatAreWoundAgainstEachOtherAreNotJoined) {
  Sheet sheet(1, 1, false);
  std::swap(sheet.corners[4], sheet.corners[5]);
  EXPECT_EQ(joined_quads(sheet.corners).paired, 0u);
  EXPECT_EQ(joined_quads({}).size(), 0u);
}

}  // namespace
}  // namespace raytree
