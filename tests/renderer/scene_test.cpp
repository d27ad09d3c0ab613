// Preparing a scene: transforms, recentering, materials and cameras by name, warnings, and what is refused.
#include <gtest/gtest.h>

#include <limits>

#include "geometry/angle.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

SceneDescription with_shape(ShapeDescription s) {
  SceneDescription scene = dark_scene(8, front_camera(4));
  scene.materials = {material("m", Rgb(0.5f))};
  scene.shapes = {std::move(s)};
  return scene;
}

Matrix44d rotation(double degrees, const Vec3d& axis) {
  Matrix44d m;
  m.setAxisAngle(axis, degrees * kDegree);
  return m;
}

/// All facets of the prepared mesh face away from `center` (scene space), and so do its vertex normals.
void expect_normals_outward(const Scene& scene, const Vec3d& world_center) {
  const Vec3d center = world_center - scene.shapes->origin;
  for (const MeshEntry& entry : scene.shapes->meshes) {
    const TriangleMesh& mesh = entry.mesh;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      Vec3d p[3];
      for (std::size_t c = 0; c < 3; ++c) p[c] = Vec3d(mesh.positions[mesh.corners[3 * t + c]]);
      const Vec3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
      ASSERT_GT(normal.dot((p[0] + p[1] + p[2]) / 3 - center), 0) << "triangle " << t;
      for (std::size_t c = 0; c < 3 && !mesh.normals.empty(); ++c) {
        const std::uint32_t index =
            mesh.normal_corners.empty() ? mesh.corners[3 * t + c] : mesh.normal_corners[3 * t + c];
        const Vec3d n(mesh.normals[index]);
        ASSERT_GT(n.dot(p[c] - center), 0);
        ASSERT_GT(n.dot(normal), 0);
        ASSERT_NEAR(n.length(), 1, 1e-6);
      }
    }
  }
}

// Descriptions are values: a copy shares its meshes, and preparing it takes meshes apart.
TEST(Scene, PreparingACopyLeavesTheOriginalWhole) {
  const SceneDescription original = with_shape(mesh_shape(globe_mesh(1, 12, 8), "m", NormalSource::flat));
  const std::size_t triangles = prepared(original).shapes->meshes[0].mesh.triangle_count();
  EXPECT_GT(triangles, 100u);
  EXPECT_EQ(prepared(original).shapes->meshes[0].mesh.triangle_count(), triangles);
}

TEST(Scene, TransformedMeshesKeepTheirNormalsOutward) {
  const Vec3d place(3, -2, 5);
  const Matrix44d transforms[] = {Matrix44d(),
                                  translation(place),
                                  rotation(50, {1, 2, 3}) * translation(place),
                                  scaling({2, 0.5, 1}) * rotation(30, {0, 1, 0}) * translation(place),
                                  scaling({-1, 1, 1}) * translation(place),
                                  scaling({-1, -2, -0.5}) * rotation(20, {1, 0, 1}) * translation(place)};
  for (const Matrix44d& m : transforms)
    for (const NormalSource normals : {NormalSource::flat, NormalSource::smooth}) {
      ShapeDescription s = mesh_shape(globe_mesh(1, 12, 8), "m", normals);
      s.transform = m;
      const Scene scene = prepared(with_shape(std::move(s)));
      expect_normals_outward(scene, Vec3d(0, 0, 0) * m);
      EXPECT_EQ(scene.shapes->meshes[0].mesh.normals.empty(), normals == NormalSource::flat);
    }
}

TEST(Scene, SmoothNormalsOfAStretchedSphereAreTheEllipsoids) {
  // Normals go by the inverse transpose: on x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 they run along (x/a^2, y/b^2, z/c^2).
  ShapeDescription s = mesh_shape(globe_mesh(1, 96, 48), "m", NormalSource::smooth);
  s.transform = scaling({2, 1, 0.5});
  const Scene scene = prepared(with_shape(std::move(s)));
  const TriangleMesh& mesh = scene.shapes->meshes[0].mesh;
  double worst = 1;
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vec3d p = Vec3d(mesh.positions[mesh.corners[i]]) + scene.shapes->origin;
    const std::uint32_t index = mesh.normal_corners.empty() ? mesh.corners[i] : mesh.normal_corners[i];
    worst = std::min(worst, Vec3d(mesh.normals[index]).dot(unit(Vec3d(p.x / 4, p.y, p.z * 4))));
  }
  // A vertex normal of 96 x 48 cells is within half a cell's turn (1.9 degrees) of the sphere's; stretched four times
  // as far. Normals that went by the matrix itself would be off by up to 60 degrees.
  EXPECT_GT(worst, std::cos(8 * kDegree));
}

TEST(Scene, AMirroredMeshLooksLikeTheMirrorImage) {
  auto picture = [](double sign) {
    ShapeDescription s = mesh_shape(box_mesh({0.2f, -1, -1}, {1.2f, 0.5f, 1}), "m");
    s.transform = rotation(sign * 25, {0, 1, 0});
    if (sign < 0) s.transform = scaling({-1, 1, 1}) * s.transform;
    SceneDescription scene = with_shape(std::move(s));
    scene.image = {32, 32};
    scene.lights = {directional_light({sign * -1, -1, -1})};
    return rendered(std::move(scene));
  };
  const RenderResult plain = picture(1), mirrored = picture(-1);
  int seen = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      EXPECT_NEAR(color_at(plain.film, x, y).r, color_at(mirrored.film, 31 - x, y).r, 1e-5);
      seen += color_at(plain.film, x, y).r > 0;
    }
  EXPECT_GT(seen, 50);
}

TEST(Scene, SpheresAndDiscsTakeOneScaleForAllAxes) {
  for (const int kind : {0, 1, 2}) {
    ShapeDescription s = shape(SphereShape{{1, 0, 0}, 0.5}, "m", "ball");
    if (kind == 1) s.kind = DiscShape{{1, 0, 0}, {0, 0, 1}, 0.5};
    if (kind == 2) s.kind = SphereFlakeShape{1, {1, 0, 0}, 0.5};
    s.transform = scaling(Vec3d(2)) * rotation(90, {0, 0, 1});
    const Scene scene = prepared(with_shape(s));
    const auto& array = kind == 1 ? scene.shapes->discs.center_radius : scene.shapes->spheres.center_radius;
    EXPECT_NEAR(array[0].w, 1, 1e-6);
    const Vec3d center = Vec3d(array[0].x, array[0].y, array[0].z) + scene.shapes->origin;
    EXPECT_LT((center - Vec3d(0, 2, 0)).length(), 1e-6);
    // A mirror image of a sphere is a sphere.
    s.transform = scaling({-1, 1, 1});
    EXPECT_NO_THROW(prepared(with_shape(s)));
    for (const Vec3d& factors : {Vec3d(1, 1, 1.001), Vec3d(0, 0, 0), Vec3d(2, 1, 1)}) {
      s.transform = scaling(factors);
      try {
        prepared(with_shape(s));
        ADD_FAILURE() << "accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_EQ(error.where().object, "shapes.ball");
        EXPECT_NE(std::string(error.what()).find("test.json:1: shapes.ball: "), std::string::npos) << error.what();
      }
    }
  }
}

TEST(Scene, WhatIsNotFiniteOrHasNoDirectionIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<ShapeKind> kinds{PlaneShape{{0, 0, 0}, {0, 0, 0}},     PlaneShape{{nan, 0, 0}, {0, 1, 0}},
                                     PlaneShape{{0, 0, 0}, {0, inf, 0}},   DiscShape{{0, 0, 0}, {0, 0, 0}, 1},
                                     DiscShape{{0, inf, 0}, {0, 1, 0}, 1}, DiscShape{{0, 0, 0}, {0, 1, 0}, nan},
                                     SphereShape{{0, nan, 0}, 1},          SphereShape{{0, 0, 0}, inf},
                                     SphereShape{{0, 0, 0}, -1},           SphereShape{{1e30, 0, 0}, 1}};
  for (std::size_t i = 0; i < kinds.size(); ++i) EXPECT_THROW(prepared(with_shape(shape(kinds[i], "m"))), Error) << i;
  // A transform that blows a mesh up beyond float, or is not a number, or flattens it away.
  for (const double factor : {1e30, nan, inf}) {
    ShapeDescription s = mesh_shape(box_mesh({-1, -1, -1}, {1, 1, 1}), "m");
    s.transform = scaling(Vec3d(factor));
    EXPECT_THROW(prepared(with_shape(std::move(s))), Error) << factor;
  }
  SceneDescription scene = with_shape(shape(SphereShape{}, "m"));
  scene.lights = {directional_light({0, 0, 0})};
  EXPECT_THROW(prepared(scene), Error);
  scene.lights = {point_light({0, nan, 0})};
  EXPECT_THROW(prepared(scene), Error);
  scene.lights.clear();
  for (const double angle : {nan, 0.0, 180.0, -40.0}) {
    scene.cameras[0] = CameraDescription();
    scene.cameras[0].field_of_view = angle;
    EXPECT_THROW(prepared(scene), Error) << angle;
  }
  scene.cameras[0] = CameraDescription();
  scene.cameras[0].position = {0, 0, inf};
  EXPECT_THROW(prepared(scene), Error);
  scene.cameras[0] = CameraDescription();
  scene.cameras[0].up = {0, 0, 3};
  EXPECT_THROW(prepared(scene), Error);
  scene.cameras[0].target = scene.cameras[0].position;
  EXPECT_THROW(prepared(scene), Error);
}

TEST(Scene, FarScenesAreRecenteredInDouble) {
  for (const double offset : {0.0, 1e6}) {
    const Vec3d at(offset, 0, -offset);
    SceneDescription scene = with_shape(shape(SphereShape{at + Vec3d(0.001, 0, 0), 0.25}, "m"));
    ShapeDescription box = mesh_shape(box_mesh({0, 0, 0}, {1e-3f, 1e-3f, 1e-3f}), "m");
    box.transform = translation(at);
    scene.shapes.push_back(std::move(box));
    const Scene ready = prepared(std::move(scene));
    const Vec3d origin = ready.shapes->origin;
    // 1e6 in float steps by .06: here a thousandth is kept to seven digits.
    const Imath::V4f& s = ready.shapes->spheres.center_radius[0];
    EXPECT_LT((Vec3d(s.x, s.y, s.z) + origin - at - Vec3d(0.001, 0, 0)).length(), 1e-8);
    const TriangleMesh& mesh = ready.shapes->meshes[0].mesh;
    EXPECT_EQ(mesh.origin, Vec3d(0, 0, 0));
    EXPECT_NEAR(mesh.positions[1].x - mesh.positions[0].x, 1e-3, 1e-7);
    EXPECT_EQ(origin == Vec3d(0, 0, 0), offset == 0);
    EXPECT_NEAR(ready.summary.shapes[0].bounds.min.x, offset + 0.001 - 0.25, 1e-9);
  }
}

TEST(Scene, MaterialsAndCamerasAreFoundByName) {
  SceneDescription scene = dark_scene(4, front_camera(1));
  scene.materials = {material("a", Rgb(1, 0, 0)), material("b", Rgb(0, 1, 0))};
  scene.ambient = Rgb(1);
  scene.cameras[0].name = "front";
  scene.cameras.push_back(front_camera(1));
  scene.cameras[1].name = "back";
  scene.cameras[1].position = {0, 0, -10};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "b", "middle"),
                  shape(PlaneShape{{0, 0, -1}, {0, 0, 1}}, "", "rear")};
  const Scene ready = prepared(scene);
  EXPECT_EQ(ready.shape_materials, (std::vector<std::uint32_t>{1, 2}));
  expect_color(color_at(render(ready, {}).film, 0, 0), Rgb(0, 1, 0), 0);
  PrepareOptions options;
  options.camera = "back";
  // A shape that names no material wears the default one.
  expect_color(color_at(render(prepared(scene, nullptr, options), {}).film, 0, 0), Rgb(0.8f), 0);
  options.camera = "side";
  try {
    prepared(scene, nullptr, options);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("front, back"), std::string::npos) << error.what();
  }
  scene.shapes[0].material = "c";
  try {
    prepared(scene);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().object, "shapes.middle");
    EXPECT_NE(std::string(error.what()).find("\"c\""), std::string::npos) << error.what();
  }
}

TEST(Scene, GlassThatIsNotClosedIsWarnedOf) {
  for (const bool open : {false, true})
    for (const bool glass : {false, true}) {
      auto mesh = box_mesh({-1, -1, -1}, {1, 1, 1});
      if (open) mesh->corners.resize(mesh->corners.size() - 6);  // one side off
      SceneDescription scene = with_shape(mesh_shape(mesh, "m"));
      if (glass) scene.materials[0].transmission = Rgb(1);
      Warnings warnings;
      prepared(std::move(scene), &warnings);
      ASSERT_EQ(warnings.size(), open && glass ? 1u : 0u);
      if (!warnings.empty()) {
        EXPECT_EQ(warnings[0].count, 4);
        EXPECT_EQ(warnings[0].where.object, "shapes.mesh");
      }
    }
}

TEST(Scene, AnEmptySceneIsAllBackground) {
  SceneDescription scene = dark_scene(5, front_camera(1));
  scene.background = ConstantBackground{Rgb(0.5f, 0.25f, 1)};
  const RenderResult result = rendered(scene);
  EXPECT_EQ(color_at(result.film, 4, 4), Rgb(0.5f, 0.25f, 1));
  EXPECT_EQ(result.statistics.total_rays(), 25u);
  SceneDescription empty_mesh = with_shape(mesh_shape(triangles({}, {}), "m"));
  EXPECT_EQ(color_at(rendered(std::move(empty_mesh)).film, 1, 1), Rgb(0));
}

TEST(Scene, SummaryTellsWhatIsThere) {
  SceneDescription scene = with_shape(mesh_shape(box_mesh({-1, -1, -1}, {1, 1, 1}), "m", NormalSource::flat, "box"));
  scene.shapes.push_back(shape(SphereFlakeShape{2, {0, 0, 0}, 1}, "m", "flake"));
  scene.shapes.push_back(shape(PlaneShape{}, "", "floor"));
  PrepareOptions options;
  options.build = false;
  const Scene ready = prepared(std::move(scene), nullptr, options);
  EXPECT_EQ(ready.intersector, nullptr);
  ASSERT_EQ(ready.summary.shapes.size(), 3u);
  EXPECT_EQ(ready.summary.shapes[0].triangles, 12u);
  EXPECT_EQ(ready.summary.shapes[1].spheres, 91u);
  EXPECT_TRUE(ready.summary.shapes[2].bounds.isInfinite());
  EXPECT_FALSE(ready.summary.bounds.isInfinite());
  EXPECT_EQ(ready.summary.shapes[2].id, 3u);
}

}  // namespace
}  // namespace raytree
