// What is cut is bounded: on random scenes, per sample and channel, 0 <= uncut - cut <= truncation channel <= cutoff.
// And the table that the promise rests on.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/renderer/cut_pictures.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

class RandomScenes {
 public:
  explicit RandomScenes(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  Rgb color(double most) {
    const auto channel = [&] { return static_cast<float>(uniform(0, most)); };
    return {channel(), channel(), channel()};
  }
  Vec3d point(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }

  SceneDescription next() {
    CameraDescription camera;
    camera.position = {uniform(-1, 1), uniform(-1, 1), 8};
    camera.field_of_view = 45;
    SceneDescription scene = dark_scene(12, camera);
    scene.render.depth = integer(1, 8);
    scene.render.cutoff = std::exp(uniform(std::log(1e-4), std::log(0.5)));
    scene.render.fresnel = chance(0.3);
    scene.render.rough_samples = integer(1, 6);
    scene.render.highlights = chance(0.5) ? HighlightForm::reflected : HighlightForm::halfway;
    scene.render.shadowed_highlights = chance(0.5);
    if (chance(0.3)) scene.render.distance_attenuation = uniform(0, 0.3);
    scene.ambient = color(0.4);
    if (chance(0.5))
      scene.background = GradientBackground{color(1.5), color(1.5), color(1.5)};
    else
      scene.background = ConstantBackground{color(1)};

    scene.render.transparent_shadows = chance(0.7);
    const bool layered = chance(0.4);  // media are told apart
    const int materials = integer(2, 5);
    for (int i = 0; i < materials; ++i) {
      MaterialDescription m = material("m" + std::to_string(i), color(1));
      if (chance(0.3)) {
        CheckerPattern checker;
        checker.even = color(1), checker.odd = color(1);
        checker.size = uniform(0.2, 2);
        checker.plane = static_cast<CheckerPattern::Plane>(integer(0, 2));
        m.diffuse = checker;
      }
      if (chance(0.15)) {
        StripesPattern stripes;
        stripes.even = color(1), stripes.odd = color(1);
        stripes.size = uniform(0.05, 2), stripes.direction = point(1) + Vec3d(2, 0, 0), stripes.smooth = chance(0.5);
        m.diffuse = stripes;
      }
      if (chance(0.2)) {
        NoisePattern noise;
        noise.low = color(1), noise.high = color(1);
        noise.size = uniform(0.05, 2), noise.octaves = integer(1, 5), noise.contrast = uniform(0, 6);
        if (chance(0.5))
          m.diffuse = noise;
        else
          m.ambient = noise;
      }
      if (chance(0.4)) {
        BumpDescription bump;
        bump.kind = static_cast<BumpDescription::Kind>(integer(0, 3));
        bump.size = uniform(0.1, 2), bump.amplitude = bump.size * uniform(-1, 1), bump.octaves = integer(1, 3);
        bump.offset = point(3), bump.direction = point(1) + Vec3d(0, 2, 0);
        m.bump = bump;
      }
      if (!m.ambient && chance(0.3)) m.ambient = color(1);
      if (chance(0.6)) m.highlight = {color(0.8), uniform(1, 80)};
      if (chance(0.8)) m.reflection = color(chance(0.2) ? 1.2 : 0.6);
      if (chance(0.6)) m.transmission = color(chance(0.2) ? 1.2 : 0.6);
      m.index_of_refraction = uniform(0.7, 2.2);
      if (chance(0.3)) m.fresnel = chance(0.7);
      if (chance(0.3)) m.absorption = color(1);
      if (chance(0.15)) m.thin = true, m.absorption = Rgb(0);
      if (chance(0.15)) m.conductor = true, m.transmission = Rgb(0);
      if (chance(0.3)) m.roughness = uniform(0.01, 1);
      if (layered) m.priority = integer(-1, 2);
      if (chance(0.2))
        m.highlight = {Rgb(0), uniform(1, 80), {{uniform(0, 40), color(0.8)}, {uniform(50, 90), color(0.8)}}};
      scene.materials.push_back(m);
    }
    const auto any_material = [&] { return "m" + std::to_string(integer(0, materials - 1)); };
    const int shapes = integer(2, 9);
    for (int i = 0; i < shapes; ++i) {
      const int kind = integer(0, 3);
      if (kind == 0) scene.shapes.push_back(shape(SphereShape{point(3), uniform(0.3, 2)}, any_material()));
      if (kind == 1)
        scene.shapes.push_back(shape(DiscShape{point(3), point(1) + Vec3d(0, 0, 2), uniform(0.5, 3)}, any_material()));
      if (kind == 2)
        scene.shapes.push_back(shape(PlaneShape{point(3) - Vec3d(0, 0, 3), point(1) + Vec3d(0, 2, 0)}, any_material()));
      if (kind == 3) {
        std::vector<Vec3f> corners;
        for (int c = 0; c < 12; ++c) corners.emplace_back(point(3));
        scene.shapes.push_back(
            mesh_shape(triangles(corners, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), any_material(), NormalSource::flat));
      }
    }
    // Half of the scenes show some of their shapes through instances, in their own materials or another.
    if (chance(0.5)) {
      GroupDescription group{"group", {}, {}};
      while (scene.shapes.size() > 1) {
        if (!std::holds_alternative<PlaneShape>(scene.shapes.back().kind)) group.shapes.push_back(scene.shapes.back());
        scene.shapes.pop_back();
      }
      scene.groups.push_back(std::move(group));
      const int uses = integer(1, 4);
      for (int i = 0; i < uses; ++i) {
        ShapeDescription use = shape(InstanceShape{"group"}, chance(0.3) ? any_material() : "");
        Matrix44d turned;
        turned.rotate(point(3));
        use.transform = scaling(Vec3d(uniform(0.4, 1.2) * (chance(0.3) ? -1 : 1))) * turned * translation(point(2));
        scene.shapes.push_back(std::move(use));
      }
    }
    const int lights = integer(0, 3);
    const auto falloff = [&] { return static_cast<Falloff>(integer(0, 2)); };
    for (int i = 0; i < lights; ++i) {
      const int kind = integer(0, 2);
      if (kind == 0) scene.lights.push_back(directional_light(point(1) + Vec3d(0, -1.5, 0), color(1.5)));
      if (kind == 1) scene.lights.push_back(light_of(PointLight{point(6), falloff(), uniform(0.3, 4)}, color(1.5)));
      if (kind == 2) {
        const double angle = uniform(5, 120);
        const Vec3d position = point(6);
        scene.lights.push_back(
            light_of(SpotLight{position, point(1) - position, angle, uniform(0, angle), falloff(), uniform(0.3, 4)},
                     color(1.5)));
      }
    }
    return scene;
  }

 private:
  std::mt19937_64 random_;
};

/// Meshes are consumed by prepare(): a scene that is rendered twice is copied with meshes of its own.
SceneDescription deep_copy(const SceneDescription& scene) {
  SceneDescription copy = scene;
  const auto copy_meshes = [](std::vector<ShapeDescription>& shapes) {
    for (ShapeDescription& s : shapes)
      if (auto* mesh = std::get_if<MeshShape>(&s.kind)) mesh->mesh = std::make_shared<PolygonMesh>(*mesh->mesh);
  };
  copy_meshes(copy.shapes);
  for (GroupDescription& group : copy.groups) copy_meshes(group.shapes);
  return copy;
}

/// Samples in a pixel, those of its border too: one, those of a grid, or those of squares that all are divided as
/// often, whatever their corners show, so that pictures cut and uncut are made of the same samples.
int choose_samples(RenderSettings& render, int i) {
  if (i % 3 == 0) return 1;
  if (i % 3 == 1) {
    render.antialias = {Antialiasing::Method::grid, 2};
    return 4;
  }
  const int levels = 1 + i / 3 % 2, edge = (1 << levels) + 1;
  render.antialias = {Antialiasing::Method::whitted, 1};
  render.adaptive = {0, levels, levels};
  return edge * edge;
}

TEST(Cutoff, IsKeptPerSampleAndChannelOnRandomScenes) {
  RandomScenes scenes(20240607);
  std::uint64_t cut_branches = 0, cut_samples = 0, scenes_cut = 0;
  const ChannelSet channels = cut_channels();
  for (int i = 0; i < 300; ++i) {
    SceneDescription scene = scenes.next();
    const int samples = choose_samples(scene.render, i);
    const double cutoff = scene.render.cutoff;
    const RenderResult cut = rendered(deep_copy(scene), channels);
    SceneDescription whole = deep_copy(scene);
    whole.render.cutoff = 0;
    const RenderResult uncut = rendered(std::move(whole), channels);
    ASSERT_EQ(cut.statistics.samples, uncut.statistics.samples) << "scene " << i;
    cut_branches += cut.statistics.branches_cut;
    scenes_cut += cut.statistics.branches_cut > 0;
    expect_cut_within_its_bound(cut.film, uncut.film, cutoff, samples, "scene " + std::to_string(i), cut_samples);
    if (testing::Test::HasFatalFailure()) return;
  }
  // The test tests something: over a hundred scenes lose branches to the cutoff.
  EXPECT_GT(scenes_cut, 100u);
  EXPECT_GT(cut_branches, 5000u);
  EXPECT_GT(cut_samples, 3000u);
  RecordProperty("scenes_cut", static_cast<int>(scenes_cut));
  RecordProperty("branches_cut", static_cast<int>(cut_branches));
  RecordProperty("samples_cut", static_cast<int>(cut_samples));
}

TEST(Cutoff, OfZeroCutsOnlyWhatCanBringNoLight) {
  RandomScenes scenes(5);
  for (int i = 0; i < 20; ++i) {
    SceneDescription scene = scenes.next();
    scene.render.cutoff = 0;
    const RenderResult result = rendered(std::move(scene));
    for (int p = 0; p < 3; ++p)
      for (int k = 0; k < 144; ++k) EXPECT_EQ(result.film.plane(ChannelGroup::truncation, p)[k], 0);
  }
}

TEST(Cutoff, OnFacingMirrorsTakesNoMoreThanTheRestOfTheSeries) {
  // I = E (1 + k + k^2 + ...): the exact remainder after level d is E k^d / (1 - k), of which the tree may lose
  // epsilon.
  const float k = 0.8f, e = 0.5f;
  SceneDescription scene = dark_scene(2, front_camera(1, 0.5));
  scene.ambient = Rgb(1);
  scene.materials = {material("m", Rgb(e))};
  scene.materials[0].reflection = Rgb(k);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m"), shape(PlaneShape{{0, 0, 1}, {0, 0, -1}}, "m")};
  scene.render.depth = 200;
  for (const double epsilon : {1e-1, 1e-2, 1e-3, 1e-4}) {
    scene.render.cutoff = epsilon;
    const RenderResult result = rendered(scene);
    const double lost = e / (1 - double(k)) - color_at(result.film, 0, 0).r;
    EXPECT_GE(lost, -1e-5);
    EXPECT_LE(lost, epsilon + 1e-5);
    // The bound is tight here, so the tree is cut at the first level whose remainder fits: no ray is wasted.
    const int levels = static_cast<int>(std::ceil(std::log(epsilon * (1 - double(k)) / e) / std::log(double(k))));
    EXPECT_NEAR(result.statistics.deepest_level, levels, 1) << epsilon;
  }
}

TEST(RadianceBound, FollowsItsRecurrence) {
  Material dull, mirror;
  dull.diffuse.even = dull.diffuse.odd = Rgb(0.5f, 0.25f, 0);
  dull.ambient = dull.diffuse;
  dull.highlight = Rgb(0.25f);
  mirror.reflection = Rgb(0.5f, 1, 0);
  mirror.transmission = Rgb(0.25f, 0.5f, 0);
  const std::vector<Material> materials{dull, mirror};
  Light light;
  light.color = Rgb(2, 1, 1);
  const std::vector<Light> lights{light, light};
  const BackgroundLight background(ConstantBackground{Rgb(0.125f, 0.125f, 0.125f)});
  const RadianceBound bound(materials, lights, background, Rgb(1), 4);
  EXPECT_EQ(bound(-1), Rgb(0));
  EXPECT_EQ(bound(-7), Rgb(0));
  // E = 1 x .5 + 4 x (.5 + .25) = 3.5; .25 + 2 x (.25 + .25) = 1.25... per channel; rho = .75, 1.5, 0.
  const Rgb e(0.5f + 4 * 0.75f, 0.25f + 2 * 0.5f, 2 * 0.25f);
  Rgb expected = e;
  for (int k = 0; k < 4; ++k) {
    const Rgb b = bound(k);
    expect_color(b, expected, 1e-4 * (k + 1), "level " + std::to_string(k));
    EXPECT_GE(b.r, expected.r);
    expected = max(e, Rgb(0.75f, 1.5f, 0) * expected);
  }
}

TEST(RadianceBound, IsALargeNumberWhereThereIsNone) {
  Material lamp, mirror;
  lamp.diffuse.even = lamp.diffuse.odd = lamp.ambient.even = lamp.ambient.odd = Rgb(1);
  mirror.reflection = Rgb(2, 0.5f, 1);
  const RadianceBound bound(std::vector<Material>{lamp, mirror}, {}, BackgroundLight(), Rgb(1), 5000);
  for (const int level : {200, 1023, 1024, 4999}) {
    EXPECT_EQ(bound(level).r, std::numeric_limits<float>::max()) << level;
    EXPECT_NEAR(bound(level).g, 1, 1e-3);
    EXPECT_GE(bound(level).b, 1);
  }
}

TEST(RadianceBound, WithFresnelTakesTheLargerOfTheTwoCoefficients) {
  Material lamp, glass;
  lamp.ambient.even = lamp.ambient.odd = Rgb(1);
  glass.reflection = Rgb(0.75f);
  glass.transmission = Rgb(0.5f);
  glass.fresnel = true;
  const RadianceBound bound(std::vector<Material>{lamp, glass}, {}, BackgroundLight(), Rgb(1), 5);
  EXPECT_NEAR(bound(4).r, 1, 1e-3);
}

}  // namespace
}  // namespace raytree
