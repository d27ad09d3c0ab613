// What each rule of a cage does, one at a time, by closed forms: sharpness from level to level, triangles, texture
// coordinates where islands meet, and which sides and corners are sharp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "geometry/subdivision_refinement.h"
#include "geometry/subdivision_surface.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/geometry/surface_samples.h"

namespace raytree {
namespace {

std::unique_ptr<ParametricSurface> ruled_surface(const PolygonMesh& mesh, const SubdivisionRules& rules,
                                                 std::size_t budget = kPatchPointBudget) {
  Warnings warnings;
  return make_subdivision_surface(mesh, rules, {}, warnings, budget);
}

TEST(SubdivisionRules, ChaikinSmoothsSharpnessAlongACrease) {
  // Edges of sharpness 3 and 1 meet: beside their vertex a child takes 3/4 of its own edge's and 1/4 of the other's, at
  // the far ends its own, and loses 1 (DeRose, Kass, Truong 1998, sec. 3.1). Uniform: each loses 1.
  PolygonMesh cage = test::grid_cage(5, 5, 1);
  SubdivisionRules rules;
  rules.creases = {{{11, 12}, 3}, {{12, 13}, 1}};
  const auto left = [&](CreaseMethod method) {
    rules.crease_method = method;
    cage.subdivision = rules;
    Warnings warnings;
    const PolygonMesh once = refine_uniformly(cage, rules, 1, RefinedPoints::control, {}, warnings);
    std::vector<double> sharpness;
    for (const Crease& crease : once.subdivision->creases) sharpness.push_back(crease.sharpness);
    std::sort(sharpness.begin(), sharpness.end());
    return sharpness;
  };
  EXPECT_EQ(left(CreaseMethod::uniform), (std::vector<double>{2, 2}));
  EXPECT_EQ(left(CreaseMethod::chaikin), (std::vector<double>{0.5, 1.5, 2}));
}

TEST(SubdivisionRules, SmoothTrianglesWeighTheirEdgesPointsOtherwise) {
  // Two triangles over the edge (0,0,0) to (0,3,0): its point is w (centroids) + (1/2 - w) (ends), w = 1/4 as for any
  // face, or 0.470 / 2 + 0.470 / 2 = 0.470 each between triangles that are smooth.
  PolygonMesh cage;
  cage.positions = {{0, 0, 0}, {0, 3, 0}, {-3, 0, 0}, {3, 0, 3}};
  cage.corners = {0, 1, 2, 0, 3, 1};
  const Vec3d centroids = Vec3d(-1, 1, 0) + Vec3d(1, 1, 1), ends(0, 3, 0);
  for (const auto& [rule, weight] : {std::pair(TriangleRule::catmark, 0.25), std::pair(TriangleRule::smooth, 0.470)}) {
    SubdivisionRules rules;
    rules.triangles = rule;
    Warnings warnings;
    const PolygonMesh once = refine_uniformly(cage, rules, 1, RefinedPoints::control, {}, warnings);
    const Vec3d expected = centroids * weight + ends * (0.5 - weight);
    double nearest = 1e9;
    for (const Vec3f& p : once.positions) nearest = std::min(nearest, (Vec3d(p) - expected).length());
    EXPECT_LE(nearest, 1e-6) << weight;
  }
}

TEST(SubdivisionRules, IslandsOfTextureMeetAsTheirRuleSays) {
  // Four quads about a vertex: one island covers two of them, the others have one each. The first one's outline runs
  // through the vertex, as a smooth cubic, (4 p + a + b) / 6, or held there since three islands meet.
  PolygonMesh cage = test::grid_cage(3, 3, 0);
  cage.texture_coordinates = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1.6f}, {2, 1}, {5, 5}, {6, 5}, {6, 6}, {5, 6}};
  cage.texture_corners = {0, 1, 4, 3, 1, 2, 5, 4, 6, 7, 8, 9, 6, 7, 8, 9};
  for (const auto& [rule, expected] :
       {std::pair(FaceVaryingRule::none, 1.4), std::pair(FaceVaryingRule::corners_only, 1.4),
        std::pair(FaceVaryingRule::corners_plus1, 1.6), std::pair(FaceVaryingRule::corners_plus2, 1.6),
        std::pair(FaceVaryingRule::boundaries, 1.6), std::pair(FaceVaryingRule::all, 1.6)}) {
    SubdivisionRules rules;
    rules.face_varying = rule;
    EXPECT_NEAR(double(test::texture_at(*ruled_surface(cage, rules), 0, {1, 1}).y), expected, 1e-5)
        << static_cast<int>(rule);
    // The corner of an island of one face: rounded, (4 p + a + b) / 6, where no rule holds it.
    EXPECT_NEAR(double(test::texture_at(*ruled_surface(cage, rules), 2, {0, 0}).x),
                rule == FaceVaryingRule::none ? 5 + 1.0 / 6 : 5, 1e-5);
  }
}

TEST(SubdivisionRules, SharpSidesAndCornersAreThoseOfCreasesAndBoundaries) {
  const PolygonMesh cage = test::grid_cage(5, 5, 1);
  SubdivisionRules rules;
  rules.creases = {{{10, 11, 12}, kInfiniteSharpness}, {{17, 18}, 3}};  // from the boundary to a dart; a semi-sharp one
  const auto surface = ruled_surface(cage, rules);
  std::size_t sharp_sides = 0, sides = 0;
  for (std::size_t face = 0; face < surface->face_count(); ++face) {
    const std::span<const FaceEdge> around = surface->sides(face);
    for (std::size_t i = 0; i < around.size(); ++i, ++sides) {
      const std::uint32_t a = around[i].vertex, b = around[(i + 1) % around.size()].vertex;
      const auto on_boundary = [](std::uint32_t v) { return v % 5 == 0 || v % 5 == 4 || v < 5 || v >= 20; };
      const auto same_side = [&] {
        return (a < 5 && b < 5) || (a >= 20 && b >= 20) || (a % 5 == 0 && b % 5 == 0) || (a % 5 == 4 && b % 5 == 4);
      };
      const bool creased = std::max(a, b) <= 12 && std::min(a, b) >= 10 && a + 1 <= b + 2 && b + 1 <= a + 2;
      EXPECT_EQ(around[i].sharp_edge, same_side() || creased) << a << " to " << b;
      // A dart's end is smooth: normals of both sides agree there.
      EXPECT_EQ(around[i].sharp_vertex, on_boundary(a) || a == 11) << a;
      sharp_sides += around[i].sharp_edge;
    }
  }
  EXPECT_EQ(sides, 64u);
  EXPECT_EQ(sharp_sides, 16u + 4);
}

TEST(SubdivisionRules, WhatIsKeptOfPatchesChangesNoBit) {
  const PolygonMesh star = test::star_cage(5);
  const auto kept = ruled_surface(star, {}), derived = ruled_surface(star, {}, 0);
  for (std::size_t face = 0; face < kept->face_count(); ++face) {
    if (kept->sides(face).empty()) continue;
    for (const Vec2d& at : {Vec2d(0, 0), Vec2d(0.01, 0.02), Vec2d(0.3, 0.7), Vec2d(1, 0.5)}) {
      const SurfaceSample a = test::sample_at(*kept, face, at), b = test::sample_at(*derived, face, at);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
  }
}

}  // namespace
}  // namespace raytree
