#include "benchmarks/bumpy_torus.h"

#include <cmath>

#include "geometry/angle.h"
#include "geometry/subdivision_refinement.h"

namespace raytree::benchmarks {

Vec3f on_bumpy_torus(double a, double b) {
  const double turn = 2 * kPi, r = 3 + std::cos(turn * b) + 0.02 * std::sin(40 * turn * a);
  return Vec3f(Vec3d(r * std::cos(turn * a), std::sin(turn * b), -r * std::sin(turn * a)));
}

PolygonMesh bumpy_torus_cage(std::uint32_t around, std::uint32_t across, bool triangles, bool textured) {
  PolygonMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j)
      mesh.positions.push_back(on_bumpy_torus(double(i) / around, double(j) / across));
  if (textured)
    for (std::uint32_t i = 0; i <= around; ++i)
      for (std::uint32_t j = 0; j <= across; ++j)
        mesh.texture_coordinates.emplace_back(float(i) / float(around), float(j) / float(across));
  const auto corner = [&](std::uint32_t i, std::uint32_t j) {
    mesh.corners.push_back((i % around) * across + j % across);
    if (textured) mesh.texture_corners.push_back(i * (across + 1) + j);
  };
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      corner(i, j), corner(i + 1, j), corner(i + 1, j + 1);
      if (triangles) corner(i, j), corner(i + 1, j + 1);
      corner(i, j + 1);
    }
  if (!triangles) mesh.face_sizes.assign(std::size_t(around) * across, 4);
  return mesh;
}

PolygonMesh irregular_torus_cage(bool textured) {
  Warnings warnings;
  return refine_uniformly(bumpy_torus_cage(41, 41, true, textured), {}, 1, RefinedPoints::control, {}, warnings);
}

}  // namespace raytree::benchmarks
