// Uniform refinement against the results of OpenSubdiv's older, independent implementation, and the limit of refined
// points against that of the cage.
#include "geometry/subdivision_refinement.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "geometry/mesh_file.h"
#include "geometry/subdivision_surface.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/mesh_expectations.h"
#include "tests/point_sets.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using test::cube_cage;
using test::set_distance;

PolygonMesh refined(const PolygonMesh& mesh, const SubdivisionRules& rules, int levels, RefinedPoints points) {
  Warnings warnings;
  return refine_uniformly(mesh, rules, levels, points, {}, warnings);
}

TEST(SubdivisionRefinement, AgreesWithTheReferenceAsPointSets) {
  const auto files = test::test_data_files("subdiv/hbr_reference");
  if (files.empty()) return;
  int compared = 0;
  double worst = 0;
  for (const auto& path : files) {
    const std::string stem = path.stem().string();  // X_levelK is X after K + 1 refinements
    const std::size_t cut = stem.rfind("_level");
    if (path.extension() != ".obj" || cut == std::string::npos) continue;
    SCOPED_TRACE(stem);
    const auto cage_path = path.parent_path().parent_path() / "osd_shapes" / (stem.substr(0, cut) + ".obj");
    Warnings warnings;
    const PolygonMesh cage = read_mesh_file(cage_path.string(), warnings);
    SubdivisionRules rules = cage.subdivision.value_or(SubdivisionRules{});
    if (stem.starts_with("bilinear")) rules.scheme = SubdivisionScheme::bilinear;
    const PolygonMesh ours = refined(cage, rules, std::stoi(stem.substr(cut + 6)) + 1, RefinedPoints::control);
    const PolygonMesh theirs = read_mesh_file(path.string(), warnings);
    EXPECT_EQ(ours.positions.size(), theirs.positions.size());
    EXPECT_EQ(ours.face_count(), theirs.face_count());
    const double distance = set_distance(ours.positions, theirs.positions);
    EXPECT_LE(distance, 1e-5);
    worst = std::max(worst, distance);
    ++compared;
  }
  std::printf("references compared: %d, largest distance %.1e\n", compared, worst);
  EXPECT_EQ(compared, 52) << "13 shapes at four levels";
}

TEST(SubdivisionRefinement, CubeHasItsClosedForms) {
  const PolygonMesh once = refined(cube_cage(), {}, 1, RefinedPoints::control);
  test::expect_valid(once);
  EXPECT_EQ(once.positions.size(), 26u);
  EXPECT_EQ(once.face_count(), 24u);
  // Catmull and Clark 1978: the corner is (Q + 2 R + S) / 3 with the means of face points, of edge midpoints, and
  // itself: for +-1, 1/3 + 2 (2/3) / 3 + 1) / 3 = 5/9; edge points 3/4 on two axes.
  EXPECT_LE((once.positions[7] - Vec3f(5.0f / 9, 5.0f / 9, 5.0f / 9)).length(), 1e-6f);
  const PolygonMesh limit = refined(cube_cage(), {}, 0, RefinedPoints::limit);
  EXPECT_LE((limit.positions[7] - Vec3f(0.5f, 0.5f, 0.5f)).length(), 1e-6f);
  EXPECT_TRUE(limit.normal_corners.empty());
  EXPECT_LE(test::degrees_between(Vec3d(limit.normals[7]), Vec3d(1, 1, 1).normalized()), 1e-3);
  // The face centers' limit is that of level 1's face points.
  const PolygonMesh fine = refined(cube_cage(), {}, 1, RefinedPoints::limit);
  test::expect_valid(fine);
  float largest = 0;
  for (const Vec3f& p : fine.positions) largest = std::max(largest, p.x);
  EXPECT_NEAR(largest, 68.0f / 81, 1e-6f);
}

TEST(SubdivisionRefinement, LimitOfRefinedPointsIsTheCagesLimit) {
  // Semi-sharp and infinite creases, sharp corners, boundaries, n-gons, holes: what is left of each after refinement
  // must have the same limit. Vertices of the cage keep their numbers' places: the first ones of each level are they.
  PolygonMesh cage = test::grid_cage(5, 5, 2);
  SubdivisionRules rules;
  rules.creases = {{{5, 6, 7, 8, 9}, 2.5}, {{10, 11, 12}, 10}, {{17, 18}, 0.4}};
  rules.corners = {{0, 1.5}, {18, 3}};
  rules.holes = {5};
  for (const auto method : {CreaseMethod::uniform, CreaseMethod::chaikin}) {
    rules.crease_method = method;
    const PolygonMesh coarse = refined(cage, rules, 0, RefinedPoints::limit);
    for (const int levels : {1, 2, 4}) {
      const PolygonMesh fine = refined(cage, rules, levels, RefinedPoints::limit);
      test::expect_valid(fine);
      double worst = 0;
      for (const Vec3f& p : coarse.positions) {
        float best = std::numeric_limits<float>::max();
        for (const Vec3f& q : fine.positions) best = std::min(best, (p - q).length2());
        worst = std::max(worst, std::sqrt(double(best)));
      }
      // Patches of level 9 about semi-sharp features: within 1e-5 of the size, which is 6.
      EXPECT_LE(worst, 6e-5) << levels;
    }
  }
}

TEST(SubdivisionRefinement, KeepsTextureGroupsAndLeavesHolesOut) {
  PolygonMesh cage = test::grid_cage(4, 3, 1);
  for (const Vec3f& p : cage.positions) cage.texture_coordinates.push_back({p.x / 3, p.y / 2});
  cage.groups = {{"left", "red", 0, 1}, {"rest", "", 1, 5}};
  SubdivisionRules rules;
  rules.holes = {1};
  const PolygonMesh fine = refined(cage, rules, 2, RefinedPoints::control);
  test::expect_valid(fine);
  EXPECT_EQ(fine.face_count(), 5u * 16);
  ASSERT_EQ(fine.groups.size(), 2u);
  EXPECT_EQ(fine.groups[0].face_count, 16u);
  EXPECT_EQ(fine.groups[1].face_count, 64u);
  EXPECT_EQ(fine.texture_corners.size(), fine.corners.size());
  // Texture coordinates that are affine in a flat grid's positions stay so inside, by the scheme's affine invariance.
  const PolygonMesh limit = refined(cage, rules, 2, RefinedPoints::limit);
  test::expect_valid(limit);
  SubdivisionRules loop;
  loop.scheme = SubdivisionScheme::loop;
  PolygonMesh tetrahedron;
  tetrahedron.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  tetrahedron.corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const PolygonMesh ball = refined(tetrahedron, loop, 3, RefinedPoints::limit);
  EXPECT_TRUE(ball.all_triangles());
  EXPECT_EQ(ball.face_count(), 256u);
}

TEST(SubdivisionRefinement, ControlPointsOfAMeshWithTagsAreACageWithTags) {
  PolygonMesh cage = test::grid_cage(5, 5, 2);
  SubdivisionRules rules;
  rules.boundary = BoundaryRule::edge_and_corner;
  rules.creases = {{{5, 6, 7, 8, 9}, 2.5}, {{10, 11, 12}, 10}, {{17, 18}, 0.4}};
  rules.corners = {{0, 1.5}, {18, 3}};
  for (const auto method : {CreaseMethod::uniform, CreaseMethod::chaikin}) {
    rules.crease_method = method;
    cage.subdivision = rules;
    const PolygonMesh once = refined(cage, rules, 1, RefinedPoints::control);
    ASSERT_TRUE(once.subdivision);
    EXPECT_EQ(once.subdivision->boundary, BoundaryRule::edge_and_corner);
    const PolygonMesh in_steps = refined(once, *once.subdivision, 2, RefinedPoints::control);
    const PolygonMesh at_once = refined(cage, rules, 3, RefinedPoints::control);
    EXPECT_EQ(in_steps.positions.size(), at_once.positions.size());
    EXPECT_EQ(in_steps.face_count(), at_once.face_count());
    // Control points of the first step are rounded to float: 2^-24 of 5 units and of what sums of them leave.
    EXPECT_LE(set_distance(in_steps.positions, at_once.positions), 2e-6);
    EXPECT_FALSE(refined(cage, rules, 1, RefinedPoints::limit).subdivision) << "points of the limit are no cage";
  }
  EXPECT_FALSE(refined(cube_cage(), {}, 1, RefinedPoints::control).subdivision);
}

TEST(SubdivisionRefinement, RefusesWhatCannotBe) {
  Warnings warnings;
  for (const int levels : {-1, 14, 16})
    EXPECT_THROW(refine_uniformly(cube_cage(), {}, levels, RefinedPoints::control, {}, warnings), Error);
  SubdivisionRules rules;
  rules.holes = {0, 1, 2, 3, 4, 5};
  EXPECT_THROW(refine_uniformly(cube_cage(), rules, 1, RefinedPoints::control, {}, warnings), Error);
}

}  // namespace
}  // namespace raytree
