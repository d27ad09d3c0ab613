// Meshes of lattices and of triangles that belong to none, for tests of what becomes of them.
#pragma once

#include <cstdint>
#include <utility>

#include "geometry/triangle_mesh.h"
#include "tests/random.h"

namespace raytree::test {

inline void add_triangle(Random& random, std::uint32_t a, std::uint32_t b, std::uint32_t c, TriangleMesh& mesh) {
  const std::uint32_t corners[3] = {a, b, c};
  for (std::size_t i = 0, turn = random.below(3); i < 3; ++i) mesh.corners.push_back(corners[(i + turn) % 3]);
}

/// Appends columns x rows cells over [0, 1]^2 at uneven heights beside what the mesh has, each halved one way or the
/// other, its triangles in either order and turned at random.
inline void add_lattice(Random& random, std::uint32_t columns, std::uint32_t rows, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const float along = mesh.positions.empty() ? 0 : mesh.positions.back().x + 0.5f;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.positions.emplace_back(along + float(i) / float(columns), float(random.uniform(0, 0.02)),
                                  float(j) / float(rows));
  // Neighbors are often halved alike, as those of terrains are.
  bool rising = false;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      if (random.below(3) == 0) rising = !rising;
      const bool other_first = random.below(2) == 0;
      for (const bool other : {other_first, !other_first})
        if (rising)
          other ? add_triangle(random, d, b, c, mesh) : add_triangle(random, a, c, b, mesh);
        else
          other ? add_triangle(random, a, d, b, mesh) : add_triangle(random, a, c, d, mesh);
    }
}

/// Appends triangles that share no vertex.
inline void add_soup(Random& random, std::uint32_t triangles, TriangleMesh& mesh) {
  const float along = mesh.positions.empty() ? 0 : mesh.positions.back().x + 0.5f;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3f at(along + float(random.uniform(0, 1)), float(random.uniform(0, 1)), float(random.uniform(0, 1)));
    for (const Vec3f& corner : {Vec3f(0, 0, 0), Vec3f(0, 0.01f, 0.1f), Vec3f(0.1f, 0, 0)})
      mesh.positions.push_back(at + corner);
    add_triangle(random, first, first + 1, first + 2, mesh);
  }
}

}  // namespace raytree::test
