// Materials that mesh files name: where they are looked up, which triangle gets which, and what the picture shows.
#include "renderer/mesh_materials.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "renderer/mesh_scene.h"
#include "renderer/render.h"
#include "tests/renderer/test_scenes.h"
#include "tests/temporary_folder.h"

namespace raytree {
namespace {

using namespace test;

class MeshMaterialsTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }
  Rgb diffuse_of(const Scene& scene, std::uint32_t triangle) const {
    return scene.materials[scene.material_at({kFirstMeshGeometry, triangle, 0, 0, 1})].diffuse.even;
  }
  /// One shape of the file, without a material of its own unless one is given.
  SceneDescription scene_of(const std::string& file, const std::string& own = "") const {
    SceneDescription scene;
    ShapeDescription shape;
    shape.name = "mesh";
    shape.material = own;
    MeshShape mesh;
    mesh.file = file;
    shape.kind = mesh;
    scene.shapes = {shape};
    return scene;
  }

  TemporaryFolder folder_;
};

// A quad, a triangle, a pentagon and a triangle: 1, 2, 3 and 1 triangles behind each other.
const std::string kFaces =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nf 1 2 3\nusemtl red\nf 1 2 3 4\nusemtl  green \nf 1 2 3 5 4\n"
    "usemtl nowhere\nf 1 2 3\n";

TEST_F(MeshMaterialsTest, EachTriangleHasTheMaterialOfItsFace) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl unused\nKd 0 0 1\n");
  write("b c.mtl", "newmtl green\nKd 0 1 0\nnewmtl red\nKd .5 0 0\n");
  const std::string mesh = write("m.obj", "mtllib a.mtl\nmtllib b c.mtl\n" + kFaces);
  Warnings warnings;
  const Scene scene = prepare(scene_of(mesh), PrepareOptions(), warnings);
  const Rgb plain(0.8f), red(1, 0, 0), green(0, 1, 0);
  const Rgb expected[] = {plain, red, red, green, green, green, plain};
  for (std::uint32_t i = 0; i < 7; ++i) EXPECT_EQ(diffuse_of(scene, i), expected[i]) << i;
  // What nothing uses does not join the scene.
  ASSERT_EQ(scene.description.materials.size(), 2u);
  EXPECT_EQ(scene.summary.shapes[0].file_materials, (std::vector<std::string>{"red", "green"}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].message.find("\"nowhere\""), std::string::npos);
}

TEST_F(MeshMaterialsTest, TheSceneComesBeforeTheLibraryAndAShapesMaterialBeforeBoth) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  const std::string mesh = write("m.obj", "mtllib a.mtl\n" + kFaces);
  Warnings warnings;
  SceneDescription scene = scene_of(mesh);
  scene.materials = {material("green", Rgb(0.25f))};
  EXPECT_EQ(diffuse_of(prepare(scene, PrepareOptions(), warnings), 3), Rgb(0.25f));
  EXPECT_EQ(diffuse_of(prepare(scene, PrepareOptions(), warnings), 1), Rgb(1, 0, 0));
  SceneDescription own = scene_of(mesh, "green");
  own.materials = scene.materials;
  for (std::uint32_t i = 0; i < 7; ++i)
    EXPECT_EQ(diffuse_of(prepare(own, PrepareOptions(), warnings), i), Rgb(0.25f)) << i;
}

TEST_F(MeshMaterialsTest, OneNameInTwoLibrariesOfTwoMeshesIsTwoMaterials) {
  write("a.mtl", "newmtl red\nKd 1 0 0\n");
  write("b.mtl", "newmtl red\nKd .5 0 0\n");
  SceneDescription scene = scene_of(write("a.obj", "mtllib a.mtl\n" + kFaces));
  scene.shapes.push_back(scene_of(write("b.obj", "mtllib b.mtl\n" + kFaces)).shapes[0]);
  scene.shapes[1].name = "second";
  Warnings warnings;
  const Scene made = prepare(scene, PrepareOptions(), warnings);
  EXPECT_EQ(diffuse_of(made, 1), Rgb(1, 0, 0));
  EXPECT_EQ(made.materials[made.material_at({kFirstMeshGeometry + 1, 1, 0, 0, 1})].diffuse.even, Rgb(0.5f, 0, 0));
}

TEST_F(MeshMaterialsTest, ALibraryThatIsNotThereIsAWarningAndADamagedOneAnError) {
  Warnings warnings;
  prepare(scene_of(write("m.obj", "mtllib gone.mtl\n" + kFaces)), PrepareOptions(), warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].message.find("gone.mtl"), std::string::npos);
  EXPECT_EQ(warnings[1].count, 3);  // names that nobody defines
  const std::string damaged = write("bad.mtl", "newmtl red\nKd red\n");
  try {
    prepare(scene_of(write("m.obj", "mtllib bad.mtl\n" + kFaces)), PrepareOptions(), warnings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where().file, damaged);
    EXPECT_EQ(error.where().line, 2);
  }
}

TEST_F(MeshMaterialsTest, InstancesKeepThemUnlessTheyHaveTheirOwn) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  const SceneDescription mesh = scene_of(write("m.obj", "mtllib a.mtl\n" + kFaces));
  SceneDescription scene;
  scene.materials = {material("gray", Rgb(0.5f))};
  scene.groups.push_back({"group", mesh.shapes, {}});
  scene.shapes = {shape(InstanceShape{"group"}, ""), shape(InstanceShape{"group"}, "gray")};
  Warnings warnings;
  const Scene made = prepare(scene, PrepareOptions(), warnings);
  Hit hit{kFirstMeshGeometry, 1, 0, 0, 1};
  hit.instance = 0;
  EXPECT_EQ(made.materials[made.material_at(hit)].diffuse.even, Rgb(1, 0, 0));
  hit.instance = 1;
  EXPECT_EQ(made.materials[made.material_at(hit)].diffuse.even, Rgb(0.5f));
}

TEST_F(MeshMaterialsTest, ABareMeshShowsItsOwnMaterialsWhereItHasSome) {
  const std::string faces = "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nusemtl red\nf 1 2 3 4\n";
  Warnings warnings;
  const auto middle = [&](const std::string& path) {
    SceneDescription scene = mesh_scene(path, warnings, {33, 33});
    scene.render.antialias.method = Antialiasing::Method::none;
    RenderOptions options;
    options.channels = {ChannelGroup::albedo};
    const RenderResult result = render(prepare(std::move(scene), PrepareOptions(), warnings), options);
    const auto at = [&](int c) { return result.film.plane(ChannelGroup::albedo, c)[16 * 33 + 16]; };
    return Rgb(at(0), at(1), at(2));
  };
  const std::string mesh = write("m.obj", "mtllib a.mtl\n" + faces);
  const Rgb clay = middle(mesh);
  EXPECT_GT(clay.r, 0.3f);
  EXPECT_GT(clay.g, 0.0f);
  write("a.mtl", "newmtl red\nKd .75 0 0\n");
  EXPECT_EQ(middle(mesh), Rgb(0.75f, 0, 0));
}

}  // namespace
}  // namespace raytree
