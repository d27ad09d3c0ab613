// `raytree bench` of a scene of mirrors and glass: each of the five kinds of rays that a render asks for is measured,
// counted and printed, and the counts are those of a render of the same scene.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "tests/app/program.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kRayKinds[] = {"primary", "shadow", "mirror", "refracted", "bounce"};
constexpr const char* kSingleRays = "triangles/robust/medium/1";

/// Metal, colored glass and a pane over a table, whose eye rays are those of a render with one sample a pixel.
ProgramResult run_bench_of_glass(const std::vector<std::string>& more) {
  return run_program(with({"bench", "glass", "--size", "96x64", "--threads", "1", "--quiet", "--filter",
                           "^(primary|shadow|mirror|refracted|bounce)/(seam|triangles/robust/medium/(1|8-coherent))$"},
                          more));
}

void expect_spread(const Json& spread, int count, const std::string& what) {
  EXPECT_EQ(spread["count"], count) << what;
  EXPECT_GT(spread["low"], 0) << what;
  EXPECT_LE(spread["low"], spread["median"]) << what;
  EXPECT_LE(spread["median"], spread["high"]) << what;
}

TEST(BenchKinds, EachIsCountedAsARenderOfTheSceneCountsIt) {
  const ProgramResult bench = run_bench_of_glass({"--repetitions", "3", "--json"});
  ASSERT_EQ(bench.status, 0) << bench.err << bench.out;
  const Json report = Json::parse(bench.out);
  EXPECT_EQ(report["baseline"], kSingleRays);
  EXPECT_EQ(report["suspicious"], false);
  const Json& scene = report["scenes"][0];

  TemporaryFolder folder;
  const ProgramResult render = run_program({"render", "glass", "--size", "96x64", "--antialias", "none", "--depth", "1",
                                            "--quiet", "-o", folder.path("a.png"), "--stats", folder.path("s.json")});
  ASSERT_EQ(render.status, 0) << render.err;
  const Json statistics = Json::parse(file_text(folder.path("s.json")));
  const auto eye_hits = statistics["counts"]["eye_hits"].get<std::uint64_t>();
  ASSERT_GT(eye_hits, 1000u);

  std::size_t next = 0;
  for (const char* kind : kRayKinds)
    for (const char* configuration : {kSingleRays, "triangles/robust/medium/8-coherent", "seam"}) {
      const std::string name = std::string(kind) + "/" + configuration;
      ASSERT_LT(next, scene["rows"].size()) << name << " is not there";
      const Json& row = scene["rows"][next++];
      ASSERT_EQ(row["name"], name);
      EXPECT_EQ(row["kind"], kind);
      EXPECT_EQ(row["threads"], 1);
      EXPECT_EQ(row["repeatable"], true) << name;
      EXPECT_EQ(row["wrong"], 0) << name;
      expect_spread(row["millions_per_second"], 3, name);
      expect_spread(row["over_baseline"], 3, name);
      EXPECT_EQ(row["samples"].size(), 3u);
      if (row["configuration"] == kSingleRays) {
        EXPECT_EQ(row["over_baseline"]["median"], 1);
      }
      EXPECT_TRUE(std::regex_match(row["checksum"].get<std::string>(), std::regex("[0-9a-f]{16}"))) << name;
      const auto rays = row["rays"].get<std::uint64_t>(), hits = row["hits"].get<std::uint64_t>();
      EXPECT_GT(hits, 0u) << name;
      EXPECT_LT(hits, rays) << name;
      if (kind == kRayKinds[0]) {
        EXPECT_EQ(rays, statistics["rays"]["primary"].get<std::uint64_t>()) << name;
        EXPECT_EQ(hits, eye_hits) << name;
      } else if (kind == kRayKinds[1]) {
        // One light, which shines on the upper side alone.
        EXPECT_GT(rays, eye_hits / 2) << name;
        EXPECT_LE(rays, eye_hits) << name;
      } else {
        EXPECT_EQ(rays, eye_hits) << name << ": one from each point that an eye ray meets";
      }
    }
  EXPECT_EQ(next, scene["rows"].size());

  ASSERT_EQ(scene["builds"].size(), 2u);
  const auto primitives = scene["triangles"].get<double>() + scene["others"].get<double>();
  for (const Json& build : scene["builds"]) {
    const std::string name = build["name"];
    EXPECT_GT(build["seconds"]["median"], 0) << name;
    EXPECT_NEAR(build["bytes_per_primitive"].get<double>() * primitives, build["bytes"].get<double>(), 1) << name;
    // Three indices and half a vertex, which six triangles share, are 18 bytes before any box is.
    EXPECT_GT(build["bytes_per_primitive"], 18) << name;
    EXPECT_LE(build["bytes"], build["peak_bytes"]) << name;
  }
}

TEST(BenchKinds, TheTableHoldsAllFiguresOfEachKind) {
  const ProgramResult text = run_bench_of_glass({"--repetitions", "2"});
  ASSERT_EQ(text.status, 0) << text.err << text.out;
  EXPECT_TRUE(std::regex_search(
      text.out,
      std::regex("\nbuilt +seconds +B each +B at peak\n  triangles/robust/medium +[0-9.]+ +[0-9.]+ +[0-9.]+")))
      << text.out;
  const std::string number = " +[0-9.e+-]+", quartiles = " +[0-9.e+]+-[0-9.e+]+",
                    counts = " +[0-9,]+ +[0-9,]+ +[0-9,]+";
  const std::string figures = number + quartiles + number + quartiles + "( +[0-9.]+)?" + counts + " +[0-9a-f]{16}\n";
  for (const char* kind : kRayKinds) {
    const std::string head =
        std::string("\n") + kind + " +Mrays/s +quartiles +ratio +quartiles +beside +rays +hits +differ +checksum\n";
    EXPECT_TRUE(
        std::regex_search(text.out, std::regex(head + "  " + kSingleRays + figures +  //
                                               "  triangles/robust/medium/8-coherent" + figures + "  seam" + figures)))
        << kind << "\n"
        << text.out;
  }
}

}  // namespace
}  // namespace raytree::test
