// Tessellation at given rates: counts and watertightness by topology, areas and volumes that converge, normals where
// sides are sharp, and the same bits for any number of threads.
#include "geometry/tessellation.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <limits>
#include <random>
#include <set>

#include "geometry/angle.h"
#include "geometry/error.h"
#include "tests/geometry/analytic_surfaces.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

/// Edges of the mesh that no triangle runs along in the other direction; indices in range, no edge used twice.
std::size_t open_edges_of(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const std::uint32_t a = mesh.corners[i], b = mesh.corners[i % 3 == 2 ? i - 2 : i + 1];
    EXPECT_LT(a, mesh.positions.size());
    EXPECT_TRUE(edges.insert({a, b}).second);
  }
  return std::size_t(std::count_if(edges.begin(), edges.end(), [&](const auto& e) {
    return edges.count({e.second, e.first}) == 0;
  }));
}

Vec3d corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t k) {
  return Vec3d(mesh.positions[mesh.corners[3 * triangle + k]]);
}
Vec3d doubled_area(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3d a = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}
double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) sum += doubled_area(mesh, i).length() / 2;
  return sum;
}
double volume_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) sum += doubled_area(mesh, i).dot(corner(mesh, i, 0)) / 6;
  return sum;
}
Vec3f normal_at(const TriangleMesh& mesh, std::size_t c) {
  return mesh.normals[mesh.normal_corners.empty() ? mesh.corners[c] : mesh.normal_corners[c]];
}

TessellationRates random_rates(const ParametricSurface& surface, unsigned seed, std::uint16_t largest) {
  TessellationRates rates = uniform_rates(surface, 1);
  std::minstd_rand random(seed);
  const auto next = [&] { return std::uint16_t(1 + random() % largest); };
  for (std::uint16_t& rate : rates.edges) rate = next();
  for (auto& inner : rates.inner) inner = {next(), next()};
  return rates;
}

TEST(Tessellation, UniformRatesGiveTheCountsOfClosedForms) {
  for (const int rate : {1, 2, 3, 8}) {
    const std::size_t r = std::size_t(rate);
    TriangleMesh mesh = tessellate_uniformly(test::torus(5, 4), rate);
    EXPECT_EQ(mesh.triangle_count(), 2 * 20 * r * r);
    EXPECT_EQ(mesh.positions.size(), 20 * r * r);
    EXPECT_EQ(open_edges_of(mesh), 0u);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_TRUE(mesh.normal_corners.empty());
    EXPECT_TRUE(mesh.texture_coordinates.empty());

    mesh = tessellate_uniformly(test::octant_sphere(), rate);
    EXPECT_EQ(mesh.triangle_count(), 8 * r * r);
    EXPECT_EQ(mesh.positions.size(), 4 * r * r + 2);
    EXPECT_EQ(open_edges_of(mesh), 0u);

    mesh = tessellate_uniformly(test::saddle(1), rate);
    EXPECT_EQ(mesh.triangle_count(), 2 * r * r);
    EXPECT_EQ(mesh.positions.size(), (r + 1) * (r + 1));
    EXPECT_EQ(open_edges_of(mesh), 4 * r);

    mesh = tessellate_uniformly(test::cylinder(6), rate);
    EXPECT_EQ(mesh.triangle_count(), 6 * 2 * r * r + 2 * 6 * (r * r / 2 + r % 2));
    EXPECT_EQ(mesh.positions.size(), mesh.triangle_count() / 2 + 2);  // Euler: closed, of genus 0
    EXPECT_EQ(open_edges_of(mesh), 0u);
  }
}

TEST(Tessellation, AFaceThatMeetsItselfSharesItsPoints) {
  for (const int rate : {1, 4, 65}) {
    const TriangleMesh mesh = tessellate_uniformly(test::torus(1, 1), rate);
    EXPECT_EQ(mesh.triangle_count(), std::size_t(2 * rate * rate));
    EXPECT_EQ(mesh.positions.size(), std::size_t(rate * rate));
    if (rate > 2) {
      EXPECT_EQ(open_edges_of(mesh), 0u);
    }
  }
}

TEST(Tessellation, PointsLieOnTheSurfaceWithItsNormals) {
  const TriangleMesh mesh = tessellate(test::octant_sphere(), random_rates(test::octant_sphere(), 3, 9));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(mesh.positions[i].length(), 1, 2e-7);
    EXPECT_EQ(mesh.positions[i], mesh.normals[i]);
  }
}

TEST(Tessellation, AreaAndVolumeOfATorusConvergeInTheSecondOrder) {
  // Points on the surface and facets of size h: errors c h^2 + O(h^4). From rate 8 on (h = 0.16 and 0.12 radians) the
  // second term is below h^2 = 3 % of the first, so halving h divides the error by 4 within 4 %.
  double area_error = 0, volume_error = 0;
  for (const int rate : {8, 16, 32}) {
    const TriangleMesh mesh = tessellate_uniformly(test::torus(7, 5), rate);
    const double area = test::torus_area() - area_of(mesh), volume = test::torus_volume() - volume_of(mesh);
    EXPECT_GT(area, 0);
    EXPECT_GT(volume, 0);
    if (rate > 8) {
      EXPECT_NEAR(area_error / area, 4, 0.16);
      EXPECT_NEAR(volume_error / volume, 4, 0.16);
    }
    area_error = area;
    volume_error = volume;
  }
  // The chord of an arc h wide at radius r lies inside it by h^2 r / 12 in the mean: a tube of cross-section area
  // smaller by h^2 / 6, a ring shorter by h^2 / 6 times the share that depends on its radius.
  const double tube = 2 * kPi / 160, ring = 2 * kPi / 224;
  EXPECT_LT(volume_error / test::torus_volume(), (tube * tube + ring * ring) / 6 * 1.05);
  EXPECT_GT(volume_error / test::torus_volume(), tube * tube / 6 * 0.95);
}

TEST(Tessellation, AnyRatesLeaveNoCrack) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const test::AnalyticSurface surfaces[] = {test::torus(5, 4), test::octant_sphere(), test::cylinder(5)};
    for (const auto& surface : surfaces) {
      const TriangleMesh mesh = tessellate(surface, random_rates(surface, seed, seed % 2 == 0 ? 5 : 12));
      ASSERT_EQ(open_edges_of(mesh), 0u);
      for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        ASSERT_GE(mesh.triangle_faces[i], 100u);
        ASSERT_LT(mesh.triangle_faces[i], 100 + surface.face_count());
      }
    }
  }
}

TEST(Tessellation, FacetsFaceOutwards) {
  for (const int rate : {4, 9}) {
    EXPECT_GT(volume_of(tessellate_uniformly(test::torus(5, 4), rate)), 0);
    for (const auto& surface : {test::torus(5, 4), test::octant_sphere(), test::cylinder(5)}) {
      const TriangleMesh mesh = tessellate_uniformly(surface, rate);
      for (std::size_t c = 0; c < mesh.corners.size(); ++c)
        ASSERT_GT(doubled_area(mesh, c / 3).dot(Vec3d(normal_at(mesh, c))), 0);
    }
  }
}

TEST(Tessellation, SharpSidesGiveEachFaceItsOwnNormals) {
  const test::AnalyticSurface surface = test::cylinder(8);
  for (const TessellationRates& rates : {uniform_rates(surface, 5), random_rates(surface, 7, 6)}) {
    const TriangleMesh mesh = tessellate(surface, rates);
    ASSERT_EQ(mesh.normal_corners.size(), mesh.corners.size());
    for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
      const Vec3f at = mesh.positions[mesh.corners[c]], normal = normal_at(mesh, c);
      const std::uint32_t face = mesh.triangle_faces[c / 3] - 100;
      const Vec3f expected = face < 8 ? Vec3f(at.x, 0, at.z) : Vec3f(0, face == 8 ? 1.0f : -1.0f, 0);
      EXPECT_LT((normal - expected).length(), 3e-7) << face;
    }
  }
}

TEST(Tessellation, ABoundaryNeedsNoNormalsOfItsOwn) {
  EXPECT_TRUE(test::saddle(1).sides(0)[0].sharp_edge);
  EXPECT_TRUE(tessellate_uniformly(test::saddle(1), 3).normal_corners.empty());
}

TEST(Tessellation, TextureCoordinatesAreEachFacesOwn) {
  test::AnalyticSurface surface = test::torus(3, 3);
  surface.textured = true;
  const TriangleMesh mesh = tessellate(surface, random_rates(surface, 5, 5));
  ASSERT_EQ(mesh.texture_corners.size(), mesh.corners.size());
  // On every face (x, y) are its own parameters: the facets cover the unit square once.
  std::vector<double> covered(9, 0);
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto at = [&](std::size_t k) { return Vec2d(mesh.texture_coordinates[mesh.texture_corners[3 * i + k]]); };
    const Vec2d u = at(1) - at(0), v = at(2) - at(0);
    const double area = (u.x * v.y - u.y * v.x) / 2;
    EXPECT_GT(area, 0);
    covered[mesh.triangle_faces[i] - 100] += area;
  }
  for (const double area : covered) EXPECT_NEAR(area, 1, 1e-6);
}

TEST(Tessellation, SharedPointsAreTheLowestFaces) {
  // Every face has a plane of its own, so that who evaluated a point shows in it.
  test::AnalyticSurface surface(6, [](std::size_t face, Vec2d p) {
    SurfaceSample s;
    s.position = Vec3f(Vec3d(p.x, p.y, double(face)));
    s.normal = Vec3f(0, 0, 1);
    return s;
  });
  surface.add_face(FaceDomain::quad, {0, 1, 2, 3});
  surface.add_face(FaceDomain::quad, {1, 4, 5, 2});
  surface.add_face(FaceDomain::quad, {3, 2, 5, 0});
  const TriangleMesh mesh = tessellate_uniformly(surface, 3);
  // Face 0: 4 corners and 4 sides of 2 points; face 1: 2 corners and 3 sides that are left; face 2: the side from
  // vertex 5 to 0. Each has 4 points inside.
  std::array<int, 3> counts{};
  for (const Vec3f& p : mesh.positions) ++counts.at(static_cast<std::size_t>(p.z));
  EXPECT_EQ(counts, (std::array<int, 3>{4 + 8 + 4, 2 + 6 + 4, 2 + 4}));
}

TEST(Tessellation, HolesLeaveNothingBehind) {
  test::AnalyticSurface surface = test::saddle(1);
  surface.add_hole();
  const TriangleMesh mesh = tessellate_uniformly(surface, 4);
  EXPECT_EQ(mesh.positions.size(), 25u);
  test::AnalyticSurface nothing(7, [](std::size_t, Vec2d) { return SurfaceSample(); });
  nothing.add_hole();
  EXPECT_EQ(tessellate_uniformly(nothing, 4).positions.size(), 0u);
  EXPECT_EQ(tessellate_uniformly(nothing, 4).triangle_count(), 0u);
}

TEST(Tessellation, ResultDoesNotDependOnThreads) {
  test::AnalyticSurface few = test::torus(1, 2), many = test::torus(60, 40), rims = test::cylinder(50);
  few.textured = true;
  const std::pair<const test::AnalyticSurface*, TessellationRates> cases[] = {
      {&few, uniform_rates(few, 200)}, {&many, random_rates(many, 1, 4)}, {&rims, random_rates(rims, 2, 20)}};
  for (const auto& [surface, rates] : cases) {
    const TriangleMesh expected =
        tbb::task_arena(1).execute([&surface = surface, &rates = rates] { return tessellate(*surface, rates); });
    for (const int threads : {2, 3, 7}) {
      const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
      const TriangleMesh mesh = tbb::task_arena(threads).execute(
          [&surface = surface, &rates = rates] { return tessellate(*surface, rates); });
      EXPECT_TRUE(test::same_bits(mesh.positions, expected.positions));
      EXPECT_TRUE(test::same_bits(mesh.corners, expected.corners));
      EXPECT_TRUE(test::same_bits(mesh.normals, expected.normals));
      EXPECT_TRUE(test::same_bits(mesh.normal_corners, expected.normal_corners));
      EXPECT_TRUE(test::same_bits(mesh.texture_coordinates, expected.texture_coordinates));
      EXPECT_TRUE(test::same_bits(mesh.texture_corners, expected.texture_corners));
      EXPECT_TRUE(test::same_bits(mesh.triangle_faces, expected.triangle_faces));
    }
  }
}

std::string message_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

TEST(Tessellation, WhatCannotBeMadeIsRefusedBeforeItIsMade) {
  for (const int rate : {0, -1, kLargestRate + 1})
    EXPECT_NE(message_of([&] { tessellate_uniformly(test::saddle(1), rate); }).find("from 1 to 1024"),
              std::string::npos);
  // 4200 quads of a million points each are more than an index can count.
  const test::AnalyticSurface large = test::torus(70, 60);
  EXPECT_NE(message_of([&] { tessellate_uniformly(large, 1024); }).find("more than 4294967294"), std::string::npos);
  TessellationRates rates = uniform_rates(large, 2);
  rates.edges[7] = 0;
  EXPECT_NE(message_of([&] { tessellate(large, rates); }).find("rate"), std::string::npos);
  rates.edges.pop_back();
  EXPECT_NE(message_of([&] { tessellate(large, rates); }).find("rate"), std::string::npos);
}

TEST(Tessellation, ASurfaceThatIsNotFiniteIsRefusedWithItsFace) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const Vec2d& bad : {Vec2d(0, 0), Vec2d(0.5, 0), Vec2d(0.5, 0.5)}) {
    test::AnalyticSurface surface(4, [=](std::size_t, Vec2d p) {
      SurfaceSample s;
      s.position = p == bad ? Vec3f(0, inf, 0) : Vec3f(float(p.x), float(p.y), 0);
      s.normal = {0, 0, 1};
      return s;
    });
    surface.add_face(FaceDomain::quad, std::vector<std::uint32_t>{0, 1, 2, 3});
    EXPECT_EQ(message_of([&] { tessellate_uniformly(surface, 2); }), "the surface is not finite in face 101");
  }
}

}  // namespace
}  // namespace raytree
