// The fast tracer against closed forms in double, and against itself: batches of every size, both coherences, every
// build option; rays that are no rays.
#include "geometry/embree_intersector.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/error.h"
#include "geometry/ray_batch.h"
#include "geometry/surface.h"
#include "tests/random.h"

namespace raytree {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using test::Random;

void add_triangle(ShapeSet& shapes, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  if (shapes.meshes.empty()) shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh;
  for (const Vec3f& p : {a, b, c}) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(p);
  }
}
void add_sphere(ShapeSet& shapes, const Vec3f& center, float radius) {
  shapes.spheres.center_radius.push_back({center.x, center.y, center.z, radius});
  shapes.spheres.shape.push_back(0);
}
void add_disc(ShapeSet& shapes, const Vec3f& center, const Vec3f& normal, float radius) {
  shapes.discs.center_radius.push_back({center.x, center.y, center.z, radius});
  shapes.discs.normal.push_back(normal);
  shapes.discs.shape.push_back(0);
}

/// Spheres, discs, triangles and planes in a cube of ten units.
ShapeSet random_shapes(Random& random, int count, bool planes) {
  ShapeSet shapes;
  for (int i = 0; i < count; ++i) {
    add_sphere(shapes, Vec3f(random.in_cube(10)), static_cast<float>(random.uniform(0.05, 1)));
    add_disc(shapes, Vec3f(random.in_cube(10)), Vec3f(random.direction()),
             static_cast<float>(random.uniform(0.1, 1.5)));
    const Vec3d a = random.in_cube(10);
    add_triangle(shapes, Vec3f(a), Vec3f(a + random.in_cube(1.5)), Vec3f(a + random.in_cube(1.5)));
  }
  if (planes) {
    shapes.planes.push_back({{0, -9, 0}, {0, 1, 0}, 0});
    shapes.planes.push_back({{0, 0, -15}, unit(Vec3d(0.1, -0.2, 1)), 0});
  }
  return shapes;
}

void fill_with_random_rays(RayBatch& rays, std::size_t count, Random& random) {
  rays.size = 0;
  for (std::size_t i = 0; i < count; ++i)
    rays.push(Vec3f(random.in_cube(12)), Vec3f(random.direction()),
              random.uniform(0, 1) < 0.3 ? static_cast<float>(random.uniform(0, 12)) : kInfinity);
}

TEST(EmbreeIntersector, MeetsASphereWhereTheQuadraticSays) {
  Random random(1);
  ShapeSet shapes;
  const Vec3d center(1, 2, 3);
  const double radius = 1.5;
  add_sphere(shapes, Vec3f(center), static_cast<float>(radius));
  const EmbreeIntersector intersector(shapes, {});
  int hits = 0, inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f origin(center + random.in_cube(4));
    const Vec3f direction(random.direction());
    const Vec3d o(origin), d = unit(Vec3d(direction));
    const double b = (o - center).dot(d), c = (o - center).dot(o - center) - radius * radius, q = b * b - c;
    if (std::abs(q) < 1e-4 || std::abs(c) < 1e-4) continue;  // tangents, and origins on the surface
    const double expected = q < 0 ? -1 : -b - std::sqrt(q) > 0 ? -b - std::sqrt(q) : -b + std::sqrt(q);
    const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
    ASSERT_EQ(hit.geometry == kSphereGeometry, expected > 0);
    EXPECT_EQ(intersector.occluded_one(origin, direction, kInfinity), expected > 0);
    if (expected <= 0) continue;
    ++hits;
    inside += c < 0;
    // d(t) = d(q) / (2 sqrt q): a few roundings of squares of about 50 under the root.
    EXPECT_NEAR(hit.distance, expected, 16 * kRoundoff * (std::abs(expected) + 50 / std::sqrt(q)));
    // The surface is solved again in double: exact but for the roundings of the float it is given in.
    const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
    const Vec3d exact = o + d * expected;
    EXPECT_LT((Vec3d(point.position) - exact).length(), 8 * kRoundoff);
    EXPECT_LT((Vec3d(point.geometric_normal) - (exact - center) / radius).length(), 4 * kRoundoff);
    EXPECT_NEAR(point.distance, expected, 2 * kRoundoff * expected);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(inside, 300);
}

TEST(EmbreeIntersector, MeetsTrianglesDiscsAndPlanesWhereTheClosedFormsSay) {
  Random random(2);
  const Vec3d a(-1, 0.5, 0.25), b(2, 0, 0.5), c(0, 2, -0.5), disc_normal = unit(Vec3d(0.3, 0.2, 1)),
                                                             disc_center(0.5, 0.25, -0.5);
  const Vec3f disc_normal_f(disc_normal);
  ShapeSet triangle, disc, plane;
  add_triangle(triangle, Vec3f(a), Vec3f(b), Vec3f(c));
  add_disc(disc, Vec3f(disc_center), disc_normal_f, 1.25f);
  plane.planes.push_back({disc_center, disc_normal, 0});
  const EmbreeIntersector on_triangle(triangle, {}), on_disc(disc, {}), on_plane(plane, {});
  int hits[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const Vec3f origin(random.in_cube(3)), direction(random.direction());
    const Vec3d o(origin), d(direction);
    const auto along = [&](const Vec3d& through, const Vec3d& normal) {
      return (through - o).dot(normal) / d.dot(normal);
    };
    {
      const Vec3d normal = (b - a).cross(c - a);
      const double t = along(a, normal);
      const Vec3d p = o + d * t;
      const double u = (p - a).cross(c - a).dot(normal) / normal.dot(normal),
                   v = (b - a).cross(p - a).dot(normal) / normal.dot(normal);
      const double edge = std::min(std::min(u, v), 1 - u - v);
      if (std::abs(edge) > 1e-4 && std::abs(t) > 1e-3 && std::abs(d.dot(unit(normal))) > 1e-2) {
        const Hit hit = on_triangle.intersect_one(origin, direction, kInfinity);
        ASSERT_EQ(hit.geometry == kFirstMeshGeometry, t > 0 && edge > 0);
        if (hit.geometry != kNoGeometry) {
          ++hits[0];
          EXPECT_NEAR(hit.distance, t, 32 * kRoundoff * (1 + t) / std::abs(d.dot(unit(normal))));
          EXPECT_NEAR(hit.u, u, 1e-4);
          EXPECT_NEAR(hit.v, v, 1e-4);
          const SurfacePoint point = surface_at(triangle, origin, direction, hit, false);
          // Off the plane by at most 12 ulp of the coordinates, whatever the angle.
          EXPECT_LT(std::abs((Vec3d(point.position) - a).dot(unit(normal))), 12 * 2 * kRoundoff * 2);
          EXPECT_LT((Vec3d(point.geometric_normal) - unit(normal)).length(), 8 * kRoundoff);
        }
      }
    }
    {
      const double t = along(disc_center, Vec3d(disc_normal_f));
      const double r = (o + d * t - disc_center).length();
      if (std::abs(r - 1.25) > 1e-4 && std::abs(t) > 1e-3 && std::abs(d.dot(disc_normal)) > 1e-2) {
        const Hit hit = on_disc.intersect_one(origin, direction, kInfinity);
        ASSERT_EQ(hit.geometry == kDiscGeometry, t > 0 && r < 1.25);
        if (hit.geometry != kNoGeometry) {
          ++hits[1];
          const SurfacePoint point = surface_at(disc, origin, direction, hit, false);
          EXPECT_NEAR(point.distance, t, 4 * kRoundoff * t);
          EXPECT_LT((Vec3d(point.position) - (o + d * t)).length(), 4 * 2 * kRoundoff);
        }
      }
    }
    {
      const double t = along(disc_center, disc_normal);
      const Hit hit = on_plane.intersect_one(origin, direction, kInfinity);
      ASSERT_EQ(hit.geometry == kPlaneGeometry, t > 0);
      if (hit.geometry != kNoGeometry) {
        ++hits[2];
        EXPECT_NEAR(hit.distance, t, 2 * kRoundoff * t);
      }
    }
  }
  for (const int count : hits) EXPECT_GT(count, 300);
}

TEST(EmbreeIntersector, CoherentAndIncoherentCallsAgreeInHitAndMiss) {
  Random random(4);
  for (const bool planes : {false, true}) {
    const ShapeSet shapes = random_shapes(random, 200, planes);
    const EmbreeIntersector intersector(shapes, {});
    RayBatch rays(1024);
    HitBatch a(1024), b(1024);
    std::vector<std::uint8_t> blocked(1024 + kBatchPadding), coherently_blocked(1024 + kBatchPadding);
    int hits = 0, misses = 0;
    for (int round = 0; round < 20; ++round) {
      fill_with_random_rays(rays, 1024, random);
      intersector.intersect(rays, Coherence::coherent, a);
      intersector.intersect(rays, Coherence::incoherent, b);
      intersector.occluded(rays, Coherence::incoherent, blocked.data());
      intersector.occluded(rays, Coherence::coherent, coherently_blocked.data());
      for (std::size_t i = 0; i < 1024; ++i) {
        ASSERT_EQ(a[i].geometry, b[i].geometry);
        ASSERT_EQ(blocked[i] != 0, b[i].geometry != kNoGeometry);
        ASSERT_EQ(coherently_blocked[i], blocked[i]);
        const Hit one = intersector.intersect_one(rays.origin(i), rays.direction(i), rays.max_distance[i]);
        ASSERT_EQ(one.geometry, b[i].geometry);
        if (one.geometry == kNoGeometry) {
          ++misses;
          continue;
        }
        ++hits;
        ASSERT_EQ(a[i].primitive, b[i].primitive);
        // On triangles incoherent packets equal single rays bit for bit. On spheres and discs Embree's packets and
        // single rays differ by an ulp or two of the distance; the surface, solved again in double, is the same.
        if (one.geometry >= kFirstMeshGeometry) {
          EXPECT_EQ(one.distance, b[i].distance);
          EXPECT_EQ(one.u, b[i].u);
          EXPECT_EQ(one.v, b[i].v);
        }
        EXPECT_NEAR(one.distance, b[i].distance, 1e-5);
        EXPECT_EQ(surface_at(shapes, rays.origin(i), rays.direction(i), one, false).position,
                  surface_at(shapes, rays.origin(i), rays.direction(i), b[i], false).position);
        EXPECT_NEAR(a[i].distance, one.distance, 1e-4);
        ASSERT_LT(one.distance, rays.max_distance[i]);
        // Occlusion means a hit before the end: with the end drawn in before the hit there is none.
        if (i % 16 == 0) {
          EXPECT_FALSE(intersector.occluded_one(rays.origin(i), rays.direction(i), one.distance * 0.999f - 1e-4f));
          EXPECT_TRUE(intersector.occluded_one(rays.origin(i), rays.direction(i), one.distance * 1.001f + 1e-4f));
        }
      }
    }
    EXPECT_GT(hits, 5000);
    EXPECT_GT(misses, 500);
  }
}

/// Packets that miss all bounds are not traced: none of them may have hit. Rays along, just inside and just outside the
/// borders of a flat mesh and of a box, at several sizes and distances, eight alike so that whole packets are left out.
TEST(EmbreeIntersector, LeavesOutNoPacketThatWouldHit) {
  Random random(21);
  int hits = 0, misses = 0;
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double shift : {0.0, 10.0, 1e4})
      for (const bool flat : {true, false}) {
        const Vec3d center = random.direction() * (shift * size);
        ShapeSet shapes;
        const auto corner = [&](double x, double y, double z) { return Vec3f(center + Vec3d(x, y, z) * size); };
        add_triangle(shapes, corner(-1, -1, 0), corner(1, -1, 0), corner(1, 1, 0));
        add_triangle(shapes, corner(-1, -1, 0), corner(1, 1, 0), corner(-1, 1, 0));
        if (!flat) add_triangle(shapes, corner(-1, -1, -1), corner(1, -1, -1), corner(0, 0, 1));
        const EmbreeIntersector intersector(shapes, {});
        RayBatch rays(1024);
        HitBatch found(1024);
        std::vector<std::uint8_t> blocked(1024 + kBatchPadding);
        for (int round = 0; round < 4; ++round) {
          rays.size = 0;
          while (rays.size < 1024) {
            // Toward a place at the border or anywhere about, from near and far.
            const double off = 1 + random.uniform(-4, 4) * (shift + 1) * 0x1p-23;
            const double along = random.uniform(-1.5, 1.5);
            const Vec3d aim = random.uniform(0, 1) < 0.5 ? Vec3d(off, along, 0) : Vec3d(along, -off, 0);
            const Vec3d from = aim + random.direction() * random.uniform(0.01, 100);
            const Vec3f origin(center + from * size);
            const Vec3f direction(unit(center + aim * size - Vec3d(origin)));
            const float end =
                random.uniform(0, 1) < 0.3 ? static_cast<float>(random.uniform(0, 100) * size) : kInfinity;
            for (int i = 0; i < 8; ++i) rays.push(origin, direction, end);
          }
          intersector.intersect(rays, Coherence::incoherent, found);
          intersector.occluded(rays, Coherence::incoherent, blocked.data());
          for (std::size_t i = 0; i < rays.size; ++i) {
            const Hit one = intersector.intersect_one(rays.origin(i), rays.direction(i), rays.max_distance[i]);
            ASSERT_EQ(found.geometry[i], one.geometry);
            ASSERT_EQ(blocked[i] != 0, one.geometry != kNoGeometry);
            (one.geometry == kNoGeometry ? misses : hits) += 1;
          }
        }
      }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(misses, 2000);
}

TEST(EmbreeIntersector, LeavesOutEmptyScenes) {
  Random random(22);
  const ShapeSet shapes;
  const EmbreeIntersector intersector(shapes, {});
  RayBatch rays(64);
  HitBatch found(64);
  std::vector<std::uint8_t> blocked(64 + kBatchPadding, 1);
  fill_with_random_rays(rays, 64, random);
  intersector.intersect(rays, Coherence::coherent, found);
  intersector.occluded(rays, Coherence::coherent, blocked.data());
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(found.geometry[i], kNoGeometry);
    EXPECT_EQ(blocked[i], 0);
  }
}

TEST(EmbreeIntersector, BatchesOfEverySizeGiveEachRayItsOwnHit) {
  Random random(5);
  const ShapeSet shapes = random_shapes(random, 100, true);
  const EmbreeIntersector intersector(shapes, {});
  for (std::size_t size = 0; size <= 33; ++size) {
    RayBatch rays(size);
    HitBatch hits(size);
    std::vector<std::uint8_t> blocked(size + kBatchPadding, 77);
    fill_with_random_rays(rays, size, random);
    for (const Coherence coherence : {Coherence::incoherent, Coherence::coherent}) {
      intersector.intersect(rays, coherence, hits);
      intersector.occluded(rays, coherence, blocked.data());
      for (std::size_t i = 0; i < size; ++i) {
        const Hit one = intersector.intersect_one(rays.origin(i), rays.direction(i), rays.max_distance[i]);
        EXPECT_EQ(hits[i].geometry, one.geometry);
        EXPECT_EQ(blocked[i], one.geometry != kNoGeometry ? 1 : 0);
      }
    }
  }
}

TEST(EmbreeIntersector, RaysThatAreNotFiniteMissAndLeaveTheirNeighborsAlone) {
  Random random(6);
  for (const bool planes : {false, true}) {
    const ShapeSet shapes = random_shapes(random, 50, planes);
    const EmbreeIntersector intersector(shapes, {});
    // Embree's assertions end the process on the finite ones too; planes, tested beside it, bear them.
    std::vector<float> poisons{kNan, kInfinity, -kInfinity};
    if (!planes) poisons.insert(poisons.end(), {1.01f * kFarthestRay, -2e18f, 1e30f, -3e38f});
    for (const float poison : poisons)
      for (int component = 0; component < 8; ++component) {
        RayBatch rays(16), sane(16);
        HitBatch hits(16), sane_hits(16);
        std::vector<std::uint8_t> blocked(16 + kBatchPadding);
        fill_with_random_rays(rays, 16, random);
        for (std::size_t i = 0; i < 16; ++i) sane.push(rays.origin(i), rays.direction(i), rays.max_distance[i]);
        const std::size_t bad = 5;
        float* arrays[] = {rays.origin_x,    rays.origin_y,    rays.origin_z,
                           rays.direction_x, rays.direction_y, rays.direction_z};
        if (component < 6)
          arrays[component][bad] = poison;
        else if (component == 6)
          rays.direction_x[bad] = rays.direction_y[bad] = rays.direction_z[bad] = 0;
        else
          rays.max_distance[bad] = std::isnan(poison) ? poison : -1.0f;
        for (const Coherence coherence : {Coherence::incoherent, Coherence::coherent}) {
          intersector.intersect(rays, coherence, hits);
          intersector.intersect(sane, coherence, sane_hits);
          intersector.occluded(rays, coherence, blocked.data());
          EXPECT_EQ(hits.geometry[bad], kNoGeometry) << component;
          EXPECT_EQ(blocked[bad], 0) << component;
          for (std::size_t i = 0; i < 16; ++i) {
            EXPECT_TRUE(i == bad || hits.geometry[i] == sane_hits.geometry[i]);
          }
        }
        EXPECT_EQ(intersector.intersect_one(rays.origin(bad), rays.direction(bad), rays.max_distance[bad]).geometry,
                  kNoGeometry);
        EXPECT_FALSE(intersector.occluded_one(rays.origin(bad), rays.direction(bad), rays.max_distance[bad]));
      }
  }
}

TEST(EmbreeIntersector, AnEmptySceneIsMissed) {
  const ShapeSet shapes;
  const EmbreeIntersector intersector(shapes, {});
  EXPECT_EQ(intersector.intersect_one({0, 0, 0}, {0, 0, 1}, kInfinity).geometry, kNoGeometry);
  EXPECT_FALSE(intersector.occluded_one({0, 0, 0}, {0, 0, 1}, kInfinity));
  ShapeSet empty_mesh;
  empty_mesh.meshes.resize(3);
  const EmbreeIntersector over_empty(empty_mesh, {});
  EXPECT_EQ(over_empty.intersect_one({0, 0, 0}, {0, 0, 1}, kInfinity).geometry, kNoGeometry);
}

TEST(EmbreeIntersector, EveryBuildOptionFindsTheSameHits) {
  Random random(7);
  const ShapeSet shapes = random_shapes(random, 300, true);
  const EmbreeIntersector reference(shapes, {});
  EXPECT_GT(reference.memory_bytes(), 0u);
  EXPECT_GE(reference.peak_memory_bytes(), reference.memory_bytes());
  RayBatch rays(512);
  fill_with_random_rays(rays, 512, random);
  HitBatch expected(512), hits(512);
  reference.intersect(rays, Coherence::incoherent, expected);
  using Quality = EmbreeOptions::Quality;
  for (const Quality quality : {Quality::low, Quality::medium, Quality::high})
    for (const bool compact : {false, true})
      for (const bool robust : {false, true}) {
        EmbreeOptions options;
        options.quality = quality, options.compact = compact, options.robust = robust, options.threads = 1;
        const EmbreeIntersector other(shapes, options);
        other.intersect(rays, Coherence::incoherent, hits);
        for (std::size_t i = 0; i < 512; ++i) {
          ASSERT_EQ(hits[i].geometry, expected[i].geometry);
          if (hits[i].geometry == kNoGeometry) continue;
          ASSERT_EQ(hits[i].primitive, expected[i].primitive);
          EXPECT_NEAR(hits[i].distance, expected[i].distance, 1e-4);
        }
      }
}

TEST(EmbreeIntersector, HitsNameMeshesInTheirOrder) {
  ShapeSet shapes;
  shapes.meshes.resize(3);
  for (int m = 0; m < 3; ++m) {
    TriangleMesh& mesh = shapes.meshes[static_cast<std::size_t>(m)].mesh;
    const float z = static_cast<float>(-m);
    if (m == 1) continue;  // an empty mesh takes no hit and moves no other's number
    mesh.positions.assign({{-1, -1, z}, {1, -1, z}, {0, 1, z}, {5, 5, z}});
    mesh.corners.assign({1, 3, 2, 0, 1, 2});
    shapes.meshes[static_cast<std::size_t>(m)].shape = static_cast<ShapeId>(10 + m);
  }
  const EmbreeIntersector intersector(shapes, {});
  const Hit front = intersector.intersect_one({0, 0, 5}, {0, 0, -1}, kInfinity);
  EXPECT_EQ(front.geometry, kFirstMeshGeometry);
  EXPECT_EQ(front.primitive, 1u);
  EXPECT_EQ(shapes.shape_of(front.geometry, front.primitive), 10u);
  const Hit back = intersector.intersect_one({0, 0, -5}, {0, 0, 1}, kInfinity);
  EXPECT_EQ(back.geometry, kFirstMeshGeometry + 2);
  EXPECT_EQ(shapes.shape_of(back.geometry, back.primitive), 12u);
}

TEST(EmbreeIntersector, AStopEndsTheBuild) {
  Random random(8);
  const ShapeSet shapes = random_shapes(random, 2000, false);
  std::atomic<bool> stop{true};
  EmbreeOptions options;
  options.stop = &stop;
  EXPECT_THROW(EmbreeIntersector(shapes, options), Error);
}

}  // namespace
}  // namespace raytree
