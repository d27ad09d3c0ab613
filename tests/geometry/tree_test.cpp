// Generated trees: their counts in closed form, their shape within what was asked for, the same on every call.
#include "geometry/tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/error.h"

namespace raytree {
namespace {

TreeParameters parameters(TreeForm form, std::int64_t leaves = 5000, std::uint32_t seed = 7) {
  return {form, 10, leaves, 0.3, seed};
}

void expect_sound(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const std::uint32_t corner : mesh.corners) ASSERT_LT(corner, mesh.positions.size());
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  for (const Vec3f& n : mesh.normals) ASSERT_NEAR(n.length(), 1, 1e-5);
}

Vec3f face_normal(const TriangleMesh& mesh, std::size_t t) {
  const auto at = [&](std::size_t c) { return mesh.positions[mesh.corners[3 * t + c]]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

TEST(Tree, HasTheTrianglesOfItsClosedForm) {
  // 2 (1 x 8 x 10 + 8 x 6 x 7 + 40 x 4 x 5 + 200 x 3 x 4) and 2 (1 x 12 x 9 + 96 x 5 x 4).
  EXPECT_EQ(tree_wood_triangles(TreeForm::broadleaf), 7232);
  EXPECT_EQ(tree_wood_triangles(TreeForm::conifer), 4056);
  for (const TreeForm form : {TreeForm::broadleaf, TreeForm::conifer})
    for (const std::int64_t leaves : {1, 2, 999, 5000}) {
      const TriangleMesh wood = make_tree_wood(parameters(form, leaves)),
                         crown = make_tree_leaves(parameters(form, leaves));
      EXPECT_EQ(static_cast<std::int64_t>(wood.triangle_count()), tree_wood_triangles(form));
      EXPECT_EQ(static_cast<std::int64_t>(crown.triangle_count()), tree_leaf_triangles(leaves));
      EXPECT_EQ(crown.positions.size(), 4u * static_cast<std::size_t>(leaves));
      expect_sound(wood);
      expect_sound(crown);
    }
}

TEST(Tree, StandsOnItsFootAndIsAsTallAsAsked) {
  for (const TreeForm form : {TreeForm::broadleaf, TreeForm::conifer})
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const TriangleMesh wood = make_tree_wood(parameters(form, 5000, seed)),
                         crown = make_tree_leaves(parameters(form, 5000, seed));
      float lowest = 1e9f, highest = -1e9f, reach = 0;
      for (const TriangleMesh* mesh : {&wood, &crown})
        for (const Vec3f& p : mesh->positions) {
          lowest = std::min(lowest, p.y), highest = std::max(highest, p.y);
          reach = std::max(reach, std::hypot(p.x, p.z));
        }
      EXPECT_GT(lowest, -0.1f) << seed;
      EXPECT_GT(highest, 8.0f) << seed;
      EXPECT_LT(highest, 13.5f) << seed;
      EXPECT_GT(reach, 1.5f) << seed;
      EXPECT_LT(reach, 8.5f) << seed;
    }
}

TEST(Tree, FacesAgreeWithTheirNormals) {
  for (const TreeForm form : {TreeForm::broadleaf, TreeForm::conifer})
    for (const bool wood : {true, false}) {
      const TriangleMesh mesh = wood ? make_tree_wood(parameters(form)) : make_tree_leaves(parameters(form));
      std::size_t agree = 0;
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        agree += face_normal(mesh, t).dot(mesh.normals[mesh.corners[3 * t]]) > 0;
      // Sharp bends of thin twigs, and leaves seen edge on from the crown's middle, may disagree.
      EXPECT_GT(static_cast<double>(agree), 0.97 * static_cast<double>(mesh.triangle_count()))
          << (form == TreeForm::conifer ? "conifer " : "broadleaf ") << (wood ? "wood" : "leaves");
    }
}

TEST(Tree, IsTheSameOnEveryCallAndAnotherForAnotherSeed) {
  const TriangleMesh a = make_tree_leaves(parameters(TreeForm::conifer)),
                     b = make_tree_leaves(parameters(TreeForm::conifer)),
                     c = make_tree_leaves(parameters(TreeForm::conifer, 5000, 8));
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_NE(a.positions, c.positions);
}

// Scenes show the same trees whatever the compiler: draws in one expression would come in the order of its choice, and
// move these middles by hundredths of the height.
TEST(Tree, IsTheSameWithEveryCompiler) {
  struct GrownTree {
    TreeForm form;
    Vec3d wood, leaves;  ///< means of the vertices, found with g++ 12 and clang 14
  };
  for (const GrownTree& c :
       {GrownTree{TreeForm::broadleaf, {0.528398, 8.023630, 0.366751}, {0.415431, 8.070475, 0.618465}},
        GrownTree{TreeForm::conifer, {-0.022230, 5.712110, 0.033224}, {-0.008472, 4.485901, 0.049523}}}) {
    const auto expect_middle = [](const TriangleMesh& mesh, const Vec3d& expected) {
      Vec3d middle(0, 0, 0);
      for (const Vec3f& p : mesh.positions) middle += Vec3d(p) / static_cast<double>(mesh.positions.size());
      EXPECT_LT((middle - expected).length(), 2e-6) << middle.x << " " << middle.y << " " << middle.z;
    };
    expect_middle(make_tree_wood(parameters(c.form, 300)), c.wood);
    expect_middle(make_tree_leaves(parameters(c.form, 300)), c.leaves);
  }
}

TEST(Tree, RefusesWhatCannotBe) {
  const auto refused = [](TreeParameters p) {
    try {
      make_tree_leaves(p);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  TreeParameters p = parameters(TreeForm::broadleaf);
  p.height = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(p).find("height must be from"), std::string::npos);
  p = parameters(TreeForm::broadleaf);
  p.leaf_size = 0;
  EXPECT_NE(refused(p).find("leaf_size must be from"), std::string::npos);
  p = parameters(TreeForm::broadleaf, 0);
  EXPECT_NE(refused(p).find("leaves must be from 1"), std::string::npos);
}

}  // namespace
}  // namespace raytree
