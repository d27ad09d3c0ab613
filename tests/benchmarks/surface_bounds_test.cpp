// The bounds that excuse disagreements hold for the tracer that they are made for, and are not so wide that they would
// excuse anything.
#include "benchmarks/surface_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "benchmarks/ray_comparison.h"
#include "geometry/embree_intersector.h"
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
Use use_of_bounds(const ShapeSet& shapes, int rays, unsigned seed, Aim&& aim) {
  EmbreeOptions options;
  options.threads = 1;
  const EmbreeIntersector tracer(shapes, options);
  const TriangleReference truth(shapes);
  const RayJudge judge(shapes, tracer, shapes, truth);
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

TEST(SurfaceBounds, TrianglesKeepWithinThem) {
  RandomFloats random(5);
  double largest = 0;
  int hits = 0, agreed = 0;
  for (int t = 0; t < 60; ++t) {
    const float size = std::pow(10.0f, random.uniform(-3, 1)), thin = std::pow(10.0f, random.uniform(-4, 0));
    const Vec3f a = random.in_box(3), along = random.in_box(1).normalized() * size;
    const Vec3f b = a + along, c = a + along * 0.4f + random.in_box(1).normalized() * (size * thin);
    const ShapeSet shapes = one_triangle(a, b, c);
    const Use use = use_of_bounds(shapes, 500, 100 + t, [&](RandomFloats& r) {
      const float u = r.uniform(-0.1f, 1.1f), v = r.uniform(-0.1f, 1.1f) * (1 - u);
      return a + (b - a) * u + (c - a) * v;
    });
    EXPECT_EQ(use.defects, 0) << "triangle " << t;
    largest = std::max(largest, use.distance);
    // Rays come from up to 25 units away, where single precision resolves 2e-6: thinner triangles are all edge.
    if (size * thin > 1e-4f) hits += use.hits, agreed += use.agreed;
  }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.01);  // a bound a hundred times too wide would excuse too much
  EXPECT_GT(agreed, hits * 0.98);
}

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
