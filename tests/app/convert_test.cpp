// `raytree convert` from outside: what it writes, and what it refuses.
#include <gtest/gtest.h>

#include "tests/app/program.h"

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
  expect_bad_input({"convert", cube, out, "--scheme", "loop"}, {"--scheme", "--subdivide"});
  expect_bad_input({"convert", cube, out, "--limit", "--scheme", "lop"}, {"loop"});
  expect_bad_input({"convert", cube, out, "--limit", "--scheme", "loop"}, {"cube.obj", "face 0", "triangles alone"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{"cube.obj"});
}

}  // namespace
}  // namespace raytree::test
