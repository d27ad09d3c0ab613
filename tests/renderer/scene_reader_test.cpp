// Scene files: what each value comes to, what is refused and in which words, --set, and writing that reads back.
#include "renderer/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "renderer/material.h"
#include "renderer/suggestion.h"
#include "tests/renderer/scene_equality.h"

namespace raytree {
namespace {

SceneDescription scene_of(const std::string& members) {
  return read_scene("{\"raytree\": 1" + (members.empty() ? "" : ",\n" + members) + "}", "s.json", "folder");
}

/// The message that a scene with these members is refused with; they start on line 2.
std::string refusal(const std::string& members) {
  try {
    scene_of(members);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "accepted";
}

SceneDescription full_scene() {
  return scene_of(R"(
    "title": "full",
    "background": {"type": "gradient", "bottom": 0.1, "horizon": [0.2, 0.3, 0.4], "top": 0.5},
    "cameras": {"main": {"position": [0, 1, 5]}, "top.view": {"position": [0, 5, 0], "up": [0, 0, -1]}},
    "lights": {"sun": {"type": "directional", "direction": [0, -1, -1]},
               "lamp": {"type": "point", "position": [1, 2, 3]}},
    "materials": {"glass": {"transmission": 0.9}, "a.b": {"diffuse": {"type": "checker"}}, "a": {}},
    "shapes": {"ball": {"type": "sphere", "material": "glass"},
               "floor": {"type": "mesh", "material": "a.b",
                         "positions": [[0, 0, 0], [1, 0, 0], [1, 0, -1], [0, 0, -1]], "faces": [[0, 1, 2, 3]]},
               "land": {"type": "terrain"}, "file": {"type": "mesh", "file": "bunny.obj"}})");
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

// --- reading ------------------------------------------------------------------------------------------------

TEST(SceneReader, TheLeastSceneHasTheDefaults) {
  const SceneDescription scene = scene_of("");
  EXPECT_TRUE(test::equal(scene, SceneDescription{}));
  EXPECT_EQ(scene.name, "s.json");
  EXPECT_EQ(scene.folder, "folder");
}

TEST(SceneReader, ColorsAreTriplesOrGrays) {
  EXPECT_EQ(scene_of(R"("ambient": 0.25)").ambient, Rgb(0.25f));
  EXPECT_EQ(scene_of(R"("ambient": [0.1, 0.2, 3])").ambient, Rgb(0.1f, 0.2f, 3));
  EXPECT_EQ(refusal(R"("ambient": [0.1, 0.2])"),
            "s.json:2: ambient: expected a color [r, g, b] or a number for a gray, not an array of 2");
  EXPECT_EQ(refusal(R"("ambient": [0.1, 0.2, -1])"), "s.json:2: ambient[2]: -1 is out of range: must be at least 0");
}

TEST(SceneReader, AntialiasIsNoneAGridOrWhitteds) {
  EXPECT_EQ(scene_of(R"("render": {"antialias": "grid:3"})").render.antialias.grid_size, 3);
  EXPECT_EQ(scene_of(R"("render": {"antialias": "grid:64"})").render.antialias.grid_size, 64);
  EXPECT_EQ(scene_of(R"("render": {"antialias": "none"})").render.antialias.method, Antialiasing::Method::none);
  EXPECT_EQ(scene_of(R"("render": {"antialias": "whitted"})").render.antialias.method, Antialiasing::Method::whitted);
  for (const char* bad : {"\"grid\"", "\"grid:\"", "\"grid:0\"", "\"grid:65\"", "\"grid:3x\"", "\"grid:+3\"",
                          "\"grid:03\"", "\"grid:99999999999\"", "\"\"", "3", "\"whitted:2\"", "\"Whitted\""})
    EXPECT_NE(refusal("\"render\": {\"antialias\": " + std::string(bad) + "}")
                  .find("known values: \"none\", \"whitted\", \"grid:N\" with N from 1 to 64"),
              std::string::npos)
        << bad;
}

TEST(SceneReader, ListsKeepTheFilesOrder) {
  const SceneDescription scene = scene_of(R"("cameras": {"z": {}, "a": {}, "m": {}})");
  ASSERT_EQ(scene.cameras.size(), 3u);
  EXPECT_EQ(scene.cameras[0].name, "z");
  EXPECT_EQ(scene.cameras[2].name, "m");
}

TEST(SceneReader, ShapesKnowWhereTheyStand) {
  const SceneDescription scene = scene_of("\"shapes\": {\n\n\"ball\": {\"type\": \"sphere\"}}");
  EXPECT_EQ(scene.shapes.at(0).where.file, "s.json");
  EXPECT_EQ(scene.shapes.at(0).where.line, 4);
  EXPECT_EQ(scene.shapes.at(0).where.object, "shapes.ball");
}

TEST(SceneReader, FilesAreReadFromDiskAndKnowTheirFolder) {
  const auto folder = std::filesystem::temp_directory_path() / "raytree_scene_reader_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a.json").string();
  std::ofstream(path) << "{\"raytree\": 1}\n";
  EXPECT_EQ(read_scene_file(path).folder, folder.string());
  std::ofstream(path) << "{\"raytree\": 1,\n\"x\": 1}\n";
  try {
    read_scene_file(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).rfind(path + ":2: unknown key \"x\"; known keys: raytree, title", 0), 0u)
        << error.what();
  }
  for (const std::string& bad : {(folder / "absent.json").string(), folder.string()}) {
    try {
      read_scene_file(bad);
      FAIL() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      EXPECT_EQ(error.where().file, bad);
    }
  }
  std::filesystem::remove_all(folder);
}

// --- refusals -----------------------------------------------------------------------------------------------

TEST(SceneReader, RefusalsSayWhatWhereAndWhatWouldBeRight) {
  EXPECT_EQ(
      refusal("\"materials\": {\n \"glass\": {\n  \"difuse\": 1}}"),
      "s.json:4: materials.glass: unknown key \"difuse\"; known keys: from, diffuse, ambient, highlight, reflection, "
      "transmission, index_of_refraction, fresnel, conductor, absorption, thin, priority, bump, roughness (did you "
      "mean \"diffuse\"?)");
  EXPECT_EQ(refusal("\"lights\": {\"sun\": {\n\"type\": \"direct\"}}"),
            "s.json:3: lights.sun.type: unknown type \"direct\"; known types: directional, point, spot (did you mean "
            "\"directional\"?)");
  EXPECT_EQ(refusal("\"lights\": {\"sun\": {\"tpye\": \"point\"}}"),
            "s.json:2: lights.sun: missing key \"type\"; one of: directional, point, spot (there is \"tpye\")");
  EXPECT_EQ(refusal("\"lights\": {\"sun\": {\"type\": \"point\", \"direction\": [0, -1, 0]}}"),
            "s.json:2: lights.sun: unknown key \"direction\"; known keys: type, position, falloff, least_distance, "
            "color");
  EXPECT_EQ(refusal("\"shapes\": {\"a b\": {\"type\": \"sphere\",\n\"radius\": 0}}"),
            "s.json:3: shapes.\"a b\".radius: 0 is out of range: must be greater than 0");
  EXPECT_EQ(
      refusal(
          "\"materials\": {\"glass\": {}},\n\"shapes\": {\"ball\": {\"type\": \"sphere\", \"material\": \"Glass\"}}"),
      "s.json:3: shapes.ball: unknown material \"Glass\"; materials of this scene: glass (did you mean \"glass\"?)");
  EXPECT_EQ(refusal("\"title\": \"a\",\n\"title\": \"b\""),
            "s.json:3: the key \"title\" stands here again; the first is on line 2");
  EXPECT_EQ(refusal("\"lights\": {\"a\": {\"type\": \"point\"},\n\"a\": {\"type\": \"point\"}}"),
            "s.json:3: lights: a second light named \"a\"; the first is on line 2");
  EXPECT_EQ(refusal("\"cameras\": {\"\": {}}"), "s.json:2: cameras: a camera needs a name that is not empty");
  EXPECT_EQ(refusal("\"render\": {\"highlights\": \"half\"}"),
            "s.json:2: render.highlights: unknown value \"half\"; known values: reflected, halfway (did you mean "
            "\"halfway\"?)");
  EXPECT_EQ(refusal("\"render\": {\"depth\": 2.5}"), "s.json:2: render.depth: expected a whole number, not 2.5");
  EXPECT_EQ(refusal("\"render\": {\"shadows\": 1}"), "s.json:2: render.shadows: expected true or false, not 1");
  EXPECT_EQ(refusal("\"cameras\": []"), "s.json:2: cameras: expected an object of cameras by name, not an empty array");
  EXPECT_EQ(refusal("\"image\": {\"width\": 65536, \"height\": 65536}"),
            "s.json:2: image: 65536 x 65536 pixels are too many: width times height is at most 1073741824");
}

TEST(SceneReader, TheVersionHeadsTheFile) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read_scene(text, "s.json", "");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message("{}"), "s.json:1: missing key \"raytree\"");
  EXPECT_EQ(message("{\"raytree\": 2}"), "s.json:1: raytree: scene version 2 is unknown; this program reads version 1");
  EXPECT_EQ(message("\n[]"), "s.json:2: expected an object, not an empty array");
}

TEST(SceneReader, RangesHoldAtTheirEnds) {
  struct Case {
    const char* members;
    bool accepted;
  };
  const Case cases[] = {
      {R"("render": {"depth": 1})", true},
      {R"("render": {"depth": 0})", false},
      {R"("render": {"depth": 1000000})", true},
      {R"("render": {"depth": 1000001})", false},
      {R"("render": {"cutoff": 0})", true},
      {R"("render": {"cutoff": -1e-9})", false},
      {R"("render": {"distance_attenuation": -1})", false},
      {R"("cameras": {"c": {"field_of_view": 0}})", false},
      {R"("cameras": {"c": {"field_of_view": 180}})", false},
      {R"("cameras": {"c": {"field_of_view": 179.9}})", true},
      {R"("cameras": {"c": {"height": 0}})", false},
      {R"("cameras": {"c": {"up": [0, 0, 0]}})", false},
      {R"("cameras": {"c": {"up": [0, 0, 3]}})", false},
      {R"("cameras": {"c": {"position": [1, 2, 3], "target": [1, 2, 3]}})", false},
      {R"("image": {"width": 0})", false},
      {R"("image": {"width": 65537})", false},
      {R"("image": {"width": 65536, "height": 16384})", true},
      {R"("lights": {"l": {"type": "directional", "direction": [0, 0, 0]}})", false},
      {R"("lights": {"l": {"type": "directional", "color": -1}})", false},
      {R"("materials": {"m": {"reflection": 0.8, "transmission": 0.9}})", true},
      {R"("materials": {"m": {"reflection": -0.1}})", false},
      {R"("materials": {"m": {"index_of_refraction": 0}})", false},
      {R"("materials": {"m": {"highlight": {"exponent": 1}}})", true},
      {R"("materials": {"m": {"highlight": {"exponent": 0.99}}})", false},
      {R"("materials": {"m": {"diffuse": {"type": "checker", "size": 0}}})", false},
      {R"("materials": {"m": {"diffuse": {"type": "spots"}}})", false},
      {R"("materials": {"m": {"diffuse": {"type": "stripes", "direction": [0, 0, 0]}}})", false},
      {R"("materials": {"m": {"diffuse": {"type": "stripes", "even": -1}}})", false},
      {R"("materials": {"m": {"ambient": {"type": "noise", "octaves": 16}}})", true},
      {R"("materials": {"m": {"ambient": {"type": "noise", "octaves": 17}}})", false},
      {R"("materials": {"m": {"ambient": {"type": "noise", "gain": 1.1}}})", false},
      {R"("materials": {"m": {"ambient": {"type": "noise", "contrast": -1}}})", false},
      {R"("materials": {"m": {"bump": {"amplitude": -1}}})", true},
      {R"("materials": {"m": {"bump": {"size": 0}}})", false},
      {R"("materials": {"m": {"bump": {"kind": "waves"}}})", false},
      {R"("materials": {"m": {"bump": {"direction": [0, 0, 0]}}})", false},
      {R"("materials": {"m": {"bump": 0.1}})", false},
      {R"("shapes": {"s": {"type": "terrain", "triangles": 2}})", true},
      {R"("shapes": {"s": {"type": "terrain", "triangles": 1}})", false},
      {R"("shapes": {"s": {"type": "terrain", "triangles": 5e7}})", true},
      {R"("shapes": {"s": {"type": "terrain", "triangles": 50000001}})", false},
      {R"("shapes": {"s": {"type": "terrain", "roughness": 1}})", false},
      {R"("shapes": {"s": {"type": "terrain", "seed": 4294967295}})", true},
      {R"("shapes": {"s": {"type": "terrain", "seed": 4294967296}})", false},
      {R"("shapes": {"s": {"type": "terrain", "seed": -1}})", false},
      {R"("shapes": {"s": {"type": "sphere_flake", "levels": 7}})", true},
      {R"("shapes": {"s": {"type": "sphere_flake", "levels": 8}})", false},
      {R"("shapes": {"s": {"type": "disc", "radius": -1}})", false},
      {R"("shapes": {"s": {"type": "plane", "normal": [0, 0, 0]}})", false},
      {R"("shapes": {"s": {"type": "mesh", "file": "a.ply", "crease_angle": 180}})", true},
      {R"("shapes": {"s": {"type": "mesh", "file": "a.ply", "crease_angle": 181}})", false},
      {R"("shapes": {"s": {"type": "sphere", "center": [1e18, 0, 0]}})", true},
      {R"("shapes": {"s": {"type": "sphere", "center": [2e18, 0, 0]}})", false},
      {R"("title": null)", false},
  };
  for (const Case& one : cases)
    EXPECT_EQ(refusal(one.members) == "accepted", one.accepted) << one.members << "\n" << refusal(one.members);
}

// --- transforms ---------------------------------------------------------------------------------------------

Vec3d moved(const std::string& transform, const Vec3d& p) {
  const SceneDescription scene =
      scene_of("\"shapes\": {\"s\": {\"type\": \"sphere\", \"transform\": " + transform + "}}");
  return p * scene.shapes.at(0).transform;
}

TEST(SceneReader, StepsApplyInOrder) {
  EXPECT_EQ(moved(R"({"translate": [1, 2, 3]})", {1, 1, 1}), Vec3d(2, 3, 4));
  EXPECT_EQ(moved(R"({"scale": 2})", {1, 1, 1}), Vec3d(2, 2, 2));
  EXPECT_EQ(moved(R"({"scale": [1, 2, -3]})", {1, 1, 1}), Vec3d(1, 2, -3));
  // Right-handed: about x, y goes to z; about y, z to x; about z, x to y. Exact at quarter turns.
  EXPECT_EQ(moved(R"({"rotate": [90, 0, 0]})", {0, 1, 0}), Vec3d(0, 0, 1));
  EXPECT_EQ(moved(R"({"rotate": [0, 90, 0]})", {0, 0, 1}), Vec3d(1, 0, 0));
  EXPECT_EQ(moved(R"({"rotate": [0, 0, 90]})", {1, 0, 0}), Vec3d(0, 1, 0));
  EXPECT_EQ(moved(R"({"rotate": [90, 90, 0]})", {0, 1, 0}), Vec3d(1, 0, 0)) << "x before y";
  EXPECT_EQ(moved(R"({"rotate": [0, 0, -270]})", {1, 0, 0}), Vec3d(0, 1, 0));
  // Within a step scale, rotate, translate; in a list from first to last.
  EXPECT_EQ(moved(R"({"translate": [1, 0, 0], "rotate": [0, 0, 90], "scale": 2})", {1, 0, 0}), Vec3d(1, 2, 0));
  EXPECT_EQ(moved(R"([{"translate": [1, 0, 0]}, {"rotate": [0, 0, 90]}, {"scale": 2}])", {1, 0, 0}), Vec3d(0, 4, 0));
  EXPECT_EQ(moved(R"({"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]})", {0, 0, 0}), Vec3d(5, 6, 7));
  EXPECT_EQ(moved(R"({"matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 0,0,0,1]})", {1, 0, 0}), Vec3d(0, 1, 0));
  EXPECT_EQ(moved("[]", {1, 2, 3}), Vec3d(1, 2, 3));
  const Vec3d p = moved(R"({"rotate": [0, 0, 30]})", {1, 0, 0});
  EXPECT_NEAR(p.x, std::sqrt(3.0) / 2, 1e-15);  // rounding of degrees to radians, of sine and cosine: 2 ulp of 1
  EXPECT_NEAR(p.y, 0.5, 1e-15);
}

TEST(SceneReader, TransformsMustBeInvertible) {
  const auto transform_refusal = [](const std::string& transform) {
    return refusal("\"shapes\": {\"s\": {\"type\": \"sphere\", \"transform\": " + transform + "}}");
  };
  EXPECT_EQ(transform_refusal(R"({"scale": [1, 0, 1]})"), "s.json:2: shapes.s.transform.scale: a factor must not be 0");
  EXPECT_NE(transform_refusal(R"({"matrix": [1,0,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]})").find("not invertible"),
            std::string::npos);
  EXPECT_NE(transform_refusal(R"({"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,1, 0,0,0,1]})").find("not affine"),
            std::string::npos);
  EXPECT_NE(
      transform_refusal(R"({"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "scale": 2})").find("step of its own"),
      std::string::npos);
  EXPECT_NE(transform_refusal(R"([{"scale": 1e15}, {"scale": 1e15}])").find("larger than 1e18"), std::string::npos);
  EXPECT_EQ(transform_refusal(R"([{"scale": 1}, {"turn": [0, 1, 0]}])"),
            "s.json:2: shapes.s.transform[1]: unknown key \"turn\"; known keys: scale, rotate, translate, matrix");
  EXPECT_EQ(transform_refusal(R"({"scale": 1e-9})"), "accepted") << "small is not flat";
}

// --- polygons in the scene file -----------------------------------------------------------------------------

const PolygonMesh& mesh_of(const SceneDescription& scene) { return *std::get<MeshShape>(scene.shapes.at(0).kind).mesh; }

std::string mesh_members(const std::string& members) {
  return "\"shapes\": {\"m\": {\"type\": \"mesh\",\n" + members + "}}";
}

TEST(SceneReader, PolygonsComeFromListsOfIndices) {
  const SceneDescription scene =
      scene_of(mesh_members(R"("positions": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 2, 2]],
      "faces": [[0, 1, 2, 3], [1, 2, 4]],
      "vertex_normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 1]],
      "texture_coordinates": [[0, 0], [1, 1]], "texture_faces": [[0, 1, 0, 1], [1, 1, 1]],
      "groups": [{"name": "front", "first_face": 1, "face_count": 1}])"));
  const PolygonMesh& mesh = mesh_of(scene);
  EXPECT_EQ(mesh.origin, Vec3d(0, 0, 0));
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.face_sizes, (Buffer<std::uint32_t>{4, 3}));
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{0, 1, 2, 3, 1, 2, 4}));
  EXPECT_EQ(mesh.normals.size(), 5u);
  EXPECT_TRUE(mesh.normal_corners.empty());
  EXPECT_EQ(mesh.texture_corners, (Buffer<std::uint32_t>{0, 1, 0, 1, 1, 1, 1}));
  EXPECT_EQ(mesh.groups.at(0).name, "front");
  const SceneDescription triangles =
      scene_of(mesh_members(R"("positions": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "faces": [[0, 1, 2]])"));
  EXPECT_TRUE(mesh_of(triangles).all_triangles());
}

// A float at 1e6 m steps by 1/16 m; about a double origin in the middle of 4 m it steps by 2^-23 m at most.
TEST(SceneReader, FarPositionsKeepTheirMillimeters) {
  const SceneDescription scene = scene_of(mesh_members(
      R"("positions": [[1000000.001, 0, -2000000], [1000004.002, 0, -2000000], [1000002.003, 3, -1999999.996]],
         "faces": [[0, 1, 2]])"));
  const PolygonMesh& mesh = mesh_of(scene);
  const Vec3d wanted[] = {{1000000.001, 0, -2000000}, {1000004.002, 0, -2000000}, {1000002.003, 3, -1999999.996}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d got = Vec3d(mesh.positions[i]) + mesh.origin;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(got[axis], wanted[i][axis], std::ldexp(1.0, -23)) << i << axis;
  }
  EXPECT_EQ(mesh.origin.y, 0) << "an axis near 0 keeps origin 0";
}

TEST(SceneReader, AGivenOriginIsAddedToThePositions) {
  const SceneDescription scene = scene_of(mesh_members(
      R"("origin": [1e6, 2, 3], "positions": [[0, 0, 0], [1, 0, 0], [1, 1, 0.001]], "faces": [[0, 1, 2]])"));
  EXPECT_EQ(mesh_of(scene).origin, Vec3d(1e6, 2, 3));
  EXPECT_EQ(mesh_of(scene).positions[2], Vec3f(1, 1, 0.001f));
}

TEST(SceneReader, PolygonsAreChecked) {
  const std::string positions = R"("positions": [[0, 0, 0], [1, 0, 0], [1, 1, 0]],)";
  EXPECT_EQ(refusal(mesh_members(positions + "\n\"faces\": [[0, 1, 2],\n[0, 1, 3]]")),
            "s.json:5: shapes.m.faces[1]: index 3 is out of range: there are 3 positions, counted from 0");
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, -1]])")).find("-1 is out of range"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1]])")).find("3 or more indices, not an array of 2"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, 1.5]])")).find("whole number"), std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [])")).find("needs at least one face"), std::string::npos);
  EXPECT_NE(refusal(mesh_members(R"("faces": [[0, 1, 2]])")).find("needs at least one position"), std::string::npos);
  EXPECT_NE(refusal(mesh_members(R"("normals": "flat")")).find("needs \"file\", or \"positions\" and \"faces\""),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(R"("file": "a.obj", )" + positions + R"("faces": [[0, 1, 2]])")).find("not both"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(R"("postions": [], "faces": [[0, 1, 2]])")).find("did you mean \"positions\"?"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, 2]], "vertex_normals": [[0, 0, 1]])"))
                .find("1 for 3 positions"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, 2]], "vertex_normals": [[0, 0, 1]],
                                                "normal_faces": [[0, 0, 0, 0]])"))
                .find("not in the shape of \"faces\""),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, 2]], "texture_faces": [[0, 0, 0]])"))
                .find("there are 0 texture_coordinates"),
            std::string::npos);
  EXPECT_NE(refusal(mesh_members(positions + R"("faces": [[0, 1, 2]], "groups": [{"first_face": 0, "face_count": 2}])"))
                .find("shapes.m.groups[0]"),
            std::string::npos);
}

// --- --set --------------------------------------------------------------------------------------------------

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

// --- writing ------------------------------------------------------------------------------------------------

/// Fills every member that the tables know with random values within their ranges.
class Randomizer {
 public:
  explicit Randomizer(unsigned seed) : random_(seed) {}

  template <class Member>
  void operator()(const Field& field, Member& member) {
    ++fields;
    fill(field, member);
  }
  template <class Variant>
  void tagged(const Field&, Variant& variant) {
    const int wanted = whole(0, static_cast<int>(std::variant_size_v<Variant>) - 1);
    int index = 0;
    for_each_alternative<Variant>([&]<class T>(std::in_place_type_t<T>) {
      if (index++ == wanted) variant = T{};
    });
    std::visit([&](auto& alternative) { visit_fields(*this, alternative); }, variant);
  }
  void inlined(MeshShape& shape) {
    if (whole(0, 1) == 0) return;
    shape.file.clear();
    shape.mesh = std::make_shared<PolygonMesh>();
    PolygonMesh& mesh = *shape.mesh;
    fill({}, mesh.origin);
    const std::size_t vertices = 4 + static_cast<std::size_t>(whole(0, 3));
    const auto vector = [&] { return Vec3f(float_number(), float_number(), float_number()); };
    for (std::size_t i = 0; i < vertices; ++i) mesh.positions.push_back(vector());
    const bool triangles = whole(0, 1) == 0;
    if (!triangles) mesh.face_sizes.push_back(4);
    for (int face = 0; face < 3; ++face)
      if (!triangles) mesh.face_sizes.push_back(3);
    const std::size_t corners = triangles ? 9 : 13;
    const auto indices = [&](std::size_t count) {
      Buffer<std::uint32_t> list;
      for (std::size_t i = 0; i < corners; ++i)
        list.push_back(static_cast<std::uint32_t>(whole(0, static_cast<int>(count) - 1)));
      return list;
    };
    mesh.corners = indices(vertices);
    if (whole(0, 1) == 0) {
      for (std::size_t i = 0; i < vertices; ++i) mesh.normals.push_back(vector());
      if (whole(0, 1) == 0) mesh.normal_corners = indices(vertices);
    }
    if (whole(0, 1) == 0) {
      for (std::size_t i = 0; i < vertices; ++i) mesh.texture_coordinates.push_back({float_number(), float_number()});
      if (whole(0, 1) == 0) mesh.texture_corners = indices(vertices);
    }
    if (whole(0, 1) == 0) mesh.groups = {{"a", "x", 0, 1}, {"b \"quoted\"", "", 1, 2}};
  }

  int fields = 0;

 private:
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double number(const Range& range = {}) {
    const double low = std::max(range.low, -1e3), high = std::min(range.high, 1e3);
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  float float_number(const Range& range = {}) { return static_cast<float>(number(range)); }

  void fill(const Field&, bool& x) { x = whole(0, 1) == 1; }
  void fill(const Field&, std::optional<bool>& x) {
    const int choice = whole(0, 2);
    x = choice == 2 ? std::nullopt : std::optional(choice == 1);
  }
  void fill(const Field& field, double& x) { x = number(field.range); }
  template <std::integral Integer>
  void fill(const Field& field, Integer& x) {
    x = static_cast<Integer>(std::floor(number(field.range)));
  }
  void fill(const Field& field, std::string& x) {
    // A shape's material is a name of the scene; the caller sets it.
    x = field.key == "material" ? "" : "text \"" + std::to_string(whole(0, 999)) + "\"\t\\ \xC3\xA4\n";
  }
  void fill(const Field&, SceneVersion&) {}
  template <class E>
  requires std::is_enum_v<E>
  void fill(const Field&, E& x) {
    const auto& entries = EnumTable<E>::entries;
    x = entries[static_cast<std::size_t>(whole(0, static_cast<int>(entries.size()) - 1))].value;
  }
  void fill(const Field&, Antialiasing& x) {
    const auto method = static_cast<Antialiasing::Method>(whole(0, 2));
    x = {method, method == Antialiasing::Method::grid ? whole(1, kMaxGridSize) : 1};
  }
  void fill(const Field& field, Vec2d& x) { x = {number(field.range), number(field.range)}; }
  void fill(const Field& field, Vec3d& x) { x = {number(field.range), number(field.range), number(field.range)}; }
  void fill(const Field& field, Rgb& x) {
    x = {float_number(field.range), float_number(field.range), float_number(field.range)};
  }
  void fill(const Field& field, ColorPattern& x) {
    if (whole(0, 1) == 0) {
      Rgb color;
      fill(field, color);
      x = color;
    } else {
      VaryingPattern pattern;
      tagged({}, pattern);
      x = color_pattern(pattern);
    }
  }
  void fill(const Field& field, std::optional<ColorPattern>& x) {
    x.reset();
    if (whole(0, 1) == 0) fill(field, x.emplace());
  }
  void fill(const Field& field, std::optional<BumpDescription>& x) {
    x.reset();
    if (whole(0, 1) == 0) fill(field, x.emplace());
  }
  void fill(const Field&, Background& x) { tagged({}, x); }
  void fill(const Field&, MaterialBase&) {}
  void fill(const Field&, std::vector<AngleWeight>& table) {
    table.clear();
    for (int i = whole(0, 3); i > 0; --i)
      table.push_back(
          {90.0 / i - (90.0 / i - 90.0 / (i + 1)) * number({0, 0.9}), {float_number({0}), float_number({0}), 1}});
  }
  void fill(const Field&, Matrix44d& x) {
    x = Matrix44d();
    if (whole(0, 2) == 0) return;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 3; ++j) x[i][j] = number();
  }
  template <Named T>
  void fill(const Field&, std::vector<T>& list) {
    list.clear();
    for (int i = 0; i < 4; ++i) {
      T element{};
      element.name = "name " + std::to_string(i) + ".x";
      visit_fields(*this, element);
      if constexpr (std::same_as<T, MaterialDescription>) make_sound(element);
      list.push_back(std::move(element));
    }
  }
  /// What material_problem() refuses cannot be read back.
  static void make_sound(MaterialDescription& material) {
    if (material.conductor) material.transmission = Rgb();
    if (material.thin) material.absorption = Rgb();
    ASSERT_EQ(material_problem(material), "");
  }
  template <Table T>
  void fill(const Field&, T& object) {
    visit_fields(*this, object);
  }

  std::mt19937 random_;
};

TEST(WriteScene, ReadsBackEqual) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SceneDescription scene;
    Randomizer randomizer(seed);
    visit_fields(randomizer, scene);
    scene.image.width = std::max(1, scene.image.width);
    // Names that others refer to must exist, and a group may only hold groups behind it.
    const auto mend = [&](std::vector<ShapeDescription>& shapes, std::size_t next_group) {
      const auto use = [&](ShapeDescription& shape, std::string& group) {
        if (next_group < scene.groups.size())
          group = scene.groups[next_group].name;
        else
          shape.kind = SphereShape{};
      };
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        ShapeDescription& shape = shapes[i];
        shape.material = i == 0 ? "" : scene.materials.at(i).name;
        if (auto* mesh = std::get_if<MeshShape>(&shape.kind); mesh && mesh->file.empty() && !mesh->mesh)
          mesh->file = "x.ply";
        if (std::holds_alternative<PlaneShape>(shape.kind) && next_group > 0) shape.kind = TerrainShape{};
        if (auto* scatter = std::get_if<ScatterShape>(&shape.kind)) {
          shapes[(i + 1) % shapes.size()].kind = TerrainShape{};
          scatter->terrain = shapes[(i + 1) % shapes.size()].name;
          scatter->largest_scale += scatter->least_scale;
          scatter->highest = scatter->lowest + 1;
          use(shape, scatter->group);
        }
        if (auto* instance = std::get_if<InstanceShape>(&shape.kind)) use(shape, instance->group);
      }
      // What became a terrain last may have stood for another one's group.
      for (ShapeDescription& shape : shapes)
        if (auto* scatter = std::get_if<ScatterShape>(&shape.kind))
          if (std::none_of(shapes.begin(), shapes.end(), [&](const ShapeDescription& s) {
                return s.name == scatter->terrain && std::holds_alternative<TerrainShape>(s.kind);
              }))
            shape.kind = SphereShape{};
    };
    mend(scene.shapes, 0);
    for (std::size_t i = 0; i < scene.groups.size(); ++i) mend(scene.groups[i].shapes, i + 1);
    const std::string text = write_scene(scene);
    try {
      const SceneDescription read = read_scene(text, "written", "");
      EXPECT_TRUE(test::equal(read, scene)) << "seed " << seed << "\n" << text;
      EXPECT_EQ(write_scene(read), text) << "seed " << seed;
    } catch (const Error& error) {
      FAIL() << "seed " << seed << ": " << error.what() << "\n" << text;
    }
  }
}

TEST(WriteScene, NumbersAreTheShortestThatReadBack) {
  SceneDescription scene;
  scene.ambient = {0.1f, 1e-7f, 16777216.0f};
  scene.render.cutoff = 0.1;
  const std::string text = write_scene(scene);
  EXPECT_NE(text.find("\"ambient\": [0.1, 1e-07, 16777216]"), std::string::npos) << text;
  EXPECT_NE(text.find("\"cutoff\": 0.1,"), std::string::npos) << text;
}

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
  EXPECT_EQ(count(RenderSettings{}), 11);
  EXPECT_EQ(count(AdaptiveSampling{}), 3);
  EXPECT_EQ(count(CameraDescription{}), 7 - 1) << "without name";
  EXPECT_EQ(count(ConstantBackground{}), 1);
  EXPECT_EQ(count(GradientBackground{}), 3);
  EXPECT_EQ(count(DirectionalLight{}), 1);
  EXPECT_EQ(count(PointLight{}), 3);
  EXPECT_EQ(count(SpotLight{}), 6);
  EXPECT_EQ(count(LightDescription{}), 3 - 1) << "without name";
  EXPECT_EQ(count(CheckerPattern{}), 6);
  EXPECT_EQ(count(StripesPattern{}), 8);
  EXPECT_EQ(count(NoisePattern{}), 10);
  EXPECT_EQ(count(BumpDescription{}), 8);
  EXPECT_EQ(count(AngleWeight{}), 2);
  EXPECT_EQ(count(HighlightDescription{}), 3);
  EXPECT_EQ(count(MaterialDescription{}), 14 - 1 + 1) << "without name, with \"from\"";
  EXPECT_EQ(count(FaceGroup{}), 4);
  EXPECT_EQ(count(MeshShape{}), 4);
  EXPECT_EQ(count(InlineMesh{}), 9 - 1) << "PolygonMesh keeps sizes and corners apart";
  EXPECT_EQ(count(SphereShape{}), 2);
  EXPECT_EQ(count(PlaneShape{}), 2);
  EXPECT_EQ(count(DiscShape{}), 3);
  EXPECT_EQ(count(ConeShape{}), 4);
  EXPECT_EQ(count(TerrainShape{}), 5);
  EXPECT_EQ(count(SphereFlakeShape{}), 3);
  EXPECT_EQ(count(TreeShape{}), 6);
  EXPECT_EQ(count(InstanceShape{}), 1);
  EXPECT_EQ(count(ScatterShape{}), 12);
  EXPECT_EQ(count(GroupDescription{}), 3 - 2) << "without name and where";
  EXPECT_EQ(count(ShapeDescription{}), 5 - 2) << "without name and where";
  EXPECT_EQ(count(SceneDescription{}), 12 - 2 + 1) << "without name and folder, with the version";
}

// --- suggestions --------------------------------------------------------------------------------------------

TEST(Suggestion, FindsTheNearestNameOrNone) {
  const std::vector<std::string> names{"diffuse", "ambient", "color", "xz"};
  EXPECT_EQ(closest_name("colour", names), "color");
  EXPECT_EQ(closest_name("Difuse", names), "diffuse");
  EXPECT_EQ(closest_name("abmient", names), "ambient");
  EXPECT_EQ(closest_name("zx", names), "xz");
  EXPECT_EQ(closest_name("specular", names), std::nullopt);
  EXPECT_EQ(closest_name("", names), std::nullopt);
  EXPECT_EQ(closest_name(std::string(1'000'000, 'x'), names), std::nullopt);
}

}  // namespace
}  // namespace raytree
