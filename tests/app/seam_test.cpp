// Normals across the pieces of an object that share a boundary (Gouraud 1971, p. 30-32), in a picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/angle.h"
#include "renderer/image_file.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

/// A cylinder of 12 sides about the y axis in two pieces, each of whose corners are its own; they meet at x = 0, before
/// the eye and behind.
nlohmann::json cylinder_in_two_pieces(bool across_pieces) {
  nlohmann::json positions = nlohmann::json::array(), faces = nlohmann::json::array();
  for (int piece = 0; piece < 2; ++piece) {
    for (int i = 0; i <= 6; ++i) {
      const double angle = (i + 6 * piece) * 30 * kDegree;
      for (const double y : {-1.0, 1.0}) positions.push_back({std::sin(angle), y, std::cos(angle)});
    }
    for (int i = 0; i < 6; ++i) {
      const int at = 14 * piece + 2 * i;
      faces.push_back({at, at + 2, at + 3, at + 1});
    }
  }
  // The last corners of the second piece are the first of the first one's, to the bit.
  for (int k = 0; k < 2; ++k) {
    positions[26 + k] = positions[k];
    positions[14 + k] = positions[12 + k];
  }
  return {{"type", "mesh"},
          {"positions", positions},
          {"faces", faces},
          {"shading", "phong"},
          {"smoothing", {{"method", "unit"}, {"crease_angle", 40}, {"across_pieces", across_pieces}}}};
}

TEST(Seams, OfPiecesHaveOneNormalWhereAskedFor) {
  const TemporaryFolder folder;
  for (const bool across : {false, true}) {
    SCOPED_TRACE(across ? "across pieces" : "piece by piece");
    // The eye looks at the seam head-on: the middle of 81 columns lies on it, a column is 1/81 wide.
    const nlohmann::json scene = {
        {"raytree", 1},
        {"cameras",
         {{"main", {{"position", {0, 0, 8}}, {"target", {0, 0, 0}}, {"projection", "orthographic"}, {"height", 1}}}}},
        {"image", {{"width", 81}, {"height", 81}}},
        {"shapes", {{"cylinder", cylinder_in_two_pieces(across)}}}};
    write_text(folder.path("s.json"), scene.dump());
    const std::string out = folder.path("out.exr");
    const ProgramResult result =
        run_program({"render", folder.path("s.json"), "-o", out, "--antialias", "none", "--channels", "normal"});
    ASSERT_EQ(result.status, 0) << result.err;
    const DecodedImage image = read_image_file(out);
    const auto plane = [&](const std::string& name) -> const std::vector<float>& {
      const auto found = std::find(image.names.begin(), image.names.end(), name);
      return image.planes.at(static_cast<std::size_t>(found - image.names.begin()));
    };
    // How far normals turn to the right of +z, degrees.
    const auto turned = [&](std::size_t column) {
      const std::size_t pixel = 40 * 81 + column;
      return std::atan2(double(plane("N.X")[pixel]), double(plane("N.Z")[pixel])) / kDegree;
    };
    // A facet is half a unit wide as it is seen, and its far corners' normals stand at 30 degrees. At the seam a piece
    // alone knows the facet's normal, at 15; both pieces together know the cylinder's, at 0. One column on, a 40th of
    // the way to 30 is made: .75 degrees at most.
    const double at_seam = across ? 0 : 15;
    EXPECT_NEAR(turned(41), at_seam, 0.8);
    EXPECT_NEAR(turned(39), -at_seam, 0.8);
  }
}

}  // namespace
}  // namespace raytree::test
