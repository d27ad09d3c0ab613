// Instances: they show what the same shapes show where they stand, however they are nested, turned, stretched or
// mirrored; names that are wrong are refused with what would be right; and no instance is lost between samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/angle.h"
#include "geometry/embree_intersector.h"
#include "geometry/instance_transform.h"
#include "geometry/surface.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

Matrix44d turn(const Vec3d& angles) {
  Matrix44d m;
  m.rotate(angles);
  return m;
}

GroupDescription group(const std::string& name, std::vector<ShapeDescription> shapes) {
  return {name, std::move(shapes), {"test.json", 2, "groups." + name}};
}

ShapeDescription instance(const std::string& group_name, const Matrix44d& transform, const std::string& material = "",
                          const std::string& name = "use") {
  ShapeDescription result = shape(InstanceShape{group_name}, material, name);
  result.transform = transform;
  return result;
}

/// Shapes of every kind that a group may hold, made anew on each call since prepare() consumes meshes.
std::vector<ShapeDescription> content(bool round) {
  std::vector<ShapeDescription> shapes{mesh_shape(globe_mesh(0.8, 24, 12), "a", NormalSource::smooth, "globe"),
                                       mesh_shape(box_mesh({0.5f, -1, 0.8f}, {1.4f, 0, 1.6f}), "b")};
  shapes[0].transform = translation({0.2, 0.5, -0.5});
  TerrainShape ground;
  ground.triangles = 800, ground.size = 4, ground.height = 0.5;
  shapes.push_back(shape(ground, "b", "ground"));
  shapes.back().transform = translation({0, -1.5, 0});
  if (round) {
    shapes.push_back(shape(SphereShape{{-1.2, 0, 0}, 0.7}, "a", "ball"));
    shapes.push_back(shape(DiscShape{{0, 1.5, 1}, {0.2, -0.3, 1}, 0.9}, "b", "disc"));
    shapes.push_back(shape(SphereFlakeShape{2, {0, -0.5, 2}, 0.4}, "a", "flake"));
  }
  return shapes;
}

SceneDescription base_scene() {
  CameraDescription camera;
  camera.position = {1, 2, 9};
  camera.target = {0, 0.5, 0};
  SceneDescription scene = dark_scene(48, camera);
  scene.ambient = Rgb(0.2f);
  scene.background = GradientBackground{};
  scene.materials = {material("a", Rgb(0.7f, 0.4f, 0.2f)), material("b", Rgb(0.2f, 0.5f, 0.3f))};
  scene.materials[0].reflection = Rgb(0.3f);
  scene.lights = {directional_light({-1, -2, -1}), point_light({3, 4, 5}, Rgb(0.5f))};
  return scene;
}

/// The same shapes placed one by one, and as instances of a group.
struct Pair {
  SceneDescription placed, instanced;
};
Pair pair_of(const std::vector<Matrix44d>& transforms, bool round) {
  Pair pair{base_scene(), base_scene()};
  pair.instanced.groups.push_back(group("things", content(round)));
  for (const Matrix44d& transform : transforms) {
    for (ShapeDescription& shape : content(round)) {
      shape.transform = shape.transform * transform;
      pair.placed.shapes.push_back(std::move(shape));
    }
    pair.instanced.shapes.push_back(instance("things", transform));
  }
  return pair;
}

/// Rays all about hit the same points with the same normals and materials. What differs are the roundings of the way
/// into the group: positions by kInstanceError of the coordinates (up to 16 here) times the magnification, which is
/// below 30 for the transforms below; normals by that over the size of the smallest triangle's edges, and by where a
/// ray that grazes an edge goes.
void expect_the_same_hits(Pair pair, const std::string& what, bool stretched = false) {
  const Scene placed = prepared(std::move(pair.placed)), instanced = prepared(std::move(pair.instanced));
  ASSERT_GT(instanced.shapes->instances.size(), 0u);
  ASSERT_EQ(placed.shapes->origin, instanced.shapes->origin);
  std::mt19937_64 random(7);
  std::normal_distribution<double> gauss;
  const auto direction = [&] { return unit(Vec3d(gauss(random), gauss(random), gauss(random))); };
  RayBatch rays(1000);
  HitBatch a(1000), b(1000);
  int hits = 0, different = 0, off = 0;
  for (int round = 0; round < 20; ++round) {
    rays.size = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3d from = direction() * 12.0, to = direction() * 3.0;
      rays.push(Vec3f(from), Vec3f(unit(to - from)), std::numeric_limits<float>::infinity());
    }
    placed.intersector->intersect(rays, Coherence::incoherent, a);
    instanced.intersector->intersect(rays, Coherence::incoherent, b);
    for (std::size_t i = 0; i < 1000; ++i) {
      if (a.geometry[i] == kNoGeometry && b.geometry[i] == kNoGeometry) continue;
      ++hits;
      if ((a.geometry[i] == kNoGeometry) != (b.geometry[i] == kNoGeometry)) {
        ++different;
        continue;
      }
      ASSERT_NE(b.instance[i], kNoInstance);
      const SurfacePoint p = surface_at(*placed.shapes, rays.origin(i), rays.direction(i), a[i], true);
      const SurfacePoint q = surface_at(*instanced.shapes, rays.origin(i), rays.direction(i), b[i], true);
      const std::uint32_t material_a = placed.material_at(a[i]), material_b = instanced.material_at(b[i]);
      const double tolerance = 16 * 30 * kInstanceError;
      if (std::abs(p.distance - q.distance) > tolerance * 20 || material_a != material_b ||
          p.geometric_normal.dot(q.geometric_normal) < 0.99f) {
        ++different;
        continue;
      }
      off += (p.position - q.position).length() > tolerance;
      off += (p.geometric_normal - q.geometric_normal).length() > 2e-3f;
      // Vertex normals are interpolated before the transform here and after it there: a stretch turns and shortens them
      // apart, by up to a share of the 15 degrees between them.
      off += (p.shading_normal - q.shading_normal).length() > (stretched ? 0.15f : 2e-3f);
    }
  }
  EXPECT_GT(hits, 5000) << what;
  // Silhouettes and edges: a ray in a thousand passes within the error of one.
  EXPECT_LE(different, hits / 500) << what;
  EXPECT_LE(off, hits / 500) << what;
}

TEST(Instances, ShowWhatTheSameShapesShow) {
  expect_the_same_hits(pair_of({Matrix44d()}, true), "identity");
  expect_the_same_hits(
      pair_of({turn({0.3, 1, -2}) * translation({0.5, 0.2, -1}), scaling(Vec3d(0.5)) * translation({-3, 1, 0}),
               scaling(Vec3d(1.5)) * turn({2, 0, 1}) * translation({3, -1, -2})},
              true),
      "turned and scaled");
  expect_the_same_hits(pair_of({scaling({-1, 1, 1}), scaling({0.7, 0.7, -0.7}) * translation({3, 0, 0})}, true),
                       "mirrored");
  Matrix44d shear;
  shear.shear(Vec3d(0.6, -0.3, 0.2));
  expect_the_same_hits(pair_of({scaling({1.5, 0.4, 0.9}) * turn({0.5, 0.2, 0}), shear * translation({-3, 0, 0}),
                                scaling({-0.8, 1.7, 0.5}) * turn({1, 0, 2}) * translation({3, 0, 1})},
                               false),
                       "stretched, sheared, mirrored meshes", true);
}

TEST(Instances, MakeTheSamePicture) {
  // Shading, shadows and reflections included: pixels differ only where a silhouette or an edge passes.
  Pair pair = pair_of(
      {turn({0.3, 1, -2}) * translation({0.5, 0.2, -1}), scaling({-0.6, 0.6, 0.6}) * translation({-3, 1, 0})}, true);
  const RenderResult placed = rendered(std::move(pair.placed)), instanced = rendered(std::move(pair.instanced));
  int far = 0;
  double sum = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const Rgb a = color_at(placed.film, x, y), b = color_at(instanced.film, x, y);
      const double d = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
      far += d > 2e-3;
      sum += d;
      const auto id = instanced.film.id_plane(ChannelGroup::object_id)[pixel_index(instanced.film, x, y)];
      EXPECT_LE(id, 2u);
    }
  EXPECT_LE(far, 48 * 48 / 100);
  EXPECT_LT(sum / (48 * 48), 1e-3);
}

TEST(Instances, OfGroupsWithinGroupsAreOneLevelOfEmbree) {
  SceneDescription nested = base_scene(), flat = base_scene();
  nested.groups.push_back(group("row", {}));
  nested.groups.push_back(group("things", content(true)));
  GroupDescription& row = nested.groups[0];  // refers to a group that comes after it
  row.shapes.push_back(mesh_shape(box_mesh({-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}), "a"));
  const Matrix44d inner[] = {translation({2, 0, 0}), turn({0, 1, 0}) * translation({-2, 0, 0})};
  for (const Matrix44d& m : inner) row.shapes.push_back(instance("things", m));
  const Matrix44d outer[] = {scaling(Vec3d(0.6)) * turn({0, 0.5, 0}) * translation({0, 1.5, 0}),
                             scaling({0.5, 0.5, -0.5}) * translation({0, -1.5, 0})};
  for (const Matrix44d& o : outer) {
    nested.shapes.push_back(instance("row", o));
    for (const Matrix44d& i : inner)
      for (ShapeDescription& s : content(true)) {
        s.transform = s.transform * i * o;
        flat.shapes.push_back(std::move(s));
      }
    ShapeDescription box = mesh_shape(box_mesh({-0.2f, -0.2f, -0.2f}, {0.2f, 0.2f, 0.2f}), "a");
    box.transform = o;
    flat.shapes.push_back(std::move(box));
  }
  const Scene scene = prepared(SceneDescription(nested.groups.empty() ? SceneDescription{} : [&] {
    SceneDescription copy = nested;
    for (GroupDescription& g : copy.groups)
      for (ShapeDescription& s : g.shapes)
        if (auto* mesh = std::get_if<MeshShape>(&s.kind)) mesh->mesh = std::make_shared<PolygonMesh>(*mesh->mesh);
    return copy;
  }()));
  // Two rows of a box and two groups of things: six uses. The first use of a row has the row's id.
  ASSERT_EQ(scene.shapes->instances.size(), 6u);
  EXPECT_EQ(scene.summary.instances, 6u);
  EXPECT_EQ(scene.summary.shapes[0].instances, 3u);
  std::vector<std::uint32_t> objects;
  for (const Instance& use : scene.shapes->instances) objects.push_back(use.object);
  EXPECT_EQ(objects, (std::vector<std::uint32_t>{0, 2, 3, 1, 4, 5}));
  EXPECT_EQ(scene.summary.shapes[0].first_extra_id, 3u);
  EXPECT_EQ(scene.summary.shapes[1].first_extra_id, 5u);
  expect_the_same_hits({std::move(flat), std::move(nested)}, "nested");
}

TEST(Instances, OfMirroringTransformsKeepTheOutsideOutside) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto globe = globe_mesh(1, 32, 16);
  for (int i = 0; i < 50; ++i) {
    Matrix44d m;
    do {
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) m[r][c] = uniform(random);
    } while (std::abs(m.determinant()) < 0.05);
    SceneDescription scene = base_scene();
    scene.groups.push_back(
        group("globe", {mesh_shape(std::make_shared<PolygonMesh>(*globe), "a", NormalSource::smooth)}));
    scene.shapes.push_back(instance("globe", m));
    const Scene made = prepared(std::move(scene));
    const EmbreeIntersector embree(*made.shapes, EmbreeOptions{});
    for (int k = 0; k < 50; ++k) {
      const Vec3d d = unit(Vec3d(uniform(random), uniform(random), uniform(random)));
      // From the middle outward: every hit is from inside.
      const Hit hit = embree.intersect_one({0, 0, 0}, Vec3f(d), std::numeric_limits<float>::infinity());
      ASSERT_NE(hit.instance, kNoInstance);
      const SurfacePoint p = surface_at(*made.shapes, {0, 0, 0}, Vec3f(d), hit, false);
      EXPECT_GT(p.geometric_normal.dot(Vec3f(d)), 0);
      EXPECT_GT(p.shading_normal.dot(Vec3f(d)), 0);
      EXPECT_NEAR(p.geometric_normal.length(), 1, 1e-6);
      EXPECT_NEAR(p.shading_normal.length(), 1, 1e-6);
    }
  }
}

TEST(Instances, FarFromTheOriginLookAsAtIt) {
  const Vec3d far(1e6, -2e6, 3e6);
  const auto scene_at = [&](const Vec3d& place) {
    SceneDescription scene =
        pair_of({turn({0.3, 1, -2}), scaling(Vec3d(0.5)) * translation({-3, 1, 0})}, true).instanced;
    for (ShapeDescription& s : scene.shapes) s.transform = s.transform * translation(place);
    scene.cameras[0].position += place;
    scene.cameras[0].target += place;
    std::get<PointLight>(scene.lights[1].kind).position += place;
    return scene;
  };
  const RenderResult here = rendered(scene_at({0, 0, 0})), there = rendered(scene_at(far));
  int differing = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const Rgb a = color_at(here.film, x, y), b = color_at(there.film, x, y);
      differing += std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > 2e-3;
    }
  EXPECT_LE(differing, 48 * 48 / 100);
}

TEST(Instances, OfAGroupFarFromItsOwnOriginLoseNothing) {
  // The group's shapes stand at 1e6, the instance brings them back: their digits survive.
  SceneDescription scene = base_scene();
  ShapeDescription globe = mesh_shape(globe_mesh(1, 64, 32), "a", NormalSource::smooth);
  globe.transform = translation({1e6, 1e6, 0});
  scene.groups.push_back(group("far", {std::move(globe)}));
  scene.shapes.push_back(instance("far", translation({-1e6, -1e6, 0})));
  const Scene made = prepared(std::move(scene));
  const EmbreeIntersector embree(*made.shapes, EmbreeOptions{});
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.0628 * i + 0.01;
    const Vec3d out(std::cos(angle), std::sin(angle), 0.05);
    const Hit hit = embree.intersect_one(Vec3f(out * 5.0), Vec3f(unit(-out)), std::numeric_limits<float>::infinity());
    ASSERT_NE(hit.geometry, kNoGeometry);
    // Facets of 64 x 32 lie at most 1 - cos(pi/64) cos(pi/32) = 0.6 % inside the sphere.
    EXPECT_NEAR(hit.distance, 5 * out.length() - 1, 0.007);
  }
}

TEST(Instances, KeepTheirShapesMaterialsUnlessTheyBringOne) {
  SceneDescription scene = base_scene();
  scene.materials.push_back(material("c", Rgb(0.9f)));
  scene.groups.push_back(
      group("pair", {shape(SphereShape{{-1, 0, 0}, 0.5}, "a"), shape(SphereShape{{1, 0, 0}, 0.5}, "b")}));
  scene.shapes = {instance("pair", translation({0, 1.5, 0})), instance("pair", translation({0, -0.5, 0}), "c"),
                  shape(SphereShape{{0, 0.5, -1}, 0.4}, "")};
  const Scene made = prepared(std::move(scene));
  EXPECT_EQ(made.shape_materials, (std::vector<std::uint32_t>{kOwnMaterials, 2, 3, 0, 1}));
  EXPECT_EQ(made.summary.materials_in_use, (std::vector<std::string>{"(default)", "a", "b", "c"}));
  RenderOptions options;
  options.channels = all_channels();
  const RenderResult result = render(made, options);
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (std::size_t i = 0; i < 48 * 48; ++i)
    if (const auto id = result.film.id_plane(ChannelGroup::object_id)[i]; id != 0)
      seen.insert({id, result.film.id_plane(ChannelGroup::material_id)[i]});
  EXPECT_EQ(seen, (std::set<std::pair<std::uint32_t, std::uint32_t>>{{1, 1}, {1, 2}, {2, 3}, {3, 4}}));
}

std::string refusal(SceneDescription scene) {
  try {
    prepared(std::move(scene));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "accepted";
}

TEST(Instances, OfWhatCannotBeAreRefused) {
  SceneDescription scene = base_scene();
  scene.groups = {group("a", {instance("b", {}, "", "use b")}), group("b", {instance("c", {}, "", "use c")}),
                  group("c", {instance("a", {}, "", "use a")})};
  EXPECT_EQ(refusal(scene),
            "test.json:1: shapes.use a: a group may not hold itself: \"a\" holds \"b\" holds \"c\" holds \"a\"");
  scene.groups = {group("a", {instance("a", {})})};
  EXPECT_NE(refusal(scene).find("a group may not hold itself: \"a\" holds \"a\""), std::string::npos) << refusal(scene);

  scene.groups = {group("tree", {shape(SphereShape{}, "a")}), group("bush", {})};
  scene.shapes = {instance("tre", {})};
  EXPECT_EQ(
      refusal(scene),
      "test.json:1: shapes.use: unknown group \"tre\"; groups of this scene: tree, bush (did you mean \"tree\"?)");
  scene.groups[0].shapes.push_back(shape(PlaneShape{}, "a"));
  scene.shapes = {instance("tree", {})};
  EXPECT_NE(refusal(scene).find("a plane has no bounds"), std::string::npos) << refusal(scene);

  scene.groups = {group("ball", {shape(SphereShape{}, "a")})};
  scene.shapes = {instance("ball", scaling({1, 2, 1}))};
  EXPECT_NE(refusal(scene).find(
                "an instance of the group \"ball\", which holds spheres, discs or cones, takes a transform with "
                "one scale for all axes"),
            std::string::npos)
      << refusal(scene);
  scene.groups = {group("box", {mesh_shape(box_mesh({0, 0, 0}, {1, 1, 1}), "a")})};
  for (const auto& [transform, why] :
       {std::pair{scaling(Vec3d(1e-12)), "scales the group"}, {scaling(Vec3d(1e11)), "scales the group"}}) {
    SceneDescription one = base_scene();
    one.groups = {group("box", {mesh_shape(box_mesh({0, 0, 0}, {1, 1, 1}), "a")})};
    one.shapes = {instance("box", transform)};
    EXPECT_NE(refusal(one).find(why), std::string::npos) << refusal(one);
  }
  SceneDescription flat = base_scene();
  flat.groups = {group("box", {mesh_shape(box_mesh({0, 0, 0}, {1, 1, 1}), "a")})};
  flat.shapes = {instance("box", Matrix44d(1, 1, 1, 0, 1, 1.0001, 1, 0, 1, 1, 1.0001, 0, 0, 0, 0, 1))};
  EXPECT_NE(refusal(std::move(flat)).find("flattens the group"), std::string::npos);

  // 100^5 uses.
  SceneDescription many = base_scene();
  for (int level = 0; level < 5; ++level) {
    std::vector<ShapeDescription> uses;
    for (int i = 0; i < 100; ++i)
      uses.push_back(instance("g" + std::to_string(level + 1), translation({0, 1.0 * i, 0})));
    many.groups.push_back(group("g" + std::to_string(level), std::move(uses)));
  }
  many.groups.push_back(group("g5", {shape(SphereShape{}, "a")}));
  many.shapes = {instance("g0", {})};
  EXPECT_NE(refusal(std::move(many)).find("more than 50 million instances"), std::string::npos);

  SceneDescription deep = base_scene();
  for (int level = 0; level < 1000; ++level)
    deep.groups.push_back(group("g" + std::to_string(level), {instance("g" + std::to_string(level + 1), {})}));
  deep.groups.push_back(group("g1000", {}));
  deep.shapes = {instance("g0", {})};
  EXPECT_NE(refusal(std::move(deep)).find("more than 64 levels deep"), std::string::npos);

  SceneDescription ground = base_scene();
  ground.groups = {group("ball", {shape(SphereShape{}, "a")})};
  ground.shapes = {shape(TerrainShape{}, "a", "hills"), shape(ScatterShape{.group = "ball", .terrain = "hill"}, "")};
  EXPECT_NE(refusal(std::move(ground)).find("unknown terrain \"hill\"; terrains beside this shape: hills"),
            std::string::npos);
}

TEST(Instances, InSceneFilesAreRefusedWithFileLineAndPath) {
  const auto refused = [](const std::string& text) -> std::string {
    try {
      read_scene(text, "f.json", "");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refused("{\"raytree\": 1, \"groups\": {\n\"a\": {\"shapes\": {\n\"x\": {\"type\": \"instance\", \"group\": "
                    "\"b\"}}},\n"
                    "\"b\": {\"shapes\": {\n\"y\": {\"type\": \"instance\", \"group\": \"a\"}}}}}"),
            "f.json:5: groups.b.shapes.y: a group may not hold itself: \"a\" holds \"b\" holds \"a\"");
  EXPECT_EQ(refused("{\"raytree\": 1, \"groups\": {\"oak\": {}, \"elm\": {}},\n\"shapes\": {\n\"x\": {\"type\": "
                    "\"instance\", \"group\": \"oac\"}}}"),
            "f.json:3: shapes.x: unknown group \"oac\"; groups of this scene: oak, elm (did you mean \"oak\"?)");
  EXPECT_EQ(
      refused("{\"raytree\": 1, \"groups\": {\"oak\": {\"shapes\": {\n\"x\": {\"type\": \"sphere\", \"material\": "
              "\"m\"}}}}}"),
      "f.json:2: groups.oak.shapes.x: unknown material \"m\"; materials of this scene: none");
  EXPECT_NE(refused("{\"raytree\": 1, \"shapes\": {\n\"x\": {\"type\": \"instance\"}}}").find("missing key \"group\""),
            std::string::npos);
  SceneDescription scene = read_scene(
      "{\"raytree\": 1, \"groups\": {\"a\": {\"shapes\": {\"s\": {\"type\": \"sphere\"}}}}, \"shapes\": {\"x\": "
      "{\"type\": \"instance\", \"group\": \"a\"}}}",
      "f.json", "");
  set_scene_value(scene, "groups.a.shapes.s.radius", "3");
  EXPECT_EQ(std::get<SphereShape>(scene.groups[0].shapes[0].kind).radius, 3);
  EXPECT_THROW(set_scene_value(scene, "shapes.x.group", "b"), Error);
}

/// How little of an object's outline lies on how many pixels: 0 lost, and together as much as they cover.
void expect_no_instance_lost(GroupDescription ball, double radius, const char* what) {
  // As small_objects_test has it for shapes: an orthographic window of a pixel a unit, objects far enough apart.
  const int size = 160, spacing = 8;
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  SceneDescription scene = dark_scene(size, front_camera(size));
  scene.render.antialias.method = Antialiasing::Method::whitted;
  scene.ambient = Rgb(1);
  scene.materials = {material("white", Rgb(1))};
  scene.groups = {std::move(ball)};
  double expected = 0;
  std::size_t count = 0;
  for (int y = spacing; y < size - spacing; y += spacing)
    for (int x = spacing; x < size - spacing; x += spacing, ++count) {
      const double r = std::exp(uniform(std::log(0.05), std::log(1.0)));
      expected += kPi * r * r;
      scene.shapes.push_back(
          instance("ball", scaling(Vec3d(r / radius)) * turn({uniform(0, 6), uniform(0, 6), 0}) *
                               translation({x - size / 2.0 + uniform(-1, 1), y - size / 2.0 + uniform(-1, 1), 0})));
    }
  const RenderResult result = rendered(std::move(scene));
  std::vector<bool> seen(count + 1, false);
  double sum = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) sum += color_at(result.film, x, y).r;
  // An instance is lost when its neighborhood stays dark.
  std::size_t lost = 0;
  for (int y = spacing; y < size - spacing; y += spacing)
    for (int x = spacing; x < size - spacing; x += spacing) {
      double near = 0;
      for (int dy = -4; dy < 4; ++dy)
        for (int dx = -4; dx < 4; ++dx) near += color_at(result.film, x + dx, size - 1 - (y + dy)).r;
      lost += near <= 0;
    }
  EXPECT_EQ(lost, 0u) << what << " of " << count;
  EXPECT_NEAR(sum / expected, 1, 0.02) << what;
}

TEST(Instances, SmallerThanAPixelAreNotLost) {
  expect_no_instance_lost(group("ball", {shape(SphereShape{{0.3, 0, 0}, 2}, "white")}), 2, "spheres");
  expect_no_instance_lost(group("ball", {mesh_shape(globe_mesh(0.5, 40, 20), "white")}), 0.5, "globes");
}

}  // namespace
}  // namespace raytree
