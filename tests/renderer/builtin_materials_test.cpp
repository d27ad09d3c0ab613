// Phong's materials: the numbers of Appendix II, and the key "from".
#include "renderer/builtin_materials.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/error.h"
#include "renderer/material.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/scene_equality.h"

namespace raytree {
namespace {

TEST(BuiltinMaterials, HaveTheNumbersOfAppendixII) {
  const std::map<std::string, double> reflectances{
      {"phong-white", .80},        {"phong-red-purple", .16}, {"phong-red", .20},
      {"phong-orange", .38},       {"phong-yellow", .60},     {"phong-violet", .14},
      {"phong-yellow-green", .46}, {"phong-green", .32},      {"phong-blue", .23}};
  for (const auto& [name, reflectance] : reflectances) {
    const MaterialDescription* material = builtin_material(name);
    ASSERT_NE(material, nullptr) << name;
    const Rgb c = std::get<Rgb>(material->diffuse);
    EXPECT_NEAR(0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b, reflectance, 1e-6) << name;
    EXPECT_LE(max_channel(c), 1) << name;
    EXPECT_EQ(material->highlight.weight, Rgb(0.2f));
    EXPECT_EQ(material->highlight.exponent, 2);
  }
  EXPECT_EQ(builtin_material("phong-white-paint")->highlight.weight, Rgb(0.1f));
  EXPECT_EQ(builtin_material("phong-white-paint")->highlight.exponent, 2);
  EXPECT_EQ(builtin_material("phong-aluminum-paint")->highlight.weight, Rgb(0.6f));
  EXPECT_EQ(builtin_material("phong-aluminum-paint")->highlight.exponent, 4);
  const HighlightDescription& metal = builtin_material("phong-polished-metal")->highlight;
  ASSERT_EQ(metal.weight_by_angle.size(), 2u);
  EXPECT_EQ(metal.weight_by_angle[0].angle, 0);
  EXPECT_EQ(metal.weight_by_angle[0].weight, Rgb(0.6f));
  EXPECT_EQ(metal.weight_by_angle[1].angle, 90);
  EXPECT_EQ(metal.weight_by_angle[1].weight, Rgb(0.8f));
  EXPECT_EQ(metal.exponent, 6);
  EXPECT_EQ(builtin_materials().size(), reflectances.size() + 3);
  for (const BuiltinMaterial& material : builtin_materials()) EXPECT_EQ(material_problem(material.description), "");
}

TEST(BuiltinMaterials, GiveTheValuesThatNoOtherKeyGives) {
  const auto read = [](const std::string& material) {
    return read_scene("{\"raytree\": 1, \"materials\": {\"mine\": " + material + "}}", "s.json", "").materials.at(0);
  };
  MaterialDescription expected = *builtin_material("phong-red");
  expected.name = "mine";
  EXPECT_TRUE(test::equal(read(R"({"from": "phong-red"})"), expected));
  expected.reflection = Rgb(0.1f);
  expected.highlight.exponent = 9;
  // Wherever "from" stands among the keys.
  EXPECT_TRUE(test::equal(read(R"({"reflection": 0.1, "from": "phong-red", "highlight": {"exponent": 9}})"), expected));
  // What is written means the same by itself.
  SceneDescription scene;
  scene.materials = {expected};
  const std::string text = write_scene(scene);
  EXPECT_EQ(text.find("\"from\""), text.npos);
  EXPECT_TRUE(test::equal(read_scene(text, "w", ""), scene));
  // --set replaces the material's values, and single ones stay settable.
  set_scene_value(scene, "materials.mine.from", "phong-polished-metal");
  EXPECT_EQ(scene.materials[0].highlight.exponent, 6);
  EXPECT_EQ(scene.materials[0].name, "mine");
  set_scene_value(scene, "materials.mine.highlight.exponent", "5");
  EXPECT_EQ(scene.materials[0].highlight.exponent, 5);
  EXPECT_EQ(scene.materials[0].highlight.weight_by_angle.size(), 2u);
}

TEST(BuiltinMaterials, UnknownNamesListTheChoices) {
  for (const char* name : {"\"phong-rde\"", "7", "\"\""}) {
    try {
      read_scene(std::string("{\"raytree\": 1, \"materials\":\n {\"m\": {\"from\":\n ") + name + "}}}", "s.json", "");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("s.json:3: materials.m.from: unknown material"), message.npos) << message;
      EXPECT_NE(message.find("phong-aluminum-paint"), message.npos) << message;
    }
  }
}

TEST(MaterialChecks, NameFileLineAndMaterial) {
  const auto refusal = [](const std::string& material) {
    try {
      read_scene("{\"raytree\": 1, \"materials\":\n {\"m\":\n " + material + "}}", "s.json", "");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal(R"({"conductor": true, "transmission": 0.5})").find("s.json:3: materials.m: a conductor transmits"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"thin": true, "absorption": 1})").find("s.json:3: materials.m: a thin sheet"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"absorption": [0, -1, 0]})").find("out of range"), std::string::npos);
  EXPECT_NE(refusal(R"({"priority": 1.5})").find("whole number"), std::string::npos);
  EXPECT_NE(
      refusal(R"({"highlight": {"weight_by_angle": [{"angle": 95, "weight": 1}]}})").find("weight_by_angle[0].angle"),
      std::string::npos);
  EXPECT_NE(refusal(R"({"highlight": {"weight_by_angle": [{"angle": 5}]}})").find("missing key \"weight\""),
            std::string::npos);
}

}  // namespace
}  // namespace raytree
