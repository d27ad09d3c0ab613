// Scenes of every scale from 1e-4 to 1e6, from 0 to 1e6 away from the world's origin: no acne, no leaks, contact
// shadows where they belong.
#include <gtest/gtest.h>

#include "renderer/tracer_choice.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

/// The whole table: scale by distance from the origin.
template <class Check>
void over_scales_and_offsets(Check&& check) {
  for (double scale = 1e-4; scale < 2e6; scale *= 10)
    for (const double offset : {0.0, 1.0, 1e3, 1e6}) {
      SCOPED_TRACE("scale " + std::to_string(scale) + " offset " + std::to_string(offset));
      check(scale, Vec3d(offset, -offset / 2, offset));
    }
}

/// Looks down at the floor y = 0 from the height 10: pixel (x, y)'s center lies at x = (x + .5 - size / 2) 4 / size,
/// z = (y + .5 - size / 2) 4 / size, in units of the scale about `at`.
SceneDescription from_above(int size, double scale, const Vec3d& at) {
  CameraDescription camera;
  camera.projection = CameraDescription::Projection::orthographic;
  camera.position = at + Vec3d(0, 10, 0) * scale;
  camera.target = at;
  camera.up = {0, 0, -1};
  camera.height = 4 * scale;
  return dark_scene(size, camera);
}

/// A level lattice of cells, 20 wide to every side, as height fields are: what Embree may be given as quads or grids.
std::shared_ptr<PolygonMesh> level_lattice() {
  auto mesh = grid_mesh(64, 0.625, [](int, int) { return 0.0; });
  for (Vec3f& p : mesh->positions) p = Vec3f(p.x, p.z, -p.y);
  return mesh;
}

/// A sphere and a box stand on a floor and on nothing but it: every pixel of floor is in the light or in their shadow,
/// and they themselves are lit by N.L. The floors: 0 a plane, 1 a disc, 2 two
/// triangles, 3 a lattice.
void expect_light_and_shadow(const std::vector<int>& floors, const std::string& hierarchy = "") {
  const int size = 24;
  const Vec3d to_sun = unit(Vec3d(0.6, 1, 0.3));
  over_scales_and_offsets([&](double scale, const Vec3d& at) {
    for (const int floor : floors) {
      SceneDescription scene = from_above(size, scale, at);
      scene.materials = {material("floor", Rgb(1)), material("object", Rgb(0.5f))};
      scene.lights = {directional_light(-to_sun * 3.0)};
      const float wide = 20;
      if (floor == 0) scene.shapes.push_back(shape(PlaneShape{at, {0, 1, 0}}, "floor"));
      if (floor == 1) scene.shapes.push_back(shape(DiscShape{at, {0, 1, 0}, wide * scale}, "floor"));
      if (floor == 2) {
        scene.shapes.push_back(mesh_shape(
            triangles({{-wide, 0, -wide}, {wide, 0, -wide}, {wide, 0, wide}, {-wide, 0, wide}}, {0, 2, 1, 0, 3, 2}),
            "floor"));
        scene.shapes.back().transform = scaling(Vec3d(scale)) * translation(at);
      }
      if (floor == 3) {
        scene.shapes.push_back(mesh_shape(level_lattice(), "floor"));
        scene.shapes.back().transform = scaling(Vec3d(scale)) * translation(at);
      }
      // A sphere and a box that stand on the floor; no pixel center falls on an edge.
      scene.shapes.push_back(shape(SphereShape{at + Vec3d(-1, 0.5, 0) * scale, 0.5 * scale}, "object"));
      scene.shapes.push_back(mesh_shape(box_mesh({0.5f, 0, -0.3f}, {1, 0.5f, 0.3f}), "object"));
      scene.shapes.back().transform = scaling(Vec3d(scale)) * translation(at);
      PrepareOptions preparing;
      preparing.hierarchy = hierarchy;
      RenderOptions options;
      options.channels = all_channels();
      const RenderResult result = render(prepared(std::move(scene), nullptr, preparing), options);
      int lit = 0, shadowed = 0, acne = 0, unshadowed = 0;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const std::size_t i = pixel_index(result.film, x, y);
          if (result.film.id_plane(ChannelGroup::object_id)[i] != 1) continue;
          const Vec3d p((x + 0.5 - size / 2.0) * 4 / size, 0, (y + 0.5 - size / 2.0) * 4 / size);
          // Whether the ray to the sun meets the sphere or the box, in double; near an outline either will do.
          const Vec3d c(-1, 0.5, 0);
          const double along = (c - p).dot(to_sun), away = ((c - p) - to_sun * along).length();
          double enter = 0, leave = 1e9;
          const Vec3d low(0.5, 0, -0.3), high(1, 0.5, 0.3);
          for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - p[axis]) / to_sun[axis], b = (high[axis] - p[axis]) / to_sun[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
          }
          if (std::abs(away - 0.5) < 1e-3 || std::abs(leave - enter) < 1e-3) continue;
          const bool dark = (along > 0 && away < 0.5) || leave > enter;
          const float value = color_at(result.film, x, y).r;
          ++(dark ? shadowed : lit);
          if (dark)
            unshadowed += value != 0;
          else
            acne += std::abs(value - to_sun.y) > 1e-5;
        }
      EXPECT_EQ(acne, 0) << "floor " << floor;
      EXPECT_EQ(unshadowed, 0) << "floor " << floor;
      EXPECT_GT(lit, 200) << "floor " << floor;
      EXPECT_GT(shadowed, 15) << "floor " << floor;
      // The sphere and the box themselves: lit where they face the sun, by N.L and nothing less.
      int own_acne = 0, faces = 0;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const std::size_t i = pixel_index(result.film, x, y);
          if (result.film.id_plane(ChannelGroup::object_id)[i] < 2) continue;
          Vec3d n;
          for (int axis = 0; axis < 3; ++axis) n[axis] = result.film.plane(ChannelGroup::normal, axis)[i];
          const double cosine = n.dot(to_sun);
          ++faces;
          own_acne +=
              std::abs(color_at(result.film, x, y).r - 0.5 * std::max(0.0, cosine)) > 1e-5 && std::abs(cosine) > 1e-3;
        }
      EXPECT_EQ(own_acne, 0) << "floor " << floor;
      EXPECT_GT(faces, 20);
    }
  });
}

TEST(Scale, FloorsAndObjectsShowNoAcneAndKeepTheirShadows) { expect_light_and_shadow({0, 1, 2}); }

TEST(Scale, EveryHierarchyOfALatticeShowsNoAcneAndKeepsItsShadows) {
  for (const HierarchyCost& cost : hierarchy_costs()) {
    SCOPED_TRACE(cost.name);
    expect_light_and_shadow({3}, cost.name);
  }
}

TEST(Scale, InstancesStandInTheirShadowsOpaqueAndOfGlass) {
  // A box and a sphere that stand on the floor, both of one group used once; light passes two faces of each. Whether
  // the ray to the sun meets them is known in double.
  const int size = 24;
  const Vec3d to_sun = unit(Vec3d(0.6, 1, 0.3)), ball(-1, 0.5, 0), low(0.5, 0, -0.3), high(1, 0.5, 0.3);
  over_scales_and_offsets([&](double scale, const Vec3d& at) {
    for (const float transmission : {0.0f, 0.5f}) {
      SceneDescription scene = from_above(size, scale, at);
      scene.materials = {material("floor", Rgb(1)), material("object", Rgb(0))};
      scene.materials[1].transmission = Rgb(transmission);
      scene.lights = {directional_light(-to_sun * 3.0)};
      scene.groups.push_back(
          {"pair",
           {shape(SphereShape{ball, 0.5}, "object"), mesh_shape(box_mesh(Vec3f(low), Vec3f(high)), "object")},
           {}});
      scene.shapes = {shape(PlaneShape{at, {0, 1, 0}}, "floor"), shape(InstanceShape{"pair"}, "")};
      scene.shapes[1].transform = scaling(Vec3d(scale)) * translation(at);
      const RenderResult result = rendered(std::move(scene));
      int lit = 0, shadowed = 0, wrong = 0;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          if (result.film.id_plane(ChannelGroup::object_id)[pixel_index(result.film, x, y)] != 1) continue;
          const Vec3d p((x + 0.5 - size / 2.0) * 4 / size, 0, (y + 0.5 - size / 2.0) * 4 / size);
          const double along = (ball - p).dot(to_sun), away = ((ball - p) - to_sun * along).length();
          double enter = 0, leave = 1e9;
          for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - p[axis]) / to_sun[axis], b = (high[axis] - p[axis]) / to_sun[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
          }
          if (std::abs(away - 0.5) < 1e-3 || std::abs(leave - enter) < 1e-3) continue;
          const int crossed = 2 * (along > 0 && away < 0.5) + 2 * (leave > enter);
          ++(crossed > 0 ? shadowed : lit);
          wrong += std::abs(color_at(result.film, x, y).r - to_sun.y * std::pow(double(transmission), crossed)) > 1e-5;
        }
      EXPECT_EQ(wrong, 0) << "transmission " << transmission;
      EXPECT_GT(lit, 200);
      EXPECT_GT(shadowed, 15);
    }
  });
}

TEST(Scale, PlanesAloneLookTheSameFarFromTheOrigin) {
  // A checkered floor and a mirror wall, which have no bounds that could say where the scene is: the checker's edges,
  // the wall's foot and the mirrored floor must stay in their pixels.
  const auto picture = [](double scale, const Vec3d& at) {
    CameraDescription camera;
    camera.position = at + Vec3d(0.3, 1.5, 4) * scale;
    camera.target = at + Vec3d(0, 0.2, 0) * scale;
    SceneDescription scene = dark_scene(48, camera);
    CheckerPattern checker;
    checker.size = 0.37 * scale;
    scene.materials = {material("floor", checker), material("wall", Rgb(0))};
    scene.materials[1].reflection = Rgb(0.7f);
    scene.lights = {point_light(at + Vec3d(1, 3, 2) * scale)};
    scene.shapes = {shape(PlaneShape{at, {0, 1, 0}}, "floor"),
                    shape(PlaneShape{at + Vec3d(0, 0, -2) * scale, {0.2, 0, 1}}, "wall")};
    return rendered(std::move(scene));
  };
  for (double scale = 1e-3; scale < 2e3; scale *= 10) {
    // The checker is anchored at the world's origin: whole periods away it is the same.
    const double period = 2 * 0.37 * scale;
    const RenderResult reference = picture(scale, {0, 0, 0});
    for (const double periods : {1e3, 1e6}) {
      const RenderResult result = picture(scale, Vec3d(periods, 0, -periods) * period);
      int differing = 0, lit = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
          lit += color_at(reference.film, x, y).r > 0.05f;
          differing += std::abs(color_at(result.film, x, y).r - color_at(reference.film, x, y).r) > 1e-3;
        }
      EXPECT_GT(lit, 500) << scale;
      // Single samples within float's rounding of an edge of the checker may fall on its other side.
      EXPECT_LE(differing, 2) << "scale " << scale << ", " << periods << " periods away";
    }
  }
}

TEST(Scale, ContactShadowsReachTheContact) {
  // A box on the floor, the sun at 45 degrees: the shadow's inner edge is the box's own foot.
  over_scales_and_offsets([&](double scale, const Vec3d& at) {
    SceneDescription scene = from_above(64, scale, at);
    scene.cameras[0].height = 0.02 * scale;  // three ten-thousandths of the box a pixel
    scene.cameras[0].position = at + Vec3d(0.01, 10, 0) * scale;
    scene.cameras[0].target = at + Vec3d(0.01, 0, 0) * scale;
    scene.materials = {material("m", Rgb(1))};
    scene.lights = {directional_light({1, -1, 0})};
    scene.shapes = {shape(PlaneShape{at, {0, 1, 0}}, "m"), mesh_shape(box_mesh({-1, 0, -1}, {0, 1, 1}), "m")};
    scene.shapes[1].transform = scaling(Vec3d(scale)) * translation(at);
    const RenderResult result = rendered(std::move(scene));
    int leaks = 0, floor = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (result.film.id_plane(ChannelGroup::object_id)[pixel_index(result.film, x, y)] == 1) {
          ++floor;
          leaks += color_at(result.film, x, y).r != 0;
        }
    EXPECT_EQ(leaks, 0);
    EXPECT_GT(floor, 3900);
  });
}

TEST(Scale, NoRayEscapesAClosedMesh) {
  // From inside a closed mesh of mirrors whatever is seen is the mesh, to any depth: the background, which would be
  // seen through a leak, is white.
  over_scales_and_offsets([&](double scale, const Vec3d& at) {
    for (const int kind : {0, 1}) {
      CameraDescription camera;
      camera.position = at + Vec3d(0.13, 0.07, -0.11) * scale;
      camera.target = camera.position + Vec3d(0.3, 0.2, 1) * scale;
      camera.field_of_view = 120;
      SceneDescription scene = dark_scene(32, camera);
      scene.background = ConstantBackground{Rgb(1)};
      scene.materials = {material("mirror", Rgb(0))};
      scene.materials[0].reflection = Rgb(1);
      scene.render.depth = 12;
      scene.shapes = {mesh_shape(kind == 0 ? box_mesh({-1, -1, -1}, {1, 1, 1}) : globe_mesh(1, 31, 17), "mirror",
                                 kind == 0 ? NormalSource::flat : NormalSource::smooth)};
      scene.shapes[0].transform = scaling(Vec3d(scale)) * translation(at);
      const RenderResult result = rendered(std::move(scene));
      int escaped = 0;
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) escaped += color_at(result.film, x, y).r != 0;
      EXPECT_EQ(escaped, 0) << "kind " << kind;
      EXPECT_EQ(result.statistics.rays[static_cast<int>(RayKind::reflected)], 32u * 32 * 11);
    }
  });
}

TEST(Scale, AGlassSphereLooksTheSameAtEverySize) {
  // The picture of a glass sphere over a gradient does not know its scale; at 1 and no offset it is the reference.
  const auto picture = [](double scale, const Vec3d& at) {
    CameraDescription camera;
    camera.position = at + Vec3d(0, 1, 4) * scale;
    camera.target = at;
    SceneDescription scene = dark_scene(24, camera);
    scene.background = GradientBackground{Rgb(0), Rgb(0.5f), Rgb(1)};
    scene.materials = {material("glass", Rgb(0))};
    scene.materials[0].transmission = Rgb(0.9f);
    scene.materials[0].reflection = Rgb(0.1f);
    scene.shapes = {shape(SphereShape{at, scale}, "glass")};
    return rendered(std::move(scene));
  };
  const RenderResult reference = picture(1, {0, 0, 0});
  over_scales_and_offsets([&](double scale, const Vec3d& at) {
    const RenderResult result = picture(scale, at);
    // Near the outline directions are ill-conditioned: their error, some 1e-6, is divided by cos; a world of 1e6 units
    // holds a sphere of 1e-4 to 1e-6 of its size, in double.
    const double tolerance = at.length() / scale > 1e8 ? 2e-4 : 5e-5;
    int differing = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x)
        differing += std::abs(color_at(result.film, x, y).r - color_at(reference.film, x, y).r) > tolerance;
    EXPECT_LE(differing, 2);
  });
}

}  // namespace
}  // namespace raytree
