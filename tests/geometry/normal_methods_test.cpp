// The ways to average vertex normals that Gouraud and Phong name: closed forms on one fan where all differ, their
// errors on spheres of even and of unbalanced facets, and pieces that share a boundary.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.h"
#include "geometry/vertex_normals.h"
#include "tests/degrees_between.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

constexpr NormalMethod kMethods[] = {
    NormalMethod::angle,  NormalMethod::unit, NormalMethod::area, NormalMethod::edges, NormalMethod::terminating_edges,
    NormalMethod::corners};

double degrees_off(const Vec3f& a, const Vec3f& b) { return test::degrees_between(Vec3d(a), Vec3d(b)); }

Vec3f normal_at(const PolygonMesh& mesh, std::size_t corner) {
  return mesh.normals[mesh.normal_corners.empty() ? mesh.corners[corner] : mesh.normal_corners[corner]];
}

/// Normal at vertex 0 of a trapezoid that faces z and a triangle that faces -x, joined at a right angle.
Vec3f fan_normal(NormalMethod method) {
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(2, 0, 0), Vec3f(4, 3, 0), Vec3f(0, 3, 0), Vec3f(0, -1, -1)});
  mesh.face_sizes.assign({4, 3});
  mesh.corners.assign({0, 1, 2, 3, 0, 3, 4});
  compute_vertex_normals(mesh, {method, kPi, false});
  return mesh.normals[0];
}

// The trapezoid: area 9, four edges, eq. 4.1 gives 36; its edges at the vertex are 2 and 3 long, at 90 degrees. The
// triangle: area 3/2, eq. 4.1 gives 9; edges of 3 and sqrt 2 at 135 degrees.
TEST(NormalMethods, EachHasItsClosedForm) {
  const auto expect = [](NormalMethod method, Vec3d sum) {
    EXPECT_LT(degrees_off(fan_normal(method), Vec3f(sum.normalized())), 1e-4) << static_cast<int>(method);
  };
  expect(NormalMethod::unit, {-1, 0, 1});
  expect(NormalMethod::area, {-3, 0, 18});
  expect(NormalMethod::edges, {-9.0 / 3, 0, 36.0 / 4});
  expect(NormalMethod::terminating_edges, {-3, 0, 6});
  expect(NormalMethod::corners, {-1, 0, 1});
  expect(NormalMethod::angle, {-135, 0, 90});
}

/// Longitude and latitude with poles on y; `skew` moves the rings together toward the north (1: even).
PolygonMesh sphere(int sides, int rings, double skew) {
  PolygonMesh mesh;
  mesh.positions.push_back(Vec3f(0, 1, 0));
  for (int ring = 1; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const double polar = kPi * std::pow(double(ring) / rings, skew), around = 2 * kPi * side / sides;
      mesh.positions.push_back(
          Vec3f(Vec3d(std::sin(polar) * std::sin(around), std::cos(polar), std::sin(polar) * std::cos(around))));
    }
  mesh.positions.push_back(Vec3f(0, -1, 0));
  const auto at = [&](int ring, int side) { return std::uint32_t(1 + (ring - 1) * sides + side % sides); };
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  const auto add = [&](std::initializer_list<std::uint32_t> face) {
    mesh.face_sizes.push_back(std::uint32_t(face.size()));
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
  };
  for (int side = 0; side < sides; ++side) {
    add({0, at(1, side), at(1, side + 1)});
    for (int ring = 1; ring + 1 < rings; ++ring)
      add({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)});
    add({last, at(rings - 1, side + 1), at(rings - 1, side)});
  }
  return mesh;
}

struct Errors {
  double mean = 0, largest = 0;  ///< degrees
};
Errors errors_on_sphere(PolygonMesh mesh, NormalMethod method) {
  compute_vertex_normals(mesh, {method, kPi, false});
  Errors errors;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double error = degrees_off(mesh.normals[v], mesh.positions[v]);
    errors.mean += error / double(mesh.positions.size());
    errors.largest = std::max(errors.largest, error);
  }
  return errors;
}

// Row 12. Gouraud 1971, p. 30: the methods can hardly be told apart but with unbalanced polygons (his figure 17).
// Printed.
TEST(NormalMethods, DifferVisiblyOnUnbalancedFacetsOnly) {
  for (const NormalMethod method : kMethods) {
    const Errors even = errors_on_sphere(sphere(16, 12, 1), method);
    const Errors unbalanced = errors_on_sphere(sphere(16, 12, 2), method);
    std::printf("  method %d: even facets %.2f deg mean, %.2f largest; unbalanced %.2f mean, %.2f largest\n",
                static_cast<int>(method), even.mean, even.largest, unbalanced.mean, unbalanced.largest);
    EXPECT_LT(even.largest, 4);
    EXPECT_GT(unbalanced.mean, even.mean + 0.3) << static_cast<int>(method);
    EXPECT_LT(unbalanced.largest, 6);
  }
}

TEST(NormalMethods, CreasesHoldForEach) {
  // A fin on a plate at a right angle.
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 0, 1), Vec3f(0, 0, 1), Vec3f(0, 0, -1),
                         Vec3f(1, 0, -1), Vec3f(1, 1, 0), Vec3f(0, 1, 0)});
  mesh.face_sizes.assign({4, 4, 4});
  mesh.corners.assign({0, 3, 2, 1, 4, 0, 1, 5, 0, 1, 6, 7});
  for (const NormalMethod method : kMethods) {
    compute_vertex_normals(mesh, {method, 40 * kDegree, false});
    for (std::size_t c = 0; c < 12; ++c)
      EXPECT_EQ(normal_at(mesh, c), c < 8 ? Vec3f(0, 1, 0) : Vec3f(0, 0, 1)) << static_cast<int>(method);
    compute_vertex_normals(mesh, {method, kPi, false});
    EXPECT_GT(degrees_off(normal_at(mesh, 8), Vec3f(0, 0, 1)), 45 - 1e-4) << static_cast<int>(method);
  }
}

/// Half a cylinder of 6 sides about z, in two pieces of 3 that meet at y = 1, each with vertices of its own. With the
/// true normals of the seam's four vertices (two of each piece).
PolygonMesh cylinder_in_two_pieces() {
  PolygonMesh mesh;
  for (const int piece : {0, 1}) {
    const auto first = std::uint32_t(mesh.positions.size());
    for (int i = 0; i <= 3; ++i)
      for (const double z : {0.0, 1.0}) {
        // The very same floats for the seam of both.
        const double angle = kPi * (3 * piece + i) / 6;
        mesh.positions.push_back(Vec3f(Vec3d(std::cos(angle), std::sin(angle), z)));
      }
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = first + 2 * i;
      mesh.face_sizes.push_back(4);
      mesh.corners.insert(mesh.corners.end(), {a, a + 2, a + 3, a + 1});
    }
  }
  return mesh;
}

// Gouraud 1971, p. 30-32: averages must go across the boundary of tangent pieces, else the shading breaks there.
TEST(NormalMethods, TangentPiecesShareNormalsAlongTheirBoundary) {
  const Vec3f seam(0, 1, 0);
  for (const NormalMethod method : kMethods)
    for (const double crease : {40 * kDegree, kPi}) {
      PolygonMesh mesh = cylinder_in_two_pieces();
      compute_vertex_normals(mesh, {method, crease, false});
      EXPECT_NEAR(degrees_off(normal_at(mesh, 9), seam), 15, 1e-3) << "each piece knows its own last side alone";
      compute_vertex_normals(mesh, {method, crease, true});
      test::expect_valid(mesh);
      std::size_t on_seam = 0;
      for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
        const Vec3f& p = mesh.positions[mesh.corners[c]];
        if (p.y != 1) continue;
        EXPECT_LT(degrees_off(normal_at(mesh, c), seam), 1e-3) << static_cast<int>(method);
        ++on_seam;
      }
      EXPECT_EQ(on_seam, 4u);
    }
}

// ... and must not where they are not tangent (his figure 11): the crease angle holds across pieces too.
TEST(NormalMethods, PiecesThatMeetAtAnAngleKeepTheirOwn) {
  PolygonMesh mesh;
  mesh.positions.assign({Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 0, -1), Vec3f(0, 0, -1),  //
                         Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(1, 1, 0), Vec3f(0, 1, 0)});
  mesh.face_sizes.assign({4, 4});
  mesh.corners.assign({0, 1, 2, 3, 4, 5, 6, 7});
  for (const NormalMethod method : kMethods) {
    compute_vertex_normals(mesh, {method, 40 * kDegree, true});
    for (std::size_t c = 0; c < 8; ++c) EXPECT_EQ(normal_at(mesh, c), c < 4 ? Vec3f(0, 1, 0) : Vec3f(0, 0, 1));
    compute_vertex_normals(mesh, {method, kPi, true});
    EXPECT_NEAR(degrees_off(normal_at(mesh, 4), Vec3f(0, 0, 1)), 45, 1e-3) << static_cast<int>(method);
  }
}

}  // namespace
}  // namespace raytree
