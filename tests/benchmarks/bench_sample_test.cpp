// Which rays stand for a picture's: from all of its columns, rows and batches, whatever its size.
#include "benchmarks/bench_sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <thread>
#include <utility>

#include "benchmarks/reference_scenes.h"

namespace raytree::benchmarks {
namespace {

// Places are one in each equal part, so they differ and are in order.
TEST(SpreadPlace, IsOneInEachEqualPart) {
  for (const std::size_t count : {1u, 2u, 7u, 75u, 256u, 1200u, 2025u})
    for (const std::size_t taken : {1u, 2u, 5u, 16u, 32u, 256u}) {
      if (taken > count) continue;
      for (std::size_t k = 0; k < taken; ++k) {
        EXPECT_GE(spread_place(k, taken, count), k * count / taken);
        EXPECT_LT(spread_place(k, taken, count), (k + 1) * count / taken);
      }
    }
}

constexpr std::size_t kBands = 8;

/// Share of the rays in each of eight columns of the picture. Rays of the camera of trivial_scene() stand in a pinhole:
/// x over depth is linear in the pixel's column.
std::array<double, kBands> columns_of(const RaySet& rays, const Scene& scene) {
  std::array<double, kBands> share{};
  const auto [width, height] = scene.description.image;
  const auto along = [&](float x, float y) {
    Vec3f origin, direction;
    scene.camera.ray(x, y, origin, direction);
    return direction;
  };
  const Vec3f middle = along(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height));
  const auto slope = [&](const Vec3f& direction, const Vec3f& right) {
    return direction.dot(right) / direction.dot(middle);
  };
  const Vec3f corner = along(0, 0.5f * static_cast<float>(height));
  const Vec3f right = unit(middle * corner.dot(middle) - corner);
  const float edge = slope(corner, right);
  for (const RayBatch& batch : rays.batches)
    for (std::size_t i = 0; i < batch.size; ++i) {
      const float at = 0.5f - 0.5f * slope(batch.direction(i), right) / edge;  // 0 at the left border, 1 at the right
      const auto band = static_cast<std::size_t>(std::clamp(at * kBands, 0.0f, kBands - 1.0f));
      share[band] += 1.0 / static_cast<double>(rays.size());
    }
  return share;
}

// 32 batches are runs of 512 pixels by 2. Were they those at equal distances, a picture 1280 wide would show none of
// its middle, and one 512 wide would show a few rays of each batch at its left border.
TEST(BenchSample, FewBatchesAreOfAllColumns) {
  for (const auto& [width, height] : {std::pair(512, 512), {640, 480}, {800, 600}, {1280, 960}, {1920, 1080}}) {
    SceneDescription description = trivial_scene();
    description.image = {width, height};
    const Scene scene = prepared(std::move(description));
    BenchRays kind;
    kind.rays = std::move(benchmark_rays(scene, nullptr, kBenchBatches)[0]);
    ASSERT_EQ(kind.rays.batches.size(), kBenchBatches);
    for (const double share : columns_of(kind.rays, scene)) {
      EXPECT_GT(share, 0.5 / kBands) << width;
      EXPECT_LT(share, 2.0 / kBands) << width;
    }
    // A few rays of many batches, as the naive tracer gets them: each quarter of the picture has some.
    const BenchRays few = part_of(kind, 16, 8);
    ASSERT_EQ(few.rays.size(), 128u);
    const std::array<double, kBands> share = columns_of(few.rays, scene);
    for (std::size_t band = 0; band < kBands; band += 2) EXPECT_GT(share[band] + share[band + 1], 0) << width;
  }
}

// The naive tracer gets a thousand rays of sixteen batches rather than one batch, which would be a corner of the
// picture, and without a budget a few of many.
TEST(BenchSample, TheNaiveTracersRaysAreOfManyBatches) {
  BenchRays kind;
  for (int i = 0; i < 40 * static_cast<int>(kBenchmarkBatch); ++i)
    add_ray(kind.rays, Vec3f(static_cast<float>(i), 0, 0), Vec3f(0, 0, 1), 1);
  const auto batches = [&](const BenchRays& part) {
    std::set<std::size_t> from;
    for (const RayBatch& batch : part.rays.batches) {
      EXPECT_GT(batch.size, 0u);
      from.insert(static_cast<std::size_t>(batch.origin(0).x) / kBenchmarkBatch);
    }
    return from.size();
  };
  // 16 rays in 2 ms: 1600 in the time given, or fewer on a busy machine.
  const auto ask = [](const BenchRays&) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); };
  const BenchRays part = fitting_part(kind, {0.4, 1, true}, ask);
  EXPECT_LE(part.rays.size(), 2048u);
  EXPECT_GE(batches(part), std::min<std::size_t>(16, part.rays.size() / 8));
  const BenchRays few = fitting_part(kind, {0, 1, true}, ask);
  EXPECT_EQ(few.rays.size(), kNaiveRays);
  EXPECT_EQ(batches(few), kNaiveRays / 8);
}

// Rays and the planes that end them stay side by side.
TEST(BenchSample, PlanesGoWithTheirRays) {
  BenchRays kind;
  kind.name = "primary";
  for (int i = 0; i < 5 * static_cast<int>(kBenchmarkBatch); ++i) {
    const auto number = static_cast<float>(i);
    add_ray(kind.rays, Vec3f(number, 0, 0), Vec3f(0, 0, 1), 1);
    add_ray(kind.without_planes, Vec3f(number, 1, 0), Vec3f(0, 0, 1), 1);
    if (i % static_cast<int>(kBenchmarkBatch) == 0) kind.plane_distance.emplace_back();
    kind.plane_distance.back().push_back(number);
  }
  std::set<std::size_t> begins;
  const BenchRays part = part_of(kind, 4, 8);
  ASSERT_EQ(part.rays.batches.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const RayBatch& batch = part.rays.batches[k];
    ASSERT_EQ(batch.size, 8u);
    ASSERT_EQ(part.plane_distance[k].size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(part.plane_distance[k][i], batch.origin(i).x);
      EXPECT_EQ(part.without_planes.batches[k].origin(i), Vec3f(batch.origin(i).x, 1, 0));
    }
    const auto first = static_cast<std::size_t>(batch.origin(0).x);
    EXPECT_EQ(first % 8, 0u) << "a packet";
    begins.insert(first % kBenchmarkBatch);
  }
  EXPECT_EQ(begins.size(), 4u);
}

}  // namespace
}  // namespace raytree::benchmarks
