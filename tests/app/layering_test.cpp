// What docs/architecture.md promises of the sources: who includes whom, that other libraries stay behind their
// adapters, that only programs print and end, and that every source is compiled with floating point as it is written.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace raytree::test {
namespace {

namespace fs = std::filesystem;

struct SourceFile {
  std::string name;                ///< from the repository's folder on, "geometry/error.h"
  std::vector<std::string> lines;  ///< without comments
};

std::vector<std::string> lines_without_comments(const std::string& file) {
  std::istringstream text(file_text(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line.substr(0, line.find("//")));
  return lines;
}

/// The sources under a folder of the repository.
std::vector<SourceFile> sources_of(const std::string& folder) {
  const fs::path root = RAYTREE_SOURCE_DIR;
  std::vector<SourceFile> sources;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder))
    if (const auto extension = entry.path().extension(); extension == ".h" || extension == ".cpp")
      sources.push_back(
          {entry.path().lexically_relative(root).string(), lines_without_comments(entry.path().string())});
  EXPECT_GT(sources.size(), 20u) << folder;
  return sources;
}

bool begins_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

std::vector<std::string> includes_of(const SourceFile& source) {
  std::vector<std::string> result;
  for (const std::string& line : source.lines) {
    if (!begins_with(line, "#include ")) continue;
    const auto begin = line.find_first_of("<\"") + 1;
    result.push_back(line.substr(begin, line.find_first_of(">\"", begin) - begin));
  }
  return result;
}

TEST(Layering, IncludesPointDownward) {
  const std::vector<std::string> upward{"geometry", "renderer", "benchmarks", "app"};
  int own = 0;
  for (std::size_t layer = 0; layer < upward.size(); ++layer)
    for (const SourceFile& source : sources_of(upward[layer]))
      for (const std::string& include : includes_of(source)) {
        own += begins_with(include, upward[layer] + "/");
        EXPECT_FALSE(begins_with(include, "tests/")) << source.name << " includes " << include;
        for (std::size_t above = layer + 1; above < upward.size(); ++above)
          EXPECT_FALSE(begins_with(include, upward[above] + "/")) << source.name << " includes " << include;
      }
  EXPECT_GT(own, 500);
}

TEST(Layering, OtherLibrariesStayBehindTheirAdapters) {
  struct Adapter {
    std::string library, includes, sources;  // patterns
  };
  const Adapter adapters[] = {
      {"Embree", "embree[34]?/.*", "geometry/embree_.*"},
      {"OpenSubdiv", "opensubdiv/.*", "geometry/(osd_|subdivision_|facet_pattern).*"},
      {"OpenColorIO", "OpenColorIO/.*", "renderer/display\\.cpp"},
      {"OpenImageIO", "OpenImageIO/.*", "renderer/image_io/image_io\\.cpp"},
      {"OpenEXR", "(OpenEXR/.*|Imf.*)", "renderer/image_io/exr_io\\.cpp"},
      {"libpng", "png\\.h", "renderer/image_io/png_io\\.cpp"},
      {"the JSON library", "nlohmann/.*", "(renderer/json_document\\.cpp|benchmarks/.*\\.cpp|app/.*\\.cpp)"},
      {"CLI11", "CLI/.*", "app/.*\\.cpp"},
  };
  std::vector<SourceFile> sources;
  for (const char* folder : {"geometry", "renderer", "benchmarks", "app"})
    for (SourceFile& source : sources_of(folder)) sources.push_back(std::move(source));
  for (const Adapter& adapter : adapters) {
    const std::regex included(adapter.includes), allowed(adapter.sources);
    int used = 0;
    for (const SourceFile& source : sources)
      for (const std::string& include : includes_of(source)) {
        if (!std::regex_match(include, included)) continue;
        ++used;
        EXPECT_TRUE(std::regex_match(source.name, allowed)) << source.name << " includes " << adapter.library;
      }
    EXPECT_GT(used, 0) << adapter.library << " is included nowhere: is the pattern right?";
  }
}

TEST(Layering, LibrariesNeitherPrintNorEndTheProcess) {
  const std::regex prints_or_ends(
      "\\b(printf|fprintf|vprintf|vfprintf|puts|fputs|putchar|perror|exit|_exit|quick_exit|abort|terminate)\\s*\\(|"
      "\\bstd::c(out|err|log)\\b|\\bfmt::print\\b");
  EXPECT_TRUE(std::regex_search("  std::fprintf(stderr, \"a\");", prints_or_ends));
  EXPECT_FALSE(std::regex_search("  std::snprintf(text, 3, \"a\");", prints_or_ends));
  // A search by these first: the pattern alone takes a thousand times as long.
  const std::vector<const char*> words{"print", "put", "exit", "abort", "terminate", "perror", "std::c"};
  for (const char* folder : {"geometry", "renderer"})
    for (const SourceFile& source : sources_of(folder))
      for (const std::string& line : source.lines) {
        const bool may =
            std::any_of(words.begin(), words.end(), [&](const char* word) { return contains(line, word); });
        EXPECT_FALSE(may && std::regex_search(line, prints_or_ends)) << source.name << ": " << line;
      }
}

TEST(Layering, LibrariesLinkWhatTheyWrapPrivately) {
  const std::regex wrapped("embree|OpenSubdiv|nlohmann|OpenColorIO|OpenImageIO|OpenEXR|PNG|TBB", std::regex::icase);
  int private_ones = 0;
  for (const char* file :
       {"/geometry/CMakeLists.txt", "/renderer/CMakeLists.txt", "/renderer/image_io/CMakeLists.txt"}) {
    if (!fs::exists(std::string(RAYTREE_SOURCE_DIR) + file)) continue;
    std::string keyword;
    std::istringstream words(file_text(std::string(RAYTREE_SOURCE_DIR) + file));
    for (std::string word; words >> word;) {
      if (contains(word, "(")) keyword.clear();
      if (word == "PUBLIC" || word == "PRIVATE" || word == "INTERFACE") keyword = word;
      if (!contains(word, "::") && word != "embree") continue;
      if (!std::regex_search(word, wrapped)) continue;
      EXPECT_FALSE(keyword == "PUBLIC" || keyword == "INTERFACE") << file << " hands on " << word;
      private_ones += keyword == "PRIVATE";
    }
  }
  EXPECT_GE(private_ones, 6);
}

TEST(Build, PresetsAreThoseThatAreDocumented) {
  const nlohmann::json presets = nlohmann::json::parse(file_text(RAYTREE_SOURCE_DIR "/CMakePresets.json"));
  const auto variables_of = [&](const std::string& name) {
    for (const nlohmann::json& preset : presets.at("configurePresets"))
      if (preset.at("name") == name) return preset.value("cacheVariables", nlohmann::json::object());
    ADD_FAILURE() << "no preset " << name;
    return nlohmann::json::object();
  };
  EXPECT_EQ(variables_of("release").value("RAYTREE_NATIVE", ""), "ON") << "for the machine at hand";
  EXPECT_EQ(variables_of("portable").value("RAYTREE_NATIVE", ""), "OFF");
  for (const char* name : {"release", "portable"})
    EXPECT_EQ(variables_of(name).value("CMAKE_BUILD_TYPE", ""), "Release");
  EXPECT_EQ(variables_of("debug").value("CMAKE_BUILD_TYPE", ""), "Debug");
  EXPECT_EQ(variables_of("asan").value("RAYTREE_SANITIZE", ""), "address,undefined");
  for (const char* name : {"asan", "clang"}) {
    EXPECT_EQ(variables_of(name).value("CMAKE_CXX_COMPILER", ""), "clang++") << name;
    EXPECT_EQ(variables_of(name).value("RAYTREE_WARNINGS_AS_ERRORS", ""), "ON") << name;
  }
}

TEST(Build, EverySourceIsCompiledWithFloatingPointAsWritten) {
  // The program lies in the build's folder for programs.
  const fs::path commands = fs::path(RAYTREE_PROGRAM).parent_path().parent_path() / "compile_commands.json";
  ASSERT_TRUE(fs::exists(commands)) << commands;
  const nlohmann::json list = nlohmann::json::parse(file_text(commands.string()));
  ASSERT_GT(list.size(), 10u);
  for (const nlohmann::json& entry : list) {
    const std::string command = entry.at("command").get<std::string>() + " ",
                      file = entry.at("file").get<std::string>();
    EXPECT_TRUE(contains(command, " -ffp-contract=off ")) << file;
    EXPECT_TRUE(contains(command, " -std=c++20 ")) << file;
    for (const char* flag :
         {" -ffast-math ", " -Ofast ", " -funsafe-math-optimizations ", " -fassociative-math ", " -freciprocal-math ",
          " -ffinite-math-only ", " -ffp-contract=fast ", " -fno-signed-zeros "})
      EXPECT_FALSE(contains(command, flag)) << file << " is compiled with" << flag;
  }
}

}  // namespace
}  // namespace raytree::test
