// Scenes as files tell them, with everything at once that the model holds: a scene file whose mesh brings materials of
// every illumination model, spot lights that fall off, patterns and bumps in every space, glass, liquid, panes, rough
// metal, groups within groups; and an NFF file of every entity. Held to what every scene is held to: the same bits
// however it is traced, numbers everywhere, bounded cuts, adaptive samples that agree with many regular ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "renderer/nff_reader.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/cut_pictures.h"
#include "tests/renderer/same_picture.h"
#include "tests/renderer/test_scenes.h"
#include "tests/temporary_folder.h"

namespace raytree {
namespace {

using namespace test;

constexpr const char* kModelScene = R"({
  "raytree": 1,
  "image": {"width": 90, "height": 70},
  "render": {"depth": 7, "cutoff": 0.01, "rough_samples": 3, "distance_attenuation": 0.004},
  "background": {"type": "gradient", "bottom": 0.2, "horizon": [0.7, 0.8, 0.9], "top": [0.1, 0.2, 0.5]},
  "ambient": [0.2, 0.22, 0.25],
  "cameras": {"main": {"position": [0.5, 3.2, 8.5], "target": [0, 0.7, 0], "field_of_view": 42}},
  "lights": {
    "sun": {"type": "directional", "direction": [-0.5, -1, -0.4], "color": [0.5, 0.48, 0.45]},
    "lamp": {"type": "spot", "position": [2, 5, 3], "direction": [-0.4, -1, -0.5], "angle": 35, "inner_angle": 15,
             "falloff": "inverse_square", "least_distance": 0.5, "color": [12, 11, 9]},
    "torch": {"type": "spot", "position": [-4, 2, 4], "direction": [1, -0.3, -1], "angle": 25, "inner_angle": 25,
              "falloff": "linear", "color": [1, 1.5, 2]},
    "bulb": {"type": "point", "position": [0, 4, -3], "falloff": "linear", "color": 1.5}
  },
  "materials": {
    "floor": {"diffuse": {"type": "checker", "even": [0.8, 0.75, 0.7], "odd": [0.3, 0.3, 0.35], "size": 0.7}, "reflection": 0.1},
    "bottle": {"diffuse": 0.02, "reflection": 1, "transmission": [0.8, 0.95, 0.85], "fresnel": true, "index_of_refraction": 1.5,
               "absorption": [0.6, 0.1, 0.4], "priority": 2, "highlight": {"weight": 0.6, "exponent": 200}},
    "liquid": {"diffuse": 0, "reflection": 1, "transmission": 1, "fresnel": true, "index_of_refraction": 1.33,
               "absorption": [0.1, 0.6, 1.5], "priority": 1},
    "pane": {"diffuse": 0, "reflection": 0.1, "transmission": [0.6, 0.7, 0.9], "thin": true},
    "frosted": {"diffuse": 0, "reflection": 1, "transmission": 0.9, "fresnel": true, "roughness": 0.15},
    "brushed": {"diffuse": 0, "reflection": [0.95, 0.7, 0.4], "conductor": true, "roughness": 0.1,
                "bump": {"kind": "wrinkles", "amplitude": 0.02, "size": 0.2, "octaves": 2},
                "highlight": {"exponent": 25, "weight_by_angle": [{"angle": 0, "weight": 0.3}, {"angle": 80, "weight": 0.8}]}},
    "shellac": {"from": "phong-red"},
    "marble": {"diffuse": {"type": "noise", "low": [0.3, 0.3, 0.35], "high": 0.9, "size": 0.3, "octaves": 4, "space": "world"},
               "bump": {"kind": "ripples", "amplitude": 0.01, "size": 0.15, "space": "world"}},
    "awning": {"diffuse": {"type": "stripes", "even": 0.9, "odd": [0.7, 0.1, 0.1], "size": 0.12, "direction": [1, 1, 0]},
               "bump": {"kind": "noise", "amplitude": 0.02, "size": 0.2}, "one_sided": true},
    "printed": {"diffuse": {"type": "checker", "even": [0.1, 0.4, 0.7], "odd": 0.9, "size": 0.25, "plane": "uv"}}
  },
  "groups": {
    "toy": {"shapes": {
      "ball": {"type": "sphere", "material": "shellac", "center": [0, 0.25, 0], "radius": 0.25},
      "hat": {"type": "cone", "material": "marble", "base": [0, 0.45, 0], "apex": [0, 0.9, 0], "base_radius": 0.25, "apex_radius": 0},
      "plate": {"type": "disc", "material": "brushed", "center": [0, 0.01, 0], "normal": [0, 1, 0], "radius": 0.4}
    }},
    "row": {"shapes": {
      "left": {"type": "instance", "group": "toy", "transform": {"translate": [-0.6, 0, 0]}},
      "middle": {"type": "instance", "group": "toy", "transform": {"scale": 0.7, "rotate": [0, 40, 0]}},
      "right": {"type": "instance", "group": "toy", "material": "frosted", "transform": {"scale": [-1, 1, 1], "translate": [0.7, 0, 0]}},
      "speck": {"type": "sphere", "material": "shellac", "center": [0.3, 1, 0], "radius": 0.008}
    }},
    "tree": {"shapes": {
      "wood": {"type": "tree", "part": "wood", "material": "shellac", "height": 3, "leaves": 200, "leaf_size": 0.4},
      "leaves": {"type": "tree", "part": "leaves", "material": "awning", "height": 3, "leaves": 200, "leaf_size": 0.4}
    }}
  },
  "shapes": {
    "floor": {"type": "plane", "material": "floor"},
    "bottle": {"type": "sphere", "material": "bottle", "center": [-1.6, 0.9, 1], "radius": 0.9},
    "liquid": {"type": "sphere", "material": "liquid", "center": [-1.6, 0.9, 1.5], "radius": 0.6},
    "frosted": {"type": "sphere", "material": "frosted", "center": [1.9, 0.6, 1.6], "radius": 0.6},
    "pane": {"type": "mesh", "material": "pane", "positions": [[0.3, 0, 2.2], [1.1, 0, 2.6], [1.1, 1.4, 2.6], [0.3, 1.4, 2.2]], "faces": [[0, 1, 2, 3]]},
    "poster": {"type": "mesh", "material": "printed", "positions": [[-3, 0, -2.5], [-1.5, 0, -3], [-1.5, 1.6, -3], [-3, 1.6, -2.5]],
               "faces": [[0, 1, 2, 3]], "texture_coordinates": [[0, 0], [1, 0], [1, 1], [0, 1]]},
    "front row": {"type": "instance", "group": "row", "transform": {"translate": [0, 0, 2.6]}},
    "back row": {"type": "instance", "group": "row", "transform": [{"scale": 1.4, "rotate": [0, 25, 0]}, {"translate": [1.2, 0, -1.2]}]},
    "hill": {"type": "terrain", "material": "marble", "triangles": 800, "size": 5, "height": 1.5, "seed": 3, "transform": {"translate": [1.5, -0.4, -5]}},
    "wood": {"type": "scatter", "group": "tree", "terrain": "hill", "count": 6, "seed": 5, "least_scale": 0.3, "largest_scale": 0.6},
    "samples": {"type": "mesh", "file": "samples.obj", "transform": {"translate": [0.9, 1.3, -0.4]}}
  }
})";

/// Eleven cubes in two rows, one for each illumination model; the last bears a material of the scene.
std::string cubes_of_every_model() {
  std::string text = "mtllib samples.mtl\n";
  for (int i = 0; i <= 10; ++i) {
    const double x = -1.5 + 0.5 * (i % 6), y = 0.01 + 0.6 * static_cast<double>(i / 6), s = 0.35;
    for (int corner = 0; corner < 8; ++corner)
      text += "v " + std::to_string(x + s * (corner & 1)) + " " + std::to_string(y + s * (corner >> 1 & 1)) + " " +
              std::to_string(s * (corner >> 2)) + "\n";
    text += "usemtl " + (i == 10 ? std::string("brushed") : "model" + std::to_string(i)) + "\n";
    for (const char* face : {"-8 -6 -5 -7", "-4 -3 -1 -2", "-8 -7 -3 -4", "-6 -2 -1 -5", "-8 -4 -2 -6", "-7 -5 -1 -3"})
      text += "f " + std::string(face) + "\n";
  }
  return text;
}
std::string library_of_every_model() {
  std::string text;
  for (int model = 0; model <= 10; ++model)
    text += "newmtl model" + std::to_string(model) + "\nKa .1 .1 .2\nKd .6 ." + std::to_string(model) +
            " .3\nKs .3 .3 .2\nNs 60\nNi 1.4\nTf .5 .6 .4\nd .8\nillum " + std::to_string(model) + "\n";
  return text;
}

/// The scene file with its mesh and its library, read anew each time.
class ModelFiles : public testing::Test {
 protected:
  ModelFiles() {
    folder_.write("samples.obj", cubes_of_every_model());
    folder_.write("samples.mtl", library_of_every_model());
    path_ = folder_.write("model.json", kModelScene);
  }
  SceneDescription scene() const { return read_scene_file(path_); }

  TemporaryFolder folder_;
  std::string path_;
};

constexpr const char* kModelNff =
    "b .3 .5 .8\nl 6 9 8\nl -7 5 3 .6 .5 .4\nv\nfrom 1 2.5 8\nat 0 .6 0\nup 0 1 0\nangle 38\nhither 1\nresolution 90 "
    "70\n"
    "f .8 .7 .5 .9 .1 10 0 0\np 4\n-6 0 4\n6 0 4\n6 0 -6\n-6 0 -6\n"
    "f 1 .2 .1 .1 .4 80 .8 1.5\ns -1.4 .9 1 .9\n"
    "f .9 .9 .9 .2 .8 200 0 0\ns 1.3 .8 -.5 .8\nc 0 0 2 .4 0 1.1 2 .1\n"
    "f .2 .6 .3 .8 .3 20 0 0\nc 2.6 0 1 .3 2.6 1.5 .5 .3\npp 3\n-3 0 -2 0 .2 1\n-1 0 -2.5 .3 .2 1\n-2 2.2 -2.2 0 .5 1\n"
    "f .4 .4 1 .3 .1 5 .6 1\np 5 .4 .1 2.6 1.2 .1 2.2 1.5 .8 2.1 .9 1.3 2.3 .3 .8 2.6\n";

SceneDescription nff_scene() {
  Warnings warnings;
  SceneDescription scene = read_nff(kModelNff, "model.nff", warnings);
  EXPECT_TRUE(warnings.empty());
  return scene;
}

/// A picture of every channel holds numbers, and samples at pixels' corners agree with many regular ones.
template <class Read>
void expect_numbers_and_agreement(const Read& read) {
  const auto traced = [&](const Antialiasing& antialias) {
    SceneDescription scene = read();
    scene.render.antialias = antialias;
    RenderResult result = rendered(std::move(scene));
    expect_finite(result.film);
    EXPECT_EQ(result.statistics.not_finite_samples, 0u);
    return result;
  };
  const RenderResult adaptive = traced({Antialiasing::Method::whitted, 1}),
                     regular = traced({Antialiasing::Method::grid, 8});
  // Pixels of both are means over the same squares: what is left, per channel and pixel, is the noise of few samples,
  // of which a mean over all pixels keeps next to nothing.
  const auto pixels = static_cast<std::size_t>(adaptive.film.window().width * adaptive.film.window().height);
  for (int c = 0; c < 3; ++c) {
    double difference = 0, square = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
      const double d = double(adaptive.film.plane(ChannelGroup::color, c)[i]) -
                       double(regular.film.plane(ChannelGroup::color, c)[i]);
      difference += d, square += d * d;
    }
    EXPECT_NEAR(difference / static_cast<double>(pixels), 0, 2e-3) << "channel " << c;
    EXPECT_LT(std::sqrt(square / static_cast<double>(pixels)), 0.03) << "channel " << c;
  }
}

/// The same samples with the tree cut and whole; enough pixels lose something for that to mean anything.
template <class Read>
void expect_bounded_cuts(const Read& read, const std::string& what) {
  for (const double cutoff : {0.002, 0.03}) {
    const auto traced = [&](double allowed) {
      SceneDescription scene = read();
      scene.render.cutoff = allowed;
      scene.render.antialias.method = Antialiasing::Method::whitted;
      scene.render.adaptive = {0, 1, 1};
      return rendered(std::move(scene), cut_channels());
    };
    const RenderResult cut = traced(cutoff), whole = traced(0);
    ASSERT_EQ(cut.statistics.samples, whole.statistics.samples);
    std::uint64_t cut_pixels = 0;
    expect_cut_within_its_bound(cut.film, whole.film, cutoff, 9, what, cut_pixels);
    EXPECT_GT(cut_pixels, 100u) << what << ", " << cutoff;
    EXPECT_GT(cut.statistics.branches_cut, 100u);
  }
}

// What the tests below rest on: the scene has in use what the model has.
TEST_F(ModelFiles, HaveTheWholeModelInUse) {
  Warnings warnings;
  SceneDescription description = scene();
  description.render.antialias.method = Antialiasing::Method::whitted;
  const Scene ready = prepare(std::move(description), PrepareOptions(), warnings);
  for (const Warning& warning : warnings) EXPECT_TRUE(contains(warning.message, "illum 10")) << warning.message;
  const std::set<std::string> features(ready.summary.features.begin(), ready.summary.features.end());
  for (const char* feature : {"antialiasing (whitted)",
                              "rough surfaces",
                              "transparent shadows",
                              "absorption",
                              "thin sheets",
                              "media by priority",
                              "conductors",
                              "fresnel",
                              "spot lights",
                              "light falloff",
                              "highlights by angle",
                              "instances",
                              "checker patterns",
                              "stripes",
                              "noise",
                              "bumps",
                              "object spaces",
                              "texture coordinates",
                              "one-sided surfaces",
                              "distance attenuation",
                              "cutoff",
                              "reflection",
                              "refraction",
                              "cone BVH"})
    EXPECT_EQ(features.count(feature), 1u) << feature;
  EXPECT_GT(ready.small_objects.size(), 0u);
  EXPECT_GE(ready.summary.instances, 2u * 3 + 6) << "groups within groups, and scattered ones";
  std::set<std::string> of_library;
  for (const MaterialDescription& material : ready.description.materials)
    if (material.name.rfind("model", 0) == 0) of_library.insert(material.name);
  EXPECT_EQ(of_library.size(), 10u);
  // Every material is seen, so that it counts.
  RenderOptions options;
  options.channels = all_channels();
  const RenderResult result = render(ready, options);
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 90 * 70; ++i) seen.insert(result.film.id_plane(ChannelGroup::material_id)[i]);
  for (std::size_t m = 0; m < ready.description.materials.size(); ++m) {
    const std::string& name = ready.description.materials[m].name;
    EXPECT_EQ(seen.count(static_cast<std::uint32_t>(m + 1)), 1u) << name;
  }
}

TEST_F(ModelFiles, SceneFilesPicturesAreBitIdentical) {
  SceneDescription description = scene();
  description.render.antialias.method = Antialiasing::Method::whitted;
  description.render.adaptive.levels = 3;
  expect_the_same_picture_always(std::move(description), "scene file, whitted");
  description = scene();
  description.render.antialias = {Antialiasing::Method::grid, 2};
  expect_the_same_picture_always(std::move(description), "scene file, grid:2");
}

TEST_F(ModelFiles, SceneFilesPicturesAreNumbersAndConverge) {
  expect_numbers_and_agreement([&] { return scene(); });
}

TEST_F(ModelFiles, SceneFilesTreesLoseNoMoreThanTheyMay) {
  expect_bounded_cuts([&] { return scene(); }, "scene file");
}

TEST(ModelNff, PicturesAreBitIdentical) {
  SceneDescription description = nff_scene();
  description.render.antialias.method = Antialiasing::Method::whitted;
  expect_the_same_picture_always(std::move(description), "NFF, whitted");
  description = nff_scene();
  description.render.antialias = {Antialiasing::Method::grid, 2};
  expect_the_same_picture_always(std::move(description), "NFF, grid:2");
}

TEST(ModelNff, PicturesAreNumbersAndConverge) { expect_numbers_and_agreement(nff_scene); }

TEST(ModelNff, TreesLoseNoMoreThanTheyMay) { expect_bounded_cuts(nff_scene, "NFF"); }

}  // namespace
}  // namespace raytree
