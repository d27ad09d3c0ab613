// No ray hits the triangle it left, whatever the triangles of meshes are handed to Embree as: quads and grids are met
// by other code than triangles, and large scenes are such without asking.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "renderer/tracer_choice.h"
#include "tests/renderer/false_hits.h"

namespace raytree {
namespace {

using test::count_false_hits, test::FalseHits, test::kSettings, test::RandomRays, test::Setting;

/// Patches of 8 x 8 cells, the smallest lattices that are looked for, each turned at random and bent a little. A point
/// in each triangle goes to `inside`.
ShapeSet bent_patches(const Setting& setting, RandomRays& random, std::vector<Vec3d>& inside) {
  constexpr int kPatches = 12, kCells = 8;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh;
  for (int patch = 0; patch < kPatches; ++patch) {
    const Vec3d place = random.in_cube(setting.place + 30 * setting.size * kCells), along = random.direction();
    Vec3d across = random.direction();
    across = unit(across - along * across.dot(along));
    const Vec3d up = along.cross(across);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i)
        mesh.positions.push_back(
            Vec3f(place + (along * i + across * j + up * random.uniform(-0.1, 0.1)) * setting.size));
    for (std::uint32_t j = 0; j < kCells; ++j)
      for (std::uint32_t i = 0; i < kCells; ++i) {
        const std::uint32_t a = first + j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
        // Cells are halved the one way in some patches, the other way in others.
        for (const std::uint32_t corner : patch % 2 == 0 ? std::vector<std::uint32_t>{a, b, d, a, d, c}
                                                         : std::vector<std::uint32_t>{a, b, c, b, d, c})
          mesh.corners.push_back(corner);
      }
  }
  for (std::size_t t = 0; t < mesh.corners.size(); t += 3) {
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.corners[t + k]]); };
    inside.push_back(corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v);
  }
  return shapes;
}

TEST(SelfIntersection, NoRayHitsTheTriangleItLeftInAnyHierarchy) {
  for (const HierarchyCost& cost : hierarchy_costs()) {
    RandomRays random(8);
    EmbreeOptions options;
    options.primitives = cost.primitives, options.quality = cost.quality, options.compact = cost.compact;
    for (const Setting& setting : kSettings) {
      std::vector<Vec3d> inside;
      const ShapeSet shapes = bent_patches(setting, random, inside);
      const FalseHits count = count_false_hits(
          shapes, static_cast<int>(inside.size()), kFirstMeshGeometry, setting.size, random,
          [&](int i) { return inside[static_cast<std::size_t>(i)]; },
          [](const Hit&, const SurfacePoint&, const Vec3f&, float) { return true; }, options);
      EXPECT_EQ(count.false_hits, 0) << cost.name << " size " << setting.size << " place " << setting.place << " of "
                                     << count.left;
      // Where the size is a few ulp of the place, most aims miss.
      if (setting.size > 1e-4 * setting.place) {
        EXPECT_GT(count.left, 15000) << cost.name << " size " << setting.size << " place " << setting.place;
      }
    }
  }
}

}  // namespace
}  // namespace raytree
