// Rays from .npy files: what is read, and what is refused with which words.
#include "benchmarks/npy_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/error.h"
#include "tests/npy_file.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

using test::contains;
using test::npy_file;

std::string refusal(const std::string& bytes) {
  try {
    parse_rays(bytes, "rays.npy");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_TRUE(contains(error.what(), "rays.npy")) << error.what();
    return error.what();
  }
  return "nothing refused";
}

TEST(NpyReader, ReadsRaysOfSixAndOfEightNumbers) {
  const auto six = parse_rays(npy_file({1, 2, 3, 0, 0, 2, 4, 5, 6, -1, 0, 0}, 6), "rays.npy");
  ASSERT_EQ(six.size(), 2u);
  EXPECT_EQ(six[0].origin, Vec3f(1, 2, 3));
  EXPECT_EQ(six[0].direction, Vec3f(0, 0, 1));
  EXPECT_EQ(six[0].begin, 0);
  EXPECT_TRUE(std::isinf(six[0].end));
  EXPECT_EQ(six[1].direction, Vec3f(-1, 0, 0));
  // Begin and end are lengths of the direction as given.
  const float kEnd = std::numeric_limits<float>::infinity();
  const auto eight = parse_rays(npy_file({0, 0, 0, 0, 2, 0, 1, 3, 0, 0, 0, 1, 0, 0, 0, kEnd}, 8), "rays.npy");
  ASSERT_EQ(eight.size(), 2u);
  EXPECT_EQ(eight[0].begin, 2);
  EXPECT_EQ(eight[0].end, 6);
  EXPECT_TRUE(std::isinf(eight[1].end));
  // Directions whose squares leave a float's range are directions all the same.
  EXPECT_EQ(parse_rays(npy_file({0, 0, 0, 0, 0, 1e-30f}, 6), "a")[0].direction, Vec3f(0, 0, 1));
  EXPECT_EQ(parse_rays(npy_file({0, 0, 0, 3e38f, 0, 0}, 6), "a")[0].direction, Vec3f(1, 0, 0));
}

TEST(NpyReader, ReadsVersionsOneToThree) {
  for (const int version : {1, 2, 3})
    EXPECT_EQ(parse_rays(npy_file({0, 0, 0, 0, 0, 1}, 6, "<f4", "False", version), "a").size(), 1u);
  EXPECT_TRUE(contains(refusal(npy_file({0, 0, 0, 0, 0, 1}, 6, "<f4", "False", 4)), "version 4"));
}

TEST(NpyReader, RefusesOtherArraysByName) {
  const std::vector<float> ray{0, 0, 0, 0, 0, 1};
  EXPECT_TRUE(contains(refusal("PLY"), "not a .npy file"));
  EXPECT_TRUE(contains(refusal(""), "not a .npy file"));
  EXPECT_TRUE(contains(refusal(npy_file(ray, 6, "<f8")), "\"<f8\""));
  EXPECT_TRUE(contains(refusal(npy_file(ray, 6, ">f4")), "\">f4\""));
  EXPECT_TRUE(contains(refusal(npy_file(ray, 6, "<f4", "True")), "Fortran"));
  EXPECT_TRUE(contains(refusal(npy_file(ray, 3)), "N x 6 or N x 8"));
  EXPECT_TRUE(contains(refusal(npy_file({}, 6)), "no rays"));
  EXPECT_TRUE(contains(refusal(npy_file(ray, 6, "<f4", "Maybe")), "'fortran_order'"));
}

TEST(NpyReader, RefusesFilesThatEndTooSoonOrTooLate) {
  const std::string whole = npy_file({0, 0, 0, 0, 0, 1}, 6);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(refusal(whole.substr(0, size)), "nothing refused") << size;
  EXPECT_TRUE(contains(refusal(whole + "x"), "25"));
  // A header that says more than memory holds.
  std::string huge = whole;
  const std::size_t at = huge.find("(1, 6)");
  ASSERT_NE(at, std::string::npos);
  std::string shape = "(999999999999999, 6)";
  huge.replace(at, shape.size(), shape);
  EXPECT_NE(refusal(huge), "nothing refused");
}

TEST(NpyReader, RefusesRaysThatAreNone) {
  const float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  const auto second = [](std::vector<float> ray) {
    std::vector<float> rays{0, 0, 0, 0, 0, 1, 0, 1};
    rays.resize(ray.size());
    rays.insert(rays.end(), ray.begin(), ray.end());
    return npy_file(rays, ray.size());
  };
  EXPECT_TRUE(contains(refusal(second({0, kNan, 0, 0, 0, 1})), "row 1: the origin is not finite"));
  EXPECT_TRUE(contains(refusal(second({0, -2e18f, 0, 0, 0, 1})), "row 1: the origin is farther than 1e18 units away"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 2e18f, 1, 2})), "row 1: its begin is farther than 1e18"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, kInf, 0, 1})), "row 1: the direction is not finite"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 0})), "row 1: the direction is zero"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 1, -1, 1})), "row 1: its begin"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 1, kInf, kInf})), "row 1: its begin"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 1, 2, 1})), "row 1: its end"));
  EXPECT_TRUE(contains(refusal(second({0, 0, 0, 0, 0, 1, 0, kNan})), "row 1: its end"));
}

TEST(NpyReader, NamesAFileThatIsNotThere) {
  test::TemporaryFolder folder;
  EXPECT_THROW(read_rays(folder.path("none.npy")), Error);
  EXPECT_EQ(read_rays(folder.write("a.npy", npy_file({0, 0, 0, 0, 0, 1}, 6))).size(), 1u);
}

}  // namespace
}  // namespace raytree::benchmarks
