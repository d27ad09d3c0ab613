// The rays of `raytree bench` against closed forms: a camera inside a sphere, which every ray leaves in a known way.
#include "benchmarks/intersection_benchmark.h"

#include <gtest/gtest.h>

#include "benchmarks/reference_scenes.h"
#include "geometry/surface.h"

namespace raytree::benchmarks {
namespace {

constexpr int kSize = 40;

/// The camera stands off center in a unit sphere, with a point light at the center and a directional one.
SceneDescription inside_of_a_sphere() {
  SceneDescription scene = trivial_scene();
  scene.image = {kSize, kSize};
  scene.cameras[0].position = {0.2, 0.1, 0.6};
  scene.cameras[0].target = {0, 0, 0};
  scene.cameras[0].field_of_view = 100;
  LightDescription lamp;
  lamp.name = "lamp";
  lamp.kind = PointLight{{0, 0, 0}};
  scene.lights.push_back(lamp);
  return scene;
}

TEST(IntersectionBenchmark, RaysOfASphereFromItsInsideAllEndOnIt) {
  const Scene scene = prepared(inside_of_a_sphere());
  const auto sets = benchmark_rays(scene);
  const auto rays = [&](BenchmarkRays kind) -> const RaySet& { return sets[static_cast<std::size_t>(kind)]; };
  const auto hits = [&](BenchmarkRays kind) { return batched_pass(scene, rays(kind), 1).hits; };
  constexpr std::size_t kPixels = kSize * kSize;
  EXPECT_EQ(rays(BenchmarkRays::primary).size(), kPixels);
  EXPECT_EQ(hits(BenchmarkRays::primary), kPixels);
  // Mirrored rays and bounces stay inside; refracted ones leave a convex body and meet nothing.
  EXPECT_EQ(rays(BenchmarkRays::mirror).size(), kPixels);
  EXPECT_EQ(hits(BenchmarkRays::mirror), kPixels);
  EXPECT_EQ(rays(BenchmarkRays::bounce).size(), kPixels);
  EXPECT_EQ(hits(BenchmarkRays::bounce), kPixels);
  EXPECT_GT(rays(BenchmarkRays::refracted).size(), 0u);
  EXPECT_EQ(hits(BenchmarkRays::refracted), 0u);
  // The lamp at the center shines on every point unhindered; light from without reaches none.
  const std::size_t shadow = rays(BenchmarkRays::shadow).size();
  EXPECT_GT(shadow, kPixels);
  EXPECT_EQ(hits(BenchmarkRays::shadow), shadow - kPixels);
}

TEST(IntersectionBenchmark, DirectionsAreUnitAndBouncesFollowTheCosine) {
  const Scene scene = prepared(inside_of_a_sphere());
  const auto sets = benchmark_rays(scene);
  for (const RaySet& set : sets)
    for (const RayBatch& batch : set.batches)
      for (std::size_t i = 0; i < batch.size; ++i) EXPECT_NEAR(batch.direction(i).length(), 1, 1e-6);
  // From a point of a unit sphere the inward normal is minus the point: the mean cosine of such bounces is 2/3.
  double sum = 0;
  const RaySet& bounces = sets[static_cast<std::size_t>(BenchmarkRays::bounce)];
  for (const RayBatch& batch : bounces.batches)
    for (std::size_t i = 0; i < batch.size; ++i) {
      const double cosine = -unit(batch.origin(i)).dot(batch.direction(i));
      EXPECT_GE(cosine, -1e-4);
      sum += cosine;
    }
  // Its standard deviation is sqrt(1/2 - 4/9) = .236: four deviations of the mean.
  const auto count = static_cast<double>(bounces.size());
  EXPECT_NEAR(sum / count, 2.0 / 3, 4 * 0.236 / std::sqrt(count));
}

TEST(IntersectionBenchmark, AnswersAreTheSameForAnyThreads) {
  SceneDescription description = reference_scene();
  description.image = {160, 120};
  const Scene scene = prepared(std::move(description));
  const auto sets = benchmark_rays(scene);
  for (const RaySet& set : sets) {
    const PassResult one = batched_pass(scene, set, 1);
    for (const int threads : {2, 3, 7}) {
      const PassResult more = batched_pass(scene, set, threads);
      EXPECT_EQ(more.hits, one.hits);
      EXPECT_EQ(more.checksum, one.checksum);
    }
  }
}

TEST(IntersectionBenchmark, FewerBatchesAreSpreadOverThePicture) {
  SceneDescription description = reference_scene();
  description.image = {320, 240};
  const Scene scene = prepared(std::move(description));
  const RaySet whole = std::move(benchmark_rays(scene)[0]), part = std::move(benchmark_rays(scene, nullptr, 5)[0]);
  ASSERT_EQ(whole.batches.size(), 75u);
  ASSERT_EQ(part.batches.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k)
    for (const std::size_t i : {std::size_t(0), std::size_t(500), kBenchmarkBatch - 1})
      EXPECT_EQ(part.batches[k].direction(i), whole.batches[spread_place(k, 5, 75)].direction(i));
  EXPECT_EQ(thinned(std::move(benchmark_rays(scene)[0]), 3).batches.size(), 3u);
}

}  // namespace
}  // namespace raytree::benchmarks
