// The flags of curved surfaces and of what the tracer builds, from outside: what they change, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// A cube's limit surface, and a sphere.
const char* const kBlobScene = R"({
  "raytree": 1,
  "cameras": {"main": {"position": [0, 0, 8], "target": [0, 0, 0], "field_of_view": 30}},
  "image": {"width": 100, "height": 100},
  "shapes": {
    "blob": {"type": "mesh", "positions": [[-1, -1, -1], [1, -1, -1], [-1, 1, -1], [1, 1, -1], [-1, -1, 1], [1, -1, 1],
                           [-1, 1, 1], [1, 1, 1]],
             "faces": [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]],
             "subdivision": {}}},
  "lights": {"key": {"type": "directional", "direction": [0, -1, -1]}}
})";

struct SceneFolder {
  TemporaryFolder folder;
  std::string scene = folder.path("s.json");
  SceneFolder() { write_text(scene, kBlobScene); }

  Json info(const std::vector<std::string>& flags) const {
    const ProgramResult result = run_program(with({"info", scene, "--json"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return result.status == 0 ? Json::parse(result.out) : Json();
  }
  std::uint64_t triangles(const std::vector<std::string>& flags) const {
    return info(flags)["totals"]["traced_triangles"].get<std::uint64_t>();
  }
};

TEST(CurvedSurfaceFlags, ToleranceAndRateSayHowMuchIsMade) {
  const SceneFolder s;
  EXPECT_EQ(s.triangles({"--rate", "1"}), 6u * 2);
  EXPECT_EQ(s.triangles({"--rate", "5"}), 6u * 2 * 25);
  const std::uint64_t by_default = s.triangles({});
  EXPECT_EQ(s.triangles({"--tolerance", "0.25"}), by_default);
  EXPECT_LT(s.triangles({"--tolerance", "2"}), by_default);
  // Facets' distance goes with the square of their size.
  EXPECT_GE(s.triangles({"--tolerance", "0.015625"}), 8 * by_default);
  // A picture twice as fine takes finer facets.
  EXPECT_GT(s.triangles({"--size", "400x400"}), by_default);
}

TEST(CurvedSurfaceFlags, TessellationIsMeasuredOnRequest) {
  const SceneFolder s;
  const Json info = s.info({"--tessellation"});
  const Json& record = info["objects"][0]["tessellation"];
  EXPECT_EQ(record["faces"], 6) << info.dump(1);
  EXPECT_EQ(record["triangles"], info["totals"]["traced_triangles"]);
  EXPECT_GT(record["bytes"].get<double>(), 0);
  EXPECT_GT(record["measured"]["largest_pixels"].get<double>(), 0);
  EXPECT_LE(record["measured"]["largest_pixels"].get<double>(), 0.25);
  const Json& normals = record["measured"]["normals"];
  std::uint64_t judged = 0;
  for (const char* kind : {"regular", "irregular", "small"}) {
    judged += normals[kind]["triangles"].get<std::uint64_t>();
    EXPECT_GE(normals[kind]["share_over_tolerance"].get<double>(), 0);
  }
  EXPECT_EQ(judged, record["triangles"].get<std::uint64_t>());
  EXPECT_EQ(record["measured"]["proved"]["triangles"], 0) << "no face of a cube is one polynomial";
  // All faces of a cube meet vertices of three: held to eight times the tolerance.
  EXPECT_EQ(normals["regular"]["triangles"], 0);
  EXPECT_EQ(normals["irregular"]["bound_shading_pixels"], 2);
  EXPECT_LE(normals["irregular"]["largest_shading_pixels"].get<double>(), 2);
  EXPECT_GT(normals["irregular"]["largest_angle_degrees"].get<double>(), 0);
  EXPECT_EQ(normals["small"]["bound_shading_pixels"], normals["irregular"]["bound_shading_pixels"]);
  EXPECT_TRUE(s.info({"--tessellation", "--rate",
                      "3"})["objects"][0]["tessellation"]["measured"]["normals"]["irregular"]["bound_shading_pixels"]
                  .is_null());
  EXPECT_FALSE(s.info({})["objects"][0]["tessellation"].contains("measured"));
  const ProgramResult text = run_program({"info", s.scene, "--tessellation"});
  ASSERT_EQ(text.status, 0);
  for (const char* part :
       {"tessellation", "pixels off", "normals", "irregular", "held to", "2.0000", "proved", "at most"})
    EXPECT_TRUE(contains(text.out, part)) << text.out;
}

TEST(CurvedSurfaceFlags, HierarchyAndMemorySayWhatIsBuilt) {
  const SceneFolder s;
  const auto report = [&](const std::vector<std::string>& flags) {
    const ProgramResult result =
        run_program(with({"render", s.scene, "-o", s.folder.path("out.png"), "--verbose"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err + result.out;
  };
  EXPECT_TRUE(contains(report({}), "balanced hierarchy for ")) << report({});
  for (const char* kind : {"balanced", "quads", "grids", "quick", "compact", "compact-quads"})
    EXPECT_TRUE(contains(report({"--hierarchy", kind}), std::string(kind) + " hierarchy, as asked for"));
  // Room for grids or a compact one of so many triangles, and not for a balanced one; then for none at all.
  const Json info = s.info({"--rate", "200"});
  const auto triangles = info["totals"]["traced_triangles"].get<double>();
  const auto bytes = [](double value) { return std::to_string(static_cast<std::uint64_t>(value)); };
  const auto arrays = info["memory_bytes"]["arrays"].get<double>();
  const std::string tight = report({"--rate", "200", "--memory", bytes(arrays + 45 * triangles)});
  EXPECT_TRUE(contains(tight, "grids hierarchy for ")) << tight;
  const std::string none = report({"--rate", "200", "--memory", bytes(arrays + 10 * triangles)});
  EXPECT_TRUE(contains(none, "more than the memory allowed")) << none;
}

TEST(CurvedSurfaceFlags, WrongValuesAreRefused) {
  const SceneFolder s;
  const std::string out = s.folder.path("out.png");
  for (const char* value : {"0", "-1", "nan", "inf", "much", ""}) {
    SCOPED_TRACE(value);
    expect_bad_input({"render", s.scene, "-o", out, "--tolerance", value}, {"--tolerance"});
    expect_bad_input({"info", s.scene, "--tolerance", value}, {"--tolerance"});
  }
  for (const char* value : {"0", "-1", "1025", "2.5", "fine"}) {
    SCOPED_TRACE(value);
    expect_bad_input({"render", s.scene, "-o", out, "--rate", value}, {"--rate"});
    expect_bad_input({"info", s.scene, "--rate", value}, {"--rate"});
  }
  expect_bad_input({"render", s.scene, "-o", out, "--rate", "2", "--tolerance", "1"}, {"--rate", "--tolerance"});
  expect_bad_input({"render", s.scene, "-o", out, "--hierarchy", "tall"}, {"tall", "balanced", "quick", "compact"});
  for (const char* value : {"0", "-5", "many", "4X", "1.5.2G"}) {
    SCOPED_TRACE(value);
    expect_bad_input({"render", s.scene, "-o", out, "--memory", value}, {"--memory"});
  }
  EXPECT_EQ(s.folder.names(), std::vector<std::string>{"s.json"});
}

}  // namespace
}  // namespace raytree::test
