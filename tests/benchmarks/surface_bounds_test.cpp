// The bounds that excuse disagreements hold for the tracer that they are made for, and are not so wide that they would
// excuse anything.
#include "benchmarks/surface_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "benchmarks/ray_comparison.h"
#include "geometry/embree_intersector.h"
#include "geometry/instance_transform.h"
#include "geometry/triangle_reference.h"

namespace raytree::benchmarks {
namespace {

class RandomFloats {
 public:
  explicit RandomFloats(unsigned seed) : generator_(seed) {}
  float uniform(float least, float most) { return std::uniform_real_distribution<float>(least, most)(generator_); }
  Vec3f in_box(float half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937 generator_;
};

/// One shape, asked by rays that run at it, near it and low over it: what Embree says lies within the bounds, and how
/// much of them it ever takes.
struct Use {
  double distance = 0;  ///< largest error over its bound
  int hits = 0, agreed = 0, edges = 0, defects = 0;
};

template <class Aim>
Use use_of_bounds(const ShapeSet& shapes, int rays, unsigned seed, Aim&& aim, bool plain = false) {
  EmbreeOptions options;
  options.threads = 1, options.robust = !plain;
  const EmbreeIntersector tracer(shapes, options);
  const TriangleReference truth(shapes);
  RayJudge judge(shapes, tracer, shapes, truth);
  if (plain) judge.set_arithmetic({FastArithmetic::Triangles::plain});
  RandomFloats random(seed);
  Use use;
  for (int i = 0; i < rays; ++i) {
    ComparedRay ray;
    ray.origin = random.in_box(10);
    ray.direction = (aim(random) - ray.origin).normalized();
    ray.max_distance = kInfinity;
    const Hit hit = judge.ask_tracer(ray);
    const ReferenceHit found = judge.ask_truth(ray);
    const RayComparison comparison = judge.nearest(ray, hit, found);
    use.hits += found.hit();
    use.agreed += found.hit() && comparison.verdict == RayVerdict::agree;
    use.edges += comparison.verdict == RayVerdict::edge;
    use.defects += comparison.verdict == RayVerdict::defect;
    if (comparison.verdict == RayVerdict::agree && found.hit() && comparison.distance_error > 0)
      use.distance = std::max(use.distance, std::abs(hit.distance - found.distance) / comparison.distance_error);
  }
  return use;
}

ShapeSet one_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  ShapeSet shapes;
  MeshEntry entry;
  for (const Vec3f& p : {a, b, c}) entry.mesh.positions.push_back(p);
  for (const std::uint32_t i : {0u, 1u, 2u}) entry.mesh.corners.push_back(i);
  shapes.meshes.push_back(std::move(entry));
  return shapes;
}

void expect_triangles_within_bounds(bool plain) {
  RandomFloats random(5);
  double largest = 0;
  int hits = 0, agreed = 0;
  for (int t = 0; t < 60; ++t) {
    const float size = std::pow(10.0f, random.uniform(-3, 1)), thin = std::pow(10.0f, random.uniform(-4, 0));
    const Vec3f a = random.in_box(3), along = random.in_box(1).normalized() * size;
    const Vec3f b = a + along, c = a + along * 0.4f + random.in_box(1).normalized() * (size * thin);
    const ShapeSet shapes = one_triangle(a, b, c);
    const Use use = use_of_bounds(
        shapes, 500, 100 + t,
        [&](RandomFloats& r) {
          const float u = r.uniform(-0.1f, 1.1f), v = r.uniform(-0.1f, 1.1f) * (1 - u);
          return a + (b - a) * u + (c - a) * v;
        },
        plain);
    EXPECT_EQ(use.defects, 0) << "triangle " << t;
    largest = std::max(largest, use.distance);
    // Rays come from up to 25 units away, where single precision resolves 2e-6: thinner triangles are all edge.
    if (size * thin > 1e-4f) hits += use.hits, agreed += use.agreed;
  }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.01);  // a bound a hundred times too wide would excuse too much
  EXPECT_GT(agreed, hits * 0.98);
}

TEST(SurfaceBounds, TrianglesKeepWithinThem) { expect_triangles_within_bounds(false); }
TEST(SurfaceBounds, TrianglesWithoutWatertightEdgesKeepWithinTheirs) { expect_triangles_within_bounds(true); }

TEST(SurfaceBounds, RoundShapesKeepWithinThem) {
  for (const bool many : {false, true}) {  // few are tested beside Embree
    ShapeSet shapes;
    RandomFloats random(6);
    for (std::size_t i = 0; i < (many ? kMostFewShapes + 10 : 3); ++i) {
      const Vec3f p = random.in_box(5), q = random.in_box(5), n = random.in_box(1).normalized();
      shapes.spheres.center_radius.push_back({p.x, p.y, p.z, random.uniform(0.01f, 1)});
      shapes.spheres.shape.push_back(0);
      shapes.discs.center_radius.push_back({q.x, q.y, q.z, random.uniform(0.01f, 1)});
      shapes.discs.normal.push_back(n);
      shapes.discs.shape.push_back(0);
      shapes.cones.base_radius.push_back({p.x, q.y, p.z, random.uniform(0.1f, 0.5f)});
      shapes.cones.apex_radius.push_back({p.x, q.y + 1, q.z, random.uniform(0.1f, 0.5f)});
      shapes.cones.shape.push_back(0);
    }
    const auto count = shapes.spheres.center_radius.size();
    const Use use = use_of_bounds(shapes, 20000, 7, [&](RandomFloats& r) {
      const auto i = static_cast<std::size_t>(r.uniform(0, static_cast<float>(count) - 0.5f));
      const Imath::V4f& round =
          r.uniform(0, 1) < 0.5f ? shapes.spheres.center_radius[i] : shapes.discs.center_radius[i];
      return Vec3f(round.x, round.y, round.z) + r.in_box(1).normalized() * (round.w * r.uniform(0, 1.05f));
    });
    EXPECT_EQ(use.defects, 0) << many;
    EXPECT_LE(use.distance, 1) << many;
    EXPECT_GT(use.agreed, use.hits * 0.99) << many;
    EXPECT_GT(use.hits, 5000) << many;
  }
}

/// Turned any way, scaled alike in all directions, mirrored half the time.
Instance random_similarity(RandomFloats& random) {
  const Vec3f x = random.in_box(1).normalized(), y = x.cross(random.in_box(1)).normalized(), z = x.cross(y);
  const float scale = std::pow(10.0f, random.uniform(-1, 0.5f)), side = random.uniform(-1, 1) < 0 ? -1.0f : 1.0f;
  const Vec3f rows[4] = {x * scale, y * scale, z * (side * scale), random.in_box(6)};
  Instance instance;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column) instance.to_scene[row][column] = rows[row][column];
  return instance;
}

/// Of an instance the ray is off, by what its single-precision inverse is off: cones, cylinders and tips.
TEST(SurfaceBounds, ConesInInstancesKeepWithinThem) {
  RandomFloats random(8);
  double largest = 0;
  int hits = 0, agreed = 0, edges = 0;
  for (int i = 0; i < 60; ++i) {
    ShapeSet shapes;
    const Vec3f base = random.in_box(2), apex = base + random.in_box(1).normalized() * random.uniform(0.2f, 3);
    const float radius = random.uniform(0.05f, 1);
    const float end = i % 3 == 0 ? 0 : i % 3 == 1 ? radius : random.uniform(0.05f, 1);
    shapes.groups.emplace_back();
    shapes.groups[0].cones.base_radius.push_back({base.x, base.y, base.z, radius});
    shapes.groups[0].cones.apex_radius.push_back({apex.x, apex.y, apex.z, end});
    shapes.groups[0].cones.shape.push_back(0);
    shapes.instances.push_back(random_similarity(random));
    const InstanceTransform transform(shapes.instances[0]);
    const Use use = use_of_bounds(shapes, 1000, 300 + i, [&](RandomFloats& r) {
      const float along = r.uniform(-0.05f, 1.05f);
      const Vec3f across = (apex - base).cross(r.in_box(1)).normalized();
      const Vec3f at =
          base + (apex - base) * along + across * ((radius + (end - radius) * along) * r.uniform(0, 1.05f));
      return Vec3f(transform.point(Vec3d(at)));
    });
    EXPECT_EQ(use.defects, 0) << i;
    EXPECT_LE(use.distance, 1) << i;
    largest = std::max(largest, use.distance);
    hits += use.hits, agreed += use.agreed, edges += use.edges;
  }
  EXPECT_GT(largest, 0.05);  // a bound twenty times too wide would excuse too much
  EXPECT_GT(hits, 20000);
  EXPECT_GT(agreed, hits * 0.99);
  EXPECT_LT(edges, hits * 0.01);
}

/// A cylinder of radius 1 and height 4, seen from 10 units away through an instance that moves nothing: what passes it
/// by a millionth does so for certain, what passes by less than single precision tells may go either way.
TEST(SurfaceBounds, AConeInAnInstanceHasAnOutlineAsWideAsItsRayIsOff) {
  ShapeSet shapes;
  shapes.groups.emplace_back();
  shapes.groups[0].cones.base_radius.push_back({0, 0, 0, 1});
  shapes.groups[0].cones.apex_radius.push_back({0, 4, 0, 1});
  shapes.groups[0].cones.shape.push_back(0);
  Instance instance{};
  for (int i = 0; i < 3; ++i) instance.to_scene[i][i] = 1;
  shapes.instances.push_back(instance);
  const auto bounds = [&](float y, float z) {
    return surface_bounds(shapes, {-10, y, z}, {1, 0, 0}, {kConeGeometry, 0, 0}, 9);
  };
  using Side = SurfaceBounds::Side;
  EXPECT_EQ(bounds(1, 0).side, Side::inside);
  EXPECT_DOUBLE_EQ(bounds(1, 0).distance, 9);
  EXPECT_GT(bounds(1, 0).distance_error, 0x1p-23 * 9);
  EXPECT_LT(bounds(1, 0).distance_error, 0x1p-18 * 9);
  EXPECT_EQ(bounds(1, 1 - 1e-4f).side, Side::inside);
  EXPECT_EQ(bounds(1, 1).side, Side::uncertain);
  EXPECT_EQ(bounds(1, 1 + 1e-4f).side, Side::outside);
  EXPECT_EQ(bounds(4 - 1e-4f, 0.5f).side, Side::inside);
  EXPECT_EQ(bounds(4, 0.5f).side, Side::uncertain);
  EXPECT_EQ(bounds(4 + 1e-4f, 0.5f).side, Side::outside);
  // Near the silhouette the distance is off by the root of what the ray is.
  EXPECT_GT(bounds(1, 1 - 1e-4f).distance_error, 10 * bounds(1, 0).distance_error);
  // Passed by, by less than rounding: a hit is an edge, but only where the ray comes that near.
  const SurfaceBounds passed = bounds(1, std::nextafter(1.0f, 2.0f));
  EXPECT_EQ(passed.side, Side::uncertain);
  EXPECT_NEAR(passed.distance, 10, 1e-3);
  EXPECT_LT(passed.distance_error, 0.02);
}

TEST(SurfaceBounds, AShapeThatIsPassedByIsOutside) {
  const ShapeSet shapes = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const SurfaceId id{kFirstMeshGeometry, 0, kNoInstance};
  const auto side = [&](float x, float y) { return surface_bounds(shapes, {x, y, 5}, {0, 0, -1}, id, 5).side; };
  using Side = SurfaceBounds::Side;
  EXPECT_EQ(side(0.3f, 0.3f), Side::inside);
  EXPECT_EQ(side(0.6f, 0.6f), Side::outside);
  EXPECT_EQ(side(0.5f, 0.5f), Side::uncertain);
  EXPECT_EQ(side(0, 0), Side::uncertain);
  // 1e-5 from an edge, seen from 5 units: an error in single precision is a fortieth of that.
  EXPECT_EQ(side(0.3f, 1e-4f), Side::inside);
  EXPECT_EQ(side(0.3f, -1e-4f), Side::outside);
  const SurfaceBounds level = surface_bounds(shapes, {-5, 0.3f, 0}, {1, 0, 0}, id, 5);
  EXPECT_TRUE(level.grazing);
}

}  // namespace
}  // namespace raytree::benchmarks
