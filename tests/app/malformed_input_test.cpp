// Malformed input from outside: the program refuses it with status 2 and a message that names file and line, soon, and
// with no more memory than four times the file plus 256 MiB. What is odd and accepted can be rendered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <regex>

#include "app/sanitized.h"
#include "renderer/image_file.h"
#include "tests/app/program.h"
#include "tests/test_data.h"

namespace raytree::test {
namespace {

constexpr bool kSanitized = kAddressSanitized;  // shadow memory and quarantine are no memory of the program

constexpr double kLongestRefusal = 10;  // seconds for a small file, on a machine busy with other tests

std::uint64_t memory_limit(std::uint64_t file_bytes) { return 4 * file_bytes + (std::uint64_t(256) << 20); }

/// Runs `raytree info` on the file; whatever it says of it, the memory stays within the promise.
ProgramResult judged(const std::string& path) {
  const ProgramResult result = run_program({"info", path});
  if (!kSanitized) {
    EXPECT_LE(result.peak_memory_bytes, memory_limit(std::filesystem::file_size(path)));
  }
  return result;
}

/// What is wrong with a file as a whole has no line.
constexpr const char* kOfTheWholeFile[] = {"no faces in this file", "not a PLY file: it does not begin with",
                                           "is no scene by its name: a scene file ends in",
                                           "the header names no element",
                                           // Of binary data, an element at most.
                                           "the file is too short for", "the data end inside this element"};

void expect_refused(const ProgramResult& result, const std::string& path) {
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_EQ(result.out, "");
  const std::string head = "raytree: error: " + path + ":";
  ASSERT_EQ(result.err.rfind(head, 0), 0u) << result.err;
  const std::string rest = result.err.substr(head.size());
  const bool whole = std::any_of(std::begin(kOfTheWholeFile), std::end(kOfTheWholeFile),
                                 [&](const char* part) { return contains(rest, part); });
  EXPECT_TRUE(whole || std::regex_search(rest, std::regex("^[1-9][0-9]*: "))) << "no line: " << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

/// Renders an odd file: a picture without NaN or infinity, soon.
void expect_a_picture(const std::string& path) {
  TemporaryFolder folder;
  const std::string picture = folder.path("a.exr");
  const ProgramResult result =
      run_program({"render", path, "-o", picture, "--size", "16x16", "--quiet", "--stats", folder.path("s.json")});
  EXPECT_LT(result.seconds, kLongestRefusal);
  EXPECT_EQ(result.status, 0) << result.err;
  if (result.status != 0) return;
  const DecodedImage image = read_image_file(picture);
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.height, 16);
  for (const auto& plane : image.planes)
    EXPECT_TRUE(std::all_of(plane.begin(), plane.end(), [](float value) { return std::isfinite(value); }));
  EXPECT_TRUE(contains(file_text(folder.path("s.json")), "\"not_finite_samples\": 0"));
}

/// Files of the folder: all must be refused but `accepted`, which maps a file that is odd and yet a mesh to a part of
/// the warning that says what is odd; "": nothing is (its kind of damage is beyond what its format's reader looks at).
void judge_folder(const std::string& folder, const std::map<std::string, std::string>& accepted = {}) {
  const auto files = test_data_files(folder);
  if (files.empty()) GTEST_SKIP() << "no test data in " << folder;
  std::size_t met = 0;
  std::uint64_t most = 0;
  for (const auto& file : files) {
    const std::string path = file.string();
    SCOPED_TRACE(path);
    const ProgramResult result = judged(path);
    EXPECT_LT(result.seconds, kLongestRefusal);
    most = std::max(most, result.peak_memory_bytes);
    const auto known = accepted.find(file.filename().string());
    if (known == accepted.end()) {
      expect_refused(result, path);
      continue;
    }
    ++met;
    EXPECT_EQ(result.status, 0) << result.err;
    if (known->second.empty())
      EXPECT_EQ(result.err, "");
    else
      EXPECT_TRUE(contains(result.err, "warning: " + path) && contains(result.err, known->second)) << result.err;
    expect_a_picture(path);
  }
  EXPECT_EQ(met, accepted.size()) << "files that should be accepted are not there";
  std::fprintf(stderr, "%s: at most %.1f MiB\n", folder.c_str(), static_cast<double>(most) / (1 << 20));
}

TEST(MalformedInput, ObjFilesOfOthers) {
  const std::string dropped = "faces with fewer than three distinct corners dropped";
  const std::string unknown = "unknown statements skipped";
  const std::string tags = "subdivision tags of unknown names ignored";
  const std::string libraries = "is not there";
  judge_folder("malformed/obj", {{"assimp_malformed2.obj", dropped},
                                 {"draco_deg_faces.obj", dropped},
                                 {"draco_degenerate_mesh.obj", ""},  // three distinct vertices at one place
                                 {"tinyobj_afl_id_000018_sig_06_src_000141_op_flip1_pos_449.obj", tags},
                                 {"tinyobj_afl_id_000019_sig_06_src_000141_op_arith8_pos_446_val__13.obj", tags},
                                 {"tinyobj_issue-319-002.obj", ""},  // polygons that are hard to triangulate
                                 {"tinyobj_issue-319-003.obj", ""},
                                 {"tinyobj_issue-330.obj", ""},
                                 {"tinyobj_missing_material_file.obj", ""},  // its mtllib line is a comment
                                 {"trimesh_jacked.obj", libraries},
                                 {"trimesh_noimg.obj", ""},  // lacks the picture of its material
                                 {"trimesh_notenoughindices.obj", dropped},
                                 {"trimesh_obj_with_no_face_in_chunk.obj", ""},
                                 {"ufbx_fuzz_0183.obj", unknown},
                                 {"ufbx_fuzz_0186.obj", unknown},
                                 {"ufbx_fuzz_0187.obj", unknown},
                                 {"ufbx_fuzz_0188.obj", unknown},
                                 {"ufbx_fuzz_0191.obj", unknown},
                                 {"ufbx_synthetic_bad_unicode_mtl_0_obj.obj", libraries}});
}

TEST(MalformedInput, PlyFilesOfOthers) {
  judge_folder("malformed/ply", {{"draco_delim_test.ply", "vertex properties not used"}});
}

// Valid JSON or not: none of these is a scene.
TEST(MalformedInput, JsonFilesOfOthers) { judge_folder("malformed/json"); }

const std::string kPlyHead = "ply\nformat ascii 1.0\n";
const std::string kVertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";

TEST(MalformedInput, NumbersThatPromiseMoreThanTheFileHolds) {
  struct Case {
    const char* name;
    std::string text, part;
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string little = "ply\nformat binary_little_endian 1.0\n";
  const std::string indices = "property list uint int vertex_indices\nend_header\n";
  const std::vector<Case> cases = {
      {"far.obj", points + "f 1 2 4294967297\n", "vertex 4294967297"},
      {"before.obj", points + "f 1 2 -9223372036854775808\n", "vertex"},
      {"vertices.ply",
       kPlyHead + "element vertex 4000000000\nproperty char x\nproperty char y\nproperty char z\n" +
           "element face 1\n" + indices + "0 0 0\n",
       "too short"},
      {"faces.ply", kPlyHead + kVertices + "element face 4000000000\n" + indices + "0 0 0 1 0 0 0 1 0\n", "too short"},
      {"list.ply", kPlyHead + kVertices + "element face 1\n" + indices + "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n",
       "face 1"},
      {"binary_list.ply",
       little + kVertices + "element face 1\n" + indices + std::string(36, '\0') + "\xff\xff\xff\xff", "face 1"},
      {"skipped.ply",
       little + "element other 1\nproperty list uint double a\n" + kVertices + "element face 1\n" + indices +
           std::string("\xff\xff\xff\xff", 4) + std::string(60, '\0'),
       "other 1"},
      {"polygon.nff", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8\np 4294967295\n0 0 0\n", "ends"},
      {"picture.nff", "v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 65536 65536\n", "2^30"},
      {"image.json", R"({"raytree": 1, "image": {"width": 4000000000, "height": 4000000000}})", "width"},
      {"terrain.json", R"({"raytree": 1, "shapes": [{"name": "t", "type": "terrain", "triangles": 1e18}]})", ""},
      {"flake.json", R"({"raytree": 1, "shapes": [{"name": "f", "type": "sphere_flake", "levels": 60}]})", ""},
  };
  TemporaryFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const std::string path = folder.path(c.name);
    write_text(path, c.text);
    const ProgramResult result = judged(path);
    EXPECT_LT(result.seconds, kLongestRefusal);
    expect_refused(result, path);
    EXPECT_TRUE(contains(result.err, c.part)) << result.err;
  }
}

/// Writes begin, as many whole units as `size` has room for, and end; block by block, since this process's memory would
/// count as the program's.
void write_repeated(const std::string& path, const std::string& begin, const std::string& unit, std::size_t size,
                    const std::string& end) {
  std::ofstream file(path, std::ios::binary);
  file << begin;
  std::string block;
  while (block.size() < (1 << 16)) block += unit;
  for (std::size_t written = 0; written + block.size() <= size; written += block.size()) file << block;
  file << end;
}

TEST(MalformedInput, LargeFilesOfTheTiniestPartsThatFailAtTheirEnd) {
  if (kSanitized) GTEST_SKIP() << "judges memory alone, which sanitizers take for themselves";
  struct Case {
    const char* name;
    std::string begin, unit, end;
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  const std::vector<Case> cases = {
      {"vertices.obj", "", "v 1 2 3\n", "f 1 2 x\n"},
      {"faces.obj", points, "f 1 2 3\n", "f 1 2 4\n"},
      {"corners.obj", points, "f 1/1/1 2/1/1 3/1/1\n", "f 1 2 4\n"},
      {"polygon.obj", points + "f", " 1 2 3", "\nf 1 2 4\n"},
      {"groups.obj", points, "g a\ng b\nf 1 2 3\n", "f 1 2 4\n"},
      {"elements.ply", kPlyHead, "element a 0\n", "end_header\n"},
      {"properties.ply", kPlyHead + "element vertex 3\n", "property char a\n", "end_header\n"},
      {"comments.ply", kPlyHead, "comment\n", "end_header\n"},
      {"spheres.nff", "", "s 0 0 0 1\n", "s 0 0 0\n"},
      {"cones.nff", "", "c 0 0 0 1 0 0 1 1\n", "s 0 0 0\n"},
      {"polygons.nff", "", "p 3 0 0 0 1 0 0 1 1 0\n", "s 0 0 0\n"},
      {"patches.nff", "", "f 1 1 1 1 0 1 0 1\n", "s 0 0 0\n"},
      {"materials.obj", "", "usemtl a\nusemtl b\nmtllib c\n", "f 1 2 x\n"},
      {"numbers.json", R"({"raytree": 1, "shapes": [0)", ",0", "],}"},
      {"objects.json", R"({"raytree": 1, "shapes": [{})", ",{}", "],}"},
      {"keys.json", R"({"raytree": 1)", ",\"\":1", ",}"},
      {"open.json", "", "[", ""},
      {"blanks.json", R"({"raytree": 1,)", "\n", "}"},
      {"string.json", R"({"raytree": 1, "title": ")", "\\n", "}"},
  };
  // 256 MiB are the program's whatever the file is: the file must be large enough for its share to show.
  constexpr std::size_t kBytes = std::size_t(64) << 20;
  TemporaryFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const std::string path = folder.path(c.name);
    write_repeated(path, c.begin, c.unit, kBytes, c.end);
    const ProgramResult result = judged(path);
    expect_refused(result, path);
    std::fprintf(stderr, "%-16s %5.2f s %4llu MiB\n", c.name, result.seconds,
                 static_cast<unsigned long long>(result.peak_memory_bytes >> 20));
    std::filesystem::remove(path);
  }
}

/// `raytree info` on an OBJ of one triangle that uses material "a" of a library beside it.
ProgramResult judged_with_library(const TemporaryFolder& folder, const std::string& library) {
  const std::string mesh = folder.path("mesh.obj");
  write_text(mesh, "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  const ProgramResult result = run_program({"info", mesh});
  EXPECT_LT(result.seconds, kLongestRefusal);
  if (!kSanitized) {
    EXPECT_LE(result.peak_memory_bytes, memory_limit(std::filesystem::file_size(folder.path(library))));
  }
  return result;
}

void judge_library(const TemporaryFolder& folder, const std::string& library, const std::string& refusal,
                   const std::string& warning) {
  SCOPED_TRACE(library);
  const ProgramResult result = judged_with_library(folder, library);
  if (!refusal.empty()) {
    expect_refused(result, folder.path(library));
    EXPECT_TRUE(contains(result.err, refusal)) << result.err;
    return;
  }
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(warning.empty() ? result.err.empty() : contains(result.err, warning)) << result.err;
  expect_a_picture(folder.path("mesh.obj"));
}

TEST(MalformedInput, DamagedMaterialLibraries) {
  struct Case {
    const char *name, *text;
    std::string refusal, warning;  ///< a part of the one or the other; both empty: nothing is said
  };
  const std::string missing = "materials that no library defines";
  TemporaryFolder folder;
  for (const Case& c : {Case{"empty.mtl", "", "", missing},
                        {"noname.mtl", "newmtl\nKd 1 1 1\n", "", missing},
                        {"before.mtl", "Kd 1 1 1\nnewmtl a\n", "before the first newmtl", ""},
                        {"word.mtl", "newmtl a\nKd red\n", "Kd needs one number or three", ""},
                        {"infinite.mtl", "newmtl a\nKd inf nan 1\n", "Kd needs one number or three", ""},
                        {"two.mtl", "newmtl a\nKd 1 1\n", "Kd needs one number or three, not two", ""},
                        {"illum.mtl", "newmtl a\nillum 99\n", "illum", ""},
                        {"map.mtl", "newmtl a\nmap_Kd picture.png\n", "", "textures dropped"},
                        {"unknown.mtl", "newmtl a\nfoo 1\nbar\n", "", "unknown statements skipped (2 "},
                        {"huge.mtl", "newmtl a\nKd 1e38 1e38 1e38\nKs 1e300\nNs 1e30\nNi 1e9\n", "", ""}}) {
    write_text(folder.path(c.name), c.text);
    judge_library(folder, c.name, c.refusal, c.warning);
  }
}

TEST(MalformedInput, LargeMaterialLibraries) {
  if (kSanitized) GTEST_SKIP() << "judges memory alone, which sanitizers take for themselves";
  struct Case {
    const char* name;
    std::string begin, unit, end, refusal, warning;
  };
  const std::string zeros(1 << 16, '\0');
  TemporaryFolder folder;
  for (const Case& c : {Case{"name.mtl", "newmtl ", "junk", "\n", "", "materials that no library defines"},
                        {"line.mtl", "newmtl a\nfoo", " bar", "\n", "", "unknown statements skipped"},
                        {"zeros.mtl", "", zeros, "", "before the first newmtl", ""},
                        {"statements.mtl", "newmtl a\n", "foo 1\n", "", "", "unknown statements skipped"},
                        {"colors.mtl", "newmtl a\n", "Kd .5 .5 .5\n", "", "", ""},
                        {"late.mtl", "newmtl a\n", "Kd .5 .5 .5\n", "Kd x\n", "Kd needs one number or three", ""},
                        {"same.mtl", "", "newmtl a\n", "", "more than 65536 materials", ""},
                        {"blank.mtl", "newmtl a\n", "# nothing\n", "Ns\n", "Ns", ""}}) {
    write_repeated(folder.path(c.name), c.begin, c.unit, std::size_t(64) << 20, c.end);
    judge_library(folder, c.name, c.refusal, c.warning);
    std::filesystem::remove(folder.path(c.name));
  }
}

}  // namespace
}  // namespace raytree::test
