// --set: single values of a scene by their path; what is refused, in which words, and that it changes nothing.
#include <gtest/gtest.h>

#include "renderer/scene_reader.h"
#include "tests/renderer/scene_equality.h"

namespace raytree {
namespace {

SceneDescription full_scene() {
  return read_scene(R"({"raytree": 1,
    "title": "full",
    "background": {"type": "gradient", "bottom": 0.1, "horizon": [0.2, 0.3, 0.4], "top": 0.5},
    "cameras": {"main": {"position": [0, 1, 5]}, "top.view": {"position": [0, 5, 0], "up": [0, 0, -1]}},
    "lights": {"sun": {"type": "directional", "direction": [0, -1, -1]},
               "lamp": {"type": "point", "position": [1, 2, 3]}},
    "materials": {"glass": {"transmission": 0.9}, "a.b": {"diffuse": {"type": "checker"}}, "a": {}},
    "shapes": {"ball": {"type": "sphere", "material": "glass"},
               "floor": {"type": "mesh", "material": "a.b",
                         "positions": [[0, 0, 0], [1, 0, 0], [1, 0, -1], [0, 0, -1]], "faces": [[0, 1, 2, 3]]},
               "land": {"type": "terrain"}, "file": {"type": "mesh", "file": "bunny.obj"}}})",
                    "s.json", "folder");
}

std::string set_refusal(const std::string& path, const std::string& value) {
  SceneDescription scene = full_scene();
  try {
    set_scene_value(scene, path, value);
  } catch (const Error& error) {
    EXPECT_EQ(error.where().file, "--set");
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_TRUE(test::equal(scene, full_scene())) << "a refused value changes nothing";
    return error.what();
  }
  return "accepted";
}

TEST(SetSceneValue, ReachesEveryKindOfValue) {
  SceneDescription scene = full_scene();
  set_scene_value(scene, "title", "1980");
  EXPECT_EQ(scene.title, "1980");
  set_scene_value(scene, "render.depth", "12");
  EXPECT_EQ(scene.render.depth, 12);
  set_scene_value(scene, "render.antialias", "grid:4");
  EXPECT_EQ(scene.render.antialias.grid_size, 4);
  set_scene_value(scene, "render.highlights", "\"halfway\"");
  EXPECT_EQ(scene.render.highlights, HighlightForm::halfway);
  set_scene_value(scene, "ambient", "[0.1, 0.2, 0.3]");
  set_scene_value(scene, "ambient[1]", "0.5");
  EXPECT_EQ(scene.ambient, Rgb(0.1f, 0.5f, 0.3f));
  set_scene_value(scene, "materials.glass.diffuse", "0.25");
  EXPECT_EQ(std::get<Rgb>(scene.materials[0].diffuse), Rgb(0.25f));
  set_scene_value(scene, "materials.glass.diffuse.2", "0.75");
  EXPECT_EQ(std::get<Rgb>(scene.materials[0].diffuse), Rgb(0.25f, 0.25f, 0.75f));
  set_scene_value(scene, "materials.glass.index_of_refraction", "1.33");
  EXPECT_EQ(scene.materials[0].index_of_refraction, 1.33);
  set_scene_value(scene, "materials.glass.highlight.exponent", "50");
  EXPECT_EQ(scene.materials[0].highlight.exponent, 50);
  set_scene_value(scene, "materials.glass.ambient.type", "checker");
  EXPECT_TRUE(std::holds_alternative<CheckerPattern>(scene.materials[0].ambient.value()));
  set_scene_value(scene, "lights.sun.color", "2");
  EXPECT_EQ(scene.lights[0].color, Rgb(2.0f));
  set_scene_value(scene, "lights.sun.direction[2]", "-3");
  EXPECT_EQ(std::get<DirectionalLight>(scene.lights[0].kind).direction, Vec3d(0, -1, -3));
  set_scene_value(scene, "cameras.main.position", "[1, 2, 3]");
  EXPECT_EQ(scene.cameras[0].position, Vec3d(1, 2, 3));
  set_scene_value(scene, "shapes.floor.material", "glass");
  EXPECT_EQ(scene.shapes[1].material, "glass");
  set_scene_value(scene, "shapes.land.triangles", "10000000");
  EXPECT_EQ(std::get<TerrainShape>(scene.shapes[2].kind).triangles, 10'000'000);
  set_scene_value(scene, "shapes.ball.transform", R"({"translate": [0, 2, 0]})");
  EXPECT_EQ(Vec3d(0, 0, 0) * scene.shapes[0].transform, Vec3d(0, 2, 0));
  set_scene_value(scene, "shapes.file.file", "dragon.ply");
  EXPECT_EQ(std::get<MeshShape>(scene.shapes[3].kind).file, "dragon.ply");
  set_scene_value(scene, "shapes.floor.faces", "[[0, 1, 2]]");
  EXPECT_EQ(std::get<MeshShape>(scene.shapes[1].kind).mesh->face_count(), 1u);
  set_scene_value(scene, "lights.lamp", R"({"type": "directional", "color": 3})");
  EXPECT_TRUE(std::holds_alternative<DirectionalLight>(scene.lights[1].kind));
  EXPECT_EQ(scene.lights[1].name, "lamp");
}

TEST(SetSceneValue, ATypeResetsItsVariant) {
  SceneDescription scene = full_scene();
  set_scene_value(scene, "background.type", "constant");
  EXPECT_EQ(std::get<ConstantBackground>(scene.background).color, Rgb());
  set_scene_value(scene, "background.color", "1");
  EXPECT_EQ(std::get<ConstantBackground>(scene.background).color, Rgb(1.0f));
  set_scene_value(scene, "lights.sun.type", "point");
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].kind).position, PointLight{}.position);
}

TEST(SetSceneValue, NamesWithDotsAreMatchedLongestFirstOrQuoted) {
  SceneDescription scene = full_scene();
  set_scene_value(scene, "materials.a.b.diffuse.size", "3");
  EXPECT_EQ(std::get<CheckerPattern>(scene.materials[1].diffuse).size, 3);
  set_scene_value(scene, "materials.\"a.b\".diffuse.plane", "uv");
  EXPECT_EQ(std::get<CheckerPattern>(scene.materials[1].diffuse).plane, CheckerPattern::Plane::uv);
  set_scene_value(scene, "materials.a.reflection", "0.5");
  EXPECT_EQ(scene.materials[2].reflection, Rgb(0.5f));
  set_scene_value(scene, "cameras.top.view.height", "3");
  EXPECT_EQ(scene.cameras[1].height, 3);
}

TEST(SetSceneValue, RefusalsNameThePathAndTheChoices) {
  EXPECT_EQ(set_refusal("materials.glas.diffuse", "1"),
            "--set: materials: unknown material \"glas\"; known materials: glass, a.b, a (did you mean \"glass\"?)");
  EXPECT_EQ(set_refusal("materials.glass.colour", "1")
                .rfind("--set: materials.glass: unknown key \"colour\"; known keys: ", 0),
            0u);
  EXPECT_EQ(set_refusal("rendr.depth", "1").rfind("--set: unknown key \"rendr\"; known keys: raytree, title, image", 0),
            0u);
  EXPECT_EQ(set_refusal("render.depth", "deep"), "--set: render.depth: expected a whole number, not \"deep\"");
  EXPECT_EQ(set_refusal("render.depth", "0"),
            "--set: render.depth: 0 is out of range: must be at least 1 and at most 1000000");
  EXPECT_EQ(set_refusal("render.depth.x", "1"), "--set: render.depth: has no part \"x\"; set it as a whole");
  EXPECT_EQ(set_refusal("background.color", "1"),
            "--set: background: unknown key \"color\"; known keys: type, bottom, horizon, top");
  EXPECT_NE(set_refusal("background.type", "sky").find("known types: constant, gradient"), std::string::npos);
  EXPECT_NE(
      set_refusal("shapes.ball.material", "gold").find("unknown material \"gold\"; materials of this scene: glass"),
      std::string::npos);
  EXPECT_NE(set_refusal("ambient[3]", "1").find("they are [0] to [2]"), std::string::npos);
  EXPECT_NE(set_refusal("ambient[-1]", "1").find("they are [0] to [2]"), std::string::npos);
  EXPECT_NE(set_refusal("ambient[1", "1").find("they are [0] to [2]"), std::string::npos);
  EXPECT_NE(set_refusal("cameras.main.up", "[0, 0, 0]").find("must not be (0, 0, 0)"), std::string::npos);
  EXPECT_NE(set_refusal("cameras.main.target", "[0, 1, 5]").find("same point"), std::string::npos);
  EXPECT_NE(set_refusal("shapes.floor.faces", "[[0, 1, 9]]").find("index 9 is out of range"), std::string::npos);
  EXPECT_NE(set_refusal("shapes.file.faces", "[[0, 1, 2]]").find("comes from a file"), std::string::npos);
  EXPECT_NE(set_refusal("materials.glass.ambient.size", "1").find("set it as a whole first"), std::string::npos);
  EXPECT_NE(set_refusal("materials.glass.diffuse.size", "1").find("set \"type\" first"), std::string::npos);
  for (const char* path : {"", ".", "..", "[", "[0]", "materials", "materials.", "materials..x", "\"", "shapes.\"",
                           "render.", "lights.sun.type.x", "image[0]"})
    EXPECT_NE(set_refusal(path, "1"), "accepted") << path;
}

}  // namespace
}  // namespace raytree
