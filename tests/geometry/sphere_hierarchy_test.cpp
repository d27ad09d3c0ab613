// Bounding spheres: where a ray lies in one, spheres about things, and a hierarchy that loses nothing.
#include "geometry/sphere_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "geometry/ray_batch.h"
#include "tests/geometry/reference_shapes.h"

namespace raytree {
namespace {

using test::Random;

TEST(BoundingSphere, HoldsWhatIsInsideAndHardlyMore) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::exp(random.uniform(-20, 20));
    const BoundingSphere sphere{random.in_cube(scale), random.uniform(0, scale)};
    const Vec3d from = random.in_cube(scale * std::exp(random.uniform(0, 12)));
    // At a place on the sphere itself, some of them where the ray only touches it.
    const Vec3d radius = random.direction() * sphere.radius, place = sphere.center + radius;
    const Vec3d direction = (place - from) * random.uniform(0.1, 10);
    const double at = (place - from).length() / direction.length();
    const RayInterval interval = sphere.inside(SphereRay(from, direction));
    ASSERT_FALSE(interval.empty());
    // A place is rounded to half an ulp of its coordinates.
    const double slack = 0x1p-52 * (place.length() + from.length()) / direction.length();
    EXPECT_LE(interval.enter, at + slack);
    EXPECT_GE(interval.leave, at - slack);
    // A thousandth of the radius beside it.
    const SphereRay passing(sphere.center + radius * 1.001, radius.cross(random.direction()));
    if (sphere.radius > 1e-9 * sphere.center.length()) {
      EXPECT_TRUE(sphere.inside(passing).empty());
    }
  }
}

TEST(BoundingSphere, AboutPointsAndSpheres) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    std::array<Vec3d, 5> points;
    for (Vec3d& p : points) p = random.in_cube(3);
    const BoundingSphere about = sphere_about(points);
    for (const Vec3d& p : points) EXPECT_LE((p - about.center).length(), about.radius);
    const BoundingSphere a{random.in_cube(1), random.uniform(0, 2)}, b{random.in_cube(1), random.uniform(0, 2)};
    const BoundingSphere both = sphere_about(a, b);
    for (const BoundingSphere& part : {a, b})
      EXPECT_LE((part.center - both.center).length() + part.radius, both.radius * (1 + 1e-14));
    EXPECT_LE(both.radius,
              ((a.center - b.center).length() + a.radius + b.radius) / 2 * (1 + 1e-12) + std::max(a.radius, b.radius));
  }
}

std::vector<BoundingSphere> random_spheres(Random& random, std::size_t count) {
  std::vector<BoundingSphere> spheres;
  for (std::size_t i = 0; i < count; ++i)
    spheres.push_back({random.in_cube(i % 7 == 0 ? 0.01 : 10), random.uniform(0, i % 5 == 0 ? 3 : 0.1)});
  return spheres;
}

/// All objects that the search visits, with a limit that stays.
std::multiset<std::uint32_t> visited(const SphereHierarchy& hierarchy, const std::vector<BoundingSphere>& spheres,
                                     const SphereRay& ray, double limit) {
  std::multiset<std::uint32_t> result;
  hierarchy.search(spheres, ray, limit, [&](std::uint32_t object, const RayInterval&) {
    result.insert(object);
    return false;
  });
  return result;
}

TEST(SphereHierarchy, FindsWhatOneAfterTheOtherFinds) {
  Random random(3);
  for (const std::size_t count : {0u, 1u, 2u, 3u, 10u, 500u, 3000u}) {
    std::vector<BoundingSphere> spheres = random_spheres(random, count);
    if (count == 500) std::fill(spheres.begin(), spheres.begin() + 300, spheres[0]);  // nothing to divide by
    SphereHierarchy linear, hierarchy;
    hierarchy.build(spheres);
    EXPECT_EQ(hierarchy.built(), count > 0);
    EXPECT_EQ(hierarchy.memory_bytes() > 0, count > 0);
    std::size_t found = 0;
    for (int i = 0; i < 500; ++i) {
      const SphereRay ray(random.in_cube(12), random.direction() * random.uniform(0.1, 5));
      const double limit = i % 3 == 0 ? kInfinity : random.uniform(0, 20);
      const auto expected = visited(linear, spheres, ray, limit);
      EXPECT_EQ(visited(hierarchy, spheres, ray, limit), expected);
      found += expected.size();
    }
    EXPECT_EQ(found > 0, count > 0);
  }
}

TEST(SphereHierarchy, StopsWhenToldAndTriesNearSpheresFirst) {
  Random random(4);
  const std::vector<BoundingSphere> spheres = random_spheres(random, 3000);
  SphereHierarchy linear, hierarchy;
  hierarchy.build(spheres);
  std::size_t tried = 0, all = 0;
  for (int i = 0; i < 200; ++i) {
    const SphereRay ray(random.in_cube(12), random.direction());
    int visits = 0;
    const bool any =
        hierarchy.search(spheres, ray, kInfinity, [&](std::uint32_t, const RayInterval&) { return ++visits > 0; });
    EXPECT_EQ(any, visits == 1);
    double limit = kInfinity;
    hierarchy.search(spheres, ray, limit, [&](std::uint32_t, const RayInterval& interval) {
      ++tried;
      limit = std::min(limit, std::max(0.0, interval.leave));
      return false;
    });
    all += visited(linear, spheres, ray, kInfinity).size();
  }
  EXPECT_LT(tried, all / 2);
}

}  // namespace
}  // namespace raytree
