// Faults are planted in the fast tracer, one kind at a time, and each is seen for what it is; without one, nothing is.
#include "benchmarks/validation.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <memory>

#include "benchmarks/planted_fault.h"
#include "geometry/sphere_bounded_intersector.h"
#include "geometry/surface.h"
#include "geometry/triangle_reference.h"
#include "renderer/builtin_scenes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree::benchmarks {
namespace {

SceneDescription unsampled(SceneDescription scene, int width, int height) {
  scene.image = {width, height};
  scene.render.antialias = {Antialiasing::Method::none, 1};
  return scene;
}

/// A mirroring globe and a glass one of triangles above a floor of triangles, lit by one lamp.
SceneDescription globes() {
  SceneDescription scene = test::dark_scene(64, test::front_camera(6));
  scene.cameras[0].projection = CameraDescription::Projection::perspective;
  scene.materials = {test::material("gray", Rgb(0.5f)), test::material("mirror", Rgb(0.1f)),
                     test::material("glass", Rgb(0.1f))};
  scene.materials[1].reflection = Rgb(0.8f);
  scene.materials[2].reflection = Rgb(0.2f);
  scene.materials[2].transmission = Rgb(0.7f);
  scene.materials[2].index_of_refraction = 1.5;
  const auto moved = [](std::shared_ptr<PolygonMesh> mesh, const Vec3f& by) {
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) mesh->positions[i] += by;
    return mesh;
  };
  scene.shapes = {
      test::mesh_shape(moved(test::globe_mesh(1, 32, 16), {-1.1f, 0, 0}), "mirror", NormalSource::flat, "a"),
      test::mesh_shape(moved(test::globe_mesh(1, 32, 16), {1.1f, 0, 0}), "glass", NormalSource::flat, "b"),
      test::mesh_shape(test::box_mesh({-4, -1.2f, -4}, {4, -1.005f, 4}), "gray", NormalSource::flat, "c")};
  scene.lights = {test::point_light({2, 6, 5})};
  scene.ambient = Rgb(0.2f);
  return scene;
}

/// The globes' mesh in ShapeSet::meshes that faults are planted in.
constexpr GeometryId kFaulty = kFirstMeshGeometry;

ValidationReport validated(Scene& scene, const ShapeSet& truth_shapes) {
  const TriangleReference truth(truth_shapes);
  return validate(scene, truth_shapes, truth, {});
}
ValidationReport validated(SceneDescription description) {
  Scene scene = test::prepared(std::move(description));
  return validated(scene, *scene.shapes);
}

ValidationReport with_fault(FaultyTracer::Fault fault) {
  Scene scene = test::prepared(globes());
  scene.intersector = std::make_unique<FaultyTracer>(std::move(scene.intersector), std::move(fault));
  return validated(scene, *scene.shapes);
}

void expect_defects(const ValidationReport& report, std::uint64_t least) {
  EXPECT_GE(report.count(RayVerdict::defect), least);
  EXPECT_FALSE(report.holds());
  ASSERT_FALSE(report.examples.empty());
  EXPECT_EQ(report.examples.front().ray.comparison.verdict, RayVerdict::defect);  // worst first
}

TEST(Validation, WithoutAFaultNothingIsFound) {
  const ValidationReport report = validated(globes());
  EXPECT_EQ(report.count(RayVerdict::defect), 0u) << report_text(report);
  EXPECT_TRUE(report.holds());
  EXPECT_EQ(report.pixels, 64u * 64u);
  EXPECT_LE(report.largest_difference, kMostPixelDifference);
  // All kinds of rays are compared, and next to all of them agree.
  for (int kind = 0; kind < kRayKindCount; ++kind) EXPECT_GT(report.kinds[kind].rays, 100u) << kind;
  const ValidationCounts all = report.all();
  EXPECT_GE(all.verdicts[0], all.rays * 0.999);
  EXPECT_GT(all.largest_ulps, 0);
}

TEST(Validation, RaysAreThoseOfTheRender) {
  for (const char* name : {"spheres-1980", "glass"}) {
    Scene scene = test::prepared(unsampled(builtin_scene(name), 96, 72));
    const RenderStatistics statistics = render(scene, RenderOptions()).statistics;
    const ValidationReport report = validated(scene, *scene.shapes);
    EXPECT_TRUE(report.holds()) << report_text(report);
    for (int kind = 0; kind < kRayKindCount; ++kind)
      EXPECT_EQ(report.kinds[kind].rays, statistics.rays[kind]) << name << " kind " << kind;
  }
}

TEST(Validation, ADroppedTriangleIsADefect) {
  const ValidationReport report = with_fault(
      [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
        if (hit.geometry != kFaulty || hit.primitive < 320 || hit.primitive >= 480) return hit;
        return FaultyTracer::behind(tracer, origin, direction, end, hit.distance * 1.001f);
      });
  expect_defects(report, 5);
}

TEST(Validation, AFlippedTriangleIsADefect) {
  SceneDescription description = globes();
  PolygonMesh& mesh = *std::get<MeshShape>(description.shapes[0].kind).mesh;
  for (std::size_t triangle = 320; triangle < 480; ++triangle)
    std::swap(mesh.corners[triangle * 3], mesh.corners[triangle * 3 + 1]);
  Scene faulty = test::prepared(std::move(description));
  const Scene sound = test::prepared(globes());
  expect_defects(validated(faulty, *sound.shapes), 5);
}

TEST(Validation, AShiftedBoundIsADefect) {
  // As if a bounding box ended before its shape does.
  const ValidationReport report = with_fault(
      [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
        const Vec3f point = origin + direction * hit.distance;
        if (hit.geometry != kFaulty || point.x < -0.2f) return hit;
        return FaultyTracer::behind(tracer, origin, direction, end, hit.distance * 1.001f);
      });
  expect_defects(report, 5);
}

TEST(Validation, AWrongIndexIsADefect) {
  const ValidationReport report =
      with_fault([](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
        Hit wrong = hit;
        if (hit.geometry == kFaulty && hit.primitive % 64 == 7) ++wrong.primitive;
        return wrong;
      });
  expect_defects(report, 5);
}

TEST(Validation, AnEpsilonIsADefect) {
  // What lies nearer than 1e-2 is taken for the surface that the ray left: the floor is 5e-3 below the globes.
  const ValidationReport report = with_fault(
      [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
        return hit.distance > 1e-2f ? hit : FaultyTracer::behind(tracer, origin, direction, end, 1e-2f);
      });
  expect_defects(report, 1);
}

TEST(Validation, AWrongDistanceIsADefect) {
  const ValidationReport report =
      with_fault([](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
        Hit wrong = hit;
        if (hit.geometry == kFaulty) wrong.distance *= 1 + 0x1p-14f;
        return wrong;
      });
  expect_defects(report, 100);
}

TEST(Validation, WrongBarycentricsAreDefects) {
  // Hit, distance, shape and normal are right: the reflected ray starts elsewhere.
  const ValidationReport report =
      with_fault([](const RayIntersector&, const Vec3f&, const Vec3f&, float, const Hit& hit) {
        Hit wrong = hit;
        if (hit.geometry == kFirstMeshGeometry + 2) std::swap(wrong.u, wrong.v);
        return wrong;
      });
  expect_defects(report, 100);
}

TEST(Validation, PlantedFaultsAreFoundOnAnyScene) {
  for (const PlantedFault& fault : planted_faults()) {
    Scene scene = test::prepared(globes());
    scene.intersector = std::make_unique<FaultyTracer>(std::move(scene.intersector), fault.make(*scene.shapes));
    EXPECT_FALSE(validated(scene, *scene.shapes).holds()) << fault.name;
  }
}

TEST(Validation, SurfacesThatCoincideAreCoplanar) {
  SceneDescription description = globes();
  // Two floors at one height, cut in triangles otherwise: which is nearer is up to rounding.
  description.shapes.push_back(
      test::mesh_shape(test::box_mesh({-4.3f, -1.2f, -3.7f}, {4.1f, -1.005f, 4.2f}), "gray", NormalSource::flat, "d"));
  const ValidationReport report = validated(std::move(description));
  EXPECT_TRUE(report.holds()) << report_text(report);
  EXPECT_GT(report.count(RayVerdict::coplanar), 100u);
}

TEST(Validation, ReportsDoNotDependOnThreads) {
  std::string reports[2];
  for (int i = 0; i < 2; ++i) {
    tbb::task_arena arena(i == 0 ? 1 : 2);
    arena.execute([&] {
      ValidationReport report = validated(unsampled(builtin_scene("glass"), 64, 48));
      report.fast = report.truth = TracerSpeed();
      reports[i] = report_text(report) + report_json(report);
    });
  }
  EXPECT_EQ(reports[0], reports[1]);
}

TEST(Validation, SamplesArePickedByTheirPlace) {
  Scene scene = test::prepared(globes());
  const TriangleReference truth(*scene.shapes);
  ValidationOptions options;
  options.pixels = 400;
  const ValidationReport report = validate(scene, *scene.shapes, truth, options);
  // Binomial, 4096 pixels of share .098: within five standard deviations of 19.
  EXPECT_NEAR(static_cast<double>(report.pixels), 400, 95);
  EXPECT_EQ(report.kinds[0].rays, report.pixels);
  std::array<std::vector<std::uint8_t>, 3> planes;
  const Image image = marked_image(report, planes);
  EXPECT_EQ(image.planes.size(), 3u);
  EXPECT_EQ(planes[0].size(), 64u * 64u);
}

/// Against the tracer that knows what triangles stand for.
ValidationReport validated_by_spheres(SceneDescription description, FaultyTracer::Fault fault = {}) {
  PrepareOptions prepare;
  prepare.keep_sources = true;
  Scene scene = test::prepared(std::move(description), nullptr, prepare);
  const SphereBoundedIntersector truth(*scene.shapes, SphereBoundedOptions());
  if (fault) scene.intersector = std::make_unique<FaultyTracer>(std::move(scene.intersector), std::move(fault));
  ValidationOptions options;
  options.tolerance = {scene.description.render.tessellation.tolerance, kDefaultSpherePixels};
  return validate(scene, *scene.shapes, truth, options);
}

TEST(Validation, FacetsOfALimitSurfaceAreTessellation) {
  const SceneDescription scene = unsampled(builtin_scene("teapot"), 64, 48);
  const ValidationReport report = validated_by_spheres(scene);
  EXPECT_EQ(report.count(RayVerdict::defect), 0u) << report_text(report);
  EXPECT_GT(report.count(RayVerdict::tessellation), 500u);
  // The tolerance excuses no hole.
  const ValidationReport faulty = validated_by_spheres(
      scene, [](const RayIntersector& tracer, const Vec3f& origin, const Vec3f& direction, float end, const Hit& hit) {
        if (hit.geometry < kFirstMeshGeometry || hit.primitive % 16 != 0) return hit;
        return FaultyTracer::behind(tracer, origin, direction, end, hit.distance * 1.001f);
      });
  EXPECT_GT(faulty.count(RayVerdict::defect), 50u);
}

TEST(Validation, PolygonsThatAreNotFlatAreNonplanar) {
  SceneDescription description = globes();
  auto mesh = std::make_shared<PolygonMesh>();
  for (const Vec3f& p : {Vec3f(-2, -1, 1.5f), Vec3f(2, -1, 1.8f), Vec3f(2, 1, 1.5f), Vec3f(-2, 1, 1.8f)})
    mesh->positions.push_back(p);
  for (const std::uint32_t i : {0u, 1u, 2u, 3u}) mesh->corners.push_back(i);
  mesh->face_sizes.push_back(4);
  description.shapes.push_back(test::mesh_shape(mesh, "gray", NormalSource::flat, "e"));
  const ValidationReport report = validated_by_spheres(std::move(description));
  EXPECT_EQ(report.count(RayVerdict::defect), 0u) << report_text(report);
  EXPECT_GT(report.count(RayVerdict::nonplanar), 100u);
}

TEST(Validation, RaysAimedAtVerticesAreExcusedAsEdges) {
  Scene scene = test::prepared(globes());
  const TriangleReference truth(*scene.shapes);
  const RayJudge judge(*scene.shapes, *scene.intersector, *scene.shapes, truth);
  const TriangleMesh& mesh = scene.shapes->meshes[0].mesh;
  std::array<int, kRayVerdictCount> verdicts{};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (int k = 0; k < 20; ++k) {
      ComparedRay ray;
      ray.origin = Vec3f(-1.1f + 0.03f * static_cast<float>(k), 0.02f * static_cast<float>(k), 0.1f);
      ray.direction = (mesh.positions[i] - ray.origin).normalized();
      ray.max_distance = std::numeric_limits<float>::infinity();
      ++verdicts[static_cast<std::size_t>(judge.nearest(ray, judge.ask_tracer(ray), judge.ask_truth(ray)).verdict)];
    }
  EXPECT_EQ(verdicts[static_cast<int>(RayVerdict::defect)], 0);
  EXPECT_GT(verdicts[static_cast<int>(RayVerdict::edge)], 100);
}

}  // namespace
}  // namespace raytree::benchmarks
