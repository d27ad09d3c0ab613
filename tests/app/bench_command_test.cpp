// `raytree bench` from outside: what it prints as text and JSON, what its flags choose, what it refuses.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program.h"
#include "tests/npy_file.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

/// `raytree bench` of few rays, less what `more` says.
ProgramResult run_bench(const std::vector<std::string>& more) {
  return run_program(with({"bench", "spheres-1980", "--size", "64x48", "--repetitions", "2", "--quiet"}, more));
}

TEST(BenchCommand, ReportsInJsonWhatIsSameForAnyNumberOfThreads) {
  const auto run = [](const char* threads) {
    const ProgramResult result = run_bench({"--json", "--threads", threads, "--filter", "/seam|/8-coherent$|/1$"});
    EXPECT_EQ(result.status, 0) << result.err << result.out;
    return Json::parse(result.out);
  };
  const Json one = run("1"), three = run("3");
  for (const char* key : {"processor", "hardware_threads", "instruction_set", "compiler", "build_type", "tracer"})
    EXPECT_TRUE(one["machine"].contains(key)) << key;
  EXPECT_EQ(one["baseline"], "triangles/robust/medium/1");
  EXPECT_EQ(one["suspicious"], false);
  const Json &a = one["scenes"][0], &b = three["scenes"][0];
  ASSERT_EQ(a["rows"].size(), b["rows"].size());
  for (std::size_t i = 0; i < a["rows"].size(); ++i) {
    const Json& row = a["rows"][i];
    for (const char* key : {"name", "kind", "configuration", "rays", "hits", "checksum"})
      EXPECT_EQ(row[key], b["rows"][i][key]) << row;
    EXPECT_EQ(row["repeatable"], true);
    EXPECT_EQ(row["millions_per_second"]["count"], 2);
    EXPECT_EQ(row["samples"].size(), 2u);
    EXPECT_GT(row["over_baseline"]["median"], 0);
  }
  EXPECT_EQ(a["rows"][0]["rays"], 64 * 48);
  EXPECT_GT(a["builds"][0]["seconds"]["median"], 0);
  EXPECT_GT(a["builds"][0]["bytes_per_primitive"], 0);
  EXPECT_GE(a["builds"][0]["peak_bytes"], a["builds"][0]["bytes"]);
}

TEST(BenchCommand, PrintsATableWithTheMachine) {
  const ProgramResult text = run_bench({"--filter", "(primary|edge)/(triangles|naive)"});
  ASSERT_EQ(text.status, 0) << text.err << text.out;
  for (const char* part : {"threads, ", "Embree", "primary", "edge", "Mrays/s", "quartiles", "ratio", "B at peak",
                           "triangles/robust/medium/8-coherent", "naive"})
    EXPECT_TRUE(contains(text.out, part)) << part << "\n" << text.out;
  EXPECT_FALSE(contains(text.out, "shadow"));
}

TEST(BenchCommand, ListsWhatAFilterChooses) {
  const ProgramResult list = run_bench({"--list", "--filter", "^shadow/naive"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_EQ(list.out, "shadow/naive\n");
}

TEST(BenchCommand, ComparesWithAnEarlierReport) {
  TemporaryFolder folder;
  const std::vector<std::string> flags{"--filter", "primary/seam", "--json"};
  const std::string before = folder.write("before.json", run_bench(flags).out);
  const ProgramResult result = run_bench(with(flags, {"--baseline", before}));
  ASSERT_EQ(result.status, 0) << result.err;
  const Json changes = Json::parse(result.out)["changes"];
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0]["row"], "primary/seam");
  EXPECT_EQ(changes[0]["verdict"], "too few samples");
  EXPECT_EQ(changes[0]["same_answers"], true);
  expect_bad_input({"bench", "spheres-1980", "--size", "16x12", "--baseline", folder.write("wrong.json", "{}")},
                   {"wrong.json", "raytree bench --json"});
}

TEST(BenchCommand, AsksAFilesRays) {
  TemporaryFolder folder;
  // From above: one at the spheres' floor, one into the sky.
  const std::string rays = folder.write("rays.npy", npy_file({0, 9, 0, 0, -1, 0, 0, 9, 0, 0, 1, 0}, 6));
  const ProgramResult result =
      run_bench({"--rays", rays, "--json", "--filter", "file/(seam|triangles/robust/medium/1$)"});
  ASSERT_EQ(result.status, 0) << result.err << result.out;
  const Json rows = Json::parse(result.out)["scenes"][0]["rows"];
  ASSERT_EQ(rows.size(), 2u);
  for (const Json& row : rows) {
    EXPECT_EQ(row["rays"], 2);
    EXPECT_EQ(row["hits"], 1);
  }
  expect_bad_input({"bench", "spheres-1980", "--rays", folder.write("short.npy", "NUMPY")},
                   {"short.npy", "not a .npy file"});
  expect_bad_input({"bench", "spheres-1980", "--rays", folder.path("none.npy")}, {"none.npy"});
}

TEST(BenchCommand, KeepsToATimeAndSaysWhatItLeavesOut) {
  const ProgramResult result =
      run_program({"bench", "standard", "--budget", "2s", "--repetitions", "1", "--filter", "primary/seam", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.err << result.out;
  EXPECT_TRUE(contains(result.out, "left out: terrain of 10 M: it would take")) << result.out;
  EXPECT_TRUE(contains(result.out, "scene spd-balls")) << result.out;
  EXPECT_LT(result.seconds, 60);
}

// SSE has packets of four, AVX2 of eight; answers are the same but for rounding at outlines.
TEST(BenchCommand, HoldsEmbreeToAnInstructionSet) {
  const auto list = [](const char* isa) {
    const ProgramResult result = run_bench({"--list", "--isa", isa});
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  const std::string narrow = list("sse4.2");
  EXPECT_TRUE(contains(narrow, "primary/triangles/robust/medium/4\n"));
  EXPECT_FALSE(contains(narrow, "medium/8")) << narrow;
  EXPECT_FALSE(contains(narrow, "/seam")) << "the renderer's tracer takes the best";
  const auto run = [](const std::vector<std::string>& more) {
    const ProgramResult result =
        run_bench(with({"--json", "--filter", "(primary|bounce)/triangles/robust/medium/4$"}, more));
    EXPECT_EQ(result.status, 0) << result.err;
    return Json::parse(result.out);
  };
  const Json held = run({"--isa", "sse4.2"}), best = run({});
  EXPECT_EQ(held["machine"]["tracer_held_to"], "sse4.2");
  EXPECT_FALSE(best["machine"].contains("tracer_held_to"));
  for (std::size_t i = 0; i < 2; ++i) {
    const Json &a = held["scenes"][0]["rows"][i], &b = best["scenes"][0]["rows"][i];
    EXPECT_EQ(a["name"], b["name"]);
    EXPECT_NEAR(a["hits"].get<double>(), b["hits"].get<double>(), 2) << a["name"];
  }
  // In other bits: what was asked for reached Embree.
  EXPECT_NE(held["scenes"][0]["rows"][0]["checksum"], best["scenes"][0]["rows"][0]["checksum"]);
  EXPECT_TRUE(
      contains(run_bench({"--isa", "avx", "--filter", "primary/triangles/robust/medium/1$"}).out, ", held to avx\n"));
  expect_bad_input({"bench", "spheres-1980", "--isa", "avx3"}, {"--isa", "avx3", "sse4.2", "did you mean"});
}

TEST(BenchCommand, AReportThatCannotBeWrittenIsAFailure) {
  for (const char* more : {"--json", "--quiet"}) {
    const std::string line = std::string(RAYTREE_PROGRAM) +
                             " bench cone --size 16x12 --repetitions 1 --filter primary/seam " + more +
                             " >/dev/full 2>/dev/null";
    const int status = std::system(line.c_str());
    EXPECT_TRUE(WIFEXITED(status)) << line;
    EXPECT_EQ(WEXITSTATUS(status), 1) << line;
  }
}

TEST(BenchCommand, WrongInputIsNamed) {
  expect_bad_input({"bench", "spheres-1980", "--repetitions", "0"}, {"--repetitions", "0 is not within 1 and 10000"});
  expect_bad_input({"bench", "spheres-1980", "--filter", "a("}, {"--filter", "a("});
  expect_bad_input({"bench", "spheres-1980", "--size", "16x12", "--filter", "nothing"}, {"nothing", "--list"});
  expect_bad_input({"bench", "spheres-1980", "--size", "16x12", "--against", "quads"},
                   {"--against", "quads", "--list"});
  expect_bad_input({"bench", "spheres-1980", "--budget", "soon"}, {"--budget", "soon"});
  expect_bad_input({"bench", "spheres-1980", "--budget", "0s"}, {"--budget", "20s"});
  expect_bad_input({"bench", "standard", "--rays", "a.npy"}, {"--rays"});
  expect_bad_input({"bench", "spheres-1980", "--mesh", "a.ply"}, {"--mesh"});
}

}  // namespace
}  // namespace raytree::test
