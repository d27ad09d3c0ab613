// Overlapping media by priority: three interfaces by Snell's law, whatever the overlap (catalogue of failures, 33);
// what lies in a medium of higher priority does nothing; where the eye is.
#include "renderer/media.h"

#include <gtest/gtest.h>

#include "geometry/angle.h"
#include "renderer/optics.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

/// A shape of the scene, which uses no instance.
Solid solid(const Scene& scene, ShapeId shape) { return {shape, shape, scene.shape_materials[shape]}; }
std::vector<Solid> solids(const Scene& scene, std::initializer_list<ShapeId> shapes) {
  std::vector<Solid> result;
  for (const ShapeId shape : shapes) result.push_back(solid(scene, shape));
  return result;
}

using namespace test;

MaterialDescription medium(const std::string& name, double index, int priority, Rgb absorption = Rgb(0)) {
  MaterialDescription result = material(name, Rgb(0));
  result.transmission = Rgb(1);
  result.index_of_refraction = index;
  result.priority = priority;
  result.absorption = absorption;
  return result;
}

/// Glass from z = 0 down to -1, liquid from -1 + overlap down to -3, a wall in the liquid at -2. The eye under `angle`.
SceneDescription glass_over_liquid(double angle, double overlap) {
  CameraDescription camera = front_camera(1e-3);
  camera.position = Vec3d(std::sin(angle), 0, std::cos(angle)) * 5.0;
  SceneDescription scene = dark_scene(2, camera);
  scene.materials = {medium("glass", 1.5, 2, Rgb(1, 0, 0)), medium("liquid", 1.33, 1, Rgb(0, 1, 0)),
                     material("wall", Rgb(1))};
  scene.shapes = {mesh_shape(box_mesh({-40, -40, -3}, {40, 40, static_cast<float>(overlap - 1)}), "liquid"),
                  mesh_shape(box_mesh({-40, -40, -1}, {40, 40, 0}), "glass"),
                  shape(PlaneShape{{0, 0, -2}, {0, 0, 1}}, "wall")};
  scene.ambient = Rgb(1);
  return scene;
}

TEST(Media, LiquidInGlassBendsAsThreeInterfacesHoweverFarItOverlaps) {
  for (const double overlap : {1e-3, 0.1, 0.9})
    for (const double degrees : {10.0, 40.0, 70.0}) {
      const double i = degrees * kDegree, in_glass = std::asin(std::sin(i) / 1.5),
                   in_liquid = std::asin(std::sin(i) / 1.33);
      // The ray travels toward -x. Pixels lie .25e-3 / cos i about the center.
      const double arrives = -0.25e-3 / std::cos(i) - std::tan(in_glass) - std::tan(in_liquid);
      // An edge from black to white on the wall, moved over the place in steps, tells to within `step`: the same
      // reckoning as of RayTree.ASlabShiftsARayByItsClosedForm.
      const double step = 1e-4;
      for (const int side : {-1, 1}) {
        SceneDescription scene = glass_over_liquid(i, overlap);
        CheckerPattern edge;
        edge.plane = CheckerPattern::Plane::xy;
        edge.even = Rgb(1), edge.odd = Rgb(0);
        edge.size = 100;
        edge.offset = {arrives + side * step, -50};
        scene.materials[2].diffuse = edge;
        // Three levels are enough: the eye ray, one in the glass, one in the liquid. The false surface costs none.
        scene.render.depth = 3;
        const Rgb seen = color_at(rendered(scene).film, 0, 0);
        if (side > 0) {
          expect_color(seen, Rgb(0), 0);
          continue;
        }
        // Absorption is that of the medium that is there: red on the way in the glass, green in the liquid.
        expect_color(seen,
                     Rgb(static_cast<float>(std::exp(-1 / std::cos(in_glass))),
                         static_cast<float>(std::exp(-1 / std::cos(in_liquid))), 1),
                     1e-4, std::to_string(degrees) + " overlap " + std::to_string(overlap));
      }
    }
}

TEST(Media, WithoutPrioritiesNothingIsTracked) {
  SceneDescription scene = glass_over_liquid(0.3, 0.1);
  EXPECT_TRUE(prepared(scene).tracks_media);
  scene = glass_over_liquid(0.3, 0.1);
  for (MaterialDescription& m : scene.materials) m.priority = 0;
  EXPECT_FALSE(prepared(scene).tracks_media);
}

TEST(Media, ShadowsGoByTheMediumThatIsThere) {
  // Light straight down through glass 1 thick and liquid 1 thick onto the wall; where they overlap the glass is.
  for (const double overlap : {1e-3, 0.5}) {
    SceneDescription scene = glass_over_liquid(0, overlap);
    scene.ambient = Rgb(0);
    scene.materials[0].transmission = Rgb(1, 1, 0.5f);
    scene.materials[1].transmission = Rgb(1, 1, 0.25f);
    scene.lights = {directional_light({0, 0, -1})};
    // k_t is that of the glass twice, where the light enters it and where it leaves it into the liquid; the liquid's
    // own surface lies in the glass and does nothing. The eye's way takes the same again.
    const auto e = [](double x) { return static_cast<float>(std::exp(x)); };
    expect_color(color_at(rendered(scene).film, 0, 0), Rgb(e(-2), e(-2), 0.0625f), 1e-4);
    // A light in the liquid: nothing is in its way, yet the liquid absorbs over the half unit to the wall.
    const SceneDescription fresh = glass_over_liquid(0, overlap);  // prepare() has taken the meshes
    scene.shapes = fresh.shapes;
    scene.lights = {point_light({0, 0, -1.5})};
    expect_color(color_at(rendered(scene).film, 0, 0), Rgb(e(-1), e(-1.5), 0.25f), 1e-4);
  }
}

TEST(Media, AnAirBubbleIsCarvedOutByItsPriority) {
  // A sphere of air in a block of glass, as a medium of index 1 and higher priority, is the same as a sphere that is
  // wound inside out: 1.5 inside over 1 outside either way.
  const auto picture = [](bool by_priority) {
    SceneDescription scene = dark_scene(48, front_camera(1.8));
    scene.background = GradientBackground{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)};
    scene.materials = {medium("glass", 1.5, by_priority ? 1 : 0),
                       medium("air", by_priority ? 1 : 1 / 1.5, by_priority ? 2 : 0)};
    scene.shapes = {mesh_shape(box_mesh({-1, -1, -1}, {1, 1, 1}), "glass"), shape(SphereShape{{0, 0, 0}, 0.6}, "air")};
    return rendered(std::move(scene));
  };
  const RenderResult ours = picture(true), other = picture(false);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      // Near the critical angle, sin i = 1 / 1.5, directions are ill-conditioned, and either may be totally reflected.
      const double rho = std::hypot(x + 0.5 - 24, y + 0.5 - 24) * 1.8 / 48 / 0.6;
      if (std::abs(rho - 1 / 1.5) < 0.02 || std::abs(rho - 1) < 0.01) continue;
      expect_color(color_at(ours.film, x, y), color_at(other.film, x, y), 2e-5, std::to_string(rho));
    }
}

TEST(Media, WhatLiesInItsOwnKindOrInAHigherPriorityIsNotThere) {
  const auto picture = [](bool more) {
    CameraDescription camera;
    camera.position = {1, 2, 5};
    SceneDescription scene = dark_scene(48, camera);
    scene.background = GradientBackground{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)};
    scene.materials = {medium("glass", 1.5, 1, Rgb(0.3f, 0.5f, 0.7f)), material("floor", Rgb(0.5f)),
                       medium("oil", 1.7, -1, Rgb(5))};
    scene.materials[0].reflection = Rgb(0.2f);
    scene.materials[0].transmission = Rgb(0.7f);
    scene.materials[2].diffuse = Rgb(1);
    scene.lights = {directional_light({-1, -3, -1})};
    scene.shapes = {shape(PlaneShape{{0, -1, 0}, {0, 1, 0}}, "floor"),
                    mesh_shape(box_mesh({-1, -0.5f, -0.5f}, {1, 0.5f, 0.5f}), "glass")};
    if (more) {
      scene.shapes.push_back(shape(SphereShape{{-0.4, 0, 0}, 0.45}, "glass"));
      scene.shapes.push_back(mesh_shape(box_mesh({-0.25f, -0.4f, -0.4f}, {0.9f, 0.4f, 0.4f}), "oil"));
    }
    return rendered(std::move(scene));
  };
  const RenderResult two = picture(true), one = picture(false);
  int differing = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const Rgb a = color_at(two.film, x, y), b = color_at(one.film, x, y);
      differing += max_channel(max(a - b, b - a)) > 1e-4f;
      const std::size_t p = pixel_index(two.film, x, y);
      EXPECT_EQ(two.film.id_plane(ChannelGroup::object_id)[p], one.film.id_plane(ChannelGroup::object_id)[p]);
    }
  // Passing a surface moves a ray by its clearance: a pixel or two may see an edge fall to the other side.
  EXPECT_LE(differing, 2);
}

TEST(Media, FirstHitsLieBehindWhatIsPassed) {
  // The eye in glass; a ball of lower priority between it and the wall is not seen, in no channel.
  SceneDescription scene = dark_scene(8, front_camera(1));
  scene.materials = {medium("glass", 1.5, 1), medium("oil", 1.7, 0), material("wall", Rgb(0.25f))};
  scene.ambient = Rgb(1);
  scene.shapes = {shape(SphereShape{{0, 0, 0}, 50}, "glass"), shape(SphereShape{{0, 0, 0}, 1}, "oil"),
                  shape(PlaneShape{{0, 0, -3}, {0, 0, 1}}, "wall")};
  const RenderResult result = rendered(scene);
  for (int i = 0; i < 64; ++i) {
    EXPECT_EQ(result.film.id_plane(ChannelGroup::object_id)[i], 3u);
    EXPECT_NEAR(result.film.plane(ChannelGroup::depth, 0)[i], 13, 1e-4);
    EXPECT_EQ(result.film.plane(ChannelGroup::color, 0)[i], 0.25f);
  }
}

TEST(Media, AnEyeInLiquidInGlassKnowsWhereItIs) {
  // Liquid (radius 1) in a thick bowl (radius 2), both about the origin, the eye at (0, 0, .5): two interfaces by
  // Snell's law on the way out.
  for (const bool parallel : {false, true}) {
    CameraDescription camera;
    camera.position = {0, 0, 0.5};
    camera.target = {1, 0, 0.5};
    camera.field_of_view = 40;
    if (parallel) camera.projection = CameraDescription::Projection::orthographic, camera.height = 0.5;
    SceneDescription scene = dark_scene(32, camera);
    scene.background = GradientBackground{Rgb(0), Rgb(0), Rgb(1)};
    scene.materials = {medium("glass", 1.5, 2), medium("liquid", 1.33, 1)};
    // The bowl is a ball of glass; where the liquid is, no glass is; and the hollow that it fills, of a priority
    // between theirs, does nothing.
    scene.materials[1].priority = 4;
    scene.materials.push_back(medium("hollow", 1, 3));
    scene.shapes = {shape(SphereShape{{0, 0, 0}, 2}, "glass"), shape(SphereShape{{0, 0, 0}, 1}, "liquid"),
                    shape(SphereShape{{0, 0, 0}, 0.9}, "hollow")};
    const Scene ready = prepared(scene);
    const Vec3f eye(Vec3d(0, 0, 0.5) - ready.shapes->origin);
    EXPECT_EQ(solids_around(ready, eye, {1, 0, 0}), solids(ready, {0, 1, 2}));
    const RenderResult result = render(ready, {});
    int looked_at = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const double pixel = (parallel ? 0.5 : 2 * std::tan(20 * kDegree)) / 32;
        const double up = (16 - y - 0.5) * pixel, right = (x + 0.5 - 16) * pixel;
        Vec3d o(0, 0, 0.5), d(1, 0, 0);
        if (parallel)
          o += Vec3d(0, up, right);
        else
          d = unit(Vec3d(1, up, right));
        bool out = true;
        for (const auto& [radius, eta] : {std::pair(1.0, 1.33 / 1.5), std::pair(2.0, 1.5)}) {
          const double b = o.dot(d);
          o += d * (-b + std::sqrt(b * b - o.dot(o) + radius * radius));
          const auto next = refracted_direction(d, -unit(o), eta);
          out &= next.has_value() && -next->dot(-unit(o)) > 0.1;
          if (!out) break;
          d = *next;
        }
        if (!out) continue;
        ++looked_at;
        EXPECT_NEAR(color_at(result.film, x, y).r, std::max(0.0, d.y), 2e-5) << x << " " << y << " " << parallel;
      }
    EXPECT_GT(looked_at, 500);
  }
}

TEST(Media, AnEyeOutsideLooksAlongAPlaneOfSymmetry) {
  // The line of sight meets both balls in the circle where they cross: of the two surfaces there a ray reports one, and
  // it leaves what it was not seen to enter.
  CameraDescription camera;
  camera.position = {0, 0.5, 4.6};
  camera.target = {0, -0.1, 0};
  SceneDescription scene = dark_scene(9, camera);
  scene.background = ConstantBackground{Rgb(1)};
  scene.materials = {medium("glass", 1.5, 2), medium("wine", 1.33, 1, Rgb(0.1f, 1.2f, 0.9f))};
  scene.shapes = {shape(SphereShape{{-0.5, 0, 0}, 0.85}, "glass"), shape(SphereShape{{0.5, 0, 0}, 0.85}, "wine")};
  const Scene ready = prepared(scene);
  const Vec3f eye = ready.camera.position(), forward = ready.camera.forward();
  EXPECT_FALSE(solids_around(ready, eye, forward).empty()) << "the case is none";
  EXPECT_TRUE(solids_around_eye(ready, eye, forward).empty());
  // What goes past both is as bright as what is behind.
  expect_color(color_at(render(ready, {}).film, 0, 0), Rgb(1), 0);
}

TEST(Media, HalfSpacesAreJudgedByTheirSide) {
  SceneDescription scene = dark_scene(2, front_camera(1));
  scene.materials = {medium("water", 1.33, 1, Rgb(0, 1, 2)), medium("air", 1, 5)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 1, 0}}, "water", "sea"),
                  shape(SphereShape{{0, -2, 0}, 1}, "air", "bubble")};
  scene.cameras[0].position = {0, -2, 0.5};
  scene.cameras[0].target = {0, -2.5, 0};
  scene.background = ConstantBackground{Rgb(1)};
  const Scene ready = prepared(scene);
  EXPECT_EQ(solids_around(ready, Vec3f(Vec3d(0, -2, 0.5) - ready.shapes->origin), Vec3f(0, -1, 0)),
            solids(ready, {0, 1}));
  EXPECT_EQ(solids_around(ready, Vec3f(Vec3d(0, -4, 0.5) - ready.shapes->origin), Vec3f(0, -1, 0)), solids(ready, {0}));
  EXPECT_TRUE(solids_around(ready, Vec3f(Vec3d(0, 1, 0.5) - ready.shapes->origin), Vec3f(0, -1, 0)).empty());
  // What leaves the scene through endless water arrives where nothing absorbs, and nowhere else.
  expect_color(color_at(render(ready, {}).film, 1, 1), Rgb(1, 0, 0), kFloatError);
}

TEST(Media, TablesKeepTheirSets) {
  SceneDescription scene = dark_scene(2, front_camera(1));
  scene.materials = {medium("a", 1.5, 1), medium("b", 1.3, 1), medium("c", 2, 3), material("opaque", Rgb(1))};
  for (const char* name : {"a", "b", "c", "a", "opaque"})
    scene.shapes.push_back(shape(SphereShape{{0, 0, 0}, 1}, name));
  const Scene ready = prepared(scene);
  MediaTable table(ready);
  const MediaBoundary into_a = table.boundary(kNoMedia, solid(ready, 0), false);
  EXPECT_FALSE(into_a.passes);
  EXPECT_FLOAT_EQ(into_a.relative_index, 1.5f);
  const MediaBoundary into_b = table.boundary(into_a.after, solid(ready, 1), false);
  EXPECT_FALSE(into_b.passes) << "of equal priorities the one entered last is there";
  EXPECT_FLOAT_EQ(into_b.relative_index, 1.3f / 1.5f);
  const MediaBoundary into_c = table.boundary(into_b.after, solid(ready, 2), false);
  EXPECT_FLOAT_EQ(into_c.relative_index, 2 / 1.3f);
  EXPECT_TRUE(table.boundary(into_c.after, solid(ready, 1), true).passes) << "b ends within c";
  EXPECT_TRUE(table.boundary(into_a.after, solid(ready, 3), false).passes) << "a within a";
  EXPECT_TRUE(table.boundary(into_a.after, solid(ready, 0), false).passes) << "entered twice";
  EXPECT_EQ(table.boundary(into_a.after, solid(ready, 0), false).after, into_a.after);
  const MediaBoundary out = table.boundary(into_a.after, solid(ready, 0), true);
  EXPECT_EQ(out.after, kNoMedia);
  EXPECT_FLOAT_EQ(out.relative_index, 1 / 1.5f);
  // A ray that never entered was inside all along.
  EXPECT_EQ(table.boundary(kNoMedia, solid(ready, 0), true).before, into_a.after);
  const MediaBoundary stone = table.boundary(into_a.after, solid(ready, 4), false);
  EXPECT_FALSE(stone.passes);
  EXPECT_EQ(stone.after, into_a.after);
  EXPECT_EQ(table.medium(into_c.after), &ready.materials[2]);
  EXPECT_EQ(table.medium(kNoMedia), nullptr);
}

TEST(Media, ATableThatIsFullLeavesRaysInTheSetTheyHave) {
  SceneDescription scene = dark_scene(2, front_camera(1));
  scene.materials = {medium("a", 1.5, 1)};
  for (int i = 0; i < 18; ++i) scene.shapes.push_back(shape(SphereShape{{0, 0, 0}, 1}, "a"));
  const Scene ready = prepared(scene);
  MediaTable table(ready);
  std::size_t refused = 0;
  MediaId last = kNoMedia;
  for (std::uint32_t mask = 0; mask < 1u << 17; ++mask) {
    std::vector<Solid> set;
    for (ShapeId i = 0; i < 17; ++i)
      if ((mask >> i & 1) != 0) set.push_back(solid(ready, i));
    const MediaId id = table.set_of(set);
    refused += id == kNoMedia && mask != 0;
    if (id != kNoMedia) last = id;
  }
  EXPECT_EQ(refused, (1u << 17) - (1u << 16));
  EXPECT_EQ(last, 65535);
  const MediaBoundary into = table.boundary(last, solid(ready, 17), false);
  EXPECT_EQ(into.before, last);
  EXPECT_EQ(into.after, last);
  EXPECT_TRUE(into.passes);
  table.clear();
  EXPECT_EQ(table.boundary(kNoMedia, solid(ready, 17), false).after, 1);
}

}  // namespace
}  // namespace raytree
