// The scenes that come with the program: they read, they round-trip, and they are what their names promise.
#include "renderer/builtin_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "renderer/scene.h"
#include "renderer/scene_reader.h"
#include "renderer/spd_scenes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

TEST(BuiltinScenes, AllReadAndRoundTrip) {
  const auto scenes = builtin_scenes();
  std::vector<std::string> names;
  for (const BuiltinScene& scene : scenes) {
    names.push_back(scene.name);
    EXPECT_FALSE(scene.summary.empty()) << scene.name;
    // The generated ones would be megabytes of text.
    const SceneDescription description = builtin_scene(scene.name + (is_spd_scene(scene.name) ? ":2" : ""));
    EXPECT_FALSE(description.cameras.empty()) << scene.name;
    EXPECT_FALSE(description.shapes.empty()) << scene.name;
    const std::string text = write_scene(description);
    EXPECT_EQ(write_scene(read_scene(text, scene.name, "")), text) << scene.name;
  }
  for (const char* name :
       {"spheres-1980", "sphere-flake", "terrain",        "forest", "stepwedge", "mirrors",      "lens",
        "glass",        "rough",        "teapot",         "goblet", "t-tail",    "whitted-fig6", "whitted-fig7",
        "cylinders",    "cone",         "faceted-sphere", "prisms", "molecule",  "spd-balls",    "spd-tree"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(BuiltinScenes, AreTheFilesOfTheSourceTreeByteForByte) {
  for (const EmbeddedScene& scene : embedded_scenes()) {
    std::ifstream file(std::string(RAYTREE_SOURCE_DIR) + "/scenes/" + std::string(scene.name) + ".json");
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_EQ(text.str(), scene.json) << scene.name;
  }
}

TEST(BuiltinScenes, AnUnknownNameListsTheChoices) {
  try {
    builtin_scene("sphere-1980");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    const std::string message = error.what();
    EXPECT_NE(message.find("stepwedge"), message.npos) << message;
    EXPECT_NE(message.find("did you mean \"spheres-1980\"?"), message.npos) << message;
  }
  EXPECT_TRUE(is_builtin_scene("terrain"));
  EXPECT_FALSE(is_builtin_scene("terrain.json"));
}

TEST(BuiltinScenes, WhittedsPictureHasAGlassAndAMirrorSphereOverAFiniteChecker) {
  const SceneDescription scene = builtin_scene("spheres-1980");
  const auto material_of = [&](const ShapeDescription& shape) {
    for (const MaterialDescription& material : scene.materials)
      if (material.name == shape.material) return material;
    return MaterialDescription{};
  };
  int glass = 0, mirror = 0, checker = 0;
  for (const ShapeDescription& shape : scene.shapes) {
    const MaterialDescription material = material_of(shape);
    if (std::holds_alternative<SphereShape>(shape.kind) && max_channel(material.transmission) > 0.5f) ++glass;
    if (std::holds_alternative<SphereShape>(shape.kind) && is_black(material.transmission) &&
        max_channel(material.reflection) > 0.5f)
      ++mirror;
    if (std::holds_alternative<MeshShape>(shape.kind) && std::holds_alternative<CheckerPattern>(material.diffuse))
      ++checker;
  }
  EXPECT_EQ(glass, 1);
  EXPECT_EQ(mirror, 1);
  EXPECT_EQ(checker, 1);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.image.width, 960);
  EXPECT_EQ(scene.image.height, 720);
  EXPECT_EQ(scene.render.antialias.method, Antialiasing::Method::whitted);
}

/// The scene as `change` makes it, small, one sample a pixel. Read anew each time, since rendering consumes meshes.
template <class Change>
RenderResult sketched(const char* name, const Change& change) {
  SceneDescription scene = builtin_scene(name);
  scene.image = {160, 120};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  change(scene);
  return test::rendered(std::move(scene));
}
/// Pixels that show shape `id` in both pictures and differ.
int changed_pixels(const RenderResult& a, const RenderResult& b, std::uint32_t id) {
  int changed = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const std::size_t i = test::pixel_index(a.film, x, y);
      if (a.film.id_plane(ChannelGroup::object_id)[i] != id || b.film.id_plane(ChannelGroup::object_id)[i] != id)
        continue;
      const Rgb d = test::color_at(a.film, x, y) - test::color_at(b.film, x, y);
      changed += std::abs(d.r) + std::abs(d.g) + std::abs(d.b) > 0.02f;
    }
  return changed;
}

TEST(BuiltinScenes, Figure6ShowsThreeGlossyWrinkledObjectsThatShadowAndReflectEachOther) {
  const SceneDescription scene = builtin_scene("whitted-fig6");
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_EQ(scene.render.antialias.method, Antialiasing::Method::whitted);
  // Without shadows: what changes on the others when one is taken away is its reflection.
  const auto picture = [](const auto& change) {
    return sketched("whitted-fig6", [&](SceneDescription& changed) {
      changed.render.shadows = false;
      change(changed);
    });
  };
  const RenderResult all = picture([](SceneDescription&) {});
  for (std::size_t i = 0; i < 3; ++i) {
    const MaterialDescription& material = scene.materials.at(i);
    ASSERT_EQ(scene.shapes[i].material, material.name);
    EXPECT_TRUE(material.bump.has_value());
    EXPECT_GT(max_channel(material.highlight.weight), 0.3f);
    const RenderResult without = picture([&](SceneDescription& changed) {
      std::get<SphereShape>(changed.shapes[i].kind).center = {0, -1000, 0};
    });
    for (std::size_t other = 0; other < 3; ++other)
      if (other != i) {
        EXPECT_GT(changed_pixels(all, without, static_cast<std::uint32_t>(other + 1)), 15) << i << " in " << other;
      }
    const RenderResult smooth = picture([&](SceneDescription& changed) { changed.materials[i].bump.reset(); });
    EXPECT_GT(changed_pixels(all, smooth, static_cast<std::uint32_t>(i + 1)), 300) << "wrinkles of " << i;
  }
  const RenderResult shadowed = sketched("whitted-fig6", [](SceneDescription&) {});
  EXPECT_GT(changed_pixels(all, shadowed, 4), 1000) << "shadows on the table";
}

TEST(BuiltinScenes, Figure7ShowsACheckerThroughAnObjectThatRefracts) {
  const SceneDescription scene = builtin_scene("whitted-fig7");
  EXPECT_EQ(scene.render.antialias.method, Antialiasing::Method::whitted);
  const MaterialDescription& glass = scene.materials.at(0);
  EXPECT_GT(max_channel(glass.transmission), 0.5f);
  EXPECT_FALSE(scene.render.fresnel) << "the paper's pictures hold k_s and k_t constant";
  const RenderResult result = sketched("whitted-fig7", [](SceneDescription&) {});
  const RenderResult straight =
      sketched("whitted-fig7", [](SceneDescription& changed) { changed.materials.at(0).index_of_refraction = 1; });
  EXPECT_GT(changed_pixels(result, straight, 1), 1500) << "what is behind is seen elsewhere";
  // The upper half of the ball shows the floor, red and yellow, where straight behind it is sky.
  int upside_down = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 160; ++x) {
      const Rgb color = test::color_at(result.film, x, y);
      upside_down += result.film.id_plane(ChannelGroup::object_id)[test::pixel_index(result.film, x, y)] == 1 &&
                     color.r > 2 * color.b;
    }
  EXPECT_GT(upside_down, 500);
}

TEST(BuiltinScenes, TheForestIsThousandsOfInstancesOfAFewTreesOnTheGround) {
  Warnings warnings;
  PrepareOptions options;
  options.build = false;
  const Scene scene = prepare(builtin_scene("forest"), options, warnings);
  EXPECT_GT(scene.summary.instances, 10'000u);
  EXPECT_EQ(scene.summary.groups.size(), 6u);
  std::uint64_t unique = 0, seen = 0;
  for (const GroupSummary& group : scene.summary.groups)
    for (const ShapeSummary& shape : group.shapes) unique += shape.triangles;
  for (const ShapeSummary& shape : scene.summary.shapes) seen += shape.instanced_triangles;
  EXPECT_LT(unique, 250'000u);
  EXPECT_GT(seen, 300'000'000u);
  // Nothing stands in the lake.
  const float lake = 22;
  for (const Instance& tree : scene.shapes->instances) EXPECT_GT(tree.to_scene[3][1] + scene.shapes->origin.y, lake);
}

// Phong 1973, App. I: the first table's shade n halves from square to square, the second's falls in equal steps. Lit by
// ambient light 1 alone, a patch sends out its ambient coefficient.
TEST(BuiltinScenes, StepwedgeHoldsPhongsTwoTables) {
  const SceneDescription scene = builtin_scene("stepwedge");
  EXPECT_EQ(scene.ambient, Rgb(1.0f));
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.cameras.at(0).projection, CameraDescription::Projection::orthographic);
  ASSERT_EQ(scene.materials.size(), 18u);
  ASSERT_EQ(scene.shapes.size(), 18u);
  for (int i = 0; i < 9; ++i) {
    const auto shade = [&](int index) {
      const MaterialDescription& material = scene.materials.at(static_cast<std::size_t>(index));
      EXPECT_EQ(std::get<Rgb>(material.diffuse), Rgb());
      EXPECT_EQ(scene.shapes.at(static_cast<std::size_t>(index)).material, material.name);
      return std::get<Rgb>(material.ambient.value());
    };
    EXPECT_EQ(shade(i), Rgb(std::ldexp(1.0f, -i)));
    EXPECT_EQ(shade(9 + i), Rgb(1 - static_cast<float>(i) / 8));
  }
}

}  // namespace
}  // namespace raytree
