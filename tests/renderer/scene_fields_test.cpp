// The tables of scene files hold every member of the description.
#include "renderer/scene_fields.h"

#include <gtest/gtest.h>

namespace raytree {
namespace {

/// How many keys a table holds.
struct Counter {
  int count = 0;
  void operator()(const Field& field, const auto&) {
    EXPECT_FALSE(field.key.empty());
    EXPECT_FALSE(field.text.empty()) << field.key;
    EXPECT_FALSE(field.text.ends_with('.')) << field.key;
    ++count;
  }
  void tagged(const Field&, const auto&) { ++count; }
  void inlined(const MeshShape&) { ++count; }
};

// Every member of every struct stands in a table, apart from those that a file gives in another way. The structured
// bindings of scene_equality.h stop compiling when a member is added; these counts then say whether its table knows it.
TEST(SceneFields, TablesHoldEveryMember) {
  const auto count = [](const auto& object) {
    Counter counter;
    visit_fields(counter, object);
    return counter.count;
  };
  EXPECT_EQ(count(ImageDescription{}), 2);
  EXPECT_EQ(count(RenderSettings{}), 13);
  EXPECT_EQ(count(TessellationSettings{}), 2);
  EXPECT_EQ(count(FacetSettings{}), 3);
  EXPECT_EQ(count(Smoothing{}), 3);
  EXPECT_EQ(count(AdaptiveSampling{}), 3);
  EXPECT_EQ(count(CameraDescription{}), 7 - 1) << "without name";
  EXPECT_EQ(count(ConstantBackground{}), 1);
  EXPECT_EQ(count(GradientBackground{}), 3);
  EXPECT_EQ(count(DirectionalLight{}), 1);
  EXPECT_EQ(count(PointLight{}), 3);
  EXPECT_EQ(count(SpotLight{}), 6);
  EXPECT_EQ(count(LightDescription{}), 3 - 1) << "without name";
  EXPECT_EQ(count(CheckerPattern{}), 7);
  EXPECT_EQ(count(StripesPattern{}), 8);
  EXPECT_EQ(count(NoisePattern{}), 10);
  EXPECT_EQ(count(BumpDescription{}), 9);
  EXPECT_EQ(count(AngleWeight{}), 2);
  EXPECT_EQ(count(HighlightDescription{}), 3);
  EXPECT_EQ(count(MaterialDescription{}), 15 - 1 + 1) << "without name, with \"from\"";
  EXPECT_EQ(count(FaceGroup{}), 4);
  EXPECT_EQ(count(MeshShape{}), 5);
  EXPECT_EQ(count(SubdivisionRules{}), 9);
  EXPECT_EQ(count(Crease{}), 2);
  EXPECT_EQ(count(SharpCorner{}), 2);
  EXPECT_EQ(count(InlineMesh{}), 9 - 1) << "PolygonMesh keeps sizes and corners apart";
  EXPECT_EQ(count(PatchesShape{}), 9);
  EXPECT_EQ(count(SphereShape{}), 4);
  EXPECT_EQ(count(PlaneShape{}), 2);
  EXPECT_EQ(count(DiscShape{}), 4);
  EXPECT_EQ(count(ConeShape{}), 6);
  EXPECT_EQ(count(TerrainShape{}), 5);
  EXPECT_EQ(count(SphereFlakeShape{}), 3);
  EXPECT_EQ(count(TreeShape{}), 6);
  EXPECT_EQ(count(InstanceShape{}), 1);
  EXPECT_EQ(count(ScatterShape{}), 12);
  EXPECT_EQ(count(GroupDescription{}), 3 - 2) << "without name and where";
  EXPECT_EQ(count(ShapeDescription{}), 9 - 2) << "without name and where";
  EXPECT_EQ(count(SceneDescription{}), 12 - 2 + 1) << "without name and folder, with the version";
}

}  // namespace
}  // namespace raytree
