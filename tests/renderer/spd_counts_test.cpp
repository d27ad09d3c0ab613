// The SPD's standard render: rays as Haines published them, and what the render changes in a scene.
#include "renderer/spd_counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/angle.h"
#include "renderer/scene.h"
#include "renderer/spd_scenes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

RenderStatistics standard_render(SceneDescription scene, const RenderOptions& options = {}) {
  set_standard_spd_render(scene);
  return render(prepared(std::move(scene)), options).statistics;
}

class SpdCountsOf : public testing::TestWithParam<SpdEntry> {};

TEST_P(SpdCountsOf, AreThePublishedOnes) {
  const SpdEntry& entry = GetParam();
  SceneDescription scene = spd_scene(entry.database, entry.standard_size);
  const std::optional<SpdCounts> published = published_spd_counts(scene);
  ASSERT_TRUE(published.has_value());
  const SpdCounts counts = spd_counts(standard_render(std::move(scene)));
  for (const SpdCountKind& kind : kSpdCounts)
    EXPECT_LE(std::abs(relative_difference(counts.*kind.value, *published.*kind.value)), kSpdTolerance)
        << kind.name << ": " << counts.*kind.value << ", published " << *published.*kind.value;
}

INSTANTIATE_TEST_SUITE_P(Databases, SpdCountsOf, testing::ValuesIn(spd_databases().begin(), spd_databases().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Figures of this renderer, to be seen when something changes. A few rays along edges may fall otherwise where another
// version of the tracer or another instruction set rounds otherwise.
TEST(SpdCounts, OfSmallScenesAreWhatTheyWere) {
  struct Case {
    const char* name;
    SpdCounts expected;
  };
  for (const Case& c : {Case{"spd-balls:2", {4225, 1766, 0, 14003}}, Case{"spd-gears:2", {3871, 7056, 4661, 43746}},
                        Case{"spd-mount:3", {2699, 5458, 5458, 6147}}, Case{"spd-rings:2", {4225, 1823, 0, 14113}},
                        Case{"spd-teapot:3", {2536, 3533, 0, 6279}}, Case{"spd-tetra:3", {981, 0, 0, 933}},
                        Case{"spd-tree:4", {2554, 0, 0, 17045}}}) {
    SceneDescription scene = spd_scene(c.name);
    scene.image = {64, 64};
    const SpdCounts counts = spd_counts(standard_render(std::move(scene)));
    for (const SpdCountKind& kind : kSpdCounts) {
      const auto found = static_cast<double>(counts.*kind.value),
                 expected = static_cast<double>(c.expected.*kind.value);
      EXPECT_NEAR(found, expected, 0.002 * expected) << c.name << ' ' << kind.name;
    }
  }
}

TEST(SpdCounts, DependNeitherOnThreadsNorOnTheOrderOfTiles) {
  const auto counts = [](int threads, std::uint64_t seed) {
    SceneDescription scene = spd_scene("spd-gears:2");
    scene.image = {64, 64};
    RenderOptions options;
    options.threads = threads;
    options.tile_order_seed = seed;
    return spd_counts(standard_render(std::move(scene), options));
  };
  const SpdCounts one = counts(1, 0), three = counts(3, 7);
  for (const SpdCountKind& kind : kSpdCounts) EXPECT_EQ(one.*kind.value, three.*kind.value) << kind.name;
}

// Whatever lies on the border of tiles, each corner is traced once, and lies on its pixel's corner.
TEST(SpdCounts, EyeRaysGoThroughTheCornersOfPixelsOnce) {
  for (const bool perspective : {true, false}) {
    SceneDescription scene = dark_scene(64, front_camera(2));
    if (perspective) {
      scene.cameras[0].projection = CameraDescription::Projection::perspective;
      scene.cameras[0].field_of_view = 2 * std::atan(0.1) / kDegree;
    }
    scene.image = {96, 64};
    // A white wall exactly as large as the window, and a little: its border is met by the outermost rays.
    const double inside = 1 - 1e-4, outside = 1 + 1e-4;
    scene.materials = {material("wall", Rgb(1))};
    for (const double half : {inside, outside}) {
      const auto y = static_cast<float>(half), x = static_cast<float>(1.5 * half);
      SceneDescription walled = scene;
      walled.shapes = {
          mesh_shape(triangles({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {0, 1, 2, 0, 2, 3}), "wall")};
      const RenderStatistics statistics = standard_render(std::move(walled));
      EXPECT_EQ(statistics.samples, 97u * 65u);
      EXPECT_EQ(statistics.eye_hits, half < 1 ? 95u * 63u : 97u * 65u);
    }
  }
}

TEST(SpdCounts, ShadowRaysGoWhereTheNormalFacesTheLightAlone) {
  SceneDescription scene = dark_scene(64, front_camera(2));
  scene.materials = {material("wall", Rgb(1))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "wall")};
  scene.lights = {point_light({0, 0, 5}), point_light({0, 0, -5}), point_light({3, 0, 1})};
  EXPECT_EQ(spd_counts(standard_render(std::move(scene))).shadow, 2u * 65 * 65);
}

TEST(SpdCounts, TransmittersReflectAndReflectTotally) {
  // A pane that transmits and has no k_s: at each of its faces one ray goes on and one back.
  SceneDescription scene = dark_scene(8, front_camera(2));
  scene.materials = {material("glass", Rgb(0))};
  scene.background = ConstantBackground{Rgb(1)};  // rays that can bring no light are not traced
  scene.materials[0].transmission = Rgb(0.8f);
  scene.materials[0].index_of_refraction = 1.5;
  scene.shapes = {mesh_shape(box_mesh({-9, -9, -1}, {9, 9, 1}), "glass")};
  const SpdCounts counts = spd_counts(standard_render(std::move(scene)));
  // Levels 2 to 5: outside a reflected ray leaves; inside one ray goes to and fro, and at each face one leaves.
  EXPECT_EQ(counts.refracted, 81u * 4);
  EXPECT_EQ(counts.reflected, 81u * 4);
}

TEST(SpdCounts, OpaqueSurfacesAreOneSidedButThoseWithVertexNormals) {
  SceneDescription scene = spd_scene("spd-teapot:2");
  set_standard_spd_render(scene);
  ASSERT_EQ(scene.materials.size(), 3u);
  EXPECT_TRUE(scene.materials[0].one_sided);
  EXPECT_TRUE(scene.materials[1].one_sided);
  EXPECT_FALSE(scene.materials[2].one_sided) << "the teapot";
  for (const char* name : {"spd-tree:2", "spd-rings:2", "spd-balls:2", "spd-tetra:2", "spd-mount:2", "spd-gears:2"}) {
    SceneDescription other = spd_scene(name);
    set_standard_spd_render(other);
    for (const MaterialDescription& material : other.materials)
      EXPECT_EQ(material.one_sided, is_black(material.transmission)) << name << ' ' << material.name;
  }
}

TEST(SpdCounts, ArePublishedOfTheSevenScenesAtTheirStandardSizeAlone) {
  for (const SpdEntry& entry : spd_databases()) {
    SceneDescription scene = spd_scene(entry.database, entry.standard_size);
    EXPECT_TRUE(published_spd_counts(scene).has_value());
    scene.name = "folder/" + std::string(entry.name) + ".nff";
    EXPECT_TRUE(published_spd_counts(scene).has_value());
    scene.image = {256, 256};
    EXPECT_FALSE(published_spd_counts(scene).has_value());
    EXPECT_FALSE(published_spd_counts(spd_scene(entry.database, entry.standard_size - 1)).has_value());
  }
}

TEST(SpdCounts, DifferencesAreRelativeToWhatWasPublished) {
  EXPECT_EQ(relative_difference(125, 100), 0.25);
  EXPECT_EQ(relative_difference(75, 100), -0.25);
  EXPECT_EQ(relative_difference(0, 0), 0);
  EXPECT_EQ(relative_difference(1, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace raytree
