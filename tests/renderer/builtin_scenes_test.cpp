// The scenes that come with the program: they read, they round-trip, and they are what their names promise.
#include "renderer/builtin_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "renderer/scene.h"
#include "renderer/scene_reader.h"

namespace raytree {
namespace {

TEST(BuiltinScenes, AllReadAndRoundTrip) {
  const auto scenes = builtin_scenes();
  std::vector<std::string> names;
  for (const BuiltinScene& scene : scenes) {
    names.push_back(scene.name);
    EXPECT_FALSE(scene.summary.empty()) << scene.name;
    const SceneDescription description = builtin_scene(scene.name);
    EXPECT_FALSE(description.cameras.empty()) << scene.name;
    EXPECT_FALSE(description.shapes.empty()) << scene.name;
    const std::string text = write_scene(description);
    EXPECT_EQ(write_scene(read_scene(text, scene.name, "")), text) << scene.name;
  }
  for (const char* name : {"spheres-1980", "sphere-flake", "terrain", "forest", "stepwedge", "mirrors", "lens", "glass"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(BuiltinScenes, AreTheFilesOfTheSourceTreeByteForByte) {
  for (const EmbeddedScene& scene : embedded_scenes()) {
    std::ifstream file(std::string(RAYTREE_SOURCE_DIR) + "/scenes/" + std::string(scene.name) + ".json");
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_EQ(text.str(), scene.json) << scene.name;
  }
}

TEST(BuiltinScenes, AnUnknownNameListsTheChoices) {
  try {
    builtin_scene("sphere-1980");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    const std::string message = error.what();
    EXPECT_NE(message.find("stepwedge"), message.npos) << message;
    EXPECT_NE(message.find("did you mean \"spheres-1980\"?"), message.npos) << message;
  }
  EXPECT_TRUE(is_builtin_scene("terrain"));
  EXPECT_FALSE(is_builtin_scene("terrain.json"));
}

TEST(BuiltinScenes, WhittedsPictureHasAGlassAndAMirrorSphereOverAFiniteChecker) {
  const SceneDescription scene = builtin_scene("spheres-1980");
  const auto material_of = [&](const ShapeDescription& shape) {
    for (const MaterialDescription& material : scene.materials)
      if (material.name == shape.material) return material;
    return MaterialDescription{};
  };
  int glass = 0, mirror = 0, checker = 0;
  for (const ShapeDescription& shape : scene.shapes) {
    const MaterialDescription material = material_of(shape);
    if (std::holds_alternative<SphereShape>(shape.kind) && max_channel(material.transmission) > 0.5f) ++glass;
    if (std::holds_alternative<SphereShape>(shape.kind) && is_black(material.transmission) &&
        max_channel(material.reflection) > 0.5f)
      ++mirror;
    if (std::holds_alternative<MeshShape>(shape.kind) && std::holds_alternative<CheckerPattern>(material.diffuse))
      ++checker;
  }
  EXPECT_EQ(glass, 1);
  EXPECT_EQ(mirror, 1);
  EXPECT_EQ(checker, 1);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.image.width, 960);
  EXPECT_EQ(scene.image.height, 720);
  EXPECT_EQ(scene.render.antialias.grid_size, 3);
}

TEST(BuiltinScenes, TheForestIsThousandsOfInstancesOfAFewTreesOnTheGround) {
  Warnings warnings;
  PrepareOptions options;
  options.build = false;
  const Scene scene = prepare(builtin_scene("forest"), options, warnings);
  EXPECT_GT(scene.summary.instances, 10'000u);
  EXPECT_EQ(scene.summary.groups.size(), 6u);
  std::uint64_t unique = 0, seen = 0;
  for (const GroupSummary& group : scene.summary.groups)
    for (const ShapeSummary& shape : group.shapes) unique += shape.triangles;
  for (const ShapeSummary& shape : scene.summary.shapes) seen += shape.instanced_triangles;
  EXPECT_LT(unique, 250'000u);
  EXPECT_GT(seen, 300'000'000u);
  // Nothing stands in the lake.
  const float lake = 22;
  for (const Instance& tree : scene.shapes->instances) EXPECT_GT(tree.to_scene[3][1] + scene.shapes->origin.y, lake);
}

// Phong 1973, App. I: the first table's shade n halves from square to square, the second's falls in equal steps. Lit by
// ambient light 1 alone, a patch sends out its ambient coefficient.
TEST(BuiltinScenes, StepwedgeHoldsPhongsTwoTables) {
  const SceneDescription scene = builtin_scene("stepwedge");
  EXPECT_EQ(scene.ambient, Rgb(1.0f));
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.cameras.at(0).projection, CameraDescription::Projection::orthographic);
  ASSERT_EQ(scene.materials.size(), 18u);
  ASSERT_EQ(scene.shapes.size(), 18u);
  for (int i = 0; i < 9; ++i) {
    const auto shade = [&](int index) {
      const MaterialDescription& material = scene.materials.at(static_cast<std::size_t>(index));
      EXPECT_EQ(std::get<Rgb>(material.diffuse), Rgb());
      EXPECT_EQ(scene.shapes.at(static_cast<std::size_t>(index)).material, material.name);
      return std::get<Rgb>(material.ambient.value());
    };
    EXPECT_EQ(shade(i), Rgb(std::ldexp(1.0f, -i)));
    EXPECT_EQ(shade(9 + i), Rgb(1 - static_cast<float>(i) / 8));
  }
}

}  // namespace
}  // namespace raytree
