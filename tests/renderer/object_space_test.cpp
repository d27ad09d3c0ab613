// Patterns and bumps that are carried with their shape: a shape that is moved together with eye and lights shows what
// it showed where it was, whatever moves it and whichever tracer finds it; normals are those of a surface that was
// raised before it was moved; patterns of the world stay where they are.
#include "renderer/object_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angle.h"
#include "renderer/bump.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/renderer/patch_shapes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

/// Scaled, turned, then moved.
Matrix44d carried_by(const Vec3d& factors, const Vec3d& angles, const Vec3d& offset) {
  Matrix44d turned;
  turned.rotate(angles);
  return scaling(factors) * turned * translation(offset);
}
Vec3d carried_vector(const Vec3d& v, const Matrix44d& m) {
  Vec3d result;
  m.multDirMatrix(v, result);
  return result;
}

/// All that may follow a shape: k_d, an ambient color of its own, a bump.
MaterialDescription carried_material() {
  MaterialDescription result = material("carried", Rgb(0));
  StripesPattern stripes;
  stripes.smooth = true;
  stripes.size = 0.4, stripes.direction = {1, 2, 0.5}, stripes.offset = {0.1, 0.05, 0};
  result.diffuse = stripes;
  NoisePattern noise;
  noise.size = 0.5, noise.octaves = 2;
  result.ambient = noise;
  BumpDescription bump{BumpDescription::Kind::noise, 0.06, 0.5, 2};
  bump.offset = {0.2, 0.1, 0};
  result.bump = bump;
  result.highlight = {Rgb(0.3f), 10};
  result.reflection = Rgb(0.2f);
  return result;
}

/// Shapes of every kind about the origin; made anew on each call, since prepare() consumes meshes.
std::vector<ShapeDescription> carried_shapes() {
  const auto named = [](ShapeKind kind, const char* name) { return shape(std::move(kind), "carried", name); };
  std::vector<ShapeDescription> shapes{
      mesh_shape(globe_mesh(1, 24, 12), "carried", NormalSource::smooth, "smooth mesh"),
      named(SphereShape{}, "sphere"),
      named(DiscShape{{0, 0, 0.2}, {0.3, 0.4, 1}, 1}, "disc"),
      named(ConeShape{{0, -0.9, 0.1}, {0.1, 0.9, 0}, 0.6, 0.6}, "cylinder"),
      named(ConeShape{{0, -0.9, 0}, {0.1, 0.9, 0.1}, 0.9, 0}, "cone"),
      named(SphereFlakeShape{1, {0, 0, 0}, 0.6}, "flake"),
      named(round_patches(), "patches"),
      mesh_shape(std::make_shared<PolygonMesh>(cube_cage()), "carried", NormalSource::smooth, "subdivided"),
      named(SphereShape{{0, 0, 0}, 1, 20}, "gouraud")};
  std::get<MeshShape>(shapes[7].kind).subdivision.emplace();
  shapes[8].shading = ShadingMethod::gouraud;
  return shapes;
}

/// Eye and lights about the origin, moved by `m`, which must scale all axes alike.
SceneDescription carried_scene(const Matrix44d& m) {
  CameraDescription camera;
  camera.position = Vec3d(1, 2, 5) * m;
  camera.target = Vec3d(0, 0, 0) * m;
  camera.up = carried_vector({0, 1, 0}, m);
  camera.field_of_view = 30;
  SceneDescription scene = dark_scene(48, camera);
  scene.ambient = Rgb(0.3f);
  scene.background = ConstantBackground{Rgb(0.2f, 0.3f, 0.4f)};
  scene.materials = {carried_material()};
  scene.lights = {directional_light(carried_vector({-1, -2, -1}, m)), point_light(Vec3d(3, 2, 4) * m, Rgb(0.5f))};
  scene.render.tessellation.rate = 12;
  return scene;
}

RenderResult carried_picture(SceneDescription scene, Tracer tracer) {
  PrepareOptions options;
  options.tracer = tracer;
  RenderOptions render_options;
  render_options.channels = all_channels();
  return render(prepared(std::move(scene), nullptr, options), render_options);
}

struct PictureDifference {
  int covered = 0, off = 0;
  double largest = 0;  ///< of those that are not off
};
/// Pixels that differ by more than `tolerance`; a mirrored eye sees left and right change places.
PictureDifference difference(const Film& a, const Film& b, bool mirrored, double tolerance) {
  PictureDifference result;
  const int size = a.window().width;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      result.covered += a.plane(ChannelGroup::alpha, 0)[pixel_index(a, x, y)] > 0;
      const Rgb off = color_at(a, x, y) - color_at(b, mirrored ? size - 1 - x : x, y);
      const double most = std::max({std::abs(off.r), std::abs(off.g), std::abs(off.b)});
      if (most > tolerance)
        ++result.off;
      else
        result.largest = std::max(result.largest, most);
    }
  return result;
}

/// The same shape moved by `m`: by its own transform, as an instance, as an instance of an instance whose first two
/// transforms the third undoes.
enum class Carrier { transform, instance, nested, overridden };
SceneDescription carried(ShapeDescription shape, const Matrix44d& m, Carrier carrier) {
  SceneDescription scene = carried_scene(m);
  const auto use = [](const char* group, const Matrix44d& transform) {
    ShapeDescription result = test::shape(InstanceShape{group}, "", "use");
    result.transform = transform;
    return result;
  };
  if (carrier == Carrier::transform) {
    shape.transform = m;
    scene.shapes = {std::move(shape)};
    return scene;
  }
  const Matrix44d first = carrier == Carrier::instance ? Matrix44d() : carried_by(Vec3d(0.4), {0.3, 1, 2}, {3, 1, -2}),
                  second =
                      carrier == Carrier::instance ? Matrix44d() : carried_by({2, -0.5, 1}, {1, -0.4, 0.2}, {0, -4, 1});
  // One that takes its group's place in all, and nothing else, keeps the material's.
  if (carrier == Carrier::overridden) shape.material = "";
  shape.transform = first;
  scene.groups.push_back({"inner", {std::move(shape)}, {}});
  scene.groups.push_back({"outer", {use("inner", second)}, {}});
  scene.shapes = {use("outer", (first * second).inverse() * m)};
  if (carrier == Carrier::overridden) scene.shapes[0].material = "carried";
  return scene;
}

// A position is off by a dozen units of 2^-24 of coordinates up to 12, 1e-5, in units that are at least .4 of the
// shape's own; colors change by at most 1.6 over a unit, and normals by .06 / .25^2 * 6, and so what is mirrored and
// highlit by ten times that. What differs by more than 1e-3 saw past an outline or another facet's shadow.
TEST(ObjectSpace, WhatIsMovedWithEyeAndLightsShowsWhatItShowed) {
  const struct {
    Matrix44d m;
    bool mirrored;
  } moves[] = {{carried_by(Vec3d(1), {0.4, -1.1, 2}, {0, 0, 0}), false},
               {carried_by(Vec3d(2.5), {-1, 0.3, 0.8}, {3, -2, 1}), false},
               {carried_by({-1.5, 1.5, 1.5}, {2, 1, -0.6}, {-1, 2, 0.5}), true}};
  for (const Tracer tracer : {Tracer::embree, Tracer::spheres})
    for (std::size_t kind = 0; kind < carried_shapes().size(); ++kind) {
      const std::string name = carried_shapes()[kind].name;
      const RenderResult still =
          carried_picture(carried(carried_shapes()[kind], Matrix44d(), Carrier::transform), tracer);
      for (const auto& [m, mirrored] : moves)
        for (const Carrier carrier : {Carrier::transform, Carrier::instance, Carrier::nested, Carrier::overridden}) {
          const RenderResult moved = carried_picture(carried(carried_shapes()[kind], m, carrier), tracer);
          const PictureDifference d = difference(still.film, moved.film, mirrored, 1e-3);
          EXPECT_GT(d.covered, 200) << name;
          EXPECT_LE(d.off, 2) << name << " by " << static_cast<int>(carrier) << " mirrored " << mirrored << " tracer "
                              << static_cast<int>(tracer);
        }
    }
}

TEST(ObjectSpace, PlanesCarryTheirPatternsToo) {
  for (const Vec3d& factors : {Vec3d(2), Vec3d(1.5, 1.5, -1.5)}) {
    const Matrix44d m = carried_by(factors, {0.4, -1.1, 2}, {1, 2, 3});
    const auto plane = [] { return shape(PlaneShape{{0, -0.5, 0}, {0.1, 1, 0.2}}, "carried"); };
    const RenderResult still = carried_picture(carried(plane(), Matrix44d(), Carrier::transform), Tracer::embree),
                       moved = carried_picture(carried(plane(), m, Carrier::transform), Tracer::embree);
    const PictureDifference d = difference(still.film, moved.film, factors.z < 0, 1e-3);
    EXPECT_GT(d.covered, 1000);
    EXPECT_LE(d.off, 2);
  }
}

/// The carried scene with all its patterns in one space.
SceneDescription in_space(SceneDescription scene, PatternSpace space) {
  const SolidSpace solid = space == PatternSpace::world ? SolidSpace::world : SolidSpace::object;
  MaterialDescription& material = scene.materials[0];
  std::get<StripesPattern>(material.diffuse).space = space;
  std::get<NoisePattern>(*material.ambient).space = space;
  material.bump->space = solid;
  return scene;
}

TEST(ObjectSpace, PatternsOfTheWorldStayWhereTheyAre) {
  // A ball that is described where it is, and one that is moved there: the numbers are exact in binary.
  const Matrix44d m = translation({0.5, 0.25, -0.75});
  const auto ball = [&](bool moved) {
    ShapeDescription result = shape(SphereShape{moved ? Vec3d(0) : Vec3d(0) * m, 1}, "carried");
    if (moved) result.transform = m;
    return result;
  };
  const auto traced = [&](bool moved, PatternSpace space) {
    SceneDescription scene = carried_scene(Matrix44d());
    scene.shapes = {ball(moved)};
    return carried_picture(in_space(std::move(scene), space), Tracer::embree);
  };
  const RenderResult described = traced(false, PatternSpace::object);
  EXPECT_EQ(differing_pixels(described.film, traced(false, PatternSpace::world).film), 0u);
  EXPECT_EQ(differing_pixels(described.film, traced(true, PatternSpace::world).film), 0u);
  EXPECT_GT(differing_pixels(described.film, traced(true, PatternSpace::object).film), 400u);
}

TEST(ObjectSpace, IsLookedForWhereAPatternIsMovedAlone) {
  const auto is_empty = [](SceneDescription scene) {
    const Scene made = prepared(std::move(scene));
    EXPECT_EQ(made.materials[0].follows_objects, !made.object_spaces.empty());
    return made.object_spaces.empty();
  };
  const Matrix44d m = translation({1, 0, 0});
  const auto ball = [] { return shape(SphereShape{}, "carried"); };
  EXPECT_TRUE(is_empty(carried(ball(), Matrix44d(), Carrier::transform)));
  EXPECT_TRUE(is_empty(in_space(carried(ball(), m, Carrier::transform), PatternSpace::world)));
  EXPECT_TRUE(is_empty(in_space(carried(ball(), m, Carrier::nested), PatternSpace::world)));
  SceneDescription plain = carried(ball(), m, Carrier::transform);
  plain.materials[0] = material("carried", Rgb(1));
  EXPECT_TRUE(is_empty(plain));
  SceneDescription over_texture = carried(ball(), m, Carrier::transform);
  CheckerPattern checker;
  checker.plane = CheckerPattern::Plane::uv;
  over_texture.materials[0] = material("carried", checker);
  EXPECT_TRUE(is_empty(over_texture));
  for (const Carrier carrier : {Carrier::transform, Carrier::instance, Carrier::nested, Carrier::overridden})
    EXPECT_FALSE(is_empty(carried(ball(), m, carrier)));
}

TEST(ObjectSpace, OfAMeshWithMaterialsOfItsFileIsFound) {
  // The shape names no material; its file's groups name those of the scene.
  auto mesh = triangles({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  mesh->groups = {{"all", "carried", 0, 2}};
  SceneDescription scene = carried_scene(Matrix44d());
  scene.shapes = {mesh_shape(mesh, "")};
  scene.shapes[0].transform = translation({1, 0, 0});
  const Scene made = prepared(std::move(scene));
  ASSERT_EQ(made.material_at({kFirstMeshGeometry, 0, 0, 0, 1}), 0u);
  EXPECT_FALSE(made.object_spaces.empty());
}

TEST(ObjectSpace, ATransformThatFlattensIsRefusedWhereAPatternFollowsIt) {
  const auto flattened = [](const Matrix44d& m, PatternSpace space) {
    SceneDescription scene = carried_scene(Matrix44d());
    scene.shapes = {mesh_shape(globe_mesh(1, 8, 4), "carried")};
    scene.shapes[0].transform = m;
    return in_space(std::move(scene), space);
  };
  // Along an axis, and along none: there the determinant is what rounding left of it.
  for (const Matrix44d& m : {scaling({1, 0, 1}), carried_by(Vec3d(1), {0.4, 0.8, 0.2}, {0, 0, 0}) *
                                                     carried_by({1, 0, 1}, {1, 0.3, 0.7}, {0, 0, 0})}) {
    EXPECT_NO_THROW(prepared(flattened(m, PatternSpace::world)));
    try {
      prepared(flattened(m, PatternSpace::object));
      FAIL() << "not refused";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("test.json:1"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("flattens the shape"), std::string::npos) << error.what();
    }
  }
}

TEST(ObjectSpace, KeepsItsDigitsFarFromTheWorldsOrigin) {
  const auto traced = [&](const Vec3d& at) {
    return carried(shape(SphereShape{}, "carried"), translation(at), Carrier::transform);
  };
  const RenderResult here = carried_picture(traced({0, 0, 0}), Tracer::embree),
                     there = carried_picture(traced({1048576, -2097152, 4194304}), Tracer::embree);
  const PictureDifference d = difference(here.film, there.film, false, 2e-5);
  EXPECT_GT(d.covered, 200);
  EXPECT_EQ(d.off, 0);
}

TEST(ObjectSpace, PatternsAndBumpsOfAnySizeGiveNumbers) {
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double size : {1e-300, 1e-18, 1.0, 1e18})
      for (const auto kind : {BumpDescription::Kind::noise, BumpDescription::Kind::wrinkles,
                              BumpDescription::Kind::ripples, BumpDescription::Kind::stripes})
        for (const double amplitude : {1e-18, 1.0, -1e18}) {
          const Matrix44d m = carried_by(Vec3d(scale), {0.4, -1.1, 2}, {0, 0, 0});
          SceneDescription scene = carried(shape(SphereShape{}, "carried"), m, Carrier::nested);
          scene.image = {16, 16};
          CheckerPattern checker;
          checker.size = size;
          std::get<StripesPattern>(scene.materials[0].diffuse).size = size;
          scene.materials[0].ambient = checker;
          scene.materials[0].bump = BumpDescription{kind, amplitude, size};
          const RenderResult result = rendered(std::move(scene));
          ASSERT_EQ(result.statistics.not_finite_samples, 0u) << scale << " " << size << " " << amplitude;
          expect_finite(result.film);
        }
}

// --- normals ---

/// Central differences of a moved surface p(s, t), unit.
template <class Surface>
Vec3d difference_normal(const Surface& surface, const Matrix44d& m, double step) {
  const auto at = [&](double s, double t) { return surface(s, t) * m; };
  return unit((at(step, 0) - at(-step, 0)).cross(at(0, step) - at(0, -step)));
}

const Matrix44d& stretching(int i) {
  static const Matrix44d all[] = {
      carried_by(Vec3d(1), {0.3, -0.4, 1}, {0.1, 0.2, 0}), carried_by({2, 0.7, 1.2}, {0.2, 0.3, 0.5}, {0, 0.1, 0.3}),
      carried_by({1.4, -0.8, 1}, {-0.3, 0.2, 2}, {0.1, 0, 0}),
      // Sheared: stretched, turned, stretched again.
      carried_by({1.5, 1, 0.8}, {0, 0.4, 0.9}, {0, 0, 0}) * carried_by({-0.9, 1.3, 1}, {0.2, 0, 0}, {0, 0.1, 0})};
  return all[i];
}

TEST(ObjectSpace, AWallsWavesAreThoseOfTheWallThatWasRaisedThenMoved) {
  BumpDescription waves{BumpDescription::Kind::stripes, 0.04, 0.8};
  waves.direction = {0.6, 0.8, 0}, waves.offset = {0.1, 0.3, 0};
  const Bump bump(waves, {0, 0, 0});
  for (int i = 0; i < 4; ++i) {
    const Matrix44d &m = stretching(i), inverse = m.inverse();
    SceneDescription scene = dark_scene(48, front_camera(2));
    scene.materials = {material("m", Rgb(0))};
    scene.materials[0].bump = waves;
    scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
    scene.shapes[0].transform = m;
    const RenderResult result = rendered(std::move(scene));
    int seen = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x) {
        // Where the pixel's ray meets the wall, in the wall's own space.
        const Vec3d from = Vec3d((x + 0.5 - 24) / 24, (24 - y - 0.5) / 24, 10) * inverse,
                    along = carried_vector({0, 0, -1}, inverse), place = from - along * (from.z / along.z);
        Vec3d expected = difference_normal(
            [&](double s, double t) {
              const Vec3d at(place.x + s, place.y + t, 0);
              return at + Vec3d(0, 0, bump.height(at - waves.offset, 0).value);
            },
            m, 1e-5);
        if (expected.z < 0) expected = -expected;
        const std::size_t pixel = pixel_index(result.film, x, y);
        Vec3d normal;
        for (int c = 0; c < 3; ++c) normal[c] = result.film.plane(ChannelGroup::normal, c)[pixel];
        // Of the places, 2^-22 times A k^2 = 2.5 and twice as much by the stretch; of the differences, 1e-5^2 k^2; of
        // float.
        EXPECT_LE((normal - expected).length(), 2e-6) << "transform " << i << " at " << x << ", " << y;
        ++seen;
      }
    EXPECT_EQ(seen, 48 * 48);
  }
}

TEST(ObjectSpace, ARoundSurfacesWrinklesAreThoseOfTheSurfaceThatWasRaisedThenMoved) {
  BumpDescription dents{BumpDescription::Kind::noise, 0.02, 0.4};
  const Bump bump(dents, {0, 0, 0});
  for (int i = 0; i < 4; ++i)
    for (const bool instanced : {false, true}) {
      const Matrix44d &m = stretching(i), inverse = m.inverse();
      SceneDescription scene = dark_scene(48, front_camera(3));
      scene.materials = {material("m", Rgb(0))};
      scene.materials[0].bump = dents;
      scene.shapes = {shape(round_patches(), "m")};
      scene.render.tessellation.rate = 100;
      // All of it by the shape, or some by the shape and the rest by the instance.
      const Matrix44d own = instanced ? carried_by({0.5, 1.5, -1}, {1, 0, 2}, {5, 0, 0}) : m;
      scene.shapes[0].transform = own;
      if (instanced) {
        scene.groups.push_back({"group", std::move(scene.shapes), {}});
        scene.shapes = {shape(InstanceShape{"group"}, "")};
        scene.shapes[0].transform = own.inverse() * m;
      }
      const RenderResult result = rendered(std::move(scene));
      int seen = 0, bent = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
          const std::size_t pixel = pixel_index(result.film, x, y);
          const float depth = result.film.plane(ChannelGroup::depth, 0)[pixel];
          if (std::isinf(depth)) continue;
          const Vec3d world((x + 0.5 - 24) / 16, (24 - y - 0.5) / 16, 10 - depth);
          const Vec3d q = unit(world * inverse), right = unit(q.cross(Vec3d(0.3, 0.5, 0.8))), up = q.cross(right);
          const auto raised = [&](bool by_bump) {
            Vec3d normal = difference_normal(
                [&](double s, double t) {
                  const Vec3d at = unit(q + right * s + up * t);
                  return at * (1 + (by_bump ? bump.height(at, 0).value : 0));
                },
                m, 1e-5);
            return normal.z < 0 ? -normal : normal;
          };
          const Vec3d expected = raised(true), smooth = raised(false);
          if (smooth.z < 0.3) continue;  // near the outline the bump may be laid down
          Vec3d normal;
          for (int c = 0; c < 3; ++c) normal[c] = result.film.plane(ChannelGroup::normal, c)[pixel];
          // N' is of the first order in h, which is .02: so much of the bend, which is .1 to .3, is missing; facets are
          // 1/60 wide and normals between their corners off by 1/60^2 / 8 times the stretch.
          EXPECT_LE((normal - expected).length(), 0.01)
              << "transform " << i << " instanced " << instanced << " at " << x << ", " << y;
          ++seen;
          bent += (expected - smooth).length() > 0.03;
        }
      EXPECT_GT(seen, 300);
      EXPECT_GT(bent, seen / 2);
    }
}

// --- patterns ---

TEST(ObjectSpace, EdgesLieWhereTheTransformTakesThem) {
  CheckerPattern checker;
  checker.even = Rgb(1), checker.odd = Rgb(0);
  checker.plane = CheckerPattern::Plane::xy, checker.size = 0.37, checker.offset = {0.11, -0.07};
  checker.filtered = false;
  for (int i = 0; i < 4; ++i)
    for (const SolidSpace space : {SolidSpace::object, SolidSpace::world}) {
      checker.space = space;
      const Matrix44d &m = stretching(i), inverse = m.inverse();
      SceneDescription scene = dark_scene(48, front_camera(2));
      scene.ambient = Rgb(1);
      scene.materials = {material("m", checker)};
      scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
      scene.shapes[0].transform = m;
      const RenderResult result = rendered(std::move(scene));
      int near_edges = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) {
          const Vec3d pixel((x + 0.5 - 24) / 24, (24 - y - 0.5) / 24, 10);
          const Vec3d from = pixel * inverse, along = carried_vector({0, 0, -1}, inverse);
          const Vec3d place = space == SolidSpace::object ? from - along * (from.z / along.z) : pixel;
          const double a = (place.x - 0.11) / 0.37, b = (place.y + 0.07) / 0.37;
          if (std::min(std::abs(a - std::round(a)), std::abs(b - std::round(b))) < 1e-5) {
            ++near_edges;
            continue;
          }
          const bool even = static_cast<int>(std::floor(a) + std::floor(b)) % 2 == 0;
          EXPECT_EQ(color_at(result.film, x, y).r, even ? 1 : 0) << "transform " << i;
        }
      EXPECT_LT(near_edges, 20);
    }
}

}  // namespace
}  // namespace raytree
