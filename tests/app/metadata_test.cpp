// What the pictures carry beside pixels: every documented name, in files of every format.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "renderer/image_file.h"
#include "tests/app/documentation.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

using MetadataJson = nlohmann::json;

/// Names that the documentation of `raytree render` lists.
std::set<std::string> documented_metadata() {
  const std::string documentation = documentation_of("render");
  const std::size_t begin = documentation.find("Metadata of the files:");
  const std::string paragraph = documentation.substr(begin, documentation.find("\n\n", begin) - begin);
  const std::regex name("`([A-Za-z:_]+)`");
  std::set<std::string> names;
  for (std::sregex_iterator match(paragraph.begin(), paragraph.end(), name), end; match != end; ++match)
    names.insert((*match)[1].str());
  return names;
}

TEST(PictureMetadata, EveryDocumentedNameInEveryFormat) {
  TemporaryFolder folder;
  const std::string scene = folder.path("s.json");
  write_text(scene, R"({"raytree": 1, "title": "A \"sphere\": 50 %", "image": {"width": 32, "height": 24},
                        "render": {"depth": 3}, "background": {"type": "gradient", "top": [0.25, 0.5, 1]},
                        "cameras": {"other": {}, "main": {"position": [0, 1, 6], "target": [0, 0, 0]}},
                        "shapes": {"ball": {"type": "sphere"}}})");
  const std::vector<std::string> files = {"a.exr", "a.png", "a.jpg", "a.tif"};
  std::vector<std::string> words = {
      "render",   scene,  "--ocio",  "builtin", "--display",  "CRT",  "--view", "Shade as brightness",
      "--camera", "main", "--depth", "5",       "--exposure", "-1.5", "--quiet"};
  for (const std::string& file : files) words = with(words, {"-o", folder.path(file)});
  const ProgramResult result = run_program(words);
  ASSERT_EQ(result.status, 0) << result.err;
  std::string version = run_program({"--version"}).out;
  version = version.substr(std::string("raytree ").size(), version.find(" (") - std::string("raytree ").size());

  const std::map<std::string, std::string> linear = {{"Software", "Raytree " + version},
                                                     {"raytree:scene", scene},
                                                     {"ImageDescription", "A \"sphere\": 50 %"}},
                                           shown = {{"raytree:ocio_config", "raytree-builtin-1"},
                                                    {"raytree:display", "CRT"},
                                                    {"raytree:view", "Shade as brightness"},
                                                    {"raytree:exposure", "-1.5"}};
  std::set<std::string> names = {"raytree:settings"};
  for (const auto* list : {&linear, &shown})
    for (const auto& [name, text] : *list) names.insert(name);
  EXPECT_EQ(names, documented_metadata());
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const DecodedImage image = read_image_file(folder.path(file));
    std::map<std::string, std::string> found(image.metadata.begin(), image.metadata.end());
    for (const auto& [name, text] : linear) EXPECT_EQ(found[name], text) << name;
    for (const auto& [name, text] : shown) EXPECT_EQ(found[name], file == "a.exr" ? "" : text) << name;
    // The settings are a scene of their own: what flags set, and the camera that looked.
    const MetadataJson settings = MetadataJson::parse(found["raytree:settings"], nullptr, false);
    ASSERT_TRUE(settings.is_object()) << found["raytree:settings"];
    EXPECT_EQ(settings["image"], (MetadataJson{{"width", 32}, {"height", 24}}));
    EXPECT_EQ(settings["render"]["depth"], 5);
    EXPECT_EQ(settings["background"]["top"], MetadataJson({0.25, 0.5, 1.0}));
    ASSERT_EQ(settings["cameras"].size(), 1u);
    EXPECT_EQ(settings["cameras"]["main"]["position"], MetadataJson({0.0, 1.0, 6.0}));
    EXPECT_TRUE(settings.value("shapes", MetadataJson()).empty());
  }
}

}  // namespace
}  // namespace raytree::test
