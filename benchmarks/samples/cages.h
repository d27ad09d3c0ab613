// Cages of subdivision surfaces, and closed forms of their limits: for tests and the stability suite.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "geometry/angle.h"
#include "geometry/polygon_mesh.h"

namespace raytree::samples {

inline void add_face(PolygonMesh& mesh, std::initializer_list<std::uint32_t> corners) {
  mesh.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
  mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
}

/// Faces of the cube +-1, counter-clockwise from outside; bits of a vertex's number are the signs of x, y, z.
inline PolygonMesh cube_cage() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(Vec3f(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f));
  add_face(mesh, {0, 4, 6, 2});
  add_face(mesh, {1, 3, 7, 5});
  add_face(mesh, {0, 1, 5, 4});
  add_face(mesh, {2, 6, 7, 3});
  add_face(mesh, {0, 2, 3, 1});
  add_face(mesh, {4, 5, 7, 6});
  return mesh;
}

/// (columns - 1) x (rows - 1) quads over the plane z = 0, vertex i * columns + j at (j, i); bumped along z by a fixed
/// pattern times `height`.
inline PolygonMesh grid_cage(int columns, int rows, float height) {
  PolygonMesh mesh;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      mesh.positions.push_back(Vec3f(static_cast<float>(j), static_cast<float>(i),
                                     height * static_cast<float>((7 * i * i + 5 * j + 3 * i * j) % 11) / 11));
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * columns + j); };
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < columns; ++j) add_face(mesh, {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
  return mesh;
}

/// A closed torus of quads, all vertices regular.
inline PolygonMesh torus_cage(int around, int across) {
  PolygonMesh mesh;
  const double turn = 2 * kPi;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = turn * i / around, b = turn * j / across, r = 3 + std::cos(b);
      mesh.positions.push_back(Vec3f(Vec3d(r * std::cos(a), std::sin(b), -r * std::sin(a))));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) add_face(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

/// A vertex of valence n (number 0) on the tip of a bumpy paraboloid, two rings of quads about it. Vertices 1..2n are
/// its ring: end points of its edges (odd) and far corners of its faces (even), alternating.
inline PolygonMesh star_cage(int n) {
  PolygonMesh mesh;
  mesh.positions.push_back(Vec3f(0.05f, -0.03f, 1.1f));
  const auto ring = [&](int count, double radius) {
    for (int i = 0; i < count; ++i) {
      const double a = 2 * kPi * i / count, r = radius * (1 + 0.15 * std::sin(3 * a + radius));
      const double x = r * std::cos(a), y = r * std::sin(a);
      mesh.positions.push_back(Vec3f(Vec3d(x, y, 1 - 0.2 * (x * x + 1.5 * y * y) + 0.1 * std::cos(5 * a + radius))));
    }
  };
  ring(2 * n, 1);
  ring(4 * n, 2);
  const auto inner = [&](int i) { return static_cast<std::uint32_t>(1 + (i + 2 * n) % (2 * n)); };
  const auto outer = [&](int i) { return static_cast<std::uint32_t>(1 + 2 * n + (i + 4 * n) % (4 * n)); };
  for (int i = 0; i < n; ++i) add_face(mesh, {0, inner(2 * i), inner(2 * i + 1), inner(2 * i + 2)});
  // Inner vertex 2i has one outer neighbour, 4i; inner vertex 2i + 1 has two, 4i + 1 and 4i + 3, about corner 4i + 2.
  for (int i = 0; i < n; ++i) {
    add_face(mesh, {inner(2 * i), outer(4 * i), outer(4 * i + 1), inner(2 * i + 1)});
    add_face(mesh, {inner(2 * i + 1), outer(4 * i + 1), outer(4 * i + 2), outer(4 * i + 3)});
    add_face(mesh, {inner(2 * i + 1), outer(4 * i + 3), outer(4 * i + 4), inner(2 * i + 2)});
  }
  return mesh;
}

struct ClosedFormLimit {
  Vec3d position, normal;
};

/// The limit at a smooth vertex of valence n among quads: P = (n^2 v + 4 sum e + sum f) / (n (n + 5)); tangents after
/// Halstead, Kass and DeRose 1993, t1 = sum A cos(2 pi i / n) e_i + (cos(2 pi i / n) + cos(2 pi (i + 1) / n)) f_i with
/// A = 1 + cos(2 pi / n) + cos(pi / n) sqrt(2 (9 + cos(2 pi / n))). Edges and faces alternate, counter-clockwise.
inline ClosedFormLimit catmark_limit(const Vec3d& v, const std::vector<Vec3d>& edges, const std::vector<Vec3d>& faces) {
  const auto n = static_cast<double>(edges.size());
  const double turn = 2 * kPi / n;
  const double a = 1 + std::cos(turn) + std::cos(turn / 2) * std::sqrt(2 * (9 + std::cos(turn)));
  Vec3d sum = v * (n * n), t1(0), t2(0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double k = static_cast<double>(i);
    sum += edges[i] * 4.0 + faces[i];
    t1 += edges[i] * (a * std::cos(turn * k)) + faces[i] * (std::cos(turn * k) + std::cos(turn * (k + 1)));
    t2 += edges[i] * (a * std::sin(turn * k)) + faces[i] * (std::sin(turn * k) + std::sin(turn * (k + 1)));
  }
  return {sum / (n * (n + 5)), t1.cross(t2).normalized()};
}

}  // namespace raytree::samples
