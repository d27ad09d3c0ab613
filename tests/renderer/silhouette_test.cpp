// Curved outlines: how far the default tolerance's lies from one of facets four times as small, by what each covers of
// the pixels; and that shades differ little.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/geometry/subdivision_cages.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

constexpr int kGrid = 8;  // samples of a pixel, each way

struct Difference {
  double mean = 0;     ///< pixels that the outline is off, over its length
  double largest = 0;  ///< of the coverage of one pixel
  double shade = 0;    ///< of the color of pixels that are covered whole, mean
};

SceneDescription silhouette_scene(ShapeKind kind) {
  SceneDescription scene;
  scene.image = {160, 120};
  CameraDescription camera;
  camera.position = {2.4, 1.8, 3.2};
  camera.target = {0, 0, 0};
  camera.field_of_view = 36;
  scene.cameras = {camera};
  scene.render.antialias.method = Antialiasing::Method::grid;
  scene.render.antialias.grid_size = kGrid;
  scene.materials = {test::material("clay", Rgb(0.8f))};
  scene.lights = {test::directional_light({-1, -1, -0.5})};
  scene.shapes = {test::shape(std::move(kind), "clay")};
  return scene;
}

SceneDescription cage_scene(PolygonMesh mesh, const SubdivisionRules& rules = {}) {
  MeshShape shape;
  shape.mesh = std::make_shared<PolygonMesh>(std::move(mesh));
  shape.subdivision = rules;
  return silhouette_scene(shape);
}

/// A ball of Bezier patches, profile as half_circle() in tests/patch_samples.h.
SceneDescription ball_scene() {
  PatchesShape shape;
  constexpr double k = 0.5522847498307936;  // a cubic's quarter circle, to 3e-4
  shape.positions = {{0, -1, 0}, {k, -1, 0}, {1, -k, 0}, {1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}};
  shape.lathe = {{0, 1, 2, 3}, {3, 4, 5, 6}};
  return silhouette_scene(shape);
}

Difference difference(const SceneDescription& scene, double tolerance) {
  const auto render_at = [&](double pixels) {
    SceneDescription copy = scene;
    copy.render.tessellation.tolerance = pixels;
    if (auto* mesh = std::get_if<MeshShape>(&copy.shapes[0].kind))
      mesh->mesh = std::make_shared<PolygonMesh>(*mesh->mesh);
    return test::rendered(std::move(copy)).film;
  };
  const Film coarse = render_at(tolerance), fine = render_at(TessellationSettings().tolerance / 16);
  Difference result;
  double moved = 0, shade = 0;
  std::size_t outline = 0, whole = 0;
  for (std::size_t i = 0; i < 160 * 120; ++i) {
    const auto both = [&](ChannelGroup group) {
      return std::pair(double(coarse.plane(group, 0)[i]), double(fine.plane(group, 0)[i]));
    };
    const auto [a, b] = both(ChannelGroup::alpha);
    moved += std::abs(a - b);
    result.largest = std::max(result.largest, std::abs(a - b));
    outline += b > 0 && b < 1;
    if (a < 1 || b < 1) continue;
    ++whole;
    const auto [shade_a, shade_b] = both(ChannelGroup::color);
    shade += std::abs(shade_a - shade_b);
  }
  EXPECT_GT(outline, 100u);
  EXPECT_GT(whole, 1500u);
  result.mean = moved / double(outline);
  result.shade = shade / double(whole);
  return result;
}

TEST(Silhouette, LiesWithinTheToleranceOfTheLimits) {
  SubdivisionRules creased;
  creased.creases = {{{4, 5, 7, 6, 4}, 2.5}};
  const std::pair<const char*, SceneDescription> scenes[] = {
      {"cube", cage_scene(test::cube_cage())},
      {"creased cube", cage_scene(test::cube_cage(), creased)},
      {"valence 7", cage_scene(test::star_cage(7))},
      {"patches", ball_scene()},
  };
  const double tolerance = TessellationSettings().tolerance;
  for (const auto& [name, scene] : scenes) {
    SCOPED_TRACE(name);
    const Difference at_default = difference(scene, tolerance), coarse = difference(scene, 16 * tolerance);
    std::printf(
        "%-12s outline off by %.3f px in the mean, coverage by %.3f at most, shade by %.4f; at 4 px %.3f, %.3f\n", name,
        at_default.mean, at_default.largest, at_default.shade, coarse.mean, coarse.largest);
    // Chords lie inside where the outline is convex: two thirds of the largest distance in the mean.
    EXPECT_LE(at_default.mean, tolerance);
    // A straight outline that is moved by d sweeps at most sqrt 2 d of a pixel; samples stand 1/8 apart, and the
    // outline of either picture lies between two of them.
    EXPECT_LE(at_default.largest, std::sqrt(2.0) * (tolerance + 1.0 / kGrid));
    // A level of 255 in the mean.
    EXPECT_LE(at_default.shade, 1.0 / 255);
    EXPECT_GT(coarse.largest, std::sqrt(2.0) * (tolerance + 1.0 / kGrid)) << "facets would be seen";
  }
}

}  // namespace
}  // namespace raytree
