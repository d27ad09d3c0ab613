// The OBJ reader: what files may say, what they must not, what becomes of odd ones, and equality for any thread count.
#include "geometry/obj_reader.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "geometry/mesh_file.h"
#include "geometry/text_scanning.h"
#include "tests/mesh_expectations.h"
#include "tests/reader_checks.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using test::expect_valid;
using test::same_mesh;

PolygonMesh read_text(const std::string& text, Warnings* kept = nullptr) {
  Warnings warnings;
  PolygonMesh mesh = read_obj(text, "test.obj", warnings);
  expect_valid(mesh);
  if (kept) *kept = warnings;
  return mesh;
}

std::string obj_error(const std::string& text) {
  Warnings warnings;
  try {
    read_obj(text, "test.obj", warnings);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().file, "test.obj");
    return error.what();
  }
  return "no error";
}

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ObjReader, ReadsEveryFormOfCorner) {
  const std::string values = kThree + "vt 0.25 0.5\nvt 1\nvn 0 0 2\n";
  EXPECT_EQ(read_text(values + "f 1 2 3").corners, (Buffer<std::uint32_t>{0, 1, 2}));
  PolygonMesh mesh = read_text(values + "f 1/2 2/1 3/2\n");
  EXPECT_EQ(mesh.texture_corners, (Buffer<std::uint32_t>{1, 0, 1}));
  EXPECT_EQ(mesh.texture_coordinates[0], Vec2f(0.25f, 0.5f));
  EXPECT_EQ(mesh.texture_coordinates[1], Vec2f(1, 0));
  EXPECT_TRUE(mesh.normals.empty());
  mesh = read_text(values + "f 1//1 2//1 3//1\n");
  EXPECT_EQ(mesh.normal_corners, (Buffer<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(mesh.normals[0], Vec3f(0, 0, 2));
  EXPECT_TRUE(mesh.texture_coordinates.empty());
  mesh = read_text(values + "f 3/1/1 1/1/1 2/2/1 # a comment\n");
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{2, 0, 1}));
  EXPECT_EQ(mesh.texture_corners, (Buffer<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(mesh.normal_corners, (Buffer<std::uint32_t>{0, 0, 0}));
}

TEST(ObjReader, RelativeIndicesCountFromTheLineTheyStandOn) {
  const PolygonMesh mesh = read_text(kThree + "f -3 -2 -1\nv 5 5 5\nf -1 -4 -2\n");
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{0, 1, 2, 3, 0, 2}));
}

TEST(ObjReader, KeepsPolygonsAndTheirSizes) {
  const PolygonMesh mesh = read_text(kThree + "v 1 1 0\nv 2 2 0\nf 1 2 4 3\nf 1 2 3\nf 1 2 5 4 3\n");
  EXPECT_EQ(mesh.face_sizes, (Buffer<std::uint32_t>{4, 3, 5}));
  EXPECT_EQ(mesh.corners.size(), 12u);
}

TEST(ObjReader, AcceptsLineEndsContinuationsAndBlanks) {
  const PolygonMesh reference = read_text(kThree + "f 1 2 3\n");
  for (const std::string text : {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
                                 "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
                                 "  v\t0  0 0 \n\n v 1 0 \\\n0\nv 0 1 0\nf 1 \\\r\n 2\\\n\\\n 3",
                                 "v 0 0 0\nv 1 0 0\n# a path C:\\folder\\\nv 0 1 0\nf 1 2 3 \\"})
    EXPECT_TRUE(same_mesh(read_text(text), reference)) << text;
}

TEST(ObjReader, NumbersInEveryNotationAreCorrectlyRounded) {
  const std::vector<std::string> numbers = {"+1",
                                            "-.5",
                                            "2.",
                                            "1e2",
                                            "+1E+2",
                                            "1.5e-3",
                                            "0.1",
                                            "1e-320",
                                            "123456789012",
                                            "9007199254740993",
                                            "1e22",
                                            "1e23",
                                            "4.35",
                                            "1e-22",
                                            "0.30000000000000004",
                                            "00001.0",
                                            "1e0005",
                                            "1.7e308",
                                            "-0"};
  for (const std::string& number : numbers) {
    double value = 0;
    const char* const end = number.data() + number.size();
    ASSERT_EQ(text::scan_double(number.data(), end, value), end) << number;
    EXPECT_EQ(value, std::strtod(number.c_str(), nullptr)) << number;
    EXPECT_EQ(std::signbit(value), number[0] == '-');
  }
  double value = 0;
  const auto scan = [&](std::string_view t) {
    return text::scan_double(t.data(), t.data() + t.size(), value) == t.data() + t.size();
  };
  EXPECT_TRUE(scan("1e999") && value == std::numeric_limits<double>::infinity());
  EXPECT_TRUE(scan("-1e99999999999") && value == -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(scan("1e-999") && value == 0);
  EXPECT_TRUE(scan("0.00001e-99999") && value == 0);
  EXPECT_TRUE(scan("NaN") && std::isnan(value));
  EXPECT_TRUE(scan("-inf") && value < 0);
  EXPECT_TRUE(scan("1.#QNAN") && std::isnan(value));
  for (const std::string_view bad : {"", "-", "+-1", ".", "e5", "1e", "x", "1.2.3", "0x10", "--1"})
    EXPECT_FALSE(scan(bad)) << bad;
}

TEST(ObjReader, MillimetresSurviveAMillionMetresFromTheOrigin) {
  const PolygonMesh mesh = read_text(
      "v 1000000.001 2000000.002 -3000000.003\nv 1000001 2000000 -3000000\n"
      "v 1000000 2000001 -3000000\nf 1 2 3\n");
  EXPECT_NE(mesh.origin, Vec3d(0, 0, 0));
  const Vec3d first = Vec3d(mesh.positions[0]) + mesh.origin;
  // Offsets are below 1: float keeps them to 2^-25, double the sum to 2^-32.
  EXPECT_NEAR(first.x, 1000000.001, 4e-8);
  EXPECT_NEAR(first.y, 2000000.002, 4e-8);
  EXPECT_NEAR(first.z, -3000000.003, 4e-8);
}

TEST(ObjReader, KeepsTheOriginWhereItGainsNothing) {
  EXPECT_EQ(read_text("v 1023 0 0\nv 1022 0 0\nv 1022 1 0\nf 1 2 3\n").origin, Vec3d(0, 0, 0));
  EXPECT_EQ(read_text("v 5000 0 0\nv -5000 0 0\nv 0 1 0\nf 1 2 3\n").origin, Vec3d(0, 0, 0));
  EXPECT_EQ(read_text("v 1024 0 0\nv 1022 0 0\nv 1022 2 0\nf 1 2 3\n").origin, Vec3d(1023, 1, 0));
}

TEST(ObjReader, GroupsAreRunsOfFaces) {
  const PolygonMesh mesh = read_text(kThree +
                                     "g one\nusemtl red paint \nf 1 2 3\nf 1 2 3\no two\nf 1 2 3\ng ghost\n"
                                     "usemtl blue\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  ASSERT_EQ(mesh.groups.size(), 3u);
  EXPECT_EQ(mesh.groups[0].name, "one");
  EXPECT_EQ(mesh.groups[0].material, "red paint");
  EXPECT_EQ(mesh.groups[0].face_count, 2u);
  EXPECT_EQ(mesh.groups[1].name, "two");
  EXPECT_EQ(mesh.groups[1].material, "red paint");
  EXPECT_EQ(mesh.groups[2].name, "ghost");
  EXPECT_EQ(mesh.groups[2].material, "blue");
  EXPECT_EQ(mesh.groups[2].first_face, 3u);
  EXPECT_EQ(mesh.groups[2].face_count, 2u);
  EXPECT_TRUE(read_text(kThree + "f 1 2 3\ng after\n").groups.empty());
}

TEST(ObjReader, GroupsFollowWhenFacesAreDropped) {
  const PolygonMesh mesh = read_text(kThree + "g a\nf 1 1 2\ng b\nf 1 2 3\nf 2 2 2\ng c\nf 3 2 1\n");
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "b");
  EXPECT_EQ(mesh.groups[0].first_face, 0u);
  EXPECT_EQ(mesh.groups[0].face_count, 1u);
  EXPECT_EQ(mesh.groups[1].first_face, 1u);
}

TEST(ObjReader, GroupsCannotMultiplyAFile) {
  // Runs of faces hold copies of names: their number and the names' length are bounded, and what is joined is counted.
  std::string text = kThree + "g " + std::string(1000, 'n') + "\n";
  for (int i = 0; i < 150000; ++i) text += "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
  Warnings warnings;
  const PolygonMesh mesh = read_text(text, &warnings);
  EXPECT_EQ(mesh.face_count(), 300000u);
  ASSERT_EQ(mesh.groups.size(), 262144u);
  EXPECT_EQ(mesh.groups[0].name.size(), 255u);
  EXPECT_EQ(mesh.groups.back().face_count, 300000u - 262143u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_GT(warnings[0].count, 0);
  // Records of changes within a chunk are bounded too.
  text = kThree;
  for (int i = 0; i < 100000; ++i) text += "g\nf\n";
  EXPECT_EQ(
      obj_error(text + "g\nf 1 2"),
      "test.obj:5: fewer than three distinct corners; 100001 faces of this kind were dropped, so no face is left");
}

TEST(ObjReader, ErrorsNameFileAndLine) {
  EXPECT_EQ(obj_error(kThree + "f 1 2 9\n"), "test.obj:4: the face refers to vertex 9; there are 3 in the file");
  EXPECT_EQ(obj_error(kThree + "f 1 2 -4\n"), "test.obj:4: the face refers to vertex -4; there are 3 before this line");
  EXPECT_EQ(obj_error(kThree + "f 0 1 2\n"), "test.obj:4: the face refers to vertex 0; indices begin at 1");
  EXPECT_EQ(obj_error("v 1 2\n" + kThree + "f 1 2 3"), "test.obj:1: expected 3 numbers, found 2");
  EXPECT_EQ(obj_error("\nv 1 2 x\n"), "test.obj:2: 'x' is not a number");
  EXPECT_EQ(obj_error(kThree + "f 1/1 2/1 3/1\n"),
            "test.obj:4: the face refers to texture coordinates 1; there are 0 in the file");
  EXPECT_EQ(obj_error(kThree + "f 1//2 2//2 3//2\nvn 0 0 1\n"),
            "test.obj:4: the face refers to normal 2; there are 1 in the file");
  EXPECT_NE(obj_error(kThree + "\\\n\nf 1 2 3x\n").find("test.obj:6: '3x' is not a corner"), std::string::npos);
  EXPECT_NE(obj_error(kThree + "f 1 2 99999999999999999999\n").find("test.obj:4"), std::string::npos);
  EXPECT_EQ(obj_error(""), "test.obj: no faces in this file");
  EXPECT_EQ(obj_error(kThree), "test.obj: no faces in this file");
  EXPECT_EQ(obj_error(kThree + "f 1 1 2\nf 2\nf\n"),
            "test.obj:4: fewer than three distinct corners; 3 faces of this kind were dropped, so no face is left");
  EXPECT_EQ(obj_error(kThree + "f 1 1 2\n"),
            "test.obj:4: fewer than three distinct corners; 1 face was dropped, so no face is left");
  // The first vertex of a face that is at fault, not one that no face uses.
  const std::string bad = "v inf 0 0\nv 0 0 0\nv 1 0 nan\nv 0 1e39 0\n";
  EXPECT_EQ(obj_error(bad + "f 2 3 4\n"),
            "test.obj:3: vertex 3 is not finite (nan); its 1 face was dropped, so no face is left");
  EXPECT_EQ(obj_error(bad + "f 2 2 3\nf 2 4 3\nf 2 2 2\n"),
            "test.obj:3: vertex 3 is not finite (nan); 2 faces with such vertices were dropped, and 1 face with fewer "
            "than three distinct corners, so no face is left");
  EXPECT_EQ(
      obj_error("v 0 0 0\nv 0 1e39 0\nv 1 0 0\nf 1 2 3\n"),
      "test.obj:2: vertex 2 is not finite (beyond the largest 32-bit float); its 1 face was dropped, so no face is "
      "left");
  EXPECT_NE(obj_error(std::string("\xff\xfev\0 \0", 6)).find("UTF-16"), std::string::npos);
}

TEST(ObjReader, LibrariesAreNamedOnceInFileOrder) {
  Warnings warnings;
  std::string text = "mtllib b.mtl\nmtllib  a b.mtl c.mtl \r\nmtllib b.mtl\n" + kThree;
  EXPECT_EQ(read_text(text + "f 1 2 3\n", &warnings).material_libraries,
            (std::vector<std::string>{"b.mtl", "a b.mtl c.mtl"}));
  EXPECT_TRUE(warnings.empty());
  for (int i = 0; i < 300; ++i) text += "mtllib " + std::to_string(i) + "\n";
  EXPECT_EQ(read_text(text + "f 1 2 3\n", &warnings).material_libraries.size(), 256u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].message.find("beyond the first 256"), std::string::npos);
}

TEST(ObjReader, TheFirstErrorInTheFileIsReported) {
  // Far more text than one chunk: every chunk has an error of its own.
  std::string text;
  for (int i = 0; i < 200000; ++i) text += "v 0 0 " + std::string(i == 1000 || i % 20000 == 19999 ? "?" : "0") + "\n";
  EXPECT_EQ(obj_error(text), "test.obj:1001: '?' is not a number");
}

TEST(ObjReader, OddButValidFilesLoadWithCountedWarnings) {
  Warnings warnings;
  const PolygonMesh mesh = read_text("mtllib a.mtl\n" + kThree +
                                         "v nan 0 0\nv 1 1 0 1\ns off\nl 1 2\np 1\nfoo bar\nfoo\n"
                                         "vp 1 2\nf 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2\nf 1 2 2 3\nf 1 2 1 3\nvn 0 0 1\n",
                                     &warnings);
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_TRUE(mesh.all_triangles());
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  const auto find = [&](const std::string& part) { return test::found_warning(warnings, part); };
  EXPECT_EQ(find("material libraries"), "none");
  EXPECT_EQ(mesh.material_libraries, std::vector<std::string>{"a.mtl"});
  EXPECT_EQ(find("lines and points"), "8 x2");
  EXPECT_EQ(find("the first is 'foo'"), "10 x2");
  EXPECT_EQ(find("free-form"), "12 x1");
  EXPECT_EQ(find("more than three components"), "6 x1");
  EXPECT_EQ(find("vertex that is not finite"), "14 x1");
  EXPECT_EQ(find("vertices that are not finite"), "5 x1");
  EXPECT_EQ(find("fewer than three distinct"), "15 x3");
  EXPECT_EQ(find("repeated corners removed"), "17 x1");
  EXPECT_EQ(find("normals that no face uses"), "19 x1");
  EXPECT_EQ(warnings.size(), 9u);
}

TEST(ObjReader, FacesWithoutNormalsAmongOthersTakeTheirOwn) {
  Warnings warnings;
  const PolygonMesh mesh = read_text(kThree + "vn 1 0 0\nvt 0.5 0.5\nf 1/1/1 2/1/1 3/1/1\nf 1 2 3\n", &warnings);
  ASSERT_EQ(mesh.normals.size(), 2u);
  EXPECT_EQ(mesh.normals[1], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.normal_corners, (Buffer<std::uint32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(mesh.texture_corners, (Buffer<std::uint32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(mesh.texture_coordinates[1], Vec2f(0, 0));
  EXPECT_EQ(warnings.size(), 2u);
}

TEST(ObjReader, EqualIndicesBecomeNormalsPerPosition) {
  const PolygonMesh mesh = read_text(kThree + "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nf 1//1 2//2 3//3\n");
  EXPECT_EQ(mesh.normals.size(), 3u);
  EXPECT_TRUE(mesh.normal_corners.empty());
}

std::string large_obj() {
  std::string text = "o first\n";
  const int n = 220;
  for (int i = 0; i < n; ++i) {
    if (i == n / 2) text += "g second\nusemtl stone\n";
    for (int k = 0; k < n; ++k) {
      text += "v " + std::to_string(i * 0.37) + " " + std::to_string(std::sin(i + k)) + " " + std::to_string(k * 1e-3) +
              "\nvn 0 1 " + std::to_string(k) + "\n";
      if (i == 0 || k == 0) continue;
      if ((i + k) % 3 == 0)
        text += "f -1//-1 -2//-2 \\\n -" + std::to_string(n + 2) + "//-" + std::to_string(n + 2) + "\n";
      else
        text += "f " + std::to_string(i * n + k) + "//1 " + std::to_string(i * n + k - 1) + "//2 -" +
                std::to_string(n + 1) + "//-1 " + std::to_string(i * n + k - n) + "//3\n";
    }
  }
  return text;
}

TEST(ObjReader, ResultDoesNotDependOnThreads) {
  const std::string text = large_obj();
  ASSERT_GT(text.size(), 8 * text::kChunkBytes);
  std::vector<PolygonMesh> meshes;
  for (const int threads : {1, 2, 3, 7}) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
    tbb::task_arena arena(threads);
    arena.execute([&] { meshes.push_back(read_text(text)); });
  }
  EXPECT_EQ(meshes[0].face_count(), 219u * 219u);
  EXPECT_EQ(meshes[0].groups.size(), 2u);
  for (const PolygonMesh& mesh : meshes) EXPECT_TRUE(same_mesh(mesh, meshes[0]));
}

TEST(ObjReader, DamagedTextNeverHarms) {
  // Every prefix and every byte replaced: an error, or a mesh whose indices are in range.
  const std::string text = kThree + "v 1 1 0\nvt 0 0\nvn 0 0 1\ng a\nf 1/1/1 2/1/1 4/1/1 3/1/1\nf -1 -2 \\\n-3\n";
  const auto try_reading = [](const std::string& damaged) {
    Warnings warnings;
    try {
      expect_valid(read_obj(damaged, "test.obj", warnings));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    try_reading(text.substr(0, i));
    for (const char c : {'\0', '\n', '/', '-', '9', '\\', '#', '\xff', ' ', 'e'}) {
      std::string damaged = text;
      damaged[i] = c;
      try_reading(damaged);
    }
  }
}

TEST(ObjReader, MalformedFilesOfOthersNeverHarm) { test::read_all_damaged("malformed/obj", ".obj"); }

TEST(ObjReader, FeatureFilesOfOthersLoad) {
  // No face at all; UTF-16 text; a number that is none ("3.1+e2"); normals that the file does not have.
  const std::vector<std::string> refused = {"issue-356-leading-spaces-newmtl.obj",
                                            "line-prim.obj",
                                            "testpoints.obj",
                                            "testlines.obj",
                                            "number_formats.obj",
                                            "cube_with_vertexcolors_uni.obj",
                                            "point_cloud.obj",
                                            "smoothing-group-two-squares.obj"};
  for (const auto& path : test::test_data_files("obj_features")) {
    if (path.extension() != ".obj") continue;
    Warnings warnings;
    try {
      expect_valid(read_mesh_file(path.string(), warnings));
    } catch (const Error& error) {
      EXPECT_NE(std::find(refused.begin(), refused.end(), path.filename().string()), refused.end()) << error.what();
    }
  }
}

TEST(ObjReader, WellKnownMeshesHaveTheirCounts) {
  const std::vector<std::tuple<std::string, std::size_t, std::size_t, std::size_t>> known = {
      {"stanford-bunny.obj", 35947, 69451, 3},
      {"armadillo.obj", 43243, 86482, 3},
      {"suzanne.obj", 507, 500, 4},
      {"teapot.obj", 3644, 6320, 3},
      {"koala.obj", 49999, 99994, 3},
      {"nefertiti_lowres.obj", 35002, 70000, 3},
      {"boot.obj", 19931, 39906, 3},
      {"mountain.obj", 25600, 50562, 3},
      {"hammer.obj", 30082, 60160, 3},
      {"goathead.obj", 2763, 5522, 3},
      {"penguin.obj", 3362, 6720, 3}};
  std::size_t found = 0;
  for (const auto& path : test::test_data_files("meshes"))
    for (const auto& [name, vertices, faces, largest] : known)
      if (path.filename() == name) {
        Warnings warnings;
        const PolygonMesh mesh = read_mesh_file(path.string(), warnings);
        expect_valid(mesh);
        EXPECT_EQ(mesh.positions.size(), vertices) << name;
        EXPECT_EQ(mesh.face_count(), faces) << name;
        EXPECT_EQ(mesh.all_triangles(), largest == 3) << name;
        ++found;
      }
  EXPECT_TRUE(found == 0 || found == known.size()) << found;
}

}  // namespace
}  // namespace raytree
