// A few small pictures against references in linear EXR (tests/reference/). They hold what closed forms do not: whole
// scenes with everything at once. After a change that is meant to alter pictures:
//   RAYTREE_UPDATE_REFERENCES=1 build/release/bin/renderer_tests --gtest_filter='ReferenceImage.*'
// writes them anew; look at what changed before committing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "renderer/builtin_scenes.h"
#include "renderer/film_image.h"
#include "renderer/image_file.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

constexpr int kWidth = 64, kHeight = 48;

/// Bits are promised per binary and instruction set alone: another one rounds differently, which moves a few samples
/// over an edge. So nearly all pixels agree closely, and no number is asked of the rest.
constexpr double kTolerance = 2e-3, kShare = 0.999;

constexpr Antialiasing kFourSamples{Antialiasing::Method::grid, 2}, kAdaptive{Antialiasing::Method::whitted, 1};

void expect_reference(SceneDescription scene, const std::string& name, const Antialiasing& antialias = kFourSamples) {
  scene.image = {kWidth, kHeight};
  scene.render.antialias = antialias;
  RenderResult result = rendered(std::move(scene), {ChannelGroup::color});
  EXPECT_EQ(result.statistics.not_finite_samples, 0u);
  expect_finite(result.film);
  const std::string path = std::string(RAYTREE_SOURCE_DIR) + "/tests/reference/" + name + ".exr";
  const char* update = std::getenv("RAYTREE_UPDATE_REFERENCES");
  if (update != nullptr && std::string(update) == "1") {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_image_file(path, scene_linear_image(result.film, false, {}), ImageFormat::exr);
  }
  const DecodedImage reference = read_image_file(path);
  ASSERT_EQ(reference.width, kWidth);
  ASSERT_EQ(reference.height, kHeight);
  int agreeing = 0;
  double mean = 0, reference_mean = 0;
  std::vector<const float*> planes(3);
  for (std::size_t p = 0; p < reference.names.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      if (reference.names[p] == std::string(1, "RGB"[c])) planes[c] = reference.planes[p].data();
  for (const float* plane : planes) ASSERT_NE(plane, nullptr);
  for (std::size_t i = 0; i < std::size_t(kWidth) * kHeight; ++i) {
    bool agrees = true;
    for (int c = 0; c < 3; ++c) {
      const float ours = result.film.plane(ChannelGroup::color, c)[i], theirs = planes[static_cast<std::size_t>(c)][i];
      agrees &= std::abs(ours - theirs) <= kTolerance;
      mean += ours, reference_mean += theirs;
    }
    agreeing += agrees;
  }
  EXPECT_GE(agreeing, kShare * kWidth * kHeight) << name;
  EXPECT_NEAR(mean / reference_mean, 1, 1e-3) << name;
}

TEST(ReferenceImage, WhittedsSpheres) { expect_reference(builtin_scene("spheres-1980"), "spheres-1980"); }

TEST(ReferenceImage, SphereFlake) {
  SceneDescription scene = builtin_scene("sphere-flake");
  for (ShapeDescription& s : scene.shapes)
    if (auto* flake = std::get_if<SphereFlakeShape>(&s.kind)) flake->levels = 3;
  expect_reference(std::move(scene), "sphere-flake");
}

TEST(ReferenceImage, Terrain) {
  SceneDescription scene = builtin_scene("terrain");
  for (ShapeDescription& s : scene.shapes)
    if (auto* terrain = std::get_if<TerrainShape>(&s.kind)) terrain->triangles = 20000;
  expect_reference(std::move(scene), "terrain");
}

// Whitted's adaptive samples, at default settings.

TEST(ReferenceImage, WhittedsSpheresSampledAdaptively) {
  expect_reference(builtin_scene("spheres-1980"), "spheres-1980-adaptive", kAdaptive);
}

TEST(ReferenceImage, GlassSampledAdaptively) { expect_reference(builtin_scene("glass"), "glass", kAdaptive); }

TEST(ReferenceImage, RoughSurfacesSampledAdaptively) { expect_reference(builtin_scene("rough"), "rough", kAdaptive); }

TEST(ReferenceImage, ForestSampledAdaptively) { expect_reference(builtin_scene("forest"), "forest", kAdaptive); }

}  // namespace
}  // namespace raytree
