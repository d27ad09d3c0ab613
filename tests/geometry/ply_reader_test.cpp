// The PLY reader: all formats and types give the same mesh, sizes are checked before memory is taken, damaged files
// give errors, and the result is equal for any thread count.
#include "geometry/ply_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <thread>

#include "geometry/mapped_file.h"
#include "geometry/mesh_file.h"
#include "geometry/text_scanning.h"
#include "tests/mesh_expectations.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using test::expect_valid;
using test::same_mesh;

PolygonMesh read_bytes(const std::string& bytes, Warnings* kept = nullptr) {
  Warnings warnings;
  PolygonMesh mesh = read_ply(bytes, "test.ply", warnings);
  expect_valid(mesh);
  if (kept) *kept = warnings;
  return mesh;
}

std::string ply_error(const std::string& bytes) {
  Warnings warnings;
  try {
    read_ply(bytes, "test.ply", warnings);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().file, "test.ply");
    return error.what();
  }
  return "no error";
}

template <class T>
void append(std::string& bytes, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

void append_typed(std::string& bytes, const std::string& type, double value, const std::string& format) {
  const bool big = format == "binary_big_endian";
  if (format == "ascii") {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g ", value);
    bytes += text;
  } else if (type == "char" || type == "int8") {
    append(bytes, static_cast<std::int8_t>(value), big);
  } else if (type == "uchar" || type == "uint8") {
    append(bytes, static_cast<std::uint8_t>(value), big);
  } else if (type == "short" || type == "int16") {
    append(bytes, static_cast<std::int16_t>(value), big);
  } else if (type == "ushort" || type == "uint16") {
    append(bytes, static_cast<std::uint16_t>(value), big);
  } else if (type == "int" || type == "int32") {
    append(bytes, static_cast<std::int32_t>(value), big);
  } else if (type == "uint" || type == "uint32") {
    append(bytes, static_cast<std::uint32_t>(value), big);
  } else if (type == "float" || type == "float32") {
    append(bytes, static_cast<float>(value), big);
  } else {
    append(bytes, value, big);
  }
}

const std::vector<std::string> kFormats = {"ascii", "binary_little_endian", "binary_big_endian"};
const std::vector<std::string> kTypes = {"char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
                                         "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};

/// A prism roof: five vertices, a triangle, a quad and a pentagon; with elements and properties that nobody knows.
std::string roof(const std::string& format, const std::string& value, const std::string& count,
                 const std::string& index, bool extras, const std::string& name = "vertex_indices") {
  std::string file = "ply\nformat " + format + " 1.0\ncomment a roof\nobj_info none\n";
  if (extras) file += "element sight 2\nproperty list uchar double path\nproperty short mark\n";
  file += "element vertex 5\n";
  if (extras) file += "property list int float weights\n";
  file += "property " + value + " x\nproperty " + value + " y\nproperty " + value + " z\n";
  if (extras) file += "property uchar red\n";
  file += "element face 3\n";
  if (extras) file += "property int flags\nproperty list uchar ushort tags\n";
  file += "property list " + count + " " + index + " " + name + "\n";
  if (extras) file += "property list uchar float texcoord\n";
  file += "end_header\n";
  const auto put = [&](const std::string& type, double v) { append_typed(file, type, v, format); };
  const auto end_line = [&] {
    if (format == "ascii") file += '\n';
  };
  if (extras)
    for (int i = 0; i < 2; ++i) {
      put("uchar", i);
      for (int k = 0; k < i; ++k) put("double", 0.5);
      put("short", -7);
      end_line();
    }
  const int positions[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 3, 1}};
  for (int i = 0; i < 5; ++i) {
    if (extras) {
      put("int", i % 3);
      for (int k = 0; k < i % 3; ++k) put("float", 0.25);
    }
    for (const int c : positions[i]) put(value, c);
    if (extras) put("uchar", 200);
    end_line();
  }
  const std::vector<std::vector<int>> faces = {{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2, 4, 3}};
  for (const auto& face : faces) {
    if (extras) {
      put("int", 1);
      put("uchar", 1);
      put("ushort", 65535);
    }
    put(count, static_cast<double>(face.size()));
    for (const int i : face) put(index, i);
    if (extras) {
      put("uchar", 2);
      put("float", 0.5);
      put("float", 0.5);
    }
    end_line();
  }
  return file;
}

TEST(PlyReader, AllFormatsTypesAndSpellingsGiveTheSameMesh) {
  const PolygonMesh reference = read_bytes(roof("ascii", "float", "uchar", "int", false));
  EXPECT_EQ(reference.face_sizes, (Buffer<std::uint32_t>{3, 4, 5}));
  EXPECT_EQ(reference.corners, (Buffer<std::uint32_t>{0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 4, 3}));
  EXPECT_EQ(reference.positions[4], Vec3f(1, 3, 1));
  for (const std::string& format : kFormats)
    for (const std::string& type : kTypes)
      for (const bool extras : {false, true}) {
        SCOPED_TRACE(format + " " + type);
        EXPECT_TRUE(same_mesh(read_bytes(roof(format, type, "uchar", "int", extras)), reference));
        EXPECT_TRUE(same_mesh(read_bytes(roof(format, "float", type, "uint", extras)), reference));
        EXPECT_TRUE(same_mesh(read_bytes(roof(format, "double", "int", type, extras, "vertex_index")), reference));
      }
}

TEST(PlyReader, SaysWhatItSkips) {
  Warnings warnings;
  read_bytes(roof("binary_little_endian", "float", "uchar", "int", true) + "xyz", &warnings);
  ASSERT_EQ(warnings.size(), 4u);
  EXPECT_EQ(warnings[0].message, "vertex properties not used: 'weights', 'red'");
  EXPECT_EQ(warnings[0].count, 0);  // a list of names counts nothing
  EXPECT_EQ(warnings[1].message, "face properties not used: 'flags', 'tags', 'texcoord'");
  EXPECT_EQ(warnings[2].message, "bytes after the last element dropped");
  EXPECT_EQ(warnings[2].count, 3);
  EXPECT_EQ(warnings[3].message, "elements 'sight' skipped");
  EXPECT_EQ(warnings[3].count, 2);
}

std::string triangle(const std::string& properties, const std::vector<std::string>& vertices,
                     const std::string& rest = "3 0 1 2\n") {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n" + properties + "element face " +
                     std::to_string(std::count(rest.begin(), rest.end(), '\n')) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const std::string& v : vertices) text += v + "\n";
  return text + rest;
}

TEST(PlyReader, ReadsNormalsAndTextureCoordinates) {
  for (const auto& [u, v] :
       std::vector<std::pair<std::string, std::string>>{{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}) {
    const PolygonMesh mesh = read_bytes(triangle(
        "property float nx\nproperty float ny\nproperty float nz\nproperty float " + u + "\nproperty float " + v + "\n",
        {"0 0 0 0 0 1 .25 .5", "1 0 0 0 1 0 1 0", "0 1 0 1 0 0 0 1"}));
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.normals[1], Vec3f(0, 1, 0));
    EXPECT_EQ(mesh.texture_coordinates[0], Vec2f(0.25f, 0.5f));
    EXPECT_TRUE(mesh.normal_corners.empty());
  }
  // Half a normal is none.
  EXPECT_TRUE(read_bytes(triangle("property float nx\n", {"0 0 0 1", "1 0 0 1", "0 1 0 1"})).normals.empty());
}

TEST(PlyReader, LineEndsOfEveryKind) {
  const std::string text = triangle("", {"0 0 0", "1 0 0", "0 1 0"});
  const PolygonMesh reference = read_bytes(text);
  for (const std::string end : {"\r\n", "\r", " \n", "\n\n"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? (other == "ply" && end == "\n\n" ? "\n" : end) : std::string(1, c);
    EXPECT_TRUE(same_mesh(read_bytes(other), reference)) << text::in_quotes(end);
  }
  EXPECT_TRUE(same_mesh(read_bytes(text.substr(0, text.size() - 1)), reference));
  // Binary data that begin with a line feed; and a header whose last line alone ends with a carriage return.
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header";
  const std::string body("\n\0\0\0\1\0\0\0\1\3\0\1\2", 13);
  EXPECT_EQ(read_bytes(header + "\n" + body).positions[0], Vec3f(10, 0, 0));
  EXPECT_EQ(read_bytes(header + "\r\n" + body).positions[0], Vec3f(10, 0, 0));
}

TEST(PlyReader, AsciiNeedNotKeepToLines) {
  const std::string lines = roof("ascii", "float", "uchar", "int", true);
  std::string tokens = lines;
  const std::size_t body = tokens.find("end_header\n") + 11;
  std::replace(tokens.begin() + static_cast<std::ptrdiff_t>(body), tokens.end(), '\n', ' ');
  Warnings warnings;
  EXPECT_TRUE(same_mesh(read_bytes(tokens, &warnings), read_bytes(lines)));
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const Warning& w) { return w.message.find("in sequence") != std::string::npos; }));
  std::replace(tokens.begin() + static_cast<std::ptrdiff_t>(body), tokens.end(), ' ', '\n');
  EXPECT_TRUE(same_mesh(read_bytes(tokens), read_bytes(lines)));
}

TEST(PlyReader, DoublesFarFromTheOriginKeepMillimetres) {
  for (const std::string& format : kFormats) {
    std::string file = "ply\nformat " + format +
                       " 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const double positions[3][3] = {{1e6 + 0.001, 5, 0}, {1e6 + 1, 5, 0}, {1e6, 6, 0.25}};
    for (const auto& p : positions)
      for (const double c : p) {
        if (format == "ascii") {
          char text[40];
          std::snprintf(text, sizeof text, "%.17g%c", c, &c == &p[2] ? '\n' : ' ');
          file += text;
        } else {
          append(file, c, format == "binary_big_endian");
        }
      }
    for (const int i : {3, 0, 1, 2}) append_typed(file, i == 3 ? "uchar" : "int", i, format);
    const PolygonMesh mesh = read_bytes(file);
    EXPECT_EQ(mesh.origin, Vec3d(1000001, 6, 0)) << format;  // the box's center, rounded
    EXPECT_NEAR(mesh.origin.x + static_cast<double>(mesh.positions[0].x), 1e6 + 0.001, 1e-7);
  }
}

TEST(PlyReader, HeaderErrorsNameTheLine) {
  const std::string begin = "ply\nformat ascii 1.0\n";
  EXPECT_NE(ply_error("").find("not a PLY file"), std::string::npos);
  EXPECT_NE(ply_error("plx\n").find("not a PLY file"), std::string::npos);
  EXPECT_NE(ply_error("ply\nformat utf8 1.0\n").find("test.ply:2: unknown format 'utf8'"), std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex many\n").find("test.ply:3: 'many' is not a count"), std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex -1\n").find("test.ply:3"), std::string::npos);
  EXPECT_NE(ply_error(begin + "property float x\n").find("test.ply:3: a property before"), std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\nproperty half x\n").find("test.ply:4: unknown type 'half'"),
            std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\nproperty list uchar x\n").find("test.ply:4"), std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\n").find("no end_header"), std::string::npos);
  EXPECT_NE(ply_error("ply\nend_header\n").find("no format line"), std::string::npos);
  EXPECT_NE(ply_error(begin + "end_header\n").find("no element 'vertex'"), std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\nproperty float x\nend_header\n1\n").find("no faces"),
            std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\nproperty float x\nelement face 1\nproperty list uchar int "
                              "vertex_indices\nend_header\n1\n3 0 0 0\n")
                .find("lacks a property x, y or z"),
            std::string::npos);
  EXPECT_NE(ply_error(begin + "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                              "property int vertex_indices\nend_header\n0 0 0\n3\n")
                .find("lacks a list vertex_indices"),
            std::string::npos);
}

TEST(PlyReader, BodyErrorsNameLineOrElement) {
  const std::vector<std::string> three = {"0 0 0", "1 0 0", "0 1 0"};
  EXPECT_EQ(ply_error(triangle("", three, "3 0 1 3\n")),
            "test.ply:13: face 1: '3' is not the index of a vertex: it must be in 0..2");
  EXPECT_NE(ply_error(triangle("", three, "3 0 1 2\n3 0 -1 2\n")).find("test.ply:14: face 2: '-1'"), std::string::npos);
  EXPECT_NE(ply_error(triangle("", {"0 0 0", "0 x 0", "1 0 0"})).find("test.ply:11: vertex 2: 'x' is not a number"),
            std::string::npos);
  EXPECT_NE(ply_error(triangle("", three, "3 0 1\n")).find("face 1: the data end inside"), std::string::npos);
  EXPECT_NE(ply_error(triangle("", three, "-3 0 1 2\n")).find("'-3' is not a list's count"), std::string::npos);
  std::string binary = roof("binary_little_endian", "float", "uchar", "int", false);
  EXPECT_NE(ply_error(binary.substr(0, binary.size() - 1)).find("test.ply: face 3: the data end inside"),
            std::string::npos);
  binary[binary.size() - 4] = 5;
  EXPECT_EQ(ply_error(binary), "test.ply: face 3: a corner is not the index of a vertex: it must be in 0..4");
  binary[binary.size() - 1] = '\xff';
  EXPECT_NE(ply_error(binary).find("face 3: a corner"), std::string::npos);
  EXPECT_EQ(ply_error(triangle("", three, "3 0 0 1\n2 0 1\n0\n")),
            "test.ply:13: face 1: fewer than three distinct corners; 3 faces of this kind were dropped, so no face is "
            "left");
  EXPECT_EQ(ply_error(triangle("", {"0 0 0", "0 nan 0", "1 0 0"})),
            "test.ply:11: vertex 2 is not finite (nan); its 1 face was dropped, so no face is left");
}

TEST(PlyReader, SizesAreCheckedBeforeMemoryIsTaken) {
  // Each of these promises up to terabytes in a file of some hundred bytes.
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  for (const std::string& format : kFormats)
    for (const std::string count : {"1000000", "4000000000", "1000000000000", "999999999999999999"}) {
      const std::string begin = "ply\nformat " + format + " 1.0\n";
      const std::string list = "property list uint int vertex_indices\nend_header\n0 0 0 0";
      EXPECT_NE(ply_error(begin + "element vertex " + count + "\n" + xyz + "element face 1\n" + list).find("too short"),
                std::string::npos);
      EXPECT_NE(ply_error(begin + "element vertex 1\n" + xyz + "element face " + count + "\n" + list).find("too short"),
                std::string::npos);
      EXPECT_NE(ply_error(begin + "element other " + count + "\nproperty list char char a\nelement vertex 1\n" + xyz +
                          "element face 1\n" + list)
                    .find("too short"),
                std::string::npos);
      // Elements without properties take no bytes: however many, they are passed at once.
      EXPECT_NE(ply_error(begin + "element none " + count + "\nelement vertex 1\n" + xyz + "element face 1\n" + list),
                "");
    }
  EXPECT_NE(ply_error(triangle("", {"0 0 0"}, "4000000000 0 0 0\n")).find("the data end inside"), std::string::npos);
  std::string binary = roof("binary_big_endian", "float", "uint", "int", false);
  const std::size_t faces = binary.find("end_header\n") + 11 + 5 * 12;
  binary.replace(faces, 4, "\xff\xff\xff\xff");
  EXPECT_NE(ply_error(binary).find("face 1: the data end inside"), std::string::npos);
}

TEST(PlyReader, OddValuesAreDroppedWithACount) {
  Warnings warnings;
  const PolygonMesh mesh = read_bytes(
      triangle("", {"0 0 0", "1 0 0", "0 1 0", "nan 0 inf"}, "3 0 1 2\n3 1 2 3\n4 0 1 1 2\n3 0 0 2\n"), &warnings);
  EXPECT_EQ(mesh.corners, (Buffer<std::uint32_t>{0, 1, 2, 0, 1, 2}));
  ASSERT_EQ(warnings.size(), 4u);
  EXPECT_EQ(warnings[0].where.line, 16);  // the repeated corner
  EXPECT_EQ(warnings[1].where.line, 17);  // the degenerate face
  EXPECT_EQ(warnings[2].where.line, 15);  // the face with the vertex that is not finite
  EXPECT_EQ(warnings[3].where.line, 13);  // that vertex
  EXPECT_EQ(mesh.positions[3], mesh.positions[0]);
}

std::string large_ply(const std::string& format, bool quads) {
  const int n = 250;
  std::string file = "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(n * n) +
                     "\nproperty float x\nproperty double y\nproperty float z\nproperty float nx\nproperty float ny\n"
                     "property float nz\nelement face " +
                     std::to_string((n - 1) * (n - 1)) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](const char* type, double v) { append_typed(file, type, v, format); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      put("float", i * 0.25);
      put("double", ((i * 7 + k * 13) % 64) * 0.125);
      put("float", k);
      put("float", 0);
      put("float", 1);
      put("float", k);
      if (format == "ascii") file += '\n';
    }
  for (int i = 1; i < n; ++i)
    for (int k = 1; k < n; ++k) {
      const int at = i * n + k;
      const bool quad = quads && (i + k) % 3 != 0;
      put("uchar", quad ? 4 : 3);
      put("int", at);
      put("int", at - 1);
      if (quad) put("int", at - 1 - n);
      put("int", at - n);
      if (format == "ascii") file += '\n';
    }
  return file;
}

TEST(PlyReader, ResultDependsNeitherOnThreadsNorOnFormat) {
  for (const bool quads : {false, true}) {
    std::vector<PolygonMesh> meshes;
    for (const std::string& format : kFormats) {
      const std::string file = large_ply(format, quads);
      EXPECT_TRUE(format != "ascii" || file.size() > 6 * text::kChunkBytes);
      for (const int threads : {1, 2, 3, 7}) {
        const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
        tbb::task_arena arena(threads);
        arena.execute([&] { meshes.push_back(read_bytes(file)); });
      }
    }
    EXPECT_EQ(meshes[0].face_count(), 249u * 249u);
    EXPECT_EQ(meshes[0].all_triangles(), !quads);
    for (const PolygonMesh& mesh : meshes) EXPECT_TRUE(same_mesh(mesh, meshes[0]));
  }
}

TEST(PlyReader, DamagedFilesNeverHarm) {
  const auto try_reading = [](const std::string& damaged) {
    Warnings warnings;
    try {
      expect_valid(read_ply(damaged, "test.ply", warnings));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  };
  for (const std::string& format : kFormats) {
    const std::string file = roof(format, "float", "uchar", "int", true);
    for (std::size_t i = 0; i < file.size(); ++i) {
      try_reading(file.substr(0, i));
      for (const char c : {'\0', '\n', '-', '9', '\xff', ' ', '\x7f'}) {
        std::string damaged = file;
        damaged[i] = c;
        try_reading(damaged);
      }
    }
  }
}

TEST(PlyReader, MalformedFilesOfOthersNeverHarm) { test::read_all_damaged("malformed/ply", ".ply"); }

TEST(PlyReader, FeatureFilesOfOthersLoad) {
  const std::vector<std::pair<std::string, std::size_t>> counts = {{"icosahedron.ply", 20},
                                                                   {"icosahedron_ascii.ply", 20},
                                                                   {"sofa.ply", 24104},
                                                                   {"platonic_shelf.ply", 50},
                                                                   {"platonic_shelf_ascii.ply", 50},
                                                                   {"platonic_shelf_big_endian.ply", 50},
                                                                   {"Wuson.ply", 3732},
                                                                   {"cube.ply", 6},
                                                                   {"cube_binary.ply", 12},
                                                                   {"cube_uv.ply", 6},
                                                                   {"cube_binary_starts_with_nl.ply", 6},
                                                                   {"cube_binary_header_with_RN_newline.ply", 12},
                                                                   {"cube_att.ply", 12},
                                                                   {"cube_quads.ply", 6},
                                                                   {"cube_blender_uv.ply", 6},
                                                                   {"bun_zipper.ply", 69451}};
  std::size_t found = 0;
  bool any = false;
  PolygonMesh shelf;
  for (const char* folder : {"ply_features", "obj_features", "meshes"})
    for (const auto& path : test::test_data_files(folder)) {
      any = true;
      for (const auto& [name, faces] : counts)
        if (path.filename() == name) {
          Warnings warnings;
          const PolygonMesh mesh = read_mesh_file(path.string(), warnings);
          expect_valid(mesh);
          EXPECT_EQ(mesh.face_count(), faces) << name;
          if (name.rfind("platonic_shelf", 0) == 0) {
            // Three formats of one mesh: the ascii file holds six digits.
            if (shelf.positions.empty()) shelf = mesh;
            EXPECT_EQ(mesh.corners, shelf.corners);
            for (std::size_t i = 0; i < shelf.positions.size(); ++i)
              EXPECT_LT((mesh.positions[i] - shelf.positions[i]).length(), 1e-5f);
          }
          ++found;
        }
    }
  EXPECT_TRUE(!any || found == counts.size()) << found;
}

TEST(MeshFile, ReadsByExtensionAndSaysWhatItCannot) {
  EXPECT_TRUE(is_mesh_file_name("a/b.OBJ"));
  EXPECT_TRUE(is_mesh_file_name("b.ply"));
  EXPECT_FALSE(is_mesh_file_name("a.ply/b"));
  EXPECT_FALSE(is_mesh_file_name("b.ply.gz"));
  Warnings warnings;
  EXPECT_THROW(read_mesh_file("no/such/file.obj", warnings), Error);
  const std::string folder = testing::TempDir() + "raytree_mesh_file_" + std::to_string(::getpid());
  ASSERT_EQ(::mkdir(folder.c_str(), 0700), 0);
  const std::string path = folder + "/packed.ply";
  std::ofstream(path) << "\x1f\x8b rest";
  try {
    read_mesh_file(path, warnings);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("gzip"), std::string::npos);
  }
  ::unlink(path.c_str());
  EXPECT_THROW(read_mesh_file(folder + "/.obj", warnings), Error);
  ::rmdir(folder.c_str());
}

TEST(MappedFile, PipesAreReadWhereFilesAreMapped) {
  const std::string folder = testing::TempDir() + "raytree_mapped_file_" + std::to_string(::getpid());
  ASSERT_EQ(::mkdir(folder.c_str(), 0700), 0);
  const std::string bytes = large_ply("binary_little_endian", true);
  const std::string file = folder + "/file.ply", pipe = folder + "/pipe.ply", empty = folder + "/empty.obj";
  std::ofstream(file, std::ios::binary) << bytes;
  std::ofstream(empty).close();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(MappedFile(file).is_mapped());
  EXPECT_EQ(MappedFile(empty).bytes().size(), 0u);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << bytes; });
  Warnings warnings;
  const PolygonMesh through_pipe = read_mesh_file(pipe, warnings);
  writer.join();
  EXPECT_TRUE(same_mesh(through_pipe, read_mesh_file(file, warnings)));
  EXPECT_THROW(MappedFile{folder}, Error);
  for (const std::string& path : {file, pipe, empty}) ::unlink(path.c_str());
  ::rmdir(folder.c_str());
}

}  // namespace
}  // namespace raytree
