// Point-in-polygon along a ray: exact where rounding decides, one face for every ray, outlines of every kind.
#include "geometry/polygon_crossing.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace raytree {
namespace {

SeenCorner at(double x, double y) { return {x, y, 1}; }

bool inside(const std::vector<SeenCorner>& polygon, double x, double y) {
  return cross_polygon(polygon.size(), [&](std::size_t i) { return at(polygon[i].x - x, polygon[i].y - y); }).inside;
}

/// Integers of 53 bits have products of 106: compared as such, and in pieces of 26 and 27 bits.
TEST(PolygonCrossing, SignsOfTurnsAreExact) {
  std::mt19937_64 engine(1980);
  std::uniform_int_distribution<std::int64_t> any(-(std::int64_t(1) << 53) + 1, (std::int64_t(1) << 53) - 1);
  __extension__ using Wide = __int128;
  int ties = 0;
  for (int i = 0; i < 200000; ++i) {
    std::int64_t ax = any(engine), ay = any(engine), bx = any(engine), by = any(engine);
    if (i % 2 == 1) {  // nearly on one line: products that agree in all but their last bits
      const std::int64_t scale = 1 + (any(engine) & 3);
      ax /= 8, ay /= 8;
      bx = ax * scale + (any(engine) % 2), by = ay * scale + (any(engine) % 2);
    }
    const Wide left = Wide(ax) * by, right = Wide(ay) * bx;
    const int expected = (left > right) - (left < right);
    ties += double(ax) * double(by) == double(ay) * double(bx) && expected != 0;
    EXPECT_EQ(turn_sign(at(double(ax), double(ay)), at(double(bx), double(by))), expected);
    EXPECT_EQ(turn_sign(at(double(bx), double(by)), at(double(ax), double(ay))), -expected);
  }
  EXPECT_GT(ties, 1000);  // that rounded products could not have told apart
}

/// A fan about the origin covers the plane once: the ray in its middle, or on any of its edges, lies in one sector.
TEST(PolygonCrossing, RaysAtSharedCornersAndEdgesLieInOneFace) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> angle(0, 6.28);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> angles;
    for (int i = 0; i < 3 + trial % 7; ++i)
      angles.push_back(trial % 2 == 0 ? angle(engine) : 0.785398163397448 * double((i * 3 + trial) % 8));
    for (const double along : {0.0, 0.25, 0.5}) {  // the middle, and places on the first edge
      std::sort(angles.begin(), angles.end());
      angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
      if (angles.size() < 3) break;
      std::vector<SeenCorner> rim;
      for (const double a : angles)
        rim.push_back(at(16 * std::round(64 * std::cos(a)), 16 * std::round(64 * std::sin(a))));
      const double x = along * rim[0].x, y = along * rim[0].y;
      int faces = 0;
      for (std::size_t i = 0; i < rim.size(); ++i) faces += inside({at(0, 0), rim[i], rim[(i + 1) % rim.size()]}, x, y);
      // Sectors of more than half a turn would be the other way round.
      double widest = angles.front() + 2 * 3.14159265358979 - angles.back();
      for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
      if (widest < 3.1) {
        EXPECT_EQ(faces, 1) << trial;
      }
    }
  }
}

TEST(PolygonCrossing, ConcaveOutlinesHolesAndBridges) {
  const std::vector<SeenCorner> notch{at(0, 0), at(4, 0), at(4, 4), at(2, 1), at(0, 4)};
  EXPECT_TRUE(inside(notch, 0.5, 2));
  EXPECT_TRUE(inside(notch, 3.5, 2));
  EXPECT_TRUE(inside(notch, 2, 0.5));
  EXPECT_FALSE(inside(notch, 2, 2));
  EXPECT_FALSE(inside(notch, 2, 3.9));
  EXPECT_FALSE(inside(notch, -1, 1));
  // A square with a square hole, joined by a bridge that is gone both ways; and with a hole of no size.
  const std::vector<SeenCorner> hole{at(0, 0), at(6, 0), at(6, 6), at(0, 6), at(0, 0),
                                     at(2, 2), at(2, 4), at(4, 4), at(4, 2), at(2, 2)};
  EXPECT_TRUE(inside(hole, 1, 1));  // on the bridge
  EXPECT_TRUE(inside(hole, 5, 3));
  EXPECT_FALSE(inside(hole, 3, 3));
  const std::vector<SeenCorner> point_hole{at(0, 0), at(6, 0), at(6, 6), at(0, 6), at(0, 0), at(3, 3)};
  for (const double x : {1.0, 2.9, 3.0, 3.1, 5.0}) EXPECT_TRUE(inside(point_hole, x, x)) << x;
  // Without area nothing is inside.
  for (const double x : {0.0, 1.0, 2.0}) EXPECT_FALSE(inside({at(0, 0), at(2, 2), at(1, 1)}, x, x));
}

}  // namespace
}  // namespace raytree
