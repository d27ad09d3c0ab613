// Glass and metal in closed form: Beer's law along the ways inside, thin sheets, Schlick's conductors, and what is said
// of materials that cannot be or that make light.
#include <gtest/gtest.h>

#include "geometry/angle.h"
#include "renderer/material.h"
#include "renderer/optics.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

MaterialDescription clear_glass(double index) {
  MaterialDescription result = material("glass", Rgb(0));
  result.transmission = Rgb(1);
  result.index_of_refraction = index;
  return result;
}

/// A white sky, the eye at an angle to the z axis, 5 units from the origin.
SceneDescription white_scene(const MaterialDescription& glass, double angle = 0) {
  CameraDescription camera = front_camera(1e-3);
  camera.position = Vec3d(std::sin(angle), 0, std::cos(angle)) * 5.0;
  SceneDescription scene = dark_scene(2, camera);
  scene.background = ConstantBackground{Rgb(1)};
  scene.materials = {glass};
  return scene;
}

void expect_beer(Rgb seen, Rgb a, double length, double tolerance, const std::string& what) {
  const auto share = [&](float rate) { return static_cast<float>(std::exp(-rate * length)); };
  expect_color(seen, Rgb(share(a.r), share(a.g), share(a.b)), tolerance, what);
}

TEST(Absorption, OfASlabIsBeersOverTheWayInside) {
  const Rgb a(0.25f, 1, 4);
  for (const bool mesh : {false, true})
    for (const double degrees : {0.0, 30.0, 70.0}) {
      MaterialDescription glass = clear_glass(1.5);
      glass.absorption = a;
      SceneDescription scene = white_scene(glass, degrees * kDegree);
      if (mesh)
        scene.shapes = {mesh_shape(box_mesh({-50, -50, -0.75f}, {50, 50, 0}), "glass")};
      else
        scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "glass"),
                        shape(PlaneShape{{0, 0, -0.75}, {0, 0, -1}}, "glass")};
      const double t = std::asin(std::sin(degrees * kDegree) / 1.5);
      // Rays of the mesh start up to 16 x 2^-24 of 50 beside its faces.
      expect_beer(color_at(rendered(scene).film, 0, 0), a, 0.75 / std::cos(t), 8 * kFloatError + 4 * 50 * 0x1p-20,
                  std::to_string(degrees));
    }
}

TEST(Absorption, OfASphereFollowsItsChordsAndActsOnTheEyesSegmentToo) {
  const Rgb a(0.25f, 1, 4);
  MaterialDescription glass = clear_glass(1);  // straight through
  glass.absorption = a;
  SceneDescription scene = white_scene(glass);
  scene.image = {32, 32};
  scene.cameras[0].height = 2.2;
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "glass")};
  const RenderResult result = rendered(scene);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double px = (x + 0.5 - 16) * 2.2 / 32, py = (16 - y - 0.5) * 2.2 / 32, rho2 = px * px + py * py;
      if (std::abs(rho2 - 1) < 1e-3) continue;
      // The chord's derivative by rho is rho / sqrt(1 - rho^2), up to 32 here, of a camera's error of 2e-7.
      expect_beer(color_at(result.film, x, y), a, rho2 < 1 ? 2 * std::sqrt(1 - rho2) : 0, 4e-5, "chord");
    }
  // From the center of the sphere every way out is its radius long.
  scene.cameras[0] = CameraDescription();
  scene.cameras[0].position = {0, 0, 0};
  scene.cameras[0].target = {1, 2, 3};
  scene.materials[0].index_of_refraction = 1.5;
  expect_beer(color_at(rendered(scene).film, 3, 20), a, 1, 8 * kFloatError, "center");
}

TEST(Absorption, OfFresnelGlassIsTheSeriesOfItsBounces) {
  // Straight on, F = .04: reflected F, then (1 - F)^2 F e^2 (1 + F^2 e^2 + ...), e = exp(-a d) a passage.
  MaterialDescription glass = clear_glass(1.5);
  glass.reflection = Rgb(1);
  glass.fresnel = true;
  glass.absorption = Rgb(0, 1, 2);
  SceneDescription scene = white_scene(glass);
  scene.render.depth = 30;
  scene.materials.push_back(material("wall", Rgb(0)));
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "glass"),
                  shape(PlaneShape{{0, 0, -0.5}, {0, 0, -1}}, "glass"),
                  shape(PlaneShape{{0, 0, -2}, {0, 0, 1}}, "wall")};
  const double f = 0.04;
  const auto reflected = [&](double a) {
    const double e2 = std::exp(-2 * a * 0.5);
    return static_cast<float>(f + (1 - f) * (1 - f) * f * e2 / (1 - f * f * e2));
  };
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(reflected(0), reflected(1), reflected(2)), 2 * kFloatError);
}

TEST(ThinSheet, TransmitsStraightAndIsTheSameFromBothSides) {
  // Through a tilted sheet the gradient behind is seen as if nothing was there, times k_t.
  MaterialDescription sheet = clear_glass(1.5);
  sheet.thin = true;
  sheet.transmission = Rgb(1, 0.5f, 0.25f);
  for (const double side : {1.0, -1.0}) {
    CameraDescription camera;
    camera.position = {0, 0, 5};
    SceneDescription scene = dark_scene(16, camera);
    scene.background = GradientBackground{Rgb(1), Rgb(0.5f), Rgb(0)};
    scene.materials = {sheet};
    const RenderResult bare = rendered(scene);
    scene.shapes = {shape(PlaneShape{{0, 0, 0}, Vec3d(0.3, 0.8, 1) * side}, "glass")};
    const RenderResult through = rendered(scene);
    int crossed = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const bool hit = through.film.id_plane(ChannelGroup::object_id)[pixel_index(through.film, x, y)] == 1;
        crossed += hit;
        const Rgb behind = color_at(bare.film, x, y);
        EXPECT_EQ(color_at(through.film, x, y), hit ? behind * sheet.transmission : behind);
      }
    EXPECT_GT(crossed, 200);
  }
}

TEST(ThinSheet, WithFresnelReflectsWhatBothFacesDo) {
  // The closed form against the series that the tree itself sums over a slab of two faces (Fresnel, 24 levels).
  for (const double side : {1.0, -1.0})
    for (const double degrees : {0.0, 30.0, 56.3099, 80.0}) {
      MaterialDescription sheet = clear_glass(1.5);
      sheet.reflection = Rgb(1);
      sheet.fresnel = true;
      SceneDescription slab = white_scene(sheet, degrees * kDegree);
      slab.render.depth = 24;
      slab.materials.push_back(material("wall", Rgb(0)));
      slab.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "glass"),
                     shape(PlaneShape{{0, 0, -0.5}, {0, 0, -1}}, "glass"),
                     shape(PlaneShape{{0, 0, -2}, {0, 0, 1}}, "wall")};
      SceneDescription thin = slab;
      thin.materials[0].thin = true;
      thin.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, side}}, "glass"), slab.shapes[2]};
      const double f = fresnel_reflectance(std::cos(degrees * kDegree), 1.5);
      const float r = color_at(rendered(thin).film, 0, 0).r;
      EXPECT_NEAR(r, 2 * f / (1 + f), 1e-6) << degrees;
      EXPECT_NEAR(r, color_at(rendered(slab).film, 0, 0).r, 1e-5) << degrees;
      // Without the wall all of the light is there.
      thin.shapes.pop_back();
      EXPECT_NEAR(color_at(rendered(thin).film, 0, 0).r, 1, 1e-6);
    }
}

TEST(Conductor, ReflectsByChannelAsSchlickHasIt) {
  MaterialDescription metal = material("glass", Rgb(0));
  metal.conductor = true;
  metal.reflection = Rgb(0.9f, 0.5f, 0);
  for (const bool fresnel : {false, true})
    for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      SceneDescription scene = white_scene(metal, degrees * kDegree);
      scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "glass")};
      scene.render.fresnel = fresnel;  // of dielectrics
      scene.render.depth = 2;
      const double grazing = std::pow(1 - std::cos(degrees * kDegree), 5);
      const auto expected = [&](double k) { return static_cast<float>(k + (1 - k) * grazing); };
      expect_color(color_at(rendered(scene).film, 0, 0), Rgb(expected(0.9), expected(0.5), expected(0)),
                   4 * kFloatError, std::to_string(degrees));
      // A black metal still reflects at grazing angles.
      scene.materials[0].reflection = Rgb(0);
      expect_color(color_at(rendered(scene).film, 0, 0), Rgb(expected(0)), 4 * kFloatError);
    }
}

std::string refusal(const MaterialDescription& bad) {
  SceneDescription scene = white_scene(bad);
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "glass")};
  try {
    prepared(scene);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().object, "materials.glass");
    return error.what();
  }
  return "accepted";
}

TEST(Material, ThatCannotBeIsRefusedByName) {
  MaterialDescription bad = clear_glass(1.5);
  EXPECT_EQ(refusal(bad), "accepted");
  bad.conductor = true;
  EXPECT_NE(refusal(bad).find("conductor transmits nothing"), std::string::npos);
  bad = clear_glass(1.5);
  bad.thin = true;
  EXPECT_EQ(refusal(bad), "accepted");
  bad.absorption = Rgb(0, 1, 0);
  EXPECT_NE(refusal(bad).find("thin sheet has no inside"), std::string::npos);
  bad = clear_glass(1.5);
  bad.highlight.weight_by_angle = {{0, Rgb(1)}, {20, Rgb(0.5f)}, {20, Rgb(1)}};
  EXPECT_NE(refusal(bad).find("angle 20 does not lie above the one before it, 20"), std::string::npos);
}

TEST(Material, ThatReturnsMoreLightThanArrivesIsWarnedOf) {
  const auto warnings_of = [](const MaterialDescription& m) {
    SceneDescription scene = white_scene(m);
    scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "glass")};
    Warnings warnings;
    prepared(scene, &warnings);
    return warnings;
  };
  MaterialDescription m = clear_glass(1.5);
  m.transmission = Rgb(0.9f);
  m.reflection = Rgb(0.1f);
  EXPECT_TRUE(warnings_of(m).empty());
  m.reflection = Rgb(0.1f, 0.2f, 0.1f);
  ASSERT_EQ(warnings_of(m).size(), 1u);
  EXPECT_EQ(warnings_of(m)[0].where.object, "materials.glass");
  EXPECT_NE(warnings_of(m)[0].message.find("reflection + transmission exceed 1"), std::string::npos);
  m.fresnel = true;  // weights k_s F and k_t (1 - F): a mean of the two
  EXPECT_TRUE(warnings_of(m).empty());
  m.transmission = Rgb(1.5f);
  EXPECT_EQ(warnings_of(m).size(), 1u);
  m = material("glass", Rgb(0));
  m.conductor = true;
  m.reflection = Rgb(0.9f);
  EXPECT_TRUE(warnings_of(m).empty());
  m.reflection = Rgb(1.5f);
  EXPECT_EQ(warnings_of(m).size(), 1u);
}

TEST(Material, AThinSheetNeedsNotBeClosed) {
  for (const bool thin : {false, true}) {
    SceneDescription scene = white_scene(clear_glass(1.5));
    scene.materials[0].thin = thin;
    scene.shapes = {mesh_shape(triangles({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {0, 1, 2}), "glass")};
    Warnings warnings;
    prepared(std::move(scene), &warnings);
    EXPECT_EQ(warnings.size(), thin ? 0u : 1u);
  }
}

}  // namespace
}  // namespace raytree
