// `raytree info --json`: each feature of the renderer is named where a scene switches it on, and nowhere else; bounds,
// materials and lights; and the memory foretold beside what a render takes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

using InfoJson = nlohmann::json;
using Names = std::set<std::string>;

/// A scene that uses next to nothing: one disc, no light, nothing cut, one sample a pixel.
InfoJson bare_scene() {
  return InfoJson::parse(R"({"raytree": 1, "background": {"type": "constant", "color": 0},
                             "render": {"antialias": "none", "cutoff": 0},
                             "cameras": {"main": {"position": [0, 3, 9], "target": [0, 0, 0]}},
                             "materials": {"m": {}}, "shapes": {"s": {"type": "disc", "material": "m"}}})");
}

InfoJson info_of(const InfoJson& scene, const std::vector<std::string>& flags = {}) {
  TemporaryFolder folder;
  write_text(folder.path("s.json"), scene.dump(2));
  const ProgramResult result = run_program(with({"info", folder.path("s.json"), "--json"}, flags));
  EXPECT_EQ(result.status, 0) << result.err << scene.dump(2);
  return result.status == 0 ? InfoJson::parse(result.out) : InfoJson();
}

struct FeatureCase {
  const char* feature;
  const char* change;  ///< merged into the bare scene: the least that switches the feature on
  Names beside;        ///< other features that come with it: what it is a property of
};

std::vector<FeatureCase> feature_cases() {
  const char* const sun = "shadows";
  return {
      {"reflection", R"({"materials": {"m": {"reflection": 0.5}}})", {}},
      {"refraction", R"({"materials": {"m": {"transmission": 0.5}}})", {}},
      {"cutoff", R"({"render": {"cutoff": 0.01}, "materials": {"m": {"reflection": 0.5}}})", {"reflection"}},
      {"highlights (reflected)", R"({"materials": {"m": {"highlight": {"weight": 0.5}}}})", {}},
      {"highlights (halfway)",
       R"({"render": {"highlights": "halfway"}, "materials": {"m": {"highlight": {"weight": 0.5}}}})",
       {}},
      {"highlights by angle",
       R"({"materials": {"m": {"highlight": {"weight_by_angle": [{"angle": 0, "weight": 0.2},
                                                                 {"angle": 90, "weight": 0.6}]}}}})",
       {"highlights (reflected)"}},
      {"fresnel", R"({"materials": {"m": {"reflection": 0.5, "fresnel": true}}})", {"reflection"}},
      {"conductors", R"({"materials": {"m": {"reflection": 0.5, "conductor": true}}})", {"reflection"}},
      {"thin sheets", R"({"materials": {"m": {"transmission": 0.5, "thin": true}}})", {"refraction"}},
      {"one-sided surfaces", R"({"materials": {"m": {"one_sided": true}}})", {}},
      {"absorption", R"({"materials": {"m": {"transmission": 0.5, "absorption": 0.5}}})", {"refraction"}},
      {"rough surfaces", R"({"materials": {"m": {"reflection": 0.5, "roughness": 0.2}}})", {"reflection"}},
      {"checker patterns", R"({"materials": {"m": {"diffuse": {"type": "checker"}}}})", {}},
      {"stripes", R"({"materials": {"m": {"diffuse": {"type": "stripes"}}}})", {}},
      {"noise", R"({"materials": {"m": {"ambient": {"type": "noise"}}}})", {}},
      {"bumps", R"({"materials": {"m": {"bump": {"kind": "wrinkles"}}}})", {}},
      {"texture coordinates",
       R"({"materials": {"m": {"diffuse": {"type": "checker", "plane": "uv"}}}})",
       {"checker patterns"}},
      {"object spaces",
       R"({"materials": {"m": {"diffuse": {"type": "checker", "space": "object"}}},
           "shapes": {"s": {"transform": {"translate": [0, 1, 0]}}}})",
       {"checker patterns"}},
      {"media by priority",
       R"({"materials": {"m": {"transmission": 0.5, "priority": 1}, "n": {"transmission": 0.5}},
           "shapes": {"t": {"type": "disc", "material": "n"}}})",
       {"refraction"}},
      {sun, R"({"lights": {"sun": {"type": "directional"}}})", {}},
      {"light falloff", R"({"lights": {"lamp": {"type": "point", "falloff": "inverse_square"}}})", {sun}},
      {"spot lights", R"({"lights": {"lamp": {"type": "spot"}}})", {sun}},
      {"transparent shadows",
       R"({"lights": {"sun": {"type": "directional"}}, "materials": {"m": {"transmission": 0.5}}})",
       {sun, "refraction"}},
      {"distance attenuation", R"({"render": {"distance_attenuation": 0.1}})", {}},
      {"antialiasing (grid)", R"({"render": {"antialias": "grid:2"}})", {}},
      {"antialiasing (whitted)", R"({"render": {"antialias": "whitted"}})", {}},
      {"gradient background", R"({"background": {"type": "gradient", "color": null}})", {}},
      {"planes", R"({"shapes": {"p": {"type": "plane"}}})", {}},
      {"sphere BVH", R"({"shapes": {"p": {"type": "sphere"}}})", {}},
      {"cone BVH", R"({"shapes": {"p": {"type": "cone"}}})", {}},
      {"triangle BVH",
       R"({"shapes": {"p": {"type": "mesh", "normals": "flat", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                            "faces": [[0, 1, 2]]}}})",
       {"flat shading"}},
      {"smooth normals",
       R"({"shapes": {"p": {"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.1]],
                            "normals": "smooth", "faces": [[0, 1, 2], [1, 3, 2]]}}})",
       {"triangle BVH"}},
      {"flat shading",
       R"({"shapes": {"p": {"type": "mesh", "shading": "flat", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                            "faces": [[0, 1, 2]]}}})",
       {"triangle BVH"}},
      {"gouraud shading",
       R"({"shapes": {"p": {"type": "mesh", "shading": "gouraud", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                            "normals": "smooth", "faces": [[0, 1, 2]]}}})",
       {"triangle BVH", "smooth normals"}},
      {"limit shading",
       R"({"shapes": {"p": {"type": "sphere", "sides": 12, "shading": "limit"}}})",
       {"triangle BVH", "smooth normals"}},
      {"instances",
       R"({"groups": {"g": {"shapes": {"a": {"type": "disc"}}}}, "shapes": {"p": {"type": "instance", "group": "g"}}})",
       {}},
      {"recentering", R"({"shapes": {"s": {"transform": {"translate": [100000, 0, 0]}}}})", {}},
  };
}

TEST(InfoCommand, EachFeatureIsNamedWhereItIsSwitchedOnAndNowhereElse) {
  // Features of what every scene has: a shape.
  const Names bare = {"disc BVH"};
  EXPECT_EQ(info_of(bare_scene())["features"].get<Names>(), bare);
  Names switched = bare;
  for (const FeatureCase& c : feature_cases()) {
    InfoJson scene = bare_scene();
    scene.merge_patch(InfoJson::parse(c.change));
    Names expected = c.beside;
    expected.insert(c.feature);
    expected.insert(bare.begin(), bare.end());
    EXPECT_EQ(info_of(scene)["features"].get<Names>(), expected) << c.feature;
    switched.insert(c.feature);
  }
  // The table above lacks none of those that the renderer tells.
  const std::string source = file_text(RAYTREE_SOURCE_DIR "/renderer/scene.cpp");
  const std::regex name("features\\.insert\\([^;\"]*\"([^\"]+)\"(?:\\s*:\\s*\"([^\"]+)\")?\\)");
  Names told;
  for (std::sregex_iterator match(source.begin(), source.end(), name), end; match != end; ++match)
    for (const std::size_t group : {1u, 2u})
      if ((*match)[group].matched) told.insert((*match)[group].str());
  // One is put together: the method's name before it.
  EXPECT_EQ(told.erase(" shading"), 1u);
  for (const char* method : {"flat", "gouraud", "limit"}) told.insert(method + std::string(" shading"));
  EXPECT_GE(told.size(), 30u) << "features are no longer told in renderer/scene.cpp";
  EXPECT_EQ(switched, told);
}

TEST(InfoCommand, WhatNoShapeUsesIsNotNamed) {
  InfoJson scene = bare_scene();
  scene.merge_patch(InfoJson::parse(
      R"({"materials": {"unused": {"transmission": 1, "reflection": 1, "roughness": 0.1, "bump": {"kind": "wrinkles"}}},
          "groups": {"unused": {"shapes": {"b": {"type": "sphere", "material": "unused"}}}},
          "lights": {"lamp": {"type": "point", "color": [2, 1, 0.5]}, "sun": {"type": "directional"}}})"));
  const InfoJson info = info_of(scene);
  EXPECT_EQ(info["materials_in_use"], InfoJson({"m"}));
  EXPECT_EQ(info["features"].get<Names>(), (Names{"disc BVH", "shadows"}));
  // A light has no switch: all that stand in the file are named, as they are.
  ASSERT_EQ(info["lights"].size(), 2u);
  EXPECT_EQ(info["lights"][0], (InfoJson{{"name", "lamp"}, {"kind", "point"}, {"color", {2.0, 1.0, 0.5}}}));
  EXPECT_EQ(info["lights"][1]["kind"], "directional");
  // Without shadow rays they switch nothing on.
  scene["render"]["shadows"] = false;
  EXPECT_EQ(info_of(scene)["features"].get<Names>(), (Names{"disc BVH"}));
}

TEST(InfoCommand, BoundsAreThoseOfTheShapes) {
  InfoJson scene = bare_scene();
  // Binary fractions: the sums and products below are exact.
  scene["shapes"] = InfoJson::parse(
      R"({"ball": {"type": "sphere", "center": [1, 2, 3], "radius": 0.5, "transform": [{"scale": 2}, {"translate": [0, 0, -8]}]},
          "slab": {"type": "mesh", "normals": "flat", "positions": [[0, 0, 0], [0.25, 0, 0], [0, -0.75, 0.125]],
                   "faces": [[0, 1, 2]], "transform": {"translate": [-4, 0, 0]}},
          "disc": {"type": "disc", "center": [0, 16, 0], "normal": [0, 1, 0], "radius": 2}})");
  const auto box = [](std::vector<double> low, std::vector<double> high) {
    return InfoJson{{"min", low}, {"max", high}};
  };
  InfoJson info = info_of(scene);
  std::map<std::string, InfoJson> bounds;
  for (const InfoJson& object : info["objects"]) bounds[object["name"]] = object["bounds"];
  EXPECT_EQ(bounds["ball"], box({1, 3, -3}, {3, 5, -1}));
  EXPECT_EQ(bounds["slab"], box({-4, -0.75, 0}, {-3.75, 0, 0.125}));
  EXPECT_EQ(bounds["disc"], box({-2, 16, -2}, {2, 16, 2}));
  EXPECT_EQ(info["bounds"], box({-4, -0.75, -3}, {3, 16, 2}));
  scene["shapes"] = InfoJson::parse(R"({"floor": {"type": "plane"}})");
  EXPECT_EQ(info_of(scene)["bounds"], nullptr);
  EXPECT_EQ(info_of(scene)["objects"][0]["bounds"], nullptr);
}

TEST(InfoCommand, ForetellsTheMemoryThatARenderTakes) {
  TemporaryFolder folder;
  for (const char* triangles : {"20000", "200000"}) {
    const std::vector<std::string> scene = {"terrain", "--set", std::string("shapes.terrain.triangles=") + triangles,
                                            "--size", "64x48"};
    const ProgramResult info = run_program(with({"info", "--json"}, scene));
    const ProgramResult render = run_program(
        with(with({"render"}, scene), {"-o", folder.path("a.exr"), "--stats", "-", "--quiet", "--threads", "2"}));
    ASSERT_EQ(info.status, 0) << info.err;
    ASSERT_EQ(render.status, 0) << render.err;
    const InfoJson foretold = InfoJson::parse(info.out)["memory_bytes"],
                   taken = InfoJson::parse(render.out)["memory_bytes"];
    // What is Raytree's own is known; what Embree takes is reckoned by bytes a triangle, within a third.
    EXPECT_EQ(foretold["arrays"], taken["arrays"]) << triangles;
    EXPECT_EQ(foretold["film"], taken["film"]) << triangles;
    const double ratio = foretold["intersector"].get<double>() / taken["intersector"].get<double>();
    EXPECT_GE(ratio, 3.0 / 4) << triangles;
    EXPECT_LE(ratio, 4.0 / 3) << triangles;
    EXPECT_EQ(foretold["total"].get<std::uint64_t>(), foretold["arrays"].get<std::uint64_t>() +
                                                          foretold["intersector"].get<std::uint64_t>() +
                                                          foretold["film"].get<std::uint64_t>());
  }
}

}  // namespace
}  // namespace raytree::test
