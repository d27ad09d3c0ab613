// The truth against closed forms of each kind of object, against itself searched in two ways, and against Embree on a
// scene of everything; rays that are no rays; what it says of its memory.
#include "geometry/sphere_bounded_intersector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "geometry/embree_intersector.h"
#include "geometry/faceted_quadric.h"
#include "geometry/instance_transform.h"
#include "geometry/patch_surface.h"
#include "geometry/ray_batch.h"
#include "geometry/reference_intersector.h"
#include "geometry/surface.h"
#include "geometry/tessellation.h"
#include "tests/geometry/reference_shapes.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using namespace test;

using Search = SphereBoundedOptions::Search;

ReferenceHit traced(const ShapeSet& shapes, const Vec3d& from, const Vec3d& direction, double most = kInfinity) {
  return SphereBoundedIntersector(shapes, {}).nearest(from, direction, most);
}

TEST(SphereBounded, SpheresFarAwayAndGrazing) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    ShapeSet shapes;
    const float radius = static_cast<float>(std::exp(random.uniform(-5, 5)));
    const Vec3f center(random.in_cube(10));
    add_sphere(shapes, center, radius);
    const Vec3d direction = random.direction(), side = direction.cross(random.direction()).normalized();
    const double r = radius, off = i % 2 == 0 ? random.uniform(0, 1) : 1 - std::exp(random.uniform(-20, -2));
    const double away = r * std::exp(random.uniform(1, 15));
    const Vec3d from = Vec3d(center) + side * (off * r) - direction * away;
    const double length = random.uniform(0.1, 10);
    const ReferenceHit hit = traced(shapes, from, direction * length);
    ASSERT_EQ(hit.geometry, kSphereGeometry);
    // The eye's place rounds to an ulp of the way; near the silhouette what the ray passes by is off by that over cos.
    const double cosine = std::sqrt((1 - off) * (1 + off));
    const double slack = 0x1p-50 * (away + Vec3d(center).length()) / cosine;
    EXPECT_NEAR(hit.distance * length, away - r * cosine, slack);
    const Vec3d normal = side * off - direction * cosine;
    EXPECT_LT((hit.normal - normal).length(), 4 * slack / r);
    EXPECT_FALSE(traced(shapes, from, direction, away - r * cosine - slack).hit());
    // From inside the far side is met; behind there is nothing.
    EXPECT_NEAR(traced(shapes, Vec3d(center) + side * (off * r), direction).distance, r * cosine,
                0x1p-48 * (r + 20) / cosine);
    EXPECT_FALSE(traced(shapes, from, -direction).hit());
  }
}

TEST(SphereBounded, DiscsConesCylindersAndPlanes) {
  ShapeSet shapes;
  add_disc(shapes, {0, 0, 0}, {0, 0, 1}, 2);
  EXPECT_EQ(traced(shapes, {1.999, 0, 5}, {0, 0, -2}).distance, 2.5);
  EXPECT_EQ(traced(shapes, {1.999, 0, 5}, {0, 0, -2}).normal, Vec3d(0, 0, 1));
  EXPECT_EQ(traced(shapes, {0, -1.999, -5}, {0, 0, 1}).geometry, kDiscGeometry);
  EXPECT_FALSE(traced(shapes, {2.001, 0, 5}, {0, 0, -1}).hit());
  EXPECT_FALSE(traced(shapes, {0, 0, 5}, {1, 0, 0}).hit());
  EXPECT_FALSE(traced(shapes, {-5, 0, 0}, {1, 0, 0}).hit()) << "in its plane";

  shapes = {};
  add_cone(shapes, {0, 0, 0}, 2, {0, 4, 0}, 0);
  // At height y the radius is 2 - y / 2.
  EXPECT_NEAR(traced(shapes, {10, 1, 0}, {-0.5, 0, 0}).distance, 17, 1e-13);
  EXPECT_LT((traced(shapes, {10, 1, 0}, {-1, 0, 0}).normal - Vec3d(2, 1, 0) / std::sqrt(5)).length(), 1e-14);
  EXPECT_NEAR(traced(shapes, {0, 1, 0}, {0, 0, 1}).distance, 1.5, 1e-14) << "from inside";
  EXPECT_FALSE(traced(shapes, {10, 4.001, 0}, {-1, 0, 0}).hit());
  EXPECT_FALSE(traced(shapes, {0.1, -5, 0}, {0, 1, 0}, 8).hit()) << "open at the base, up to the inside of the tip";
  EXPECT_NEAR(traced(shapes, {0.1, -5, 0}, {0, 1, 0}).distance, 8.8, 1e-13);

  shapes = {};
  add_cone(shapes, {-3, 0, 0}, 1, {3, 0, 0}, 1);
  EXPECT_NEAR(traced(shapes, {2.999, 10, 0.6}, {0, -1, 0}).distance, 9.2, 1e-13);
  EXPECT_FALSE(traced(shapes, {3.001, 10, 0.6}, {0, -1, 0}).hit());
  EXPECT_NEAR(traced(shapes, {2.5, 10, 1 - 1e-9}, {0, -1, 0}).distance, 10 - std::sqrt(2e-9), 1e-9) << "grazing";

  shapes = {};
  shapes.planes.push_back({{0, 1, 0}, {0, 1, 0}, 0});
  EXPECT_EQ(traced(shapes, {7, 3, 5}, {1, -4, 0}).distance, 0.5);
  EXPECT_EQ(traced(shapes, {7, 3, 5}, {1, -4, 0}).geometry, kPlaneGeometry);
  EXPECT_FALSE(traced(shapes, {7, 3, 5}, {1, 4, 0}).hit());
  EXPECT_FALSE(traced(shapes, {7, 3, 5}, {1, 0, 0}).hit());
  EXPECT_EQ(traced(shapes, {7, 3, 5}, {0, -1, 0}, 2).distance, 2) << "the end counts";
  EXPECT_FALSE(traced(shapes, {7, 3, 5}, {0, -1, 0}, 1.999).hit());
}

/// A concave outline with a hole, one face of 14 corners in the plane z = 1; triangles of it get the point.
TEST(SphereBounded, PolygonsAsTheyAre) {
  PolygonMesh mesh;
  for (const Vec2f& p : {Vec2f(0, 0), Vec2f(6, 0), Vec2f(6, 6), Vec2f(3, 5), Vec2f(0, 6), Vec2f(0, 0), Vec2f(2, 2),
                         Vec2f(2, 4), Vec2f(4, 4), Vec2f(4, 2), Vec2f(2, 2)})
    mesh.positions.push_back({p.x, p.y, 1});
  for (std::uint32_t i = 0; i < 11; ++i) mesh.corners.push_back(i == 5 ? 0 : i == 10 ? 6 : i);
  mesh.face_sizes.push_back(11);
  const ShapeSet shapes = polygon_shapes(mesh);
  const SphereBoundedIntersector tracer(shapes, {});
  EXPECT_EQ(tracer.object_count(), 1u);
  const TriangleMesh& triangles = shapes.meshes[0].mesh;
  int inside = 0;
  for (double x = -0.45; x < 6.5; x += 0.1)
    for (double y = -0.45; y < 6.5; y += 0.1) {
      const bool expected =
          x > 0 && x < 6 && y > 0 && y < 6 - (x < 3 ? x : 6 - x) / 3 && !(x > 2 && x < 4 && y > 2 && y < 4);
      const Vec3d direction(0.3, -0.2, -0.5);
      const ReferenceHit hit = tracer.nearest(Vec3d(x, y, 1) - direction * 7.0, direction, kInfinity);
      ASSERT_EQ(hit.hit(), expected) << x << " " << y;
      if (!expected) continue;
      ++inside;
      EXPECT_NEAR(hit.distance, 7, 1e-13);
      EXPECT_EQ(hit.normal, Vec3d(0, 0, 1));
      EXPECT_EQ(hit.face, 0u);
      ASSERT_LT(hit.primitive, triangles.triangle_count());
      const std::uint32_t* corner = &triangles.corners[3 * std::size_t(hit.primitive)];
      const Vec3d at = Vec3d(triangles.positions[corner[0]]) * (1 - hit.u - hit.v) +
                       Vec3d(triangles.positions[corner[1]]) * hit.u + Vec3d(triangles.positions[corner[2]]) * hit.v;
      EXPECT_LT((at - Vec3d(x, y, 1)).length(), 1e-12);
      EXPECT_GT(std::min({hit.u, hit.v, 1 - hit.u - hit.v}), -1e-12);
    }
  EXPECT_GT(inside, 2000);
}

/// The plane of Newell's normal through the mean of the corners, seen within the outline; depth never leaves that of
/// the corners, even seen along the plane.
TEST(SphereBounded, PolygonsThatAreNotFlatArePlanesWithinTheirOutline) {
  PolygonMesh mesh;
  mesh.positions = {Vec3f(0, 0, 0), Vec3f(1, 0, 0.2f), Vec3f(1, 1, 0), Vec3f(0, 1, 0.2f)};
  mesh.corners = {0, 1, 2, 3};
  mesh.face_sizes = {4};
  const ShapeSet shapes = polygon_shapes(mesh);
  for (const double x : {0.01, 0.5, 0.99})
    for (const double y : {0.01, 0.3, 0.99}) {
      const ReferenceHit hit = traced(shapes, {x, y, 5}, {0, 0, -1});
      ASSERT_TRUE(hit.hit());
      EXPECT_NEAR(hit.distance, 5 - double(0.2f) / 2, 1e-14);
      EXPECT_EQ(hit.normal, Vec3d(0, 0, 1));
    }
  EXPECT_FALSE(traced(shapes, {1.01, 0.5, 5}, {0, 0, -1}).hit());
  const ReferenceHit along = traced(shapes, {0.25, -3, 0.1}, {0, 1, 0});
  ASSERT_TRUE(along.hit());
  EXPECT_GE(along.distance, 3);
  EXPECT_LE(along.distance, 4);
}

/// Everything there is: spheres, discs, cones, planes, triangles, n-gons, a curved surface, and a group with most of it
/// used five times.
ShapeSet everything(Random& random, bool planes) {
  const auto fill = [&](BoundedShapes& shapes, double reach) {
    for (int i = 0; i < 12; ++i) {
      add_sphere(shapes, Vec3f(random.in_cube(reach)), static_cast<float>(random.uniform(0.05, 0.8)));
      add_disc(shapes, Vec3f(random.in_cube(reach)), Vec3f(random.direction()),
               static_cast<float>(random.uniform(0.1, 1)));
      const Vec3d base = random.in_cube(reach);
      add_cone(shapes, Vec3f(base), static_cast<float>(random.uniform(0, 0.5)),
               Vec3f(base + random.direction() * random.uniform(0.3, 1)), static_cast<float>(random.uniform(0.1, 0.5)));
    }
    for (int i = 0; i < 6; ++i) {
      PolygonMesh mesh = i % 2 == 0 ? faceted_sphere({0, 0, 0}, random.uniform(0.2, 0.9), 12, 6) : cube_cage();
      mesh.normals = {}, mesh.normal_corners = {};
      const Vec3f shift(random.in_cube(reach));
      for (Vec3f& p : mesh.positions) p = p * 0.5f + shift;
      shapes.meshes.push_back(polygon_entry(std::move(mesh)));
    }
    PolygonMesh triangles;
    for (std::uint32_t i = 0; i < 60; ++i) {
      if (i % 3 == 0)
        triangles.positions.push_back(Vec3f(random.in_cube(reach)));
      else
        triangles.positions.push_back(triangles.positions.back() + Vec3f(random.in_cube(1)));
      triangles.corners.push_back(i);
    }
    shapes.meshes.push_back(polygon_entry(std::move(triangles)));
  };
  ShapeSet shapes;
  fill(shapes, 6);
  fill(shapes.groups.emplace_back(), 1.5);
  for (int i = 0; i < 5; ++i) {
    Instance instance{};
    const Vec3d x = random.direction(), y = x.cross(random.direction()).normalized(), z = x.cross(y);
    const double scale = random.uniform(0.3, 1.5);
    const Vec3d origin = random.in_cube(6);
    for (int axis = 0; axis < 3; ++axis) {
      instance.to_scene[0][axis] = static_cast<float>(x[axis] * scale);
      instance.to_scene[1][axis] = static_cast<float>(y[axis] * scale);
      instance.to_scene[2][axis] = static_cast<float>(z[axis] * scale * (i == 3 ? -1 : 1));
      instance.to_scene[3][axis] = static_cast<float>(origin[axis]);
    }
    shapes.instances.push_back(instance);
  }
  if (planes) shapes.planes.push_back({{0, -5, 0}, Vec3d(0.1, 1, 0.05).normalized(), 0});
  return shapes;
}

/// Octants of a sphere in the tessellation of rate 4 that stands for them, the pixel a hundredth.
void add_curved_ball(ShapeSet& shapes) {
  Warnings warnings;
  const std::vector<BezierPatch> octants = sphere_patches();
  const PatchSurface surface({octants.begin(), octants.end()}, {}, {}, warnings);
  auto source = std::make_shared<MeshSource>();
  source->patches = surface.limit_patches();
  source->pixel.everywhere = 0.01;
  MeshEntry entry{tessellate(surface, uniform_rates(surface, 4), &source->parameters), 0, {}, {}, {}};
  entry.source = std::move(source);
  shapes.meshes.push_back(std::move(entry));
}

bool equal(const ReferenceHit& a, const ReferenceHit& b) {
  return a.geometry == b.geometry && a.primitive == b.primitive && a.face == b.face && a.u == b.u && a.v == b.v &&
         a.distance == b.distance && a.normal == b.normal && a.instance == b.instance;
}

TEST(SphereBounded, LinearAndHierarchyAgreeBitForBit) {
  Random random(11);
  ShapeSet shapes = everything(random, true);
  add_curved_ball(shapes);
  // Coincident objects: of equal distances the first counts.
  add_sphere(shapes, {0, 4, 0}, 1);
  add_sphere(shapes, {0, 4, 0}, 1);
  shapes.instances.push_back(shapes.instances[2]);
  const SphereBoundedIntersector linear(shapes, {Search::linear}), hierarchy(shapes, {Search::hierarchy});
  EXPECT_FALSE(linear.uses_hierarchy());
  EXPECT_TRUE(hierarchy.uses_hierarchy());
  EXPECT_EQ(SphereBoundedIntersector(shapes, {}).uses_hierarchy(), linear.object_count() > kMostLinearObjects);
  std::map<GeometryId, int> kinds;
  int in_instances = 0;
  for (int i = 0; i < 6000; ++i) {
    Vec3d from = random.in_cube(9), direction = random.direction() * random.uniform(0.2, 3);
    if (i % 5 == 0) direction = Vec3d(0, 4, 0) - from;
    if (i % 5 == 1) direction = shapes.instances[2].origin() - from;
    const double most = i % 4 == 0 ? random.uniform(0, 10) : kInfinity;
    const ReferenceHit a = linear.nearest(from, direction, most), b = hierarchy.nearest(from, direction, most);
    ASSERT_TRUE(equal(a, b)) << i << ": " << a.geometry << " " << b.geometry;
    EXPECT_EQ(linear.is_occluded(from, direction, most), a.hit());
    EXPECT_EQ(hierarchy.is_occluded(from, direction, most), a.hit());
    EXPECT_NE(a.instance, 5u) << "the first of two instances in one place counts";
    if (a.geometry == kSphereGeometry && a.instance == kNoInstance) {
      EXPECT_NE(a.primitive, 13u);
    }
    ++kinds[std::min(a.geometry, kFirstMeshGeometry)];
    in_instances += a.instance != kNoInstance;
  }
  for (GeometryId kind = 0; kind <= kFirstMeshGeometry; ++kind) EXPECT_GT(kinds[kind], 20) << kind;
  EXPECT_GT(in_instances, 100);
}

/// Hits as Embree has them: the same object at the same place, within what single precision is off by.
TEST(SphereBounded, AgreesWithEmbree) {
  Random random(12);
  const ShapeSet shapes = everything(random, true);
  const SphereBoundedIntersector truth(shapes, {});
  const EmbreeIntersector fast(shapes, {});
  RayBatch rays(1024);
  HitBatch hits(1024);
  int compared = 0, missed = 0;
  for (int batch = 0; batch < 12; ++batch) {
    rays.size = 0;
    for (int i = 0; i < 1024; ++i)
      rays.push(Vec3f(random.in_cube(9)), Vec3f(random.direction()), std::numeric_limits<float>::infinity());
    fast.intersect(rays, Coherence::incoherent, hits);
    for (std::size_t i = 0; i < rays.size; ++i) {
      const ReferenceHit hit = truth.nearest(Vec3d(rays.origin(i)), Vec3d(rays.direction(i)), kInfinity);
      if (hit.hit() != (hits.geometry[i] != kNoGeometry) ||
          (hit.hit() && (hit.geometry != hits.geometry[i] || hit.instance != hits.instance[i]))) {
        ++missed;  // an outline within rounding
        continue;
      }
      if (!hit.hit()) continue;
      // Coordinates of up to 16 in float, magnified by how flat the ray lies to the surface; instances add as much.
      const double cosine = std::abs(hit.normal.dot(Vec3d(rays.direction(i))));
      // Embree's own spheres are worst where they are far and small (catalogue of failures, row 44).
      const double tolerance = 2e-5 / std::max(cosine, 1e-3);
      if (cosine < 0.02) continue;
      EXPECT_NEAR(hit.distance, double(hits.distance[i]), tolerance)
          << "geometry " << hit.geometry << " instance " << hit.instance;
      const SurfacePoint point = surface_at(shapes, rays.origin(i), rays.direction(i), hits[i], false);
      EXPECT_LT((hit.normal - Vec3d(point.geometric_normal)).length(), 2e-3 / cosine);
      ++compared;
    }
  }
  EXPECT_GT(compared, 6000);
  EXPECT_LE(missed, 2);
}

/// The facet that stands for a hit holds its parameters: at them the surface has the hit's place and normal.
TEST(SphereBounded, CurvedSurfacesAreExactAndKnowTheirFacet) {
  ShapeSet shapes;
  add_curved_ball(shapes);
  const SphereBoundedIntersector tracer(shapes, {});
  const MeshEntry& entry = shapes.meshes[0];
  Random random(13);
  int exact = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d toward = random.direction() * 0.9, from = random.direction() * 4.0, direction = (toward - from) / 2;
    const ReferenceHit hit = tracer.nearest(from, direction, kInfinity);
    ASSERT_TRUE(hit.hit());
    const Vec3d place = from + direction * hit.distance;
    // Where Newton's iteration found the crossing; else within two spheres of a quarter of a pixel.
    EXPECT_LT(std::abs(place.length() - 1), 2 * 0.0025);
    exact += std::abs(place.length() - 1) < 1e-10;
    EXPECT_LT((hit.normal - place.normalized()).length(), 0.01);
    ASSERT_LT(hit.primitive, entry.mesh.triangle_count());
    EXPECT_EQ(entry.source->parameters.faces[hit.primitive], hit.face);
    EXPECT_GE(std::min({hit.u, hit.v, 1 - hit.u - hit.v}), -1e-12);
    const std::uint32_t* corner = &entry.mesh.corners[3 * std::size_t(hit.primitive)];
    const Vec3d on_facet = Vec3d(entry.mesh.positions[corner[0]]) * (1 - hit.u - hit.v) +
                           Vec3d(entry.mesh.positions[corner[1]]) * hit.u +
                           Vec3d(entry.mesh.positions[corner[2]]) * hit.v;
    // A quarter circle in 4 segments, pi / 8 long: parameters run unevenly over them, by less than a third.
    EXPECT_LT((on_facet - place).length(), 0.13);
  }
  EXPECT_GT(exact, 1990);
}

TEST(SphereBounded, RaysThatAreNoRaysMiss) {
  Random random(14);
  const ShapeSet shapes = everything(random, true);
  const SphereBoundedIntersector tracer(shapes, {});
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kFar = std::numeric_limits<float>::infinity();
  RayBatch rays(8);
  HitBatch hits(8);
  rays.push({kNan, 0, 0}, {0, 0, 1}, kFar);
  rays.push({0, 0, 0}, {0, kNan, 1}, kFar);
  rays.push({0, 0, 0}, {0, 0, 0}, kFar);
  rays.push({0, kFar, 0}, {0, 0, 1}, kFar);
  rays.push({0, 0, 0}, {0, -1, 0}, kNan);
  rays.push({0, 0, 0}, {0, -1, 0}, -1);
  rays.push({0, 0, 0}, {0, -1, 0}, kFar);
  std::uint8_t occluded[8 + kBatchPadding];
  tracer.intersect(rays, Coherence::mixed, hits);
  tracer.occluded(rays, Coherence::mixed, occluded);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(hits.geometry[i], kNoGeometry) << i;
    EXPECT_EQ(occluded[i], 0) << i;
  }
  EXPECT_NE(hits.geometry[6], kNoGeometry);
  EXPECT_EQ(occluded[6], 1);
  // An empty scene is no error.
  const ShapeSet none;
  for (const Search search : {Search::linear, Search::hierarchy})
    EXPECT_FALSE(SphereBoundedIntersector(none, {search}).nearest({0, 0, 0}, {0, 0, 1}, kInfinity).hit());
}

TEST(SphereBounded, MemoryIsWhatItHolds) {
  PolygonMesh mesh = faceted_sphere({0, 0, 0}, 1, 200, 100);
  mesh.normals = {}, mesh.normal_corners = {};
  const ShapeSet shapes = polygon_shapes(std::move(mesh));
  const SphereBoundedIntersector linear(shapes, {Search::linear}), hierarchy(shapes, {Search::hierarchy});
  const std::size_t objects = linear.object_count();
  EXPECT_EQ(objects, 20000u);
  // A sphere of four doubles, two numbers, and the first triangle of each n-gon.
  EXPECT_NEAR(double(linear.memory_bytes()), double(objects) * (32 + 8 + 4), 0.05 * double(objects) * 44);
  EXPECT_GT(hierarchy.memory_bytes(), linear.memory_bytes() + objects * 20);
  EXPECT_LT(hierarchy.memory_bytes(), linear.memory_bytes() + objects * 60);
  EXPECT_GT(hierarchy.peak_memory_bytes(), hierarchy.memory_bytes());
  EXPECT_GE(linear.peak_memory_bytes(), linear.memory_bytes());
}

TEST(ReferenceIntersector, PutsATracerBehindTheSeam) {
  Random random(15);
  const ShapeSet shapes = everything(random, true);
  const SphereBoundedIntersector tracer(shapes, {});
  const ReferenceIntersector adapted(std::make_unique<SphereBoundedIntersector>(shapes, SphereBoundedOptions{}));
  EXPECT_EQ(adapted.memory_bytes(), tracer.memory_bytes());
  RayBatch rays(200);
  HitBatch hits(200), same(200);
  for (int i = 0; i < 200; ++i)
    rays.push(Vec3f(random.in_cube(9)), Vec3f(random.direction()), static_cast<float>(random.uniform(1, 30)));
  std::uint8_t occluded[200 + kBatchPadding];
  adapted.intersect(rays, Coherence::mixed, hits);
  adapted.occluded(rays, Coherence::coherent, occluded);
  tracer.intersect(rays, Coherence::coherent, same);
  for (std::size_t i = 0; i < rays.size; ++i) {
    const ReferenceHit hit =
        tracer.nearest(Vec3d(rays.origin(i)), Vec3d(rays.direction(i)), double(rays.max_distance[i]));
    EXPECT_EQ(hits.geometry[i], hit.geometry);
    EXPECT_EQ(same.geometry[i], hit.geometry);
    EXPECT_EQ(occluded[i], hit.hit());
    EXPECT_EQ(hits.distance[i], hit.hit() ? static_cast<float>(hit.distance) : rays.max_distance[i]);
    if (hit.hit()) {
      EXPECT_EQ(hits.primitive[i], hit.primitive);
    }
    EXPECT_EQ(hits.instance[i], hit.instance);
  }
}

}  // namespace
}  // namespace raytree
