// Vertex normals: exact corners of the cube for any cut of its faces, creases, bounds on a tessellated sphere, and
// degenerate faces.
#include "geometry/vertex_normals.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <set>

#include "geometry/angle.h"
#include "geometry/newell.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

/// Faces of the cube +-1, counter-clockwise from outside. `cut` chooses each face's form: 0 quad, 1 and 2 the
/// diagonals.
PolygonMesh cube(unsigned cut) {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(Vec3f(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f));
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    if (cut % 3 == 0) {
      mesh.face_sizes.push_back(4);
      mesh.corners.insert(mesh.corners.end(), q, q + 4);
    } else {
      const std::uint32_t s = cut % 3 - 1;
      for (const std::uint32_t k : {s, s + 1, s + 2, s, s + 2, s + 3}) mesh.corners.push_back(q[k % 4]);
      mesh.face_sizes.insert(mesh.face_sizes.end(), {3, 3});
    }
    cut /= 3;
  }
  return mesh;
}

Vec3f corner_normal(const PolygonMesh& mesh, std::size_t corner) {
  return mesh.normals[mesh.normal_corners.empty() ? mesh.corners[corner] : mesh.normal_corners[corner]];
}

TEST(VertexNormals, SmoothCubeCornersPointOutDiagonallyHoweverItsFacesAreCut) {
  const auto third = static_cast<float>(1 / std::sqrt(3.0));
  for (unsigned cut = 0; cut < 729; ++cut) {
    PolygonMesh mesh = cube(cut);
    compute_vertex_normals(mesh, kPi);
    ASSERT_EQ(mesh.normals.size(), 8u);
    EXPECT_TRUE(mesh.normal_corners.empty());
    for (std::size_t v = 0; v < 8; ++v) EXPECT_EQ(mesh.normals[v], mesh.positions[v] * third);
  }
}

TEST(VertexNormals, CreasedCubeKeepsItsFaceNormals) {
  for (const unsigned cut : {0u, 364u, 728u, 100u}) {
    PolygonMesh mesh = cube(cut);
    compute_vertex_normals(mesh, 40 * kDegree);
    test::expect_valid(mesh);
    // Three normals at each of eight vertices, one per side: triangles of one side share theirs.
    EXPECT_EQ(mesh.normals.size(), 24u);
    std::set<std::array<float, 3>> distinct;
    for (const Vec3f& n : mesh.normals) distinct.insert({n.x, n.y, n.z});
    EXPECT_EQ(distinct.size(), 6u);
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.face_sizes) {
      const Vec3f face(newell_normal(mesh.positions.data(), &mesh.corners[corner], size).normalized());
      for (std::uint32_t k = 0; k < size; ++k) EXPECT_EQ(corner_normal(mesh, corner++), face);
    }
  }
}

TEST(VertexNormals, FacesThatMeetAtExactlyTheCreaseAngleAreSmooth) {
  for (const double degrees : {10.0, 40.0, 60.0, 90.0, 120.0, 179.0}) {
    PolygonMesh mesh;
    const double a = degrees * kDegree;
    mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, -1, 0), Vec3f(Vec3d(0, std::cos(a), std::sin(a)))});
    mesh.corners.assign({1, 0, 2, 0, 1, 3});
    for (const double crease : {a - 0.02 * kDegree, a, a + 0.02 * kDegree}) {
      // 0.02 degrees away the cosine differs by sin(a) times 3.5e-4: beyond the tolerance of 4e-7 from 0.1 degrees on.
      compute_vertex_normals(mesh, crease);
      EXPECT_EQ(mesh.normal_corners.empty(), crease >= a) << degrees;
    }
  }
}

TEST(VertexNormals, ATeeAtNinetyDegreesHasNoErrorWithACrease) {
  // A fin standing on a plate, sharing the two vertices of its foot: without a crease each is 45 degrees or more wrong.
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 0, 1), Vec3f(0, 0, 1), Vec3f(0, 0, -1),
                         Vec3f(1, 0, -1), Vec3f(1, 1, 0), Vec3f(0, 1, 0)});
  mesh.face_sizes.assign({4, 4, 4});
  mesh.corners.assign({0, 3, 2, 1, 4, 0, 1, 5, 0, 1, 6, 7});
  compute_vertex_normals(mesh, 40 * kDegree);
  for (std::size_t c = 0; c < 12; ++c) EXPECT_EQ(corner_normal(mesh, c), c < 8 ? Vec3f(0, 1, 0) : Vec3f(0, 0, 1));
  compute_vertex_normals(mesh, kPi);
  EXPECT_LT(corner_normal(mesh, 8).dot(Vec3f(0, 0, 1)), std::cos(45 * kDegree) + 1e-6);
}

TEST(VertexNormals, SmoothSidesJoinAroundAVertexAcrossManyEdges) {
  // A cone's tip with many sides: neighbors are smooth, opposite sides are not, yet all share one normal.
  PolygonMesh mesh;
  const int sides = 64;
  mesh.positions.push_back(Vec3f(0, 0, 1));
  for (int i = 0; i < sides; ++i)
    mesh.positions.push_back(Vec3f(Vec3d(std::cos(2 * kPi * i / sides), std::sin(2 * kPi * i / sides), 0)));
  for (std::uint32_t i = 0; i < sides; ++i) mesh.corners.insert(mesh.corners.end(), {0, 1 + i, 1 + (i + 1) % sides});
  compute_vertex_normals(mesh, 20 * kDegree);
  EXPECT_TRUE(mesh.normal_corners.empty());
  EXPECT_NEAR(mesh.normals[0].z, 1, 1e-6);
}

/// Latitude and longitude, with poles of triangles; quads elsewhere, or cut in triangles.
PolygonMesh sphere(int rings, bool triangles) {
  PolygonMesh mesh;
  const int around = 2 * rings;
  mesh.positions.push_back(Vec3f(0, 0, 1));
  for (int i = 1; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const double theta = kPi * i / rings, phi = 2 * kPi * k / around;
      mesh.positions.push_back(
          Vec3f(Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta))));
    }
  mesh.positions.push_back(Vec3f(0, 0, -1));
  const auto at = [&](int i, int k) -> std::uint32_t {
    if (i == 0) return 0;
    if (i == rings) return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    return static_cast<std::uint32_t>(1 + (i - 1) * around + k % around);
  };
  const auto face = [&](std::initializer_list<std::uint32_t> corners) {
    mesh.corners.insert(mesh.corners.end(), corners);
    if (!triangles) mesh.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const std::uint32_t a = at(i, k), b = at(i + 1, k), c = at(i + 1, k + 1), d = at(i, k + 1);
      if (i == 0) {
        face({a, b, c});
      } else if (i == rings - 1) {
        face({a, b, d});
      } else if (triangles) {
        face({a, b, c});
        face({a, c, d});
      } else {
        face({a, b, c, d});
      }
    }
  return mesh;
}

TEST(VertexNormals, TessellatedSphereStaysWithinItsFacetsAngle) {
  for (const int rings : {8, 16, 64})
    for (const bool triangles : {false, true}) {
      PolygonMesh mesh = sphere(rings, triangles);
      compute_vertex_normals(mesh, kPi);
      // The plane of a facet whose corners lie on the sphere meets it in a circle that passes through them. Its edges
      // are at most h = pi / rings long, its diagonals sqrt(2) h, so that circle's angular radius is at most h /
      // sqrt(2) (1 + O(h^2)); that is the angle between the facet's normal and the sphere's at a corner. A mean of unit
      // vectors within a cone stays within it.
      const double bound = kPi / rings / std::sqrt(2.0) * 1.05;
      double worst = 0, mean = 0;
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3d normal(mesh.normals[v]), truth(mesh.positions[v]);
        EXPECT_NEAR(normal.length(), 1, 2e-7);
        const double angle = std::asin(std::min(1.0, normal.cross(truth).length()));
        worst = std::max(worst, angle);
        mean += angle / double(mesh.positions.size());
      }
      EXPECT_LT(worst, bound);
      // Opposite facets cancel to first order: on the mean far less is left than the bound.
      EXPECT_LT(mean, bound / 10);
    }
}

TEST(VertexNormals, ReflexCornersWeighTheirInnerAngle) {
  // An L in the plane z = 0 whose reflex corner (270 degrees) also belongs to an upright quarter plane (90 degrees).
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(2, 0, 0), Vec3f(2, 1, 0), Vec3f(1, 1, 0), Vec3f(1, 2, 0), Vec3f(0, 2, 0),
                         Vec3f(2, 1, 1), Vec3f(1, 1, 1)});
  mesh.face_sizes.assign({6, 4});
  mesh.corners.assign({0, 1, 2, 3, 4, 5, 3, 2, 6, 7});
  compute_vertex_normals(mesh, kPi);
  const Vec3d expected = (Vec3d(0, 0, 1) * 3 + Vec3d(0, -1, 0)).normalized();
  EXPECT_LT((Vec3d(mesh.normals[3]) - expected).length(), 1e-7);
}

TEST(VertexNormals, DegenerateFacesContributeNothingAndNoNormalIsZero) {
  for (const double crease : {kPi, 40 * kDegree}) {
    PolygonMesh mesh;
    // Two smooth triangles with a sliver without area between them, a lone face without area, a sheet with both sides,
    // and a vertex without a face.
    mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(2, 0, 0), Vec3f(1, 1, 0), Vec3f(1, -1, 0),
                           Vec3f(5, 0, 0), Vec3f(6, 0, 0), Vec3f(7, 0, 0), Vec3f(8, 0, 0), Vec3f(8, 1, 0),
                           Vec3f(9, 0, 0), Vec3f(3, 3, 3)});
    mesh.corners.assign({0, 2, 3, 0, 1, 2, 0, 4, 1, 1, 4, 2, 5, 6, 7, 8, 9, 10, 10, 9, 8});
    compute_vertex_normals(mesh, crease);
    for (const Vec3f& n : mesh.normals) EXPECT_NEAR(n.length(), 1, 2e-7);
    for (std::size_t c = 0; c < 12; ++c) EXPECT_EQ(corner_normal(mesh, c), Vec3f(0, 0, 1)) << c;
  }
}

TEST(VertexNormals, OwnNormalsAreMadeUnitAndBadOnesReplaced) {
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 0)});
  mesh.corners.assign({0, 2, 1});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.normals.assign({Vec3f(3, 0, 4), Vec3f(0, 0, 0), Vec3f(nan, 1, 0), Vec3f(1e-30f, 0, 0)});
  EXPECT_EQ(normalize_vertex_normals(mesh), 2);
  EXPECT_EQ(mesh.normals[0], Vec3f(0.6f, 0, 0.8f));
  EXPECT_EQ(mesh.normals[1], Vec3f(0, 0, -1));
  EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, -1));
  EXPECT_EQ(mesh.normals[3], Vec3f(1, 0, 0));
  mesh.normals.assign({Vec3f(0, 0, 0)});
  mesh.normal_corners.assign(3, 0);
  EXPECT_EQ(normalize_vertex_normals(mesh), 1);
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, -1));
}

TEST(VertexNormals, ResultDoesNotDependOnThreads) {
  for (const double crease : {1 * kDegree, kPi}) {
    std::vector<PolygonMesh> meshes;
    for (const int threads : {1, 2, 7}) {
      meshes.push_back(sphere(120, true));
      const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
      tbb::task_arena(threads).execute([&] { compute_vertex_normals(meshes.back(), crease); });
    }
    EXPECT_EQ(meshes[0].normal_corners.empty(), crease == kPi);
    EXPECT_TRUE(test::same_mesh(meshes[0], meshes[1]));
    EXPECT_TRUE(test::same_mesh(meshes[0], meshes[2]));
  }
}

}  // namespace
}  // namespace raytree
