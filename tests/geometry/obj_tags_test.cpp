// OpenSubdiv's tags in OBJ text: what each says, how holes follow faces that are dropped, and what is refused.
#include "geometry/obj_tags.h"

#include <gtest/gtest.h>

#include "geometry/obj_reader.h"
#include "tests/reader_checks.h"

namespace raytree {
namespace {

const std::string kSquares =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"  // line 6
    "f 1 2 5 4\nf 2 3 6 5\n";                                 // line 8

PolygonMesh read_cage(const std::string& text, Warnings& warnings) { return read_obj(text, "cage.obj", warnings); }

TEST(ObjTags, AreRead) {
  Warnings warnings;
  const PolygonMesh mesh =
      read_cage(kSquares +
                    "t crease 2/1/0 1 4 2.5\nt crease 4/2/0 0 1 1 2 3 10 # two edges\nt corner 2/1/0 0 5 inf\n"
                    "t hole 1/0/0 1\nt interpolateboundary 1/0/0 1\nt facevaryinginterpolateboundary 1/0/0 3\n"
                    "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n",
                warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_TRUE(mesh.subdivision);
  const SubdivisionRules& rules = *mesh.subdivision;
  ASSERT_EQ(rules.creases.size(), 3u);
  EXPECT_EQ(rules.creases[0].vertices, (std::vector<std::uint32_t>{1, 4}));
  EXPECT_EQ(rules.creases[0].sharpness, 2.5);
  EXPECT_EQ(rules.creases[2].vertices, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(rules.creases[2].sharpness, 10);
  ASSERT_EQ(rules.corners.size(), 2u);
  EXPECT_EQ(rules.corners[1].vertex, 5u);
  EXPECT_EQ(rules.holes, std::vector<std::uint32_t>{1});
  EXPECT_EQ(rules.boundary, BoundaryRule::edge_and_corner);
  EXPECT_EQ(rules.face_varying, FaceVaryingRule::corners_plus2);
  EXPECT_EQ(rules.crease_method, CreaseMethod::chaikin);
  EXPECT_EQ(rules.triangles, TriangleRule::smooth);
  EXPECT_FALSE(rules.scheme);
  EXPECT_FALSE(read_cage(kSquares, warnings).subdivision);
}

TEST(ObjTags, HolesFollowTheirFaces) {
  Warnings warnings;
  const std::string text = "f 1 1 2\n" + kSquares + "t hole 3/0/0 0 1 2\n";
  const PolygonMesh mesh = read_cage("v 5 5 5\n" + text, warnings);
  EXPECT_EQ(test::found_warning(warnings, "fewer than three"), "2 x1");
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.subdivision->holes, (std::vector<std::uint32_t>{0, 1}));
}

TEST(ObjTags, EditsAndUnknownNamesAreCounted) {
  Warnings warnings;
  const PolygonMesh mesh = read_cage(kSquares +
                                         "t vertexedit 16/4/3 3 4 1 0\nt edgeedit whatever\nt faceedit\n"
                                         "t tattoo 1/0/0 2\n",
                                     warnings);
  EXPECT_FALSE(mesh.subdivision);
  EXPECT_EQ(test::found_warning(warnings, "hierarchical"), "9 x3");
  EXPECT_EQ(test::found_warning(warnings, "unknown names"), "12 x1");
}

TEST(ObjTags, DamagedOnesAreRefusedAtTheirLine) {
  Warnings warnings;
  const std::pair<const char*, const char*> cases[] = {
      {"t crease", "three counts"},
      {"t crease 2/1 0 1 2", "three counts"},
      {"t crease -2/1/0 0 1 2", "three counts"},
      {"t crease 2/1/0 0 1", "fewer values"},
      {"t crease 2/1/0 0 1 2 3", "more values"},
      {"t crease 2/1/0 0 x 2", "not an integer"},
      {"t crease 2/1/0 0 1 sharp", "not a number"},
      {"t crease 3/1/0 0 1 2 2", "pairs"},
      {"t crease 0/1/0 2", "pairs"},
      {"t crease 2/1/0 0 6 2", "vertex 6; there are 6"},
      {"t crease 2/1/0 -1 1 2", "vertex -1"},
      {"t crease 2/1/0 1 1 2", "itself"},
      {"t crease 2/1/0 0 1 -2", "0 or larger"},
      {"t crease 2/1/0 0 1 nan", "0 or larger"},
      {"t crease 2/0/0 0 1", "one sharpness"},
      {"t crease 999999999999/1/0 0 1 2", "fewer values"},
      {"t corner 1/1/0 6 2", "vertex 6"},
      {"t hole 1/0/0 2", "face 2; there are 2"},
      {"t interpolateboundary 1/0/0 3", "0 none"},
      {"t interpolateboundary 0/0/0", "0 none"},
      {"t facevaryinginterpolateboundary 1/0/0 6", "corners only"},
      {"t creasemethod 0/0/1 catmark", "chaikin"},
      {"t smoothtriangles 0/0/0", "smooth"},
  };
  for (const auto& [tag, part] : cases) {
    SCOPED_TRACE(tag);
    test::expect_refusal([&, line = tag] { read_cage(kSquares + line + "\n", warnings); }, "cage.obj", 9, part);
  }
}

TEST(ObjTags, SurviveDamage) {
  const std::string good = kSquares + "t crease 2/1/0 1 4 2.5\nt corner 2/1/0 0 5 3\nt hole 1/0/0 1\n";
  test::read_damaged_copies(good, 2000, [](const std::string& text) {
    Warnings warnings;
    read_obj(text, "cage.obj", warnings);
  });
}

}  // namespace
}  // namespace raytree
