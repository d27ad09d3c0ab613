// `raytree render` from outside: files of every format, streams, flags that reach the picture, statistics, progress.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "renderer/image_file.h"
#include "tests/app/documentation.h"
#include "tests/app/object_extent.h"
#include "tests/app/program.h"
#include "tests/app/small_render.h"

namespace raytree::test {
namespace {

using Json = nlohmann::json;

TEST(CommandLineRender, WritesEveryFormatFromOneRender) {
  TemporaryFolder folder;
  const std::vector<std::string> names = {"a.exr", "b.jpg", "c.png", "d.tif"};
  // Names that follow the first one of -o belong to it too.
  const ProgramResult result = run_program({"render", kScene, "--size", "64x48", "-o", folder.path("a.exr"),
                                            folder.path("b.jpg"), "-o", folder.path("c.png"), folder.path("d.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(folder.names(), names);
  for (const std::string& name : names) {
    const DecodedImage image = read_image_file(folder.path(name));
    EXPECT_EQ(image.width, 64) << name;
    EXPECT_EQ(image.height, 48) << name;
    EXPECT_EQ(image.names.size(), name == "a.exr" ? 4u : 3u) << name;
  }
  // Both orders of SCENE and -o.
  EXPECT_EQ(run_program({"render", "-o", folder.path("c.png"), "--size", "64x48", kScene}).status, 0);
}

TEST(CommandLineRender, CountsOfTheStandardRenderStandBesideThePublishedOnes) {
  TemporaryFolder folder;
  const ProgramResult result = run_program({"render", "spd-tetra", "--counts", "spd", "-o", folder.path("a.exr")});
  ASSERT_EQ(result.status, 0) << result.err;
  std::smatch parts;
  ASSERT_TRUE(std::regex_search(result.out, parts,
                                std::regex("^spd-tetra, 513 x 513 corner rays, 5 levels\n"
                                           "rays +traced +published +difference\n"
                                           "eye hits +(49,7..|49,8..) +49,788 +[-+]0.0. %\n"
                                           "reflected +0 +0 +\\+0.00 %\nrefracted +0 +0 +\\+0.00 %\n"
                                           "shadow +46,... +46,112 +[-+]0.0. %\n$")))
      << result.out;
  // The picture's pixels are the corners; what hit something is in its alpha.
  const DecodedImage image = read_image_file(folder.path("a.exr"));
  EXPECT_EQ(image.width, 513);
  EXPECT_EQ(image.height, 513);
  const std::vector<float>& alpha = image.planes.at(static_cast<std::size_t>(image.plane_index("A")));
  std::string hits = parts[1];
  hits.erase(hits.find(','), 1);
  EXPECT_EQ(std::count(alpha.begin(), alpha.end(), 1.0f), std::stoi(hits));

  // Of other sizes and scenes nothing was published; no picture need be written.
  const ProgramResult small = run_program({"render", kScene, "--counts", "spd", "--size", "32x24"});
  ASSERT_EQ(small.status, 0) << small.err;
  EXPECT_EQ(small.out.rfind("spheres-1980, 33 x 25 corner rays, 5 levels\nrays            traced\neye hits", 0), 0u)
      << small.out;

  expect_bad_input({"render", kScene, "--counts", "rays"}, {"--counts", "rays", "spd"});
  expect_bad_input({"render", kScene, "--counts", "spd", "--depth", "3"}, {"--counts spd and --depth exclude"});
  expect_bad_input({"render", kScene, "--counts", "spd", "--stats", "-"}, {"--stats -", "standard output"});
  expect_bad_input({"render", "spd-tetra:12", "-o", folder.path("b.png")}, {"spd-tetra", "from 1 to 11"});
}

TEST(CommandLineRender, StandardOutputCarriesThePictureAlone) {
  TemporaryFolder folder;
  const ProgramResult file = run_program(small_render(folder.path("a.png")));
  ASSERT_EQ(file.status, 0) << file.err;
  const ProgramResult stream = run_program(with(small_render("-"), {"--format", "png"}));
  ASSERT_EQ(stream.status, 0) << stream.err;
  EXPECT_EQ(stream.out, file_text(folder.path("a.png")));
  ProgramOptions closed;
  closed.close_stdout = true;
  EXPECT_EQ(run_program(with(small_render("-"), {"--format", "png"}), closed).status, 1);
}

TEST(CommandLineRender, FilesDoNotDependOnThreads) {
  TemporaryFolder folder;
  std::string first[2];
  for (const char* threads : {"1", "2", "3", "7"}) {
    const std::string exr = folder.path("a.exr"), png = folder.path("a.png");
    const ProgramResult result =
        run_program(with(small_render(exr), {"-o", png, "--channels", "all", "--threads", threads}));
    ASSERT_EQ(result.status, 0) << result.err;
    for (const int i : {0, 1}) {
      const std::string bytes = file_text(i ? png : exr);
      if (first[i].empty()) first[i] = bytes;
      EXPECT_TRUE(bytes == first[i]) << threads << " threads, " << (i ? "PNG" : "EXR");
    }
  }
}

TEST(CommandLineRender, ACropIsItsWindowOfTheFrame) {
  TemporaryFolder folder;
  for (const char* name : {"a.exr", "a.png"}) {
    const std::string full_path = folder.path(std::string("full_") + name);
    const std::string crop_path = folder.path(std::string("crop_") + name);
    ASSERT_EQ(run_program({"render", kScene, "--size", "97x61", "-o", full_path}).status, 0);
    ASSERT_EQ(run_program({"render", kScene, "--size", "97x61", "--crop", "37x29+41+17", "-o", crop_path}).status, 0);
    const DecodedImage full = read_image_file(full_path), crop = read_image_file(crop_path);
    ASSERT_EQ(crop.width, 37);
    ASSERT_EQ(crop.height, 29);
    ASSERT_EQ(crop.names, full.names);
    std::size_t different = 0;
    for (std::size_t plane = 0; plane < crop.planes.size(); ++plane)
      for (int y = 0; y < 29; ++y)
        for (int x = 0; x < 37; ++x) {
          const float a = crop.planes[plane][static_cast<std::size_t>(y * 37 + x)];
          const float b = full.planes[plane][static_cast<std::size_t>((y + 17) * 97 + x + 41)];
          different += std::memcmp(&a, &b, sizeof a) != 0;
        }
    EXPECT_EQ(different, 0u) << name;
  }
}

TEST(CommandLineRender, FlagsReachTheRender) {
  TemporaryFolder folder;
  const auto render = [&](const std::vector<std::string>& flags) {
    const ProgramResult result =
        run_program(with(small_render(folder.path("a.png")), with({"--stats", "-", "--quiet"}, flags)));
    EXPECT_EQ(result.status, 0) << result.err;
    return result.status == 0 ? Json::parse(result.out) : Json();
  };
  const Json grid = render({"--antialias", "grid:3", "--cutoff", "0"});
  EXPECT_EQ(grid["samples"], 9 * 64 * 48);
  EXPECT_EQ(grid["settings"]["antialias"], "grid:3");
  EXPECT_EQ(grid["counts"]["branches_cut"], 0);
  const Json adaptive = render({"--antialias", "whitted", "--threshold", "0.1", "--levels", "2"});
  EXPECT_EQ(adaptive["settings"]["antialias"], "whitted");
  const Json shallow = render({"--antialias", "none", "--depth", "1", "--cutoff", "0.25", "--threads", "3"});
  EXPECT_EQ(shallow["samples"], 64 * 48);
  EXPECT_EQ(shallow["rays"]["reflected"], 0);
  EXPECT_EQ(shallow["rays"]["refracted"], 0);
  EXPECT_EQ(shallow["counts"]["deepest_level"], 1);
  EXPECT_EQ(shallow["settings"]["cutoff"], 0.25);
  EXPECT_EQ(shallow["settings"]["threads"], 3);
  // A flag made for the purpose wins over --set.
  EXPECT_EQ(render({"--depth", "2", "--set", "render.depth=1"})["settings"]["depth"], 2);
  const Json crop = render({"--crop", "8x4+16+2", "--set", "render.depth=1"});
  EXPECT_EQ(crop["settings"]["window"], Json({16, 2, 8, 4}));
  EXPECT_EQ(crop["settings"]["depth"], 1);
}

TEST(CommandLineRender, ExposureDisplayAndViewReachTheFile) {
  TemporaryFolder folder;
  const auto mean = [&](const std::vector<std::string>& flags) {
    const std::string path = folder.path("a.png");
    const ProgramResult result = run_program(with(small_render(path), with({"--ocio", "builtin"}, flags)));
    EXPECT_EQ(result.status, 0) << result.err;
    const DecodedImage image = read_image_file(path);
    double sum = 0;
    for (const auto& plane : image.planes)
      for (const float value : plane) sum += value;
    return sum;
  };
  const double standard = mean({});
  EXPECT_GT(mean({"--exposure", "1"}), standard);
  EXPECT_LT(mean({"--exposure", "-1.5"}), standard);
  EXPECT_NE(mean({"--display", "CRT"}), standard);
  EXPECT_NE(mean({"--display", "CRT", "--view", "Shade as brightness"}), mean({"--display", "CRT"}));
  const DecodedImage image = read_image_file(folder.path("a.png"));
  std::string metadata;
  for (const auto& [name, value] : image.metadata) metadata += name + "=" + value + "\n";
  for (const char* part : {"Raytree ", kScene, "CRT", "\"depth\""})
    EXPECT_TRUE(contains(metadata, part)) << part << "\n" << metadata;
}

TEST(CommandLineRender, ChannelsAndHalf) {
  TemporaryFolder folder;
  const std::string path = folder.path("a.exr");
  ASSERT_EQ(run_program(with(small_render(path), {"--channels", "color,depth,object_id"})).status, 0);
  DecodedImage image = read_image_file(path);
  EXPECT_EQ(std::set<std::string>(image.names.begin(), image.names.end()),
            (std::set<std::string>{"R", "G", "B", "Z", "id.object"}));
  const auto full_size = std::filesystem::file_size(path);
  ASSERT_EQ(run_program(with(small_render(path), {"--channels", "all", "--half"})).status, 0);
  image = read_image_file(path);
  std::size_t planes = 0;
  for (int i = 0; i < kChannelGroupCount; ++i) planes += plane_names(static_cast<ChannelGroup>(i)).size();
  EXPECT_EQ(image.names.size(), planes);
  ASSERT_EQ(run_program(with(small_render(path), {"--channels", "color,depth,object_id", "--half"})).status, 0);
  EXPECT_LT(std::filesystem::file_size(path), full_size);
}

/// Names of all values of --stats in the order of the file, those of parts after their whole; what stands in lists has
/// none.
std::vector<std::string> statistics_keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> names;
  const std::function<void(const nlohmann::ordered_json&, const std::string&)> visit =
      [&](const nlohmann::ordered_json& value, const std::string& prefix) {
        if (!value.is_object()) return;
        for (const auto& [key, part] : value.items()) {
          names.push_back(prefix + key);
          visit(part, prefix + key + ".");
        }
      };
  visit(json, "");
  return names;
}

/// The names of the documentation's table of --stats, in its order.
std::vector<std::string> documented_keys() {
  const std::string documentation = documentation_of("render");
  std::istringstream lines(documentation.substr(documentation.find("The keys of `--stats`, in this order:")));
  std::vector<std::string> names;
  const std::regex key("`([a-z_.]+)`");
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("| `", 0) == 0)
      for (std::sregex_iterator match(line.begin(), line.end(), key), end; match != end; ++match)
        names.push_back((*match)[1].str());
  return names;
}

TEST(CommandLineRender, StatisticsHaveTheDocumentedKeys) {
  TemporaryFolder folder;
  const ProgramResult result =
      run_program(with(small_render(folder.path("a.exr")), {"--stats", folder.path("s.json")}));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.exr", "s.json"}));
  const Json json = Json::parse(file_text(folder.path("s.json")));
  EXPECT_EQ(statistics_keys(nlohmann::ordered_json::parse(file_text(folder.path("s.json")))), documented_keys());
  EXPECT_EQ(json["rays"]["primary"], json["samples"]);
  EXPECT_EQ(json["rays"]["total"].get<std::uint64_t>(),
            json["rays"]["primary"].get<std::uint64_t>() + json["rays"]["shadow"].get<std::uint64_t>() +
                json["rays"]["reflected"].get<std::uint64_t>() + json["rays"]["refracted"].get<std::uint64_t>());
  double split = 0;
  for (const auto& part : json["time_split_percent"]) split += part.get<double>();
  EXPECT_NEAR(split, 100, 1e-6);
  EXPECT_GT(json["memory_bytes"]["peak"], json["memory_bytes"]["film"]);
  EXPECT_EQ(json["files"], Json({folder.path("a.exr")}));
}

TEST(CommandLineRender, LoadingTheImageLibraryDoesNotHoldUpTheFirstRay) {
  TemporaryFolder folder;
  // JPEG files need it; PNG and EXR do not. Loading it takes .35 s of an idle core. The least of a few runs: what else
  // the machine does only adds to it.
  double before_trace = 1e300;
  for (int i = 0; i < 3; ++i) {
    const ProgramResult result = run_program(with(small_render(folder.path("a.jpg")), {"--stats", "-", "--quiet"}));
    ASSERT_EQ(result.status, 0) << result.err;
    before_trace = std::min(before_trace, Json::parse(result.out)["seconds"]["before_trace"].get<double>());
  }
  EXPECT_LT(before_trace, 0.2);
}

TEST(CommandLineRender, MessagesGoToStandardErrorAndQuietSilencesThem) {
  TemporaryFolder folder;
  const std::string path = folder.path("a.png");
  const ProgramResult quiet = run_program(with(small_render(path), {"--quiet"}));
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
  const ProgramResult verbose = run_program(with(small_render(path), {"--verbose"}));
  EXPECT_EQ(verbose.out, "");
  for (const char* part : {"phases", "Mrays/s", "overhead", "intersection", "shading", "peak", "not finite"})
    EXPECT_TRUE(contains(verbose.err, part)) << part << "\n" << verbose.err;
  const ProgramResult odd = run_program(with(small_render(path), {"--half"}));
  EXPECT_EQ(odd.status, 0);
  EXPECT_TRUE(contains(odd.err, "warning: --half")) << odd.err;
  EXPECT_FALSE(contains(run_program(with(small_render(path), {"--half", "--quiet"})).err, "warning"));
}

TEST(CommandLineRender, ProgressIsALinePerFivePercentOffATerminal) {
  TemporaryFolder folder;
  const std::vector<std::string> words = {"render", kScene, "-o", folder.path("a.png"), "--size", "640x640"};
  const std::regex line("tracing +[0-9]+ %  [0-9.]+ Mrays/s");
  const auto lines = [&](const std::string& mode) {
    const std::string err = run_program(with(words, {"--progress", mode})).err;
    return std::distance(std::sregex_iterator(err.begin(), err.end(), line), std::sregex_iterator());
  };
  // 400 tiles: every twentieth is told.
  EXPECT_EQ(lines("auto"), 20);
  EXPECT_EQ(lines("none"), 0);
  const std::string bar = run_program(with(words, {"--progress", "bar"})).err;
  EXPECT_TRUE(contains(bar, "\r")) << bar;
  EXPECT_EQ(bar.back(), '\n');  // the line that says what was written follows the bar, which is taken away
}

TEST(CommandLineRender, AnUnknownSceneLeavesAnEarlierFileAlone) {
  TemporaryFolder folder;
  write_text(folder.path("a.png"), "earlier");
  EXPECT_EQ(run_program({"render", "no-such-scene", "-o", folder.path("a.png")}).status, 2);
  EXPECT_EQ(file_text(folder.path("a.png")), "earlier");
}

TEST(CommandLineRender, ABareMeshFillsTheFrameOfTheSizeAskedFor) {
  TemporaryFolder folder;
  write_text(folder.path("slab.obj"),
             "v -3 0 -1\nv 3 0 -1\nv 3 0 1\nv -3 0 1\nv 0 2 0\nf 1 4 3 2\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  for (const char* size : {"160x60", "60x160", "96x96"}) {
    const std::string path = folder.path("a.exr");
    const ProgramResult result =
        run_program({"render", folder.path("slab.obj"), "-o", path, "--size", size, "--channels", "object_id"});
    ASSERT_EQ(result.status, 0) << result.err;
    const DecodedImage image = read_image_file(path);
    const ObjectExtent extent = extent_of(image, 1);
    EXPECT_FALSE(extent.touches_border) << size;
    EXPECT_GE(extent.larger_share, .8) << size;
    EXPECT_LE(extent.larger_share, .96) << size;
  }
}

}  // namespace
}  // namespace raytree::test
