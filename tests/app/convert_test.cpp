// `raytree convert` from outside: what it writes, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "geometry/mesh_file.h"
#include "tests/app/program.h"
#include "tests/point_sets.h"

namespace raytree::test {
namespace {

const char* const kCubeObj =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";

TEST(Convert, WritesWhatWasMade) {
  const TemporaryFolder folder;
  write_text(folder.path("cube.obj"), kCubeObj);
  const auto convert = [&](const std::vector<std::string>& flags, const std::string& name) {
    const ProgramResult result = run_program(with({"convert", folder.path("cube.obj"), folder.path(name)}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    return file_text(folder.path(name));
  };
  EXPECT_TRUE(contains(convert({}, "same.obj"), "v -1 -1 -1\n"));
  // Catmull and Clark 1978: the corner goes to 5/9, the limit of the cage's corners is 1/2.
  EXPECT_TRUE(contains(convert({"--subdivide", "1"}, "once.obj"), "v 0.5555556 0.5555556 0.5555556\n"));
  const std::string limit = convert({"--limit"}, "limit.obj");
  EXPECT_TRUE(contains(limit, "v 0.5 0.5 0.5\n") && contains(limit, "vn 0.57735026 0.57735026 0.57735026\n")) << limit;
  EXPECT_TRUE(contains(convert({"--rate", "1"}, "rate.obj"), "v 0.5 0.5 0.5\n"));
  EXPECT_EQ(convert({"--subdivide", "2", "--threads", "1"}, "a.ply"), convert({"--subdivide", "2"}, "b.ply"));
  EXPECT_TRUE(contains(convert({"--subdivide", "2"}, "c.PLY"), "element face 96\n"));
  EXPECT_TRUE(contains(convert({"--subdivide", "1", "--scheme", "bilinear"}, "flat.obj"), "v 1 1 1\n"));
}

TEST(Convert, SubdividesAsTheReferenceDoes) {
  const TemporaryFolder folder;
  const auto expect_agreement = [&](const std::string& shape, int refinements, const std::vector<std::string>& flags) {
    SCOPED_TRACE(shape);
    const std::string data = std::string(RAYTREE_TEST_DATA) + "/subdiv/";
    const std::string cage = data + "osd_shapes/" + shape + ".obj";
    const std::string theirs =  // level K is the cage after K + 1 refinements
        data + "hbr_reference/" + shape + "_level" + std::to_string(refinements - 1) + ".obj";
    if (!std::filesystem::exists(theirs)) {
      std::fprintf(stderr, "LEFT OUT: no test data in %s\n", theirs.c_str());
      return;
    }
    for (const char* name : {"out.obj", "out.ply"}) {
      const std::string out = folder.path(name);
      const ProgramResult result =
          run_program(with({"convert", cage, out, "--subdivide", std::to_string(refinements)}, flags));
      ASSERT_EQ(result.status, 0) << result.err;
      Warnings warnings;
      const PolygonMesh ours = read_mesh_file(out, warnings), reference = read_mesh_file(theirs, warnings);
      // A PLY has a vertex for each pair of texture coordinates at a point.
      if (std::string(name).ends_with(".obj")) {
        EXPECT_EQ(ours.positions.size(), reference.positions.size());
      }
      EXPECT_EQ(ours.face_count(), reference.face_count());
      EXPECT_LE(set_distance(ours.positions, reference.positions), 1e-5);
    }
  };
  expect_agreement("catmark_cube_creases0", 3, {});
  expect_agreement("catmark_dart_edgeonly", 2, {});
  expect_agreement("bilinear_cube", 2, {"--scheme", "bilinear"});
}

TEST(Convert, TessellatesWithinADistance) {
  const TemporaryFolder folder;
  write_text(folder.path("cube.obj"), kCubeObj);
  const auto triangles = [&](const char* tolerance) {
    const std::string out = folder.path(std::string(tolerance) + ".ply");
    const ProgramResult result = run_program({"convert", folder.path("cube.obj"), out, "--tolerance", tolerance});
    EXPECT_EQ(result.status, 0) << result.err;
    Warnings warnings;
    return read_mesh_file(out, warnings).face_count();
  };
  // Facets' distance goes with the square of their size: 16 times closer, about 16 times as many.
  const std::size_t coarse = triangles("0.01"), fine = triangles("0.000625");
  EXPECT_GT(coarse, 12u);
  EXPECT_GE(fine, 8 * coarse);
  EXPECT_LE(fine, 32 * coarse);
}

TEST(Convert, ReadsPatches) {
  const TemporaryFolder folder;
  // A flat square of side 3: one patch, its points in place.
  std::string text = "1\n3 3\n";
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) text += std::to_string(i) + " " + std::to_string(j) + " 0\n";
  write_text(folder.path("square.bpt"), text);
  const auto convert = [&](const std::vector<std::string>& flags) {
    const ProgramResult result =
        run_program(with({"convert", folder.path("square.bpt"), folder.path("out.obj")}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return file_text(folder.path("out.obj"));
  };
  const std::string cut = convert({"--rate", "3"});
  EXPECT_TRUE(contains(cut, "v 1 2 0\n") && contains(cut, "vn 0 0 1\n")) << cut;
  EXPECT_EQ(std::count(cut.begin(), cut.end(), 'f'), 18);
  const std::string flat = convert({"--tolerance", "0.001"});
  EXPECT_EQ(std::count(flat.begin(), flat.end(), 'f'), 2) << "flat: no more than it takes";
  const std::string patches = folder.path("square.bpt"), out = folder.path("none.obj");
  expect_bad_input({"convert", patches, out}, {"square.bpt", "--rate or --tolerance"});
  expect_bad_input({"convert", patches, out, "--subdivide", "1"}, {"--subdivide", "cages"});
  expect_bad_input({"convert", patches, out, "--rate", "2", "--scheme", "loop"}, {"--scheme", "cages"});
  write_text(patches, "2\n1 2\n");
  expect_bad_input({"convert", patches, out, "--rate", "2"}, {"square.bpt"});
}

TEST(Convert, KeepsTagsWhereTheFileCan) {
  const TemporaryFolder folder;
  write_text(folder.path("cube.obj"), kCubeObj + std::string("t crease 2/1/0 0 1 2.5\nt corner 1/1/0 7 10\n"));
  const auto convert = [&](const std::string& name, const std::vector<std::string>& flags) {
    const ProgramResult result = run_program(with({"convert", folder.path("cube.obj"), folder.path(name)}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  EXPECT_EQ(convert("same.obj", {}), "");
  const std::string same = file_text(folder.path("same.obj"));
  EXPECT_TRUE(contains(same, "t crease 2/1/0 0 1 2.5\n") && contains(same, "t corner 1/1/0 7 10\n")) << same;
  EXPECT_EQ(convert("once.obj", {"--subdivide", "1"}), "");
  const std::string once = file_text(folder.path("once.obj"));
  // The crease's two halves, a level less sharp.
  std::size_t halves = 0;
  for (std::size_t at = once.find("t crease"); at != std::string::npos; at = once.find("t crease", at + 1)) {
    EXPECT_TRUE(contains(once.substr(at, once.find('\n', at) - at), " 1.5"));
    ++halves;
  }
  EXPECT_EQ(halves, 2u) << once;
  EXPECT_TRUE(contains(convert("same.ply", {}), "subdivision tags left out"));
  EXPECT_EQ(convert("limit.ply", {"--limit"}), "") << "no tags are left to lose";
}

TEST(Convert, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const std::string cube = folder.path("cube.obj"), out = folder.path("out.obj");
  write_text(cube, kCubeObj);
  expect_bad_input({"convert"}, {"give a mesh to read"});
  expect_bad_input({"convert", cube}, {"give a mesh to read"});
  expect_bad_input({"convert", cube, folder.path("out.stl")}, {"out.stl", ".obj or .ply"});
  expect_bad_input({"convert", folder.path("none.obj"), out}, {"none.obj"});
  expect_bad_input({"convert", cube, out, "--subdivide", "16"}, {"--subdivide", "15"});
  expect_bad_input({"convert", cube, out, "--subdivide", "1", "--rate", "2"}, {"--rate", "neither"});
  expect_bad_input({"convert", cube, out, "--rate", "0"}, {"--rate"});
  expect_bad_input({"convert", cube, out, "--rate", "1025"}, {"--rate", "1024"});
  expect_bad_input({"convert", cube, out, "--tolerance", "0"}, {"--tolerance", "larger than 0"});
  expect_bad_input({"convert", cube, out, "--tolerance", "nan"}, {"--tolerance"});
  expect_bad_input({"convert", cube, out, "--tolerance", "thin"}, {"--tolerance", "thin"});
  expect_bad_input({"convert", cube, out, "--tolerance", "1", "--rate", "2"}, {"--tolerance", "--rate"});
  expect_bad_input({"convert", cube, out, "--tolerance", "1", "--limit"}, {"--tolerance", "--limit"});
  expect_bad_input({"convert", cube, out, "--scheme", "loop"}, {"--scheme", "--subdivide"});
  expect_bad_input({"convert", cube, out, "--limit", "--scheme", "lop"}, {"loop"});
  expect_bad_input({"convert", cube, out, "--limit", "--scheme", "loop"}, {"cube.obj", "face 0", "triangles alone"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"cube.obj"});
}

}  // namespace
}  // namespace raytree::test
