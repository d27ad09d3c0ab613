// Patch files: both layouts, and what is wrong refused by file and line.
#include "geometry/patch_reader.h"

#include <gtest/gtest.h>

#include "tests/reader_checks.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using namespace test;

std::string sixteen_points() {
  std::string text;
  for (int i = 0; i < 16; ++i) text += std::to_string(i % 4) + ".5," + std::to_string(i / 4) + ",-1e-1\n";
  return text;
}
const std::string kIndices = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\n";

std::vector<BezierPatch> read_patches(const std::string& text) {
  Warnings warnings;
  return read_patches(text, "test.bpt", warnings);
}

void expect_refused(const std::string& text, std::int64_t line, const std::string& part) {
  expect_refusal([&] { read_patches(text); }, "test.bpt", line, part);
}

TEST(PatchReader, ReadsIndexedPoints) {
  const auto patches =
      read_patches("2\n" + kIndices + "16,15,14,13,12,11,10,9,8,7,6,5,4,3,2,1\n16\n" + sixteen_points());
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(patches[0].points[0], Vec3d(0.5, 0, -0.1));
  EXPECT_EQ(patches[0].points[6], Vec3d(2.5, 1, -0.1));
  EXPECT_EQ(patches[1].points[0], Vec3d(3.5, 3, -0.1));
  EXPECT_EQ(patches[1].weights[5], 1);
}

TEST(PatchReader, ReadsPointsInPlace) {
  const auto patches = read_patches("2\n3 3\n" + sixteen_points() + "3 3\n" + sixteen_points());
  ASSERT_EQ(patches.size(), 2u);
  EXPECT_EQ(patches[1].points[6], Vec3d(2.5, 1, -0.1));
}

TEST(PatchReader, TakesBlanksCommasAndBlankLines) {
  std::string text = "1\r\n\n 1, 2 ,3\t4 5 6 7 8 9 10 11 12 13 14 15 16 \r\n\r\n16\r\n" + sixteen_points() + "\n \n";
  EXPECT_EQ(read_patches(text).size(), 1u);
  text.resize(text.size() - 4);  // the last line without its end
  EXPECT_EQ(read_patches(text).size(), 1u);
}

TEST(PatchReader, SaysWhatIsWrongAndWhere) {
  expect_refused("", 1, "number of patches");
  expect_refused("teapot\n", 1, "expected the number of patches, not 'teapot'");
  expect_refused("0\n", 1, "at least 1");
  expect_refused("-3\n", 1, "at least 1");
  expect_refused("1 2\n", 1, "unexpected '2'");
  expect_refused("1\n", 1, "can hold");
  expect_refused("1\n1,2,3\n16\n" + sixteen_points(), 2, "16 indices of a patch, or its two degrees, not 3");
  expect_refused("1\n2 3\n" + sixteen_points(), 2, "only bicubic ones");
  expect_refused("1\n3.5 3\n" + sixteen_points(), 2, "expected an index, not '3.5'");
  expect_refused("1\n1,2,,4,5,6,7,8,9,10,11,12,13,14,15,16\n16\n" + sixteen_points(), 2, "expected an index");
  expect_refused("1\n" + kIndices + "16\n0,0\n" + sixteen_points(), 4, "line ends where a coordinate");
  expect_refused("1\n" + kIndices + "16\n0,0,\n" + sixteen_points(), 4, "ends behind a comma");
  expect_refused("1\n" + kIndices + "16\n0,0,0,0\n" + sixteen_points(), 4, "unexpected '0'");
  expect_refused("1\n" + kIndices + "16\n0,0,nan\n" + sixteen_points(), 4, "not finite");
  expect_refused("1\n" + kIndices + "16\n0,1e999,0\n" + sixteen_points(), 4, "not finite");
  expect_refused("1\n" + kIndices + "16\n" + sixteen_points().substr(0, 15 * 12), 19, "the file ends where a point");
  expect_refused("1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,15\n15\n" + sixteen_points(), 19,
                 "expected the end of the file");
  expect_refused("1\n0" + kIndices.substr(1) + "16\n" + sixteen_points(), 2, "index 0 is out of range");
  expect_refused("1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,17\n16\n" + sixteen_points(), 2, "index 17 is out of range");
  expect_refused("2\n" + kIndices + "16\n" + sixteen_points(), 3, "line ends where one of 16 indices");
  expect_refused("2\n3 3\n" + sixteen_points() + "3 4\n" + sixteen_points(), 19, "only bicubic ones");
  expect_refused("2\n3 3\n" + sixteen_points(), 19, "the file ends where a patch's degrees");
}

TEST(PatchReader, HostileCountsAskForNothing) {
  expect_refused("999999999999999999\n" + kIndices, 1, "more than the rest of the file can hold, 1 at most");
  expect_refused("9999999999999999999999\n" + kIndices, 1, "expected the number of patches");
  expect_refused("1\n" + kIndices + "4294967297\n" + sixteen_points(), 3, "can hold");
  expect_refused("1\n1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,999999999999999999\n16\n" + sixteen_points(), 2,
                 "index 999999999999999999");
}

TEST(PatchReader, WarnsOfPointsThatNoPatchUses) {
  Warnings warnings;
  read_patches("1\n" + kIndices + "18\n" + sixteen_points() + "0 0 0\n1 1 1\n", "test.bpt", warnings);
  EXPECT_EQ(found_warning(warnings, "points that no patch uses"), "0 x2");
}

TEST(PatchReader, DamagedFilesAreReadOrRefused) {
  read_damaged_copies("1\n" + kIndices + "16\n" + sixteen_points(), 2000, read_patches);
  read_damaged_copies("2\n3 3\n" + sixteen_points() + "3 3\n" + sixteen_points(), 2000, read_patches);
}

TEST(PatchReader, ReadsThePublishedTeaSet) {
  int files = 0;
  for (const auto& path : test_data_files("patches")) {
    if (path.extension() != ".bpt") continue;
    Warnings warnings;
    const auto patches = read_patch_file(path.string(), warnings);
    const bool teapot = path.filename() == "newell_teapot.bpt";
    EXPECT_EQ(patches.size(), teapot ? 32u : 26u) << path;
    if (teapot) {
      EXPECT_EQ(patches[0].points[1], Vec3d(1.4, -0.784, 2.4));
      // Points 205, 206, 216 and 223: the tip of the knob stands in the file five times.
      EXPECT_EQ(found_warning(warnings, "points that no patch uses"), "0 x4");
    }
    ++files;
  }
  EXPECT_TRUE(files == 0 || files == 2);
}

TEST(PatchReader, NamesOfPatchFiles) {
  EXPECT_TRUE(is_patch_file_name("a/teapot.BPT"));
  EXPECT_FALSE(is_patch_file_name("a.bpt/teapot"));
  Warnings warnings;
  EXPECT_THROW(read_patch_file("no/such/file.bpt", warnings), Error);
}

}  // namespace
}  // namespace raytree
