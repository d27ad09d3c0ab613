// Scene files: what each value comes to, what is refused and in which words.
#include "renderer/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

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
      "transmission, index_of_refraction, fresnel, conductor, absorption, thin, one_sided, priority, bump, roughness "
      "(did you mean \"diffuse\"?)");
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
  EXPECT_EQ(message("{}"), "s.json:1: missing key \"raytree\"; say \"raytree\": 1");
  EXPECT_EQ(message("{\"raytree\": 2}"), "s.json:1: raytree: scene version 2 is unknown; this program reads version 1");
  // No int holds it, nor may it be converted to one.
  EXPECT_EQ(message("{\"raytree\": 1e18}"), "s.json:1: raytree: 1e+18 is out of range");
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

}  // namespace
}  // namespace raytree
