// The flags that choose what traces, from outside: what they change, what the report says, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

TEST(IntersectorFlags, SpheresTraceTheSamePictureHoweverSearched) {
  const TemporaryFolder folder;
  const auto picture = [&](const std::string& name, const std::vector<std::string>& flags) {
    const std::string file = folder.path(name);
    const ProgramResult result = run_program(with(small_render(file), with({"--intersector", "spheres"}, flags)));
    EXPECT_EQ(result.status, 0) << result.err;
    return file_text(file);
  };
  const std::string reference = picture("a.exr", {"--sphere-search", "linear", "--threads", "1"});
  EXPECT_FALSE(reference.empty());
  EXPECT_EQ(picture("b.exr", {"--sphere-search", "hierarchy", "--threads", "3"}), reference);
  EXPECT_EQ(picture("c.exr", {"--sphere-search", "auto"}), reference);
  EXPECT_EQ(picture("d.exr", {"--sphere-size", "2"}), reference) << "no surface of this scene is divided";
  const ProgramResult embree = run_program(with(small_render(folder.path("e.exr")), {"--intersector", "embree"}));
  EXPECT_EQ(embree.status, 0) << embree.err;
}

TEST(IntersectorFlags, ReportsSayWhatTracedAndHowItsTimeWasSpent) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(with(
      small_render(folder.path("a.png")), {"--intersector", "spheres", "--verbose", "--stats", folder.path("s.json")}));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("bounding spheres about 3 objects, tried one after the other"), std::string::npos)
      << result.err;
  const auto json = nlohmann::json::parse(file_text(folder.path("s.json")));
  EXPECT_GT(json["time_split_percent"]["intersection"].get<double>(), 10);
  EXPECT_GT(json["rays"]["primary"].get<double>(), 0);
}

TEST(IntersectorFlags, WrongValuesAreRefusedAndIdleOnesWarnedOf) {
  const TemporaryFolder folder;
  const std::string out = folder.path("a.png");
  const auto bad = [&](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    expect_bad_input(with(small_render(out), flags), parts);
  };
  bad({"--intersector", "sphere"}, {"--intersector", "embree", "spheres", "did you mean"});
  bad({"--intersector", "spheres", "--sphere-search", "fast"}, {"--sphere-search", "linear", "hierarchy"});
  for (const char* size : {"0", "-1", "nan", "inf", "small"})
    bad({"--intersector", "spheres", "--sphere-size", size}, {"--sphere-size"});
  EXPECT_TRUE(folder.names().empty());

  const auto warns = [&](const std::vector<std::string>& flags, const std::string& flag) {
    const ProgramResult result = run_program(with(small_render(out), flags));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find(flag + " has no effect"), std::string::npos) << result.err;
  };
  warns({"--sphere-size", "1"}, "--sphere-size");
  warns({"--sphere-search", "linear"}, "--sphere-search");
  warns({"--intersector", "spheres", "--hierarchy", "quick"}, "--hierarchy");
  warns({"--intersector", "spheres", "--memory", "1G"}, "--memory");
}

/// What no picture can be made of is refused in the same words, whatever traces.
TEST(IntersectorFlags, BadScenesAreRefusedAlike) {
  const TemporaryFolder folder;
  const std::string scene = folder.path("s.json");
  for (const char* shape : {R"({"type": "sphere", "radius": -1})",
                            R"({"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0]], "faces": [[0, 1, 2]]})",
                            R"({"type": "mesh", "file": "none.obj"})",
                            R"({"type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [[0, 1, 1]],
                                "subdivision": {}})",
                            R"({"type": "patches", "positions": [[0, 0, 0]], "bezier": [[0, 1, 2]]})"}) {
    SCOPED_TRACE(shape);
    write_text(scene, std::string(R"({"raytree": 1, "shapes": {"s": )") + shape + "}}");
    const ProgramResult fast = run_program({"render", scene, "-o", folder.path("a.png")});
    const ProgramResult truth = run_program({"render", scene, "-o", folder.path("a.png"), "--intersector", "spheres"});
    EXPECT_EQ(fast.status, 2);
    EXPECT_EQ(truth.status, fast.status);
    EXPECT_EQ(truth.err, fast.err);
  }
}

}  // namespace
}  // namespace raytree::test
