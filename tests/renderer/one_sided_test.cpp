// One-sided surfaces: seen from the front, not there from behind, for every kind of ray but those toward lights.
#include <gtest/gtest.h>

#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

/// Looks along -z; every material is given by the tests.
SceneDescription lit_by_ambient() {
  SceneDescription scene = dark_scene(8, front_camera(2));
  scene.ambient = Rgb(1);
  scene.materials = {material("one-sided", Rgb(1, 0, 0)), material("wall", Rgb(0, 0, 1))};
  scene.materials[0].one_sided = true;
  scene.shapes = {shape(PlaneShape{{0, 0, -5}, {0, 0, 1}}, "wall", "wall")};
  return scene;
}

Rgb middle(const RenderResult& result) { return color_at(result.film, 4, 4); }

TEST(OneSided, ShapesOfEveryKindAreSeenFromTheirFrontAlone) {
  for (const double side : {1.0, -1.0}) {
    const auto quad = triangles(
        {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}},
        side > 0 ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<std::uint32_t>{2, 1, 0, 3, 2, 0});
    for (ShapeDescription tested :
         {shape(PlaneShape{{0, 0, 0}, {0, 0, side}}, "one-sided"),
          shape(DiscShape{{0, 0, 0}, {0, 0, side}, 3}, "one-sided"), mesh_shape(quad, "one-sided")}) {
      SceneDescription scene = lit_by_ambient();
      scene.shapes.push_back(std::move(tested));
      const RenderResult result = rendered(std::move(scene));
      expect_color(middle(result), side > 0 ? Rgb(1, 0, 0) : Rgb(0, 0, 1), 0);
      EXPECT_EQ(result.film.id_plane(ChannelGroup::object_id)[0], side > 0 ? 2u : 1u);
      // The way goes on from where the back was met.
      EXPECT_NEAR(result.film.plane(ChannelGroup::depth, 0)[0], side > 0 ? 10 : 15, 1e-4);
      EXPECT_EQ(result.statistics.eye_hits, 64u);
      EXPECT_EQ(result.statistics.rays_through_backs, side > 0 ? 0u : 64u);
    }
  }
}

TEST(OneSided, ASphereAboutTheEyeIsNotSeen) {
  SceneDescription scene = lit_by_ambient();
  scene.shapes.push_back(shape(SphereShape{{0, 0, 10}, 4}, "one-sided"));
  expect_color(middle(rendered(std::move(scene))), Rgb(0, 0, 1), 0);
}

TEST(OneSided, MirrorsSeeThroughBacksAndTheLevelsOfTheTreeDoNotCountThem) {
  // A mirror faces the camera; between them, seen from behind first, three backs.
  SceneDescription scene = lit_by_ambient();
  scene.render.depth = 2;
  scene.materials.push_back(material("mirror", Rgb(0)));
  scene.materials.back().reflection = Rgb(1);
  scene.shapes = {shape(PlaneShape{{0, 0, -1}, {0, 0, 1}}, "mirror")};
  scene.background = ConstantBackground{Rgb(0, 1, 0)};
  for (const double z : {1.0, 2.0, 3.0})
    scene.shapes.push_back(shape(DiscShape{{0, 0, z}, {0, 0, -1}, 5}, "one-sided"));
  // The eye ray passes three backs; what the mirror sends back meets the first front.
  const RenderResult result = rendered(scene);
  expect_color(middle(result), Rgb(1, 0, 0), 0);
  EXPECT_EQ(result.statistics.rays_through_backs, 3 * 64u);
  EXPECT_EQ(result.statistics.deepest_level, 2);
  // With the discs turned about, the eye sees a front at once.
  for (std::size_t i = 1; i < 4; ++i) std::get<DiscShape>(scene.shapes[i].kind).normal = {0, 0, 1};
  EXPECT_EQ(rendered(scene).statistics.rays_through_backs, 0u);
}

TEST(OneSided, ShadowsAreCastToBothSides) {
  for (const double side : {1.0, -1.0}) {
    SceneDescription scene = lit_by_ambient();
    scene.ambient = Rgb(0);
    scene.lights = {directional_light({0, 0, -1})};
    // Beside the line of sight of an eye that looks from the side.
    scene.cameras[0].position = {10, 0, 5};
    scene.cameras[0].target = {0, 0, -5};
    scene.shapes.push_back(shape(DiscShape{{0, 0, 0}, {0, 0, side}, 3}, "one-sided"));
    expect_color(middle(rendered(std::move(scene))), Rgb(0), 0);
  }
}

TEST(OneSided, MediaAndRoughSurfacesGoOnAsWell) {
  for (const bool media : {true, false}) {
    SceneDescription scene = lit_by_ambient();
    MaterialDescription other = material("other", Rgb(0));
    other.transmission = Rgb(1);
    other.index_of_refraction = 1.001;
    if (media)
      other.priority = 1;
    else
      other.roughness = 1e-4;
    scene.materials.push_back(other);
    scene.shapes.push_back(shape(SphereShape{{0, 0, 4}, 1}, "other"));
    scene.shapes.push_back(shape(PlaneShape{{0, 0, 0}, {0, 0, -1}}, "one-sided"));
    expect_color(middle(rendered(std::move(scene))), Rgb(0, 0, 1), 1e-6, media ? "media" : "rough");
  }
}

TEST(OneSided, WhatTransmitsHasTwoSides) {
  MaterialDescription bad = material("bad", Rgb(0));
  bad.one_sided = true;
  bad.transmission = Rgb(0.5f);
  EXPECT_NE(material_problem(bad), "");
}

}  // namespace
}  // namespace raytree
