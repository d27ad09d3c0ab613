// Scans that everyone knows, by one word each: they fill the frame, and every value of the picture is finite.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/app/object_extent.h"
#include "tests/app/program.h"
#include "tests/test_data.h"

namespace raytree::test {
namespace {

TEST(ScannedMeshes, FillTheFrame) {
  for (const char* name : {"meshes/stanford-bunny.obj", "meshes/bun_zipper.ply", "meshes/armadillo.obj",
                           "meshes/suzanne.obj", "big/dragon_vrip.ply.gz"}) {
    SCOPED_TRACE(name);
    std::string mesh = std::string(RAYTREE_TEST_DATA) + "/" + name;
    if (!std::filesystem::exists(mesh)) {
      std::fprintf(stderr, "LEFT OUT: no test data %s\n", mesh.c_str());
      continue;
    }
    TemporaryFolder folder;
    if (mesh.ends_with(".gz")) {
      const std::string unpacked = folder.path("unpacked.ply");
      if (std::system(("gunzip -c '" + mesh + "' > '" + unpacked + "' 2> /dev/null").c_str()) != 0) {
        std::fprintf(stderr, "LEFT OUT: no gunzip for %s\n", mesh.c_str());
        continue;
      }
      mesh = unpacked;
    }
    const std::string picture = folder.path("a.exr");
    const ProgramResult result = run_program(
        {"render", mesh, "-o", picture, "--size", "96x96", "--channels", "all", "--stats", folder.path("s.json")});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(file_text(folder.path("s.json")), "\"not_finite_samples\": 0"));
    const DecodedImage image = read_image_file(picture);
    const ObjectExtent extent = extent_of(image, 1);
    EXPECT_FALSE(extent.touches_border);
    EXPECT_GE(extent.larger_share, .8);
    EXPECT_LE(extent.larger_share, .96);
    // Where nothing is seen the distance is infinite, and nothing else ever is.
    for (std::size_t plane = 0; plane < image.planes.size(); ++plane)
      for (const float value : image.planes[plane])
        ASSERT_TRUE(image.names[plane] == "Z" ? !std::isnan(value) : std::isfinite(value)) << image.names[plane];
    // A picture that one would show has light and shade: no color of the object's own takes all of it.
    const std::vector<float>& green = image.planes.at(static_cast<std::size_t>(image.plane_index("G")));
    const auto [least, most] = std::minmax_element(green.begin(), green.end());
    EXPECT_GT(*most - *least, .2f);
  }
}

}  // namespace
}  // namespace raytree::test
