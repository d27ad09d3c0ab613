// Local light, measured on pixels of small pictures whose every value is known: ambient, Lambert, highlights, patterns,
// backgrounds, shadows, both kinds of light.
#include <gtest/gtest.h>

#include <functional>

#include "geometry/angle.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

TEST(Shading, AmbientAloneIsAmbientTimesItsShare) {
  SceneDescription scene = dark_scene(8, front_camera(1));
  scene.ambient = Rgb(0.5f, 0.25f, 0.125f);
  scene.materials = {material("a", Rgb(0.5f, 1, 0.25f)), material("b", Rgb(0.5f))};
  scene.materials[1].ambient = Rgb(0.75f, 0, 1);
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "a")};
  expect_color(color_at(rendered(scene).film, 3, 3), Rgb(0.25f, 0.25f, 0.03125f), 0);
  scene.shapes[0].material = "b";
  expect_color(color_at(rendered(scene).film, 3, 3), Rgb(0.375f, 0, 0.125f), 0);
}

TEST(Shading, LambertsCosineIsExactOnPlanesAndSpheres) {
  const double tilt = 0.7;
  SceneDescription scene = dark_scene(32, front_camera(2.5));
  scene.materials = {material("m", Rgb(0.8f, 0.4f, 0.2f))};
  scene.lights = {directional_light({std::sin(tilt), 0, -std::cos(tilt)}, Rgb(1, 2, 3))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  const float c = static_cast<float>(std::cos(tilt));
  expect_color(color_at(rendered(scene).film, 5, 9), Rgb(0.8f * c, 0.8f * c, 0.6f * c), 4 * kFloatError);

  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "m")};
  const RenderResult result = rendered(scene);
  const Vec3d to_light(-std::sin(tilt), 0, std::cos(tilt));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double px = (x + 0.5 - 16) * 2.5 / 32, py = (16 - y - 0.5) * 2.5 / 32, rho2 = px * px + py * py;
      if (std::abs(rho2 - 1) < 1e-4) continue;
      double expected = 0;
      if (rho2 < 1) expected = 0.8 * std::max(0.0, Vec3d(px, py, std::sqrt(1 - rho2)).dot(to_light));
      // Toward the rim the float camera's error of 2e-7 is divided by cos.
      const double tolerance = kFloatError * (2 + (rho2 < 1 ? 1 / std::sqrt(1 - rho2) : 0));
      EXPECT_NEAR(color_at(result.film, x, y).r, expected, tolerance) << x << " " << y;
    }
}

TEST(Shading, APointLightShinesFromWhereItStands) {
  SceneDescription scene = dark_scene(16, front_camera(4));
  scene.materials = {material("m", Rgb(1))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.lights = {point_light({0.5, -0.25, 1.5}, Rgb(2))};
  const RenderResult result = rendered(scene);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Vec3d p((x + 0.5 - 8) * 0.25, (8 - y - 0.5) * 0.25, 0);
      // No falloff with distance: Whitted's sum has none.
      EXPECT_NEAR(color_at(result.film, x, y).g, 2 * unit(Vec3d(0.5, -0.25, 1.5) - p).z, 4 * kFloatError);
    }
}

TEST(Shading, FalloffIsThatOfTheDistanceAndStopsAtTheLeastOne) {
  SceneDescription scene = dark_scene(16, front_camera(4));
  scene.materials = {material("m", Rgb(1))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  const Vec3d place(0.5, -0.25, 1.5);
  int held_back = 0;
  for (const double least : {1e-3, 1.75})
    for (const auto& [falloff, power] : {std::pair(Falloff::linear, 1), std::pair(Falloff::inverse_square, 2)}) {
      scene.lights = {light_of(PointLight{place, falloff, least}, Rgb(2))};
      const RenderResult result = rendered(scene);
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
          const Vec3d to_light = place - Vec3d((x + 0.5 - 8) * 0.25, (8 - y - 0.5) * 0.25, 0);
          held_back += to_light.length() < least;
          const double weakened = std::pow(std::max(to_light.length(), least), -power);
          EXPECT_NEAR(color_at(result.film, x, y).g, 2 * weakened * unit(to_light).z, 4 * kFloatError) << x << " " << y;
        }
    }
  EXPECT_GT(held_back, 50) << "some points lie nearer than the least distance";
}

TEST(Shading, ASpotShinesFullInsideItsConeNotAtAllOutsideAndSmoothlyBetween) {
  SceneDescription scene = dark_scene(64, front_camera(4));
  scene.materials = {material("m", Rgb(1))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  const Vec3d place(0.25, 0.5, 2), travels(-0.1, -0.2, -1);
  for (const double inner : {12.0, 24.0, 35.0}) {
    constexpr double kBorder = 35;
    scene.lights = {light_of(SpotLight{place, travels * 3, kBorder, inner, Falloff::none, 1})};
    const RenderResult result = rendered(scene);
    int full = 0, dark = 0, between = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const Vec3d to_light = unit(place - Vec3d((x + 0.5 - 32) / 16, (32 - y - 0.5) / 16, 0));
        const double cosine = -to_light.dot(unit(travels)), border = std::cos(kBorder * kDegree);
        // A hard border falls within a pixel's rounding to one side or the other.
        if (inner == kBorder && std::abs(cosine - border) < 1e-5) continue;
        const double t = std::clamp((cosine - border) / std::max(std::cos(inner * kDegree) - border, 1e-6), 0.0, 1.0);
        const double share = t * t * (3 - 2 * t);
        (share == 0 ? dark : share == 1 ? full : between) += 1;
        EXPECT_NEAR(color_at(result.film, x, y).r, share * to_light.z, 1e-5) << inner << ": " << x << " " << y;
      }
    EXPECT_GT(full, 100);
    EXPECT_GT(dark, 100);
    EXPECT_EQ(between > 100, inner < kBorder);
  }
  // What is behind the light is dark even where a cone of more than 90 degrees would reach it from the front.
  scene.lights = {light_of(SpotLight{place, {0, 0, 1}, 60, 60, Falloff::none, 1})};
  expect_color(color_at(rendered(scene).film, 32, 32), Rgb(0), 0);
}

TEST(Shading, LightsThatCannotShineAreRefusedByName) {
  SceneDescription scene = dark_scene(4, front_camera(4));
  const auto message = [&](auto kind) {
    scene.lights = {light_of(kind)};
    scene.lights[0].name = "lamp";
    try {
      rendered(scene);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message(SpotLight{{0, 0, 2}, {0, 0, 0}}).find("lights.lamp"), std::string::npos);
  EXPECT_NE(message(SpotLight{{0, 0, 2}, {0, 0, -1}, 20, 30}).find("inner_angle 30 is larger than angle 20"),
            std::string::npos);
  EXPECT_NE(message(PointLight{{0, 0, 2}, Falloff::linear, 0}).find("least_distance 0"), std::string::npos);
  EXPECT_EQ(message(SpotLight{{0, 0, 2}, {0, 0, -1}, 20, 20}), "accepted");
}

TEST(Shading, LightsAddUpAndASurfaceIsLitFromTheSideThatIsSeen) {
  SceneDescription scene = dark_scene(4, front_camera(1));
  scene.materials = {material("m", Rgb(0.5f))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  scene.lights = {directional_light({0, 0, -1}, Rgb(1, 0, 0)), directional_light({0, 0, -2}, Rgb(0, 1, 0)),
                  directional_light({0, 0, 1}, Rgb(0, 0, 1))};
  expect_color(color_at(rendered(scene).film, 1, 1), Rgb(0.5f, 0.5f, 0), kFloatError);
  // Two-sided: seen from behind, the light behind is the one that counts.
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, -1}}, "m")};
  expect_color(color_at(rendered(scene).film, 1, 1), Rgb(0.5f, 0.5f, 0), kFloatError);
}

/// Radius at which a profile, sampled along +x from the center in steps, falls below `level`; linear between samples.
double contour_radius(const Film& film, int size, double height, double level) {
  const int row = size / 2;
  for (int x = size / 2; x + 1 < size; ++x) {
    const double a = color_at(film, x, row).g, b = color_at(film, x + 1, row).g;
    if (a >= level && b < level) {
      const double px = (x + (a - level) / (a - b) + 0.5 - size / 2.0) * height / size;
      const double py = 0.5 * height / size;
      return std::sqrt(px * px + py * py);
    }
  }
  return -1;
}

TEST(Shading, HighlightContoursOnASphereLieWhereTheFormulasPutThem) {
  // Eye and light in one direction: R.V = 1 - 2 rho^2 and N.H = N.L = sqrt(1 - rho^2).
  const int size = 256;
  const double height = 2.2;
  SceneDescription scene = dark_scene(size, front_camera(height));
  scene.materials = {material("m", Rgb(0))};
  scene.materials[0].highlight.weight = Rgb(1);
  scene.lights = {directional_light({0, 0, -1})};
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "m")};
  for (const double n : {2.0, 5.0, 20.0, 100.0}) {
    scene.materials[0].highlight.exponent = n;
    for (const HighlightForm form : {HighlightForm::reflected, HighlightForm::halfway}) {
      scene.render.highlights = form;
      const RenderResult result = rendered(scene, {ChannelGroup::color});
      for (const double c : {0.2, 0.5, 0.8}) {
        const double rho = form == HighlightForm::reflected ? std::sqrt((1 - std::pow(c, 1 / n)) / 2)
                                                            : std::sqrt(1 - std::pow(c, 2 / n));
        // The profile's second derivative over a pixel h: |I''| <= about 4 n (n = 100: 400), linear interpolation errs
        // by I'' h^2 / 8 over a slope of at least n rho / 2; a thirtieth of a pixel covers it for all these.
        EXPECT_NEAR(contour_radius(result.film, size, height, c), rho, height / size / 30)
            << "n " << n << " c " << c << " form " << static_cast<int>(form);
      }
      // And the value at each pixel of a diagonal.
      for (int i = 0; i < size; i += 7) {
        const double px = (i + 0.5 - size / 2.0) * height / size, rho2 = 2 * px * px;
        if (rho2 > 0.98) continue;
        const double expected =
            form == HighlightForm::reflected ? std::pow(std::max(0.0, 1 - 2 * rho2), n) : std::pow(1 - rho2, n / 2);
        EXPECT_NEAR(color_at(result.film, i, i).r, expected, 2 * n * kFloatError);
      }
    }
  }
}

TEST(Shading, HighlightHasTheLightsColorTimesItsWeightAndLeavesTheDiffuseColorAlone) {
  SceneDescription scene = dark_scene(2, front_camera(1e-3));
  scene.materials = {material("m", Rgb(0.1f, 0.2f, 0.3f))};
  scene.materials[0].highlight = {Rgb(0.5f, 0.25f, 0.125f), 10};
  scene.lights = {directional_light({0, 0, -1}, Rgb(1, 2, 4))};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  expect_color(color_at(rendered(scene).film, 0, 0), Rgb(0.1f + 0.5f, 0.4f + 0.5f, 1.2f + 0.5f), 2 * kFloatError);
}

TEST(Shading, AHighlightsWeightFollowsItsTableOverTheAngleOfIncidence) {
  // The eye stands where the mirrored light goes: cos s = 1, so that the highlight is W(i) to the last digits.
  SceneDescription scene = dark_scene(2, front_camera(1e-4));
  scene.materials = {material("m", Rgb(0))};
  scene.materials[0].highlight.exponent = 2;
  scene.materials[0].highlight.weight_by_angle = {
      {10, Rgb(0.2f, 0, 1)}, {30, Rgb(0.4f, 0.5f, 1)}, {80, Rgb(1, 0.25f, 0)}};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  const auto seen_at = [&](double degrees) {
    const double i = degrees * kDegree;
    scene.cameras[0].position = Vec3d(std::sin(i), 0, std::cos(i)) * 5.0;
    scene.lights = {directional_light({std::sin(i), 0, -std::cos(i)})};
    return color_at(rendered(scene).film, 0, 0);
  };
  // acos of a cosine in float: off by an ulp of it over sin i; times the steepest slope, 1 in 20 degrees.
  const double tolerance = 4 * kFloatError + 3 * 0x1p-23 / std::sin(10 * kDegree);
  expect_color(seen_at(5), Rgb(0.2f, 0, 1), tolerance, "before the first point");
  expect_color(seen_at(20), Rgb(0.3f, 0.25f, 1), tolerance, "between");
  expect_color(seen_at(55), Rgb(0.7f, 0.375f, 0.5f), tolerance, "between");
  expect_color(seen_at(85), Rgb(1, 0.25f, 0), tolerance, "after the last point");
  // What the cutoff rests on is the largest entry of each channel.
  EXPECT_EQ(prepared(scene).materials[0].highlight, Rgb(1, 0.5f, 1));
}

TEST(Shading, HighlightsAreLeftOutWhereTheirPowerIsZeroAndNowhereElse) {
  for (const double exponent : {1.0, 2.0, 7.5, 20.0, 200.0, 400.0, 1e5, 1e18}) {
    MaterialDescription description;
    description.highlight = {Rgb(1), exponent};
    const Material shiny = make_material(description, false, Vec3d(0, 0, 0));
    EXPECT_EQ(std::pow(shiny.least_highlight, shiny.exponent), 0) << exponent;
    // The next power of a half that is not 0 is 2^-149; two roundings of an exponent of 151 lie between.
    EXPECT_GE(shiny.least_highlight, std::nextafter(static_cast<float>(std::exp2(-151.5 / exponent)), 0.0f))
        << exponent;
  }
}

TEST(Shading, CheckerLooksUpTheSquareThatAPointLiesIn) {
  SceneDescription scene = dark_scene(40, front_camera(8));  // five pixels a unit
  scene.ambient = Rgb(1);
  CheckerPattern checker;
  checker.even = Rgb(1, 0, 0);
  checker.odd = Rgb(0, 1, 0);
  checker.plane = CheckerPattern::Plane::xy;
  checker.size = 1.5;
  checker.offset = {0.35, -0.15};
  checker.filtered = false;
  scene.materials = {material("m", checker)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  const RenderResult result = rendered(scene);
  int even = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double px = (x + 0.5 - 20) * 0.2, py = (20 - y - 0.5) * 0.2;
      const int square =
          static_cast<int>(std::floor((px - 0.35) / 1.5)) + static_cast<int>(std::floor((py + 0.15) / 1.5));
      expect_color(color_at(result.film, x, y), square % 2 == 0 ? checker.even : checker.odd, 0);
      even += square % 2 == 0;
    }
  EXPECT_GT(even, 400);
  EXPECT_LT(even, 1200);
}

TEST(Shading, CheckerFollowsTheWorldWhereTheSceneIsRecentered) {
  // The sphere draws scene space's origin to itself, a million units away; the plane's squares stay where they were.
  CheckerPattern checker;
  checker.even = Rgb(1);
  checker.odd = Rgb(0);
  checker.plane = CheckerPattern::Plane::xy;
  checker.filtered = false;
  for (const double offset : {0.0, 1e6}) {
    CameraDescription camera = front_camera(4);
    camera.position = {offset, 0, 10};
    camera.target = {offset, 0, 0};
    SceneDescription scene = dark_scene(16, camera);
    scene.ambient = Rgb(1);
    scene.materials = {material("m", checker)};
    scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m"), shape(SphereShape{{offset, 0, -50}, 1}, "m")};
    const Scene ready = prepared(scene);
    EXPECT_NE(ready.shapes->origin, Vec3d(0, 0, 0));
    const RenderResult result = render(ready, {});
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const int square =
            static_cast<int>(std::floor((x + 0.5 - 8) / 4)) + static_cast<int>(std::floor((8 - y - 0.5) / 4));
        EXPECT_EQ(color_at(result.film, x, y).r, square % 2 == 0 ? 1 : 0) << x << " " << y << " " << offset;
      }
  }
}

TEST(Shading, TextureCheckerGoesByTheMeshsCoordinates) {
  auto mesh = triangles({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  mesh->texture_coordinates.assign({Vec2f(0, 0), Vec2f(4, 0), Vec2f(4, 4), Vec2f(0, 4)});
  CheckerPattern checker;
  checker.even = Rgb(1);
  checker.odd = Rgb(0);
  checker.plane = CheckerPattern::Plane::uv;
  SceneDescription scene = dark_scene(16, front_camera(2));
  scene.ambient = Rgb(1);
  scene.materials = {material("m", checker)};
  scene.shapes = {mesh_shape(mesh, "m")};
  const RenderResult result = rendered(scene);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      EXPECT_EQ(color_at(result.film, x, y).r, (x / 4 + (15 - y) / 4) % 2 == 0 ? 1 : 0) << x << " " << y;
}

TEST(Shading, BackgroundIsConstantOrBlendsByHeight) {
  CameraDescription camera;
  camera.position = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.field_of_view = 120;
  SceneDescription scene = dark_scene(32, camera);
  scene.background = ConstantBackground{Rgb(0.1f, 0.2f, 0.3f)};
  expect_color(color_at(rendered(scene).film, 3, 30), Rgb(0.1f, 0.2f, 0.3f), 0);
  const GradientBackground gradient{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)};
  scene.background = gradient;
  const RenderResult result = rendered(scene);
  const double pixel = 2 * std::tan(kPi / 3) / 32;
  for (int y = 0; y < 32; ++y) {
    const double h = unit(Vec3d((4.5 - 16) * pixel, (16 - y - 0.5) * pixel, -1)).y;
    expect_color(color_at(result.film, 4, y),
                 Rgb(static_cast<float>(std::max(0.0, -h)), static_cast<float>(1 - std::abs(h)),
                     static_cast<float>(std::max(0.0, h))),
                 kFloatError);
    EXPECT_EQ(result.film.plane(ChannelGroup::alpha, 0)[pixel_index(result.film, 4, y)], 0);
    EXPECT_TRUE(std::isinf(result.film.plane(ChannelGroup::depth, 0)[pixel_index(result.film, 4, y)]));
    EXPECT_EQ(result.film.id_plane(ChannelGroup::object_id)[pixel_index(result.film, 4, y)], 0u);
  }
}

/// A disc of radius .5 at height 1 over the plane z = 0, the sun straight above, the camera between them.
SceneDescription shadow_scene(const std::string& occluder_material) {
  CameraDescription camera = front_camera(2, 0.5);
  SceneDescription scene = dark_scene(32, camera);
  scene.materials = {material("floor", Rgb(0.5f)), material("clear", Rgb(0))};
  scene.materials[0].highlight = {Rgb(0.25f), 1};
  scene.materials[1].transmission = Rgb(1);
  scene.lights = {directional_light({0, 0, -1})};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "floor"),
                  shape(DiscShape{{0, 0, 1}, {0, 0, 1}, 0.5}, occluder_material)};
  return scene;
}

TEST(Shading, ShadowsAreOpaqueAndSharp) {
  for (const char* occluder : {"floor", "clear"}) {
    SceneDescription scene = shadow_scene(occluder);
    scene.render.transparent_shadows = false;
    const RenderResult result = rendered(scene);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const double px = (x + 0.5 - 16) / 16, py = (y + 0.5 - 16) / 16, r = std::sqrt(px * px + py * py);
        if (std::abs(r - 0.5) < 1e-5) continue;
        EXPECT_NEAR(color_at(result.film, x, y).r, r < 0.5 ? 0 : 0.75f, kFloatError) << x << " " << y;
      }
  }
}

TEST(Shading, ShadowSwitchesDecideWhatAShadowTakes) {
  SceneDescription scene = shadow_scene("floor");
  scene.render.shadowed_highlights = false;
  EXPECT_NEAR(color_at(rendered(scene).film, 16, 16).r, 0.25f, kFloatError);
  EXPECT_NEAR(color_at(rendered(scene).film, 1, 1).r, 0.75f, kFloatError);
  scene.render.shadows = false;
  EXPECT_NEAR(color_at(rendered(scene).film, 16, 16).r, 0.75f, kFloatError);
}

TEST(Shading, APointLightIsShadowedByWhatLiesBeforeItOnly) {
  SceneDescription scene = shadow_scene("floor");
  scene.materials[0].highlight.weight = Rgb(0);
  scene.lights = {point_light({0, 0, 0.9})};  // below the disc
  EXPECT_NEAR(color_at(rendered(scene).film, 16, 16).r, 0.5f * unit(Vec3d(1 / 32.0, 1 / 32.0, 0.9)).z, kFloatError);
  scene.lights = {point_light({0, 0, 1.1})};  // above it
  EXPECT_EQ(color_at(rendered(scene).film, 16, 16).r, 0);
}

TEST(Shading, ALightIsSeenOnlyWhereBothNormalsAgree) {
  // A facet whose normals lean by 60 degrees toward +x; the light comes 75 degrees from the other side, then from
  // below the facet but before the leaning normal.
  auto mesh = triangles({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  const double lean = kPi / 3;
  mesh->normals.assign(4, Vec3f(static_cast<float>(std::sin(lean)), 0, static_cast<float>(std::cos(lean))));
  SceneDescription scene = dark_scene(4, front_camera(1));
  scene.materials = {material("m", Rgb(1))};
  scene.shapes = {mesh_shape(mesh, "m", NormalSource::file)};
  const auto lit_from = [&](double degrees) {
    const double angle = degrees * kDegree;
    SceneDescription copy = scene;
    copy.shapes[0] = mesh_shape(std::make_shared<PolygonMesh>(*mesh), "m", NormalSource::file);
    copy.lights = {directional_light({-std::sin(angle), 0, -std::cos(angle)})};
    return color_at(rendered(copy).film, 1, 2).r;
  };
  EXPECT_NEAR(lit_from(0), std::cos(lean), kFloatError);
  EXPECT_NEAR(lit_from(60), 1, kFloatError);
  EXPECT_EQ(lit_from(-75), 0);  // 135 degrees from the shading normal
  EXPECT_EQ(lit_from(100), 0);  // behind the facet, 40 degrees from the shading normal
}

}  // namespace
}  // namespace raytree
