// Few shapes in batches: what the quick look at eight rays leaves out must be what the exact test would refuse.
#include "geometry/few_shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace raytree {
namespace {

/// Rays at a ball whose lines pass its center at about its radius, inside and outside by a few roundings, from near and
/// far; in groups of eight alike, so that whole blocks are left out.
RayBatch rays_at_outlines(const Imath::V4f& ball, double distance, std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto unit_vector = [&] {
    for (;;) {
      const Vec3d v(coordinate(random), coordinate(random), coordinate(random));
      if (const double square = v.dot(v); square > 0.01 && square <= 1) return v * (1 / std::sqrt(square));
    }
  };
  RayBatch rays(1000);
  while (rays.size + 8 <= rays.capacity()) {
    const Vec3d toward = unit_vector();
    Vec3d across = unit_vector();
    across -= toward * across.dot(toward);
    across *= 1 / std::sqrt(across.dot(across));
    const double off = ball.w * (1 + 4 * coordinate(random) * (ball.w + distance) / ball.w * 0x1p-24);
    for (int i = 0; i < 8; ++i) {
      const Vec3d aim = Vec3d(ball.x, ball.y, ball.z) + across * (off * (1 + 0x1p-24 * i));
      const Vec3f origin(aim - toward * distance);
      Vec3d direction = aim - Vec3d(origin);
      direction *= 1 / std::sqrt(direction.dot(direction));
      rays.push(origin, Vec3f(direction), INFINITY);
    }
  }
  return rays;
}

TEST(FewShapes, BatchesFindWhatSingleRaysFind) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-1, 1);
  std::int64_t hits = 0, rays_asked = 0;
  for (const float radius : {1e-4f, 1e-2f, 1.0f, 1e3f})
    for (const float far : {1.0f, 30.0f, 1e4f})
      for (const bool disc : {false, true}) {
        ShapeSet shapes;
        const Imath::V4f ball(place(random) * radius * far, place(random) * radius * far, place(random) * radius,
                              radius);
        if (disc) {
          shapes.discs.center_radius = {ball};
          shapes.discs.normal = {Vec3f(0, 0.6f, 0.8f)};
          shapes.discs.shape = {0};
        } else {
          shapes.spheres.center_radius = {ball};
          shapes.spheres.shape = {0};
        }
        const FewShapes few(shapes, kMostFewShapes);
        ASSERT_TRUE(few.any());
        const RayBatch rays = rays_at_outlines(ball, double(radius) * far, random);
        FewHits found;
        intersect_few(few, rays, found);
        for (std::size_t i = 0; i < rays.size; ++i) {
          const Hit single = intersect_few(few, rays.origin(i), rays.direction(i), INFINITY);
          ASSERT_EQ(found.geometry[i], single.geometry) << "radius " << radius << ", distance " << far << ", ray " << i;
          ASSERT_EQ(found.distance[i], single.distance);
          hits += single.geometry != kNoGeometry;
          ++rays_asked;
        }
      }
  // The rays lie at the outline: some must meet and some miss, or nothing was tested.
  EXPECT_GT(hits, rays_asked / 10);
  EXPECT_LT(hits, rays_asked * 9 / 10);
}

TEST(FewShapes, OfSeveralShapesTheNearestWithinTheRayIsFound) {
  std::mt19937 random(23);
  std::uniform_real_distribution<float> place(-3, 3), radius(0.2f, 1.5f), end(0.5f, 9);
  ShapeSet shapes;
  shapes.planes = {{Vec3d(0, -2, 0), Vec3d(0, 1, 0)}, {Vec3d(4, 0, 0), Vec3d(0.6, 0, 0.8)}};
  for (int i = 0; i < 6; ++i) {
    shapes.spheres.center_radius.push_back({place(random), place(random), place(random), radius(random)});
    shapes.spheres.shape.push_back(0);
    shapes.discs.center_radius.push_back({place(random), place(random), place(random), radius(random)});
    shapes.discs.normal.push_back({0.6f, 0, 0.8f});
    shapes.discs.shape.push_back(0);
  }
  const FewShapes few(shapes, kMostFewShapes);
  FewHits found;  // of larger batches first: what they left behind must not count
  std::array<int, 4> hits{};
  for (std::size_t size = 40; size > 0; --size)
    for (int round = 0; round < 20; ++round) {
      RayBatch rays(size);
      while (rays.size < size) {
        const Vec3f toward(place(random), place(random), place(random));
        rays.push({place(random), place(random), place(random)}, toward * (1 / std::sqrt(toward.dot(toward))),
                  rays.size % 3 == 0 ? INFINITY : end(random));
      }
      intersect_few(few, rays, found);
      for (std::size_t i = 0; i < size; ++i) {
        const Hit single = intersect_few(few, rays.origin(i), rays.direction(i), rays.max_distance[i]);
        ASSERT_EQ(found.geometry[i], single.geometry) << "ray " << i << " of " << size;
        ASSERT_EQ(found.distance[i], single.distance);
        if (single.geometry == kNoGeometry) {
          ++hits[3];
          continue;
        }
        ASSERT_EQ(found.primitive[i], single.primitive);
        ++hits[single.geometry];
      }
    }
  for (const int count : hits) EXPECT_GT(count, 800);
}

TEST(FewShapes, RaysThatOverflowAreLookedAtInDouble) {
  ShapeSet shapes;
  shapes.spheres.center_radius = {Imath::V4f(0, 0, -3e25f, 1e25f)};
  shapes.spheres.shape = {0};
  RayBatch rays(8);
  for (int i = 0; i < 8; ++i) rays.push({0, 0, 0}, {0, 0, -1}, INFINITY);
  FewHits found;
  intersect_few(FewShapes(shapes, kMostFewShapes), rays, found);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(found.geometry[i], kSphereGeometry);
    EXPECT_FLOAT_EQ(found.distance[i], 2e25f);
  }
}

}  // namespace
}  // namespace raytree
