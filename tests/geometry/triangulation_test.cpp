// Triangulation: the triangles cover the polygon exactly (area, no turned triangle, boundary kept), for convex,
// concave, tilted, large and degenerate polygons; the way back to faces and corners.
#include "geometry/triangulation.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>

#include "geometry/angle.h"
#include "geometry/newell.h"

namespace raytree {
namespace {

PolygonMesh polygon(const std::vector<Vec3f>& points) {
  PolygonMesh mesh;
  mesh.positions.assign(points.begin(), points.end());
  mesh.face_sizes.assign({static_cast<std::uint32_t>(points.size())});
  for (std::uint32_t i = 0; i < points.size(); ++i) mesh.corners.push_back(i);
  return mesh;
}

TriangleMesh cut(PolygonMesh mesh, std::int64_t* bad = nullptr) {
  Warnings warnings;
  TriangleMesh result = triangulate(std::move(mesh), {"test", 0, {}}, warnings);
  if (bad)
    *bad = warnings.empty() ? 0 : warnings[0].count;
  else
    EXPECT_TRUE(warnings.empty());
  return result;
}

/// Twice the signed area of each triangle along the polygon's normal: none is turned over and they sum to the polygon's
/// own. With the boundary's edges each used once and all others twice in opposite directions, the cover is exact.
void expect_exact_cover(const std::vector<Vec3f>& points) {
  const TriangleMesh mesh = cut(polygon(points));
  ASSERT_EQ(mesh.triangle_count(), points.size() - 2);
  std::vector<std::uint32_t> order(points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const Vec3d normal = newell_normal(points.data(), order.data(), points.size());
  const Vec3d unit = normal.normalized();
  double sum = 0, extent = 0;
  for (const Vec3f& p : points) extent = std::max(extent, double((p - points[0]).length()));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  // Points are floats, so that a flat polygon in a tilted plane is flat up to 2^-24 of its extent: each signed area is
  // off by that times the extent, squared.
  const double tolerance = std::ldexp(extent * extent, -22);
  double worst = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* c = &mesh.corners[3 * t];
    const double area = newell_normal(mesh.positions.data(), c, 3).dot(unit);
    worst = std::min(worst, area);
    sum += std::abs(area);
    for (int k = 0; k < 3; ++k) ++edges[{c[k], c[(k + 1) % 3]}];
  }
  EXPECT_GE(worst, -tolerance);
  EXPECT_NEAR(sum, normal.length(), tolerance * std::sqrt(double(points.size())));
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    const bool on_boundary = (edge.first + 1) % points.size() == edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), on_boundary ? 0u : 1u);
  }
}

/// The polygon in the plane z = 0, then turned and moved in space, then reversed.
void expect_exact_cover_everywhere(const std::vector<Vec2d>& flat) {
  Imath::M44d turn;
  turn.rotate(Vec3d(0.7, -1.1, 2.3));
  Imath::M44d upside;
  upside.rotate(Vec3d(kPi / 2, 0.2, 0));
  for (const Imath::M44d& matrix : {Imath::M44d(), turn, upside}) {
    std::vector<Vec3f> points;
    for (const Vec2d& p : flat) points.push_back(Vec3f(Vec3d(p.x, p.y, 0) * matrix));
    expect_exact_cover(points);
    std::reverse(points.begin(), points.end());
    expect_exact_cover(points);
  }
}

TEST(Triangulation, TrianglesAreMovedNotCopied) {
  PolygonMesh mesh = polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  mesh.face_sizes = {};
  mesh.origin = {1e6, 0, 0};
  const auto* positions = mesh.positions.data();
  const auto* corners = mesh.corners.data();
  const TriangleMesh result = cut(std::move(mesh));
  EXPECT_EQ(result.positions.data(), positions);
  EXPECT_EQ(result.corners.data(), corners);
  EXPECT_EQ(result.origin, Vec3d(1e6, 0, 0));
  EXPECT_TRUE(result.triangle_faces.empty());
}

TEST(Triangulation, ConcaveQuadsSplitAtTheirReflexCorner) {
  // A dart: the reflex corner must lie on the diagonal, whichever corner it is.
  std::vector<Vec3f> dart = {{0, 0, 0}, {4, -1, 0}, {1, 0, 0}, {4, 1, 0}};
  std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  for (int turn = 0; turn < 4; ++turn) {
    expect_exact_cover(dart);
    std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  }
}

TEST(Triangulation, ConvexQuadsTakeTheShorterDiagonal) {
  const TriangleMesh mesh = cut(polygon({{0, 0, 0}, {1, -3, 0}, {2, 0, 0}, {1, 3, 0}}));
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  const TriangleMesh turned = cut(polygon({{1, -3, 0}, {2, 0, 0}, {1, 3, 0}, {0, 0, 0}}));
  EXPECT_EQ(turned.corners, (Buffer<std::uint32_t>{1, 2, 3, 1, 3, 0}));
}

TEST(Triangulation, CollinearCornersMakeNoEmptyTriangleWhereOneCanDoWithout) {
  for (int turn = 0; turn < 8; ++turn) {
    std::vector<Vec3f> quad = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}};
    std::vector<Vec3f> square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                 {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    std::rotate(quad.begin(), quad.begin() + turn % 4, quad.end());
    std::rotate(square.begin(), square.begin() + turn, square.end());
    for (const auto& points : {quad, square}) {
      expect_exact_cover(points);
      const TriangleMesh mesh = cut(polygon(points));
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        EXPECT_GT(newell_normal(mesh.positions.data(), &mesh.corners[3 * t], 3).length(), 0.5);
    }
  }
}

TEST(Triangulation, CoversStarsCombsAndSpirals) {
  for (const int spikes : {3, 5, 17, 200}) {
    std::vector<Vec2d> star;
    for (int i = 0; i < 2 * spikes; ++i) {
      const double angle = kPi * i / spikes, r = i % 2 ? 0.2 : 1.0;
      star.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    expect_exact_cover_everywhere(star);
    std::vector<Vec2d> comb = {{double(spikes), -1}, {double(spikes), 0}};
    for (int i = spikes - 1; i >= 0; --i) {
      comb.push_back({i + 0.5, 10.0 - i * 0.01});
      comb.push_back({double(i), 0});
    }
    comb.push_back({0, -1});
    expect_exact_cover_everywhere(comb);
  }
  std::vector<Vec2d> spiral, inner;
  for (int i = 0; i < 300; ++i) {
    const double angle = i * 0.1;
    spiral.push_back({(1 + angle) * std::cos(angle), (1 + angle) * std::sin(angle)});
    inner.push_back({(0.5 + 0.9 * angle) * std::cos(angle), (0.5 + 0.9 * angle) * std::sin(angle)});
  }
  spiral.insert(spiral.end(), inner.rbegin(), inner.rend());
  expect_exact_cover_everywhere(spiral);
}

/// Simple for any radii: the corners go around the center in order.
std::vector<Vec2d> ragged(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec2d> points;
  for (std::size_t i = 0; i < size; ++i) {
    const double angle = 2 * kPi * double(i) / double(size);
    const double r = 0.1 + double(random() % 1000) / 1000;
    points.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  return points;
}

TEST(Triangulation, CoversRandomSimplePolygons) {
  for (unsigned seed = 0; seed < 300; ++seed) expect_exact_cover_everywhere(ragged(5 + seed % 60, seed));
  // On a coarse lattice many corners are collinear or touch edges' lines: x-monotone chains over and under the axis.
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const int n = 2 + int(seed % 15);
    std::vector<Vec2d> points = {{0, 0}};
    for (int i = 1; i < n; ++i) points.push_back({double(i), -1.0 - double(random() % 3)});
    points.push_back({double(n), 0});
    for (int i = n - 1; i > 0; --i) points.push_back({double(i), 1.0 + double(random() % 3)});
    if (points.size() > 4) expect_exact_cover_everywhere(points);
  }
}

TEST(Triangulation, HolesThroughABridgeAreLeftOpen) {
  // A square with a square hole: the boundary walks to the hole and back over the same two vertices.
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(4, 0, 0), Vec3f(4, 4, 0), Vec3f(0, 4, 0), Vec3f(1, 1, 0), Vec3f(1, 3, 0),
                         Vec3f(3, 3, 0), Vec3f(3, 1, 0)});
  const std::vector<std::uint32_t> loop = {0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
  for (std::size_t turn = 0; turn < loop.size(); ++turn) {
    PolygonMesh turned = mesh;
    turned.face_sizes.assign({10});
    for (std::size_t i = 0; i < 10; ++i) turned.corners.push_back(loop[(i + turn) % 10]);
    const TriangleMesh result = cut(std::move(turned));
    double sum = 0;
    for (std::size_t t = 0; t < result.triangle_count(); ++t) {
      const double area = newell_normal(result.positions.data(), &result.corners[3 * t], 3).z;
      EXPECT_GE(area, 0);
      sum += area;
      Vec3f center(0, 0, 0);
      for (int k = 0; k < 3; ++k) center += result.positions[result.corners[3 * t + std::size_t(k)]] / 3;
      EXPECT_FALSE(area > 0 && center.x > 1 && center.x < 3 && center.y > 1 && center.y < 3);
    }
    EXPECT_DOUBLE_EQ(sum, 2 * (16 - 4));
  }
}

TEST(Triangulation, PolygonsThatCrossThemselvesAreCountedAndDegenerateOnesHarmless) {
  std::int64_t bad = 0;
  // A pentagram, a bow tie of unequal wings, an eight of six corners.
  std::vector<Vec3f> pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back(Vec3f(Vec3d(std::cos(i * 4 * kPi / 5), std::sin(i * 4 * kPi / 5), 0)));
  EXPECT_EQ(cut(polygon(pentagram), &bad).triangle_count(), 3u);
  EXPECT_EQ(bad, 1);
  for (const float far : {2.0f, 3.0f, 1.0f}) {  // wings that cancel, and that do not
    EXPECT_EQ(cut(polygon({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {far, 3, 0}}), &bad).triangle_count(), 2u);
    EXPECT_EQ(bad, 1) << far;
  }
  EXPECT_EQ(cut(polygon({{0, 0, 0}, {3, 3, 0}, {4, 3, 0}, {4, 0, 0}, {3, 0, 0}, {0, 2, 0}}), &bad).triangle_count(),
            4u);
  EXPECT_EQ(bad, 1);
  for (const std::size_t size : {4u, 5u, 9u}) {
    std::vector<Vec3f> line, point(size, Vec3f(1, 2, 3));
    for (std::size_t i = 0; i < size; ++i) line.push_back(Vec3f(float(i), float(2 * i), 0));
    EXPECT_EQ(cut(polygon(line)).triangle_count(), size - 2);
    EXPECT_EQ(cut(polygon(point)).triangle_count(), size - 2);
  }
}

TEST(Triangulation, HugePolygonsEndInTime) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<Vec2d> circle, spiral, inner;
  for (int i = 0; i < 70000; ++i) {
    const double angle = 2 * kPi * i / 70000;
    circle.push_back({std::cos(angle), std::sin(angle)});
  }
  for (int i = 0; i < 35000; ++i) {
    const double angle = i * 0.02;
    spiral.push_back({(1 + angle) * std::cos(angle), (1 + angle) * std::sin(angle)});
    inner.push_back({(0.5 + angle) * std::cos(angle), (0.5 + angle) * std::sin(angle)});
  }
  spiral.insert(spiral.end(), inner.rbegin(), inner.rend());
  std::mt19937 random(1);
  std::vector<Vec2d> crossed;
  for (int i = 0; i < 20000; ++i) crossed.push_back({double(random() % 1000), double(random() % 1000)});
  for (const auto& flat : {circle, spiral, ragged(66000, 7), crossed}) {
    std::vector<Vec3f> points;
    for (const Vec2d& p : flat) points.push_back(Vec3f(float(p.x), float(p.y), 0));
    std::int64_t bad = 0;
    EXPECT_EQ(cut(polygon(points), &bad).triangle_count(), points.size() - 2);
    std::fprintf(stderr, "after %zu corners: %.3f s, %lld bad\n", points.size(),
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
                 static_cast<long long>(bad));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(Triangulation, CarriesFacesNormalsAndTextureCorners) {
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0), Vec3f(0, 1, 0)});
  mesh.face_sizes.assign({3, 4});
  mesh.corners.assign({0, 1, 2, 0, 1, 2, 3});
  mesh.normals.push_back(Vec3f(0, 0, 1));
  mesh.normal_corners.assign(7, 0);
  mesh.texture_coordinates.assign(7, Vec2f(0, 0));
  mesh.texture_corners.assign({0, 1, 2, 3, 4, 5, 6});
  const TriangleMesh result = cut(std::move(mesh));
  EXPECT_EQ(result.triangle_faces, (Buffer<std::uint32_t>{0, 1, 1}));
  EXPECT_EQ(result.corners, (Buffer<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(result.texture_corners, (Buffer<std::uint32_t>{0, 1, 2, 3, 4, 5, 3, 5, 6}));
  EXPECT_EQ(result.normal_corners.size(), 9u);
}

TEST(Triangulation, ResultDoesNotDependOnThreads) {
  std::vector<Buffer<std::uint32_t>> results;
  for (const int threads : {1, 2, 7}) {
    PolygonMesh mesh;
    for (unsigned face = 0; face < 10000; ++face) {
      const std::vector<Vec2d> points = ragged(3 + face % 9, face);
      mesh.face_sizes.push_back(static_cast<std::uint32_t>(points.size()));
      for (const Vec2d& p : points) {
        mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(Vec3f(float(p.x), float(p.y), 0));
      }
    }
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
    tbb::task_arena(threads).execute([&] { results.push_back(cut(std::move(mesh)).corners); });
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace raytree
