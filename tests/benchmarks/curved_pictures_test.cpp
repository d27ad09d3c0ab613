// What row curved-pictures measures with, on surfaces small enough for a test: cracks that are there are counted, none
// where there are none; outlines within the tolerance are within the bound, coarse ones are not.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "benchmarks/crack_rays.h"
#include "benchmarks/curved_picture_scenes.h"
#include "benchmarks/outline_difference.h"
#include "benchmarks/samples/cages.h"
#include "geometry/embree_intersector.h"
#include "renderer/mesh_scene.h"
#include "renderer/scene.h"
#include "renderer/scene_reader.h"
#include "tests/temporary_folder.h"

namespace raytree::benchmarks {
namespace {

constexpr int kTestWidth = 240, kTestHeight = 180;
constexpr std::size_t kTestRays = 100'000;

/// A cube's limit surface, and nothing else.
Scene cube_alone(double tolerance) {
  SceneDescription description = mesh_scene(std::make_shared<PolygonMesh>(samples::cube_cage()), "cube",
                                            ImageDescription{kTestWidth, kTestHeight});
  set_scene_value(description, "shapes.object.subdivision", "{}");
  description.render.tessellation.tolerance = tolerance;
  Warnings warnings;
  return prepare(curved_shapes_alone(std::move(description)), {}, warnings);
}

TEST(CrackRays, FindNoneInATessellation) {
  const Scene scene = cube_alone(0.25);
  const CrackCount count = count_cracks(*scene.shapes, *scene.intersector, scene.camera.position(), kTestRays);
  EXPECT_GT(count.rays, kTestRays * 3 / 4);
  EXPECT_EQ(count.cracks, 0u);
  EXPECT_EQ(open_edges(*scene.shapes), 0);
}

TEST(CrackRays, FindTrianglesDrawnBackFromTheirEdges) {
  // The tracer's triangles are those of the scene, each a little smaller about its own middle: cracks along all edges.
  const Scene scene = cube_alone(0.25);
  ShapeSet cracked;
  cracked.meshes.resize(1);
  TriangleMesh& mesh = cracked.meshes[0].mesh;
  const TriangleMesh& whole = scene.shapes->meshes[0].mesh;
  for (std::size_t t = 0; t < whole.triangle_count(); ++t) {
    Vec3f middle(0);
    for (std::size_t k = 0; k < 3; ++k) middle += whole.positions[whole.corners[3 * t + k]] / 3.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f& p = whole.positions[whole.corners[3 * t + k]];
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(p + (middle - p) * 0.001f);
    }
  }
  const EmbreeIntersector tracer(cracked, {});
  const CrackCount count = count_cracks(*scene.shapes, tracer, scene.camera.position(), kTestRays);
  // From outside the far side's edges lie behind the near side, which hides them; from inside all are seen.
  EXPECT_GT(count.cracks, count.rays / 4);
  EXPECT_EQ(open_edges(cracked), std::int64_t(mesh.corners.size()));
}

TEST(OutlineDifference, IsWithinTheBoundAtTheDefaultTolerance) {
  const double tolerance = TessellationSettings().tolerance, finer = tolerance / 8;
  const double bound = outline_bound(tolerance + finer);
  const Scene limit = cube_alone(finer);
  const auto difference = [&](double of) {
    const Scene scene = cube_alone(of);
    return outline_difference(*scene.intersector, *limit.intersector, scene.camera, kTestWidth, kTestHeight, bound);
  };
  const OutlineDifference same = difference(finer), usual = difference(tolerance), coarse = difference(16 * tolerance);
  std::printf("outline of %d pixels: off by %.4f in the mean, %.3f at most; at 4 px by %.4f, %.3f\n", int(usual.pixels),
              usual.mean, usual.largest, coarse.mean, coarse.largest);
  EXPECT_EQ(same.largest, 0);
  EXPECT_GT(usual.pixels, 300u);
  EXPECT_GT(usual.largest, 0);
  EXPECT_LE(usual.largest, bound);
  EXPECT_LE(usual.mean, tolerance + finer);
  EXPECT_EQ(usual.over, 0u);
  EXPECT_GT(coarse.largest, bound) << "facets would be seen";
  EXPECT_GT(coarse.over, 0u);
}

TEST(CurvedPictures, WithoutFilesOfOthersAreOfCagesThatShip) {
  const test::TemporaryFolder folder;
  const std::vector<CurvedPicture> pictures = curved_pictures(folder.path("none"), folder.path(""));
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_TRUE(test::contains(pictures[0].name, "Spot's file is not there")) << pictures[0].name;
  EXPECT_TRUE(test::contains(pictures[1].name, "the car's file is not there")) << pictures[1].name;
  EXPECT_EQ(pictures[2].words, std::vector<std::string>{"teapot"});
  EXPECT_TRUE(pictures[0].closed);
  EXPECT_FALSE(pictures[1].closed);
  EXPECT_TRUE(pictures[3].closed);
  for (const CurvedPicture& picture : pictures) {
    SCOPED_TRACE(picture.name);
    EXPECT_FALSE(curved_shapes_alone(picture.make()).shapes.empty());
  }
}

}  // namespace
}  // namespace raytree::benchmarks
