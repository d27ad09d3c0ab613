// What the scene files of the project show, beyond being read: each renders without a warning and shows every shape
// that it holds, and each picture changes where a part of the model that the scene is for is taken from it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "renderer/builtin_scenes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr int kGalleryWidth = 192;

/// The scene in its own proportions, small, one sample a pixel; read anew each time, since rendering consumes meshes.
SceneDescription gallery_scene(const std::string& name) {
  SceneDescription scene = builtin_scene(name);
  scene.image.height = static_cast<int>(std::lround(double(kGalleryWidth) * scene.image.height / scene.image.width));
  scene.image.width = kGalleryWidth;
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

/// Share of the pixels that differ by two levels of 255 or more, about, in some channel.
double changed_share(const Film& a, const Film& b) {
  const PixelWindow& window = a.window();
  int changed = 0;
  for (int y = 0; y < window.height; ++y)
    for (int x = 0; x < window.width; ++x) {
      const Rgb d = color_at(a, x, y) - color_at(b, x, y);
      changed += std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)}) > 0.01f;
    }
  return static_cast<double>(changed) / (window.width * window.height);
}

/// Numbers of the shapes (without uses of groups), from 1, and of the materials that pixels show at first hand.
struct SeenAtFirstHand {
  std::set<std::uint32_t> objects, materials;
};
SeenAtFirstHand seen_at_first_hand(const Film& film) {
  SeenAtFirstHand seen;
  const PixelWindow& window = film.window();
  for (int i = 0; i < window.width * window.height; ++i) {
    seen.objects.insert(film.id_plane(ChannelGroup::object_id)[i]);
    seen.materials.insert(film.id_plane(ChannelGroup::material_id)[i]);
  }
  return seen;
}

TEST(SceneGallery, EverySceneShowsAllThatItHoldsWithoutAWarning) {
  std::size_t scenes = 0;
  for (const EmbeddedScene& embedded : embedded_scenes()) {
    const std::string name(embedded.name);
    SCOPED_TRACE(name);
    ++scenes;
    SceneDescription description = gallery_scene(name);
    const std::size_t shapes = description.shapes.size();
    Warnings warnings;
    const Scene scene = prepare(std::move(description), PrepareOptions(), warnings);
    for (const Warning& warning : warnings) ADD_FAILURE() << warning.message;
    RenderOptions options;
    options.channels = all_channels();
    const RenderResult result = render(scene, options);
    expect_finite(result.film);
    EXPECT_EQ(result.statistics.not_finite_samples, 0u);
    const SeenAtFirstHand seen = seen_at_first_hand(result.film);
    if (scene.shapes->instances.empty()) {
      // What eye rays do not meet is seen in a mirror or through glass: without it the picture is another one.
      for (std::size_t s = 0; s < shapes; ++s) {
        if (seen.objects.count(static_cast<std::uint32_t>(s + 1)) == 1) continue;
        SceneDescription without = gallery_scene(name);
        const std::string shape = without.shapes[s].name;
        without.shapes.erase(without.shapes.begin() + static_cast<std::ptrdiff_t>(s));
        EXPECT_GE(changed_share(result.film, rendered(std::move(without), {ChannelGroup::color}).film), 1e-4) << shape;
      }
    } else {
      EXPECT_GT(seen.objects.size(), 100u) << "uses of groups";
      for (std::size_t m = 0; m < scene.description.materials.size(); ++m)
        EXPECT_EQ(seen.materials.count(static_cast<std::uint32_t>(m + 1)), 1u) << scene.description.materials[m].name;
    }
  }
  EXPECT_GE(scenes, 19u);
}

struct PartOfTheModel {
  const char *scene, *what;
  double share;  ///< of the pixels that change at least: half of what was found, about
  std::function<void(SceneDescription&)> take_away;
};

/// Changes every material of the scene.
std::function<void(SceneDescription&)> of_materials(std::function<void(MaterialDescription&)> change) {
  return [change = std::move(change)](SceneDescription& scene) {
    for (MaterialDescription& material : scene.materials) change(material);
  };
}

TEST(SceneGallery, PicturesChangeWithoutThePartsOfTheModelThatTheyAreFor) {
  using Material = MaterialDescription;
  const auto fewer_levels = [](SceneDescription& scene) { scene.render.depth = 1; };
  const PartOfTheModel parts[] = {
      {"glass", "light through colored glass", 0.03, [](auto& scene) { scene.render.transparent_shadows = false; }},
      {"glass", "absorption", 0.08, of_materials([](Material& m) { m.absorption = Rgb(0); })},
      {"glass", "tea held by its tumbler", 0.025, of_materials([](Material& m) { m.priority = 0; })},
      {"glass", "a pane that does not bend", 0.035, of_materials([](Material& m) { m.thin = false; })},
      {"glass", "metal by Schlick", 0.035, of_materials([](Material& m) { m.conductor = false; })},
      {"glass", "Fresnel", 0.1, [](auto& scene) { scene.render.fresnel = false; }},
      {"rough", "roughness", 0.1, of_materials([](Material& m) { m.roughness = 0; })},
      {"rough", "facets", 0.1, [](auto& scene) { scene.render.rough_samples = 1; }},
      {"lens", "refraction", 0.3, of_materials([](Material& m) { m.index_of_refraction = 1; })},
      {"mirrors", "the depth of the tree", 0.02, [](auto& scene) { scene.render.depth = 3; }},
      {"spheres-1980", "glass and mirror", 0.15, fewer_levels},
      {"whitted-fig7", "glass and mirror", 0.15, fewer_levels},
      {"sphere-flake", "reflection", 0.4, fewer_levels},
      {"goblet", "reflection", 0.25, fewer_levels},
      {"teapot", "reflection", 0.4, fewer_levels},
      {"teapot", "bumps", 0.012, of_materials([](Material& m) { m.bump.reset(); })},
      {"whitted-fig6", "bumps", 0.2, of_materials([](Material& m) { m.bump.reset(); })},
      {"terrain", "reflection in the lake", 0.14, fewer_levels},
      {"forest", "reflection in the lake", 0.14, fewer_levels},
      {"forest", "shadows of leaves", 0.25, [](auto& scene) { scene.render.shadows = false; }},
  };
  std::string name;
  std::optional<RenderResult> whole;
  for (const PartOfTheModel& part : parts) {
    if (name != part.scene) whole = rendered(gallery_scene(name = part.scene), {ChannelGroup::color});
    SceneDescription without = gallery_scene(name);
    part.take_away(without);
    const double share = changed_share(whole->film, rendered(std::move(without), {ChannelGroup::color}).film);
    RecordProperty(name + ", " + part.what, std::to_string(share));
    EXPECT_GE(share, part.share) << name << " without " << part.what;
  }
}

}  // namespace
}  // namespace raytree
