// OpenSubdiv's own regression shapes, through the program: each renders or is refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "renderer/image_file.h"
#include "tests/app/program.h"
#include "tests/test_data.h"

namespace raytree::test {
namespace {

TEST(OpenSubdivShapes, RenderOrAreRefusedWithAReason) {
  const TemporaryFolder folder;
  const std::string out = folder.path("out.exr");
  std::set<std::string> refused;
  int shapes = 0;
  for (const auto& path : test_data_files("subdiv/osd_shapes")) {
    if (path.extension() != ".obj") continue;
    const std::string name = path.stem().string();
    SCOPED_TRACE(name);
    ++shapes;
    const std::string scheme = name.substr(0, name.find('_'));
    const ProgramResult result = run_program({"render", path.string(), "-o", out, "--size", "32x24", "--quiet", "--set",
                                              "shapes.object.subdivision={\"scheme\": \"" + scheme + "\"}"});
    if (result.status == 2) {
      for (const char* part : {name.c_str(), "face ", "vertex ", "which two faces alone share", "crease"})
        EXPECT_TRUE(contains(result.err, part)) << result.err;
      refused.insert(name);
      continue;
    }
    ASSERT_EQ(result.status, 0) << result.err;
    const DecodedImage image = read_image_file(out);
    ASSERT_EQ(image.width * image.height, 32 * 24);
    float highest = 0;
    for (std::size_t plane = 0; plane < image.planes.size(); ++plane)
      for (const float value : image.planes[plane]) {
        ASSERT_TRUE(std::isfinite(value)) << image.names[plane];
        if (image.names[plane] == "A") highest = std::max(highest, value);
      }
    EXPECT_GT(highest, 0) << "nothing to be seen";
  }
  if (shapes == 0) return;  // without test data
  EXPECT_EQ(shapes, 77);
  EXPECT_EQ(refused, std::set<std::string>{"catmark_val2_interior"});
}

}  // namespace
}  // namespace raytree::test
