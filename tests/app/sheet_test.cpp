// `raytree sheet` from outside: a labelled picture of every scene in four ways, and what it refuses. And the flags that
// change how facets are shaded.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "renderer/builtin_scenes.h"
#include "renderer/image_file.h"
#include "tests/app/program.h"

namespace raytree::test {
namespace {

TEST(Sheet, ShowsEverySceneInFourWaysUnderItsName) {
  const TemporaryFolder folder;
  const std::string path = folder.path("sheet.png");
  const ProgramResult result =
      run_program({"sheet", "cone", "prisms", "-o", path, "--size", "180x60", "--antialias", "none"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "2 scenes")) << result.err;
  const DecodedImage sheet = read_image_file(path);
  // Margins of 8 around cells, a line of letters 18 high above each.
  ASSERT_EQ(sheet.width, 8 + 4 * (180 + 8));
  ASSERT_EQ(sheet.height, 8 + 2 * (60 + 18 + 8 + 8));
  const auto region = [&](int left, int top, int width, int height) {
    std::vector<float> values;
    for (int y = top; y < top + height; ++y)
      for (int x = left; x < left + width; ++x) values.push_back(sheet.planes[0][std::size_t(y * sheet.width + x)]);
    return values;
  };
  std::set<std::vector<float>> cells, labels;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column) {
      const int left = 8 + column * 188, top = 8 + row * 94;
      const std::vector<float> label = region(left, top, 180, 18);
      const auto ink = std::count_if(label.begin(), label.end(), [](float v) { return v > 0.9f; });
      EXPECT_GT(ink, 300) << "letters of two pixels a dot";
      EXPECT_EQ(std::count_if(label.begin(), label.end(), [](float v) { return v > 0.16f && v < 0.9f; }), 0);
      labels.insert(label);
      cells.insert(region(left, top + 26, 180, 60));
    }
  // On a cylinder an interpolated normal points along the true radius: phong and limit are one there.
  EXPECT_GE(cells.size(), 7u);
  EXPECT_EQ(labels.size(), 8u);
  run_program({"sheet", "cone", "prisms", "-o", folder.path("again.png"), "--size", "180x60", "--antialias", "none",
               "--threads", "1"});
  EXPECT_EQ(file_text(path), file_text(folder.path("again.png")));
}

TEST(Sheet, ShortensANameForTheWholeRow) {
  const TemporaryFolder folder;
  const std::string path = folder.path("sheet.png");
  // 16 letters a cell: "cylinders flat" would fit, "cylinders gouraud" would not.
  const ProgramResult result =
      run_program({"sheet", "cylinders", "-o", path, "--size", "200x20", "--antialias", "none"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "(flat, gouraud, phong and limit)")) << result.err;
  const DecodedImage sheet = read_image_file(path);
  const auto letters = [&](int column, int begin, int count) {
    std::vector<float> values;
    for (int y = 8; y < 8 + 18; ++y)
      for (int x = 0; x < 12 * count; ++x)
        values.push_back(sheet.planes[0][std::size_t(y * sheet.width + 8 + 208 * column + 12 * begin + x)]);
    return values;
  };
  const std::vector<float> name = letters(0, 0, 9);  // seven letters, the dots, a blank
  EXPECT_GT(std::count_if(name.begin(), name.end(), [](float v) { return v > 0.9f; }), 300);
  const std::vector<float> dots = letters(0, 7, 1);
  EXPECT_EQ(std::count_if(dots.begin(), dots.end(), [](float v) { return v > 0.9f; }), 3 * 4) << "three dots";
  for (int column = 1; column < 4; ++column) EXPECT_EQ(letters(column, 0, 9), name) << column;
}

TEST(Sheet, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const std::string out = folder.path("sheet.png");
  expect_bad_input({"sheet", "-o", out}, {"no scene"});
  expect_bad_input({"sheet", "cone"}, {"no output", "-o"});
  expect_bad_input({"sheet", "cone", "-o", folder.path("sheet.exr")}, {"display-referred", ".png"});
  expect_bad_input({"sheet", "cone", "-o", out, "--shading", "flat"}, {"--shading"});
  expect_bad_input({"sheet", "conee", "-o", out}, {"conee", "did you mean cone"});
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(ShadingFlags, ChangeThePictureAndAreChecked) {
  const TemporaryFolder folder;
  const auto picture = [&](const std::vector<std::string>& flags) {
    const ProgramResult result = run_program(
        with({"render", "molecule", "-o", folder.path("p.png"), "--size", "60x40", "--antialias", "none"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return file_text(folder.path("p.png"));
  };
  const std::string plain = picture({});
  EXPECT_EQ(picture({"--set", "shapes.bond 1.shading=phong"}).empty(), false);
  EXPECT_NE(picture({"--shading", "flat"}), plain);
  EXPECT_NE(picture({"--shading", "gouraud"}), plain);
  EXPECT_NE(picture({"--shading", "limit"}), plain);
  const std::string offset = picture({"--terminator", "offset"});
  EXPECT_NE(offset, plain);
  // Off alone is what --classic turns off: both remedies, whatever the scene says.
  const std::string classic = picture({"--classic"});
  EXPECT_EQ(classic, picture({"--terminator", "classic", "--reflections", "classic"}));
  EXPECT_EQ(classic, picture({"--set", "render.facets.shadow_terminator=offset", "--classic"}));
  EXPECT_NE(classic, offset);
  expect_bad_input({"render", "molecule", "-o", folder.path("q.png"), "--shading", "gourad"},
                   {"--shading", "flat, gouraud, phong, limit", "did you mean gouraud"});
  expect_bad_input({"render", "molecule", "-o", folder.path("q.png"), "--terminator", "hanika"}, {"classic, offset"});
  expect_bad_input({"render", "molecule", "-o", folder.path("q.png"), "--classic", "--reflections", "clamped"},
                   {"--classic", "exclude"});
  const ProgramResult info = run_program({"info", "molecule", "--shading", "gouraud"});
  EXPECT_TRUE(contains(info.out, "gouraud shading")) << info.out;
  EXPECT_TRUE(contains(run_program({"info", "molecule", "--json"}).out, "\"shading\": \"phong\""));
}

TEST(ShadingFlags, ReflectionsOfACoarseMirrorAreByEachMethod) {
  const TemporaryFolder folder;
  write_text(folder.path("s.json"), R"({
    "raytree": 1,
    "cameras": {"main": {"position": [0, 1, 6], "target": [0, 0, 0], "field_of_view": 24}},
    "background": {"type": "gradient", "bottom": [0.8, 0.2, 0.1], "horizon": [1, 1, 1], "top": [0.1, 0.2, 0.8]},
    "materials": {"mirror": {"diffuse": 0, "reflection": 0.9}},
    "shapes": {"ball": {"type": "sphere", "radius": 1, "sides": 16, "material": "mirror"}}
  })");
  const auto planes = [&](const std::vector<std::string>& flags) {
    const std::string out = folder.path("p.exr");
    const ProgramResult result = run_program(
        with({"render", folder.path("s.json"), "-o", out, "--size", "80x80", "--antialias", "none"}, flags));
    EXPECT_EQ(result.status, 0) << result.err;
    return read_image_file(out).planes;
  };
  const auto clamped = planes({"--reflections", "clamped"}), classic = planes({"--reflections", "classic"}),
             consistent = planes({"--reflections", "consistent"});
  EXPECT_EQ(planes({}), clamped);
  EXPECT_EQ(planes({"--classic"}), classic);
  EXPECT_NE(classic, clamped);
  EXPECT_NE(classic, consistent);
  EXPECT_NE(clamped, consistent);
}

TEST(PapersScenes, HaveTheSidesOfTheirFigures) {
  const auto sides_of = [](const char* scene) {
    std::multiset<int> sides;
    for (const ShapeDescription& shape : builtin_scene(scene).shapes)
      if (const auto* const cone = std::get_if<ConeShape>(&shape.kind)) {
        EXPECT_EQ(cone->base_radius, cone->apex_radius) << shape.name;
        sides.insert(cone->sides);
      }
    return sides;
  };
  EXPECT_EQ(sides_of("cylinders"), (std::multiset<int>{3, 4, 8, 12, 16, 32, 64}));
  EXPECT_EQ(sides_of("prisms"), (std::multiset<int>{3, 3, 3, 3}));
}

TEST(PapersScenes, SheetsOfTheDocumentationAreMade) {
  const TemporaryFolder folder;
  std::istringstream text(file_text(RAYTREE_SOURCE_DIR "/docs/shading.md"));
  int made = 0;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("./run sheet ")) continue;
    SCOPED_TRACE(line);
    std::istringstream words(line.substr(6));
    std::vector<std::string> command;
    int scenes = 0;
    bool flags = false;
    for (std::string word; words >> word;) {
      flags |= word.starts_with("-");
      scenes += !flags && !command.empty();
      command.push_back(command.empty() || command.back() != "-o" ? word : folder.path(word));
    }
    const ProgramResult result = run_program(with(command, {"--size", "40x30"}));
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.err, std::to_string(scenes) + " scenes")) << result.err;
    ++made;
  }
  EXPECT_EQ(made, 2);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"curved.png", "papers.png"}));
}

}  // namespace
}  // namespace raytree::test
