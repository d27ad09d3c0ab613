// No ray hits the surface it left, and nearby surfaces are still found: random triangles (slivers too), spheres, discs
// and planes of every size and place that a scene may have. kSurfaceError and kNormalError (geometry/surface.h) are
// chosen so that this holds with a margin; halving them four times makes these tests fail.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "geometry/instance_transform.h"
#include "tests/renderer/false_hits.h"

namespace raytree {
namespace {

using test::count_false_hits, test::FalseHits, test::kSettings, test::RandomRays, test::Setting;

/// Triangles with edges of about `size`, of the given least height over their longest edge.
FalseHits triangle_false_hits(const Setting& setting, double aspect, bool level, RandomRays& random) {
  const int n = 1500;
  ShapeSet shapes;
  shapes.meshes.resize(1);
  TriangleMesh& mesh = shapes.meshes[0].mesh;
  std::vector<Vec3d> inside;
  for (int i = 0; i < n; ++i) {
    // Far enough apart that a spawned ray's nearest hit is seldom another triangle.
    const Vec3d place = random.in_cube(setting.place + 30 * setting.size);
    Vec3d along = random.direction(), across = random.direction();
    if (level) along.y = across.y = 0;  // horizontal: a floor's normal has components that are exactly 0
    along = unit(along);
    across = unit(across - along * across.dot(along));
    const double apex = random.uniform(-0.2, 1.2);
    const Vec3d corners[3] = {place, place + along * setting.size,
                              place + (along * apex + across * aspect) * setting.size};
    Vec3d p[3];
    for (int c = 0; c < 3; ++c) {
      mesh.positions.push_back(Vec3f(corners[c]));
      mesh.corners.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
      p[c] = Vec3d(mesh.positions.back());
    }
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    inside.push_back(p[0] * (1 - u - v) + p[1] * u + p[2] * v);
  }
  return count_false_hits(
      shapes, n, kFirstMeshGeometry, setting.size, random, [&](int i) { return inside[static_cast<std::size_t>(i)]; },
      [](const Hit&, const SurfacePoint&, const Vec3f&, float) { return true; });
}

TEST(SelfIntersection, NoRayHitsTheTriangleItLeft) {
  RandomRays random(1);
  for (const Setting& setting : kSettings)
    for (const bool level : {false, true}) {
      const FalseHits count = triangle_false_hits(setting, 0.5, level, random);
      EXPECT_EQ(count.false_hits, 0) << "size " << setting.size << " place " << setting.place << " of " << count.left;
      // Where the size is a few ulp of the place, most aims miss.
      if (setting.size > 1e-4 * setting.place) {
        EXPECT_GT(count.left, 20000) << "size " << setting.size << " place " << setting.place;
      }
    }
}

TEST(SelfIntersection, NoRayHitsTheSliverItLeft) {
  RandomRays random(2);
  for (const double aspect : {1e-1, 1e-2, 1e-3})
    for (const Setting& setting : {Setting{1, 0}, Setting{1, 1}, Setting{1e3, 1e3}, Setting{1e-4, 0}})
      for (const bool level : {false, true}) {
        const FalseHits count = triangle_false_hits(setting, aspect, level, random);
        EXPECT_EQ(count.false_hits, 0) << "aspect " << aspect << " size " << setting.size << " place " << setting.place
                                       << " of " << count.left << (level ? " level" : "");
        EXPECT_GT(count.left, 5000);
      }
}

TEST(SelfIntersection, NoRayHitsTheSphereItLeftButForItsFarSide) {
  RandomRays random(3);
  for (const Setting& setting : kSettings) {
    if (setting.size < 1e-5 * setting.place) continue;  // not a sphere any more: its radius is a few ulp
    const int n = 1500;
    ShapeSet shapes;
    for (int i = 0; i < n; ++i) {
      const Vec3f c(random.in_cube(setting.place + 30 * setting.size));
      shapes.spheres.center_radius.push_back(
          {c.x, c.y, c.z, static_cast<float>(setting.size * random.uniform(0.1, 1))});
      shapes.spheres.shape.push_back(0);
    }
    const auto center = [&](std::size_t i) {
      const Imath::V4f& s = shapes.spheres.center_radius[i];
      return Vec3d(s.x, s.y, s.z);
    };
    const FalseHits count = count_false_hits(
        shapes, n, kSphereGeometry, setting.size, random,
        [&](int i) {
          const auto k = static_cast<std::size_t>(i);
          return center(k) + random.direction() * (random.uniform(0, 1) * shapes.spheres.center_radius[k].w);
        },
        [&](const Hit& hit, const SurfacePoint& point, const Vec3f& direction, float side) {
          if (side > 0) return true;
          const double chord = 2 * std::abs(Vec3d(direction).dot(Vec3d(point.geometric_normal))) *
                               shapes.spheres.center_radius[hit.primitive].w;
          return hit.distance < chord / 2 && chord > 4 * point.clearance;
        });
    EXPECT_EQ(count.false_hits, 0) << "size " << setting.size << " place " << setting.place << " of " << count.left;
    EXPECT_GT(count.left, 10000);
  }
}

TEST(SelfIntersection, NoRayHitsTheConeItLeft) {
  RandomRays random(6);
  for (const Setting& setting : kSettings) {
    if (setting.size < 1e-5 * setting.place) continue;
    const int n = 1500;
    ShapeSet shapes;
    std::vector<Vec3d> on_surface;
    for (int i = 0; i < n; ++i) {
      const Vec3f base(random.in_cube(setting.place + 30 * setting.size));
      const Vec3f apex(Vec3d(base) + random.direction() * (setting.size * random.uniform(0.2, 1)));
      const auto radius = [&] { return static_cast<float>(setting.size * random.uniform(0.2, 1)); };
      const float base_radius = radius();
      shapes.cones.base_radius.push_back({base.x, base.y, base.z, base_radius});
      shapes.cones.apex_radius.push_back({apex.x, apex.y, apex.z, i % 3 == 0 ? base_radius : radius()});
      shapes.cones.shape.push_back(0);
      const ConeFrame frame(shapes.cones[static_cast<std::size_t>(i)]);
      const double height = frame.length * random.uniform(0.02, 0.98);
      const Vec3d d = random.direction();
      on_surface.push_back(frame.base + frame.axis * height +
                           unit(d - frame.axis * d.dot(frame.axis)) * (frame.base_radius + frame.slope * height));
    }
    const FalseHits count = count_false_hits(
        shapes, n, kConeGeometry, setting.size, random, [&](int i) { return on_surface[static_cast<std::size_t>(i)]; },
        [&](const Hit& hit, const SurfacePoint& point, const Vec3f& direction, float side) {
          // No ray that leaves the outside comes back; from inside, a ball of the smaller radius rolls freely along the
          // wall, so the way to the other side is at least that ball's chord.
          if (side > 0) return true;
          const Cone cone = shapes.cones[hit.primitive];
          const double chord = 2 * std::abs(Vec3d(direction).dot(Vec3d(point.geometric_normal))) *
                               std::min(cone.base_radius, cone.apex_radius);
          return hit.distance < chord / 2 && chord > 4 * point.clearance;
        });
    EXPECT_EQ(count.false_hits, 0) << "size " << setting.size << " place " << setting.place << " of " << count.left;
    if (setting.size > 1e-4 * setting.place) {
      EXPECT_GT(count.left, 10000);
    }
  }
}

TEST(SelfIntersection, NoRayHitsTheDiscItLeft) {
  RandomRays random(4);
  for (const Setting& setting : kSettings)
    for (const bool level : {false, true}) {
      if (setting.size < 1e-5 * setting.place) continue;
      const int n = 1500;
      ShapeSet shapes;
      std::vector<Vec3d> inside;
      for (int i = 0; i < n; ++i) {
        const Vec3f c(random.in_cube(setting.place + 30 * setting.size)),
            normal(level ? Vec3d(0, 1, 0) : random.direction());
        const double radius = setting.size * random.uniform(0.1, 1);
        shapes.discs.center_radius.push_back({c.x, c.y, c.z, static_cast<float>(radius)});
        shapes.discs.normal.push_back(normal);
        shapes.discs.shape.push_back(0);
        const Vec3d nd = unit(Vec3d(normal)), d = random.direction();
        inside.push_back(Vec3d(c) + unit(d - nd * d.dot(nd)) * (0.99 * radius * std::sqrt(random.uniform(0, 1))));
      }
      const FalseHits count = count_false_hits(
          shapes, n, kDiscGeometry, setting.size, random, [&](int i) { return inside[static_cast<std::size_t>(i)]; },
          [](const Hit&, const SurfacePoint&, const Vec3f&, float) { return true; });
      EXPECT_EQ(count.false_hits, 0) << "size " << setting.size << " place " << setting.place << " of " << count.left;
      if (setting.size > 1e-4 * setting.place) {
        EXPECT_GT(count.left, 10000);
      }
    }
}

TEST(SelfIntersection, NoRayHitsThePlaneItLeft) {
  RandomRays random(5);
  for (const Setting& setting : kSettings) {
    FalseHits count;
    for (int i = 0; i < 200; ++i) {
      ShapeSet shapes;
      shapes.planes.push_back(
          {random.in_cube(setting.place + setting.size), i % 2 == 0 ? Vec3d(0, 1, 0) : random.direction(), 0});
      const Vec3d normal = shapes.planes[0].normal;
      Vec3d target = shapes.planes[0].point + random.in_cube(setting.size);
      target -= normal * (target - shapes.planes[0].point).dot(normal);
      const FalseHits one = count_false_hits(
          shapes, 1, kPlaneGeometry, setting.size, random, [&](int) { return target; },
          [](const Hit&, const SurfacePoint&, const Vec3f&, float) { return true; });
      count.left += one.left;
      count.false_hits += one.false_hits;
    }
    EXPECT_EQ(count.false_hits, 0) << "size " << setting.size << " place " << setting.place << " of " << count.left;
  }
}

/// Instances of triangles, spheres or discs: each group one primitive, each instance a transform that stretches,
/// shears and mirrors it and takes it to a place.
enum class Primitive { triangle, sliver, sphere, disc };
FalseHits instance_false_hits(const Setting& setting, Primitive primitive, bool level, RandomRays& random) {
  const int groups = 40, uses = 600;
  ShapeSet shapes;
  shapes.groups.resize(groups);
  std::vector<Vec3d> normals(groups);
  for (int g = 0; g < groups; ++g) {
    BoundedShapes& group = shapes.groups[static_cast<std::size_t>(g)];
    // The group's own space has a scale and a place of its own.
    const double size = std::pow(10.0, random.uniform(-2, 2));
    const Vec3d place = random.in_cube(g % 3 == 0 ? 0 : size * std::pow(10.0, random.uniform(-1, 2)));
    Vec3d along = random.direction(), across = random.direction();
    if (level) along.y = across.y = 0;
    along = unit(along);
    across = unit(across - along * across.dot(along));
    const Vec3f p(place);
    if (primitive == Primitive::triangle || primitive == Primitive::sliver) {
      group.meshes.resize(1);
      TriangleMesh& mesh = group.meshes[0].mesh;
      const double aspect = primitive == Primitive::sliver ? 0.01 : 0.6;
      mesh.positions.assign({p, Vec3f(place + along * size), Vec3f(place + (along * 0.4 + across * aspect) * size)});
      mesh.corners.assign({0, 1, 2});
    } else if (primitive == Primitive::sphere) {
      group.spheres.center_radius.push_back({p.x, p.y, p.z, static_cast<float>(size / 2)});
      group.spheres.shape.push_back(0);
    } else {
      group.discs.center_radius.push_back({p.x, p.y, p.z, static_cast<float>(size / 2)});
      group.discs.normal.push_back(Vec3f(level ? Vec3d(0, 1, 0) : along));
      group.discs.shape.push_back(0);
    }
  }
  const bool round = primitive == Primitive::sphere || primitive == Primitive::disc;
  std::vector<Vec3d> targets;
  for (int i = 0; i < uses; ++i) {
    const std::size_t g = static_cast<std::size_t>(i % groups);
    const BoundedShapes& group = shapes.groups[g];
    const TriangleMesh* mesh = round ? nullptr : &group.meshes[0].mesh;
    const Imath::V4f ball = primitive == Primitive::sphere ? group.spheres.center_radius[0]
                            : round                        ? group.discs.center_radius[0]
                                                           : Imath::V4f(0);
    const double own_size = round ? 2.0 * ball.w : (mesh->positions[1] - mesh->positions[0]).length();
    Matrix44d linear;
    linear.scale(Vec3d(setting.size / own_size));
    if (!round) {
      linear.scale(Vec3d(random.uniform(0.2, 2), random.uniform(0.2, 2), random.uniform(0.2, 2)));
      if (i % 3 == 0) linear.shear(random.in_cube(0.7));
    }
    if (i % 2 == 0) linear.scale(Vec3d(-1, 1, 1));
    Matrix44d turned;
    if (level)
      turned.rotate(Vec3d(0, random.uniform(0, 6), 0));
    else
      turned.rotate(random.in_cube(3));
    linear = linear * turned;
    // Shear and turns may have brought the normal off the vertical; where all is level only turns about y keep it.
    const Vec3d middle = round ? Vec3d(ball.x, ball.y, ball.z) : Vec3d(mesh->positions[0]);
    const Vec3d place = random.in_cube(setting.place + 30 * setting.size) - middle * linear;
    Instance instance;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) instance.to_scene[r][c] = static_cast<float>(linear[r][c]);
    for (int c = 0; c < 3; ++c) instance.to_scene[3][c] = static_cast<float>(place[c]);
    instance.group = static_cast<std::uint32_t>(g);
    shapes.instances.push_back(instance);
    const InstanceTransform transform(instance);
    if (round) {
      Vec3d d = random.direction();
      if (primitive == Primitive::disc) {
        const Vec3d n(group.discs.normal[0]);
        d = unit(d - n * d.dot(n));
      }
      targets.push_back(transform.point(middle + d * (0.99 * ball.w * std::sqrt(random.uniform(0, 1)))));
    } else {
      double u = random.uniform(0, 1), v = random.uniform(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d a(mesh->positions[0]), b(mesh->positions[1]), c(mesh->positions[2]);
      targets.push_back(transform.point(a * (1 - u - v) + b * u + c * v));
    }
  }
  const EmbreeIntersector intersector(shapes, EmbreeOptions{});
  FalseHits count;
  for (int i = 0; i < uses; ++i) {
    const Vec3d target = targets[static_cast<std::size_t>(i)];
    for (int shot = 0; shot < 3; ++shot) {
      const Vec3f origin(target + random.direction() * setting.size * std::pow(10.0, random.uniform(-1, 1.5)));
      if (Vec3d(origin) == target) continue;
      const Vec3f direction(unit(target - Vec3d(origin)));
      const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
      if (hit.instance != static_cast<InstanceId>(i)) continue;
      const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
      test::leave_to_both_sides(
          intersector, point, random, [&](const HitBatch& hits, std::size_t k, const Vec3f& leaving, float side) {
            ++count.left;
            if (hits.geometry[k] == kNoGeometry || hits.instance[k] != hit.instance) return;
            if (primitive == Primitive::sphere && side < 0) {
              const double chord = std::abs(Vec3d(leaving).dot(Vec3d(point.geometric_normal))) * setting.size;
              if (hits.distance[k] >= chord / 2 || chord <= 4 * point.clearance) return;
            }
            ++count.false_hits;
          });
    }
  }
  return count;
}

TEST(SelfIntersection, NoRayHitsTheInstanceItLeft) {
  RandomRays random(8);
  for (const Primitive primitive : {Primitive::triangle, Primitive::sliver, Primitive::sphere, Primitive::disc})
    for (const Setting& setting : kSettings) {
      if (setting.size < 1e-4 * setting.place) continue;  // a few ulp of its place
      for (const bool level : {false, true}) {
        const FalseHits count = instance_false_hits(setting, primitive, level, random);
        EXPECT_EQ(count.false_hits, 0) << "primitive " << static_cast<int>(primitive) << " size " << setting.size
                                       << " place " << setting.place << " of " << count.left << (level ? " level" : "");
        EXPECT_GT(count.left, 3000) << "primitive " << static_cast<int>(primitive) << " size " << setting.size
                                    << " place " << setting.place;
      }
    }
}

TEST(SelfIntersection, ClearanceOfInstancesIsOfTheSizeOfTheirErrors) {
  // A level floor of 1000 units that an instance turns about its own normal and takes to height 0: rays start within a
  // ten-thousandth of a unit of it, not at an error of its width.
  ShapeSet shapes;
  shapes.groups.resize(1);
  shapes.groups[0].meshes.resize(1);
  TriangleMesh& mesh = shapes.groups[0].meshes[0].mesh;
  mesh.positions.assign({{-500, 0, 500}, {500, 0, 500}, {0, 0, -500}});
  mesh.corners.assign({0, 1, 2});
  Matrix44d turned;
  turned.rotate(Vec3d(0, 0.7, 0));
  Instance instance{};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) instance.to_scene[r][c] = static_cast<float>(turned[r][c]);
  instance.to_scene[3][0] = 300;
  shapes.instances.push_back(instance);
  const EmbreeIntersector intersector(shapes, EmbreeOptions{});
  const Vec3f origin(310, 5, 20), direction(0, -1, 0);
  const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
  ASSERT_EQ(hit.instance, 0u);
  const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
  EXPECT_LT(point.clearance, 1e-4f);
  EXPECT_GT(point.clearance, 0);
}

TEST(SelfIntersection, RaysAlongASharedEdgeDoNotHitTheNeighborOfAFlatMesh) {
  // Two triangles of one flat quad, tilted: what leaves one close to the diagonal must not meet the other either.
  RandomRays random(6);
  for (const Setting& setting : {Setting{1, 0}, Setting{1, 10}, Setting{1e3, 1e3}, Setting{1e-3, 1}}) {
    int false_hits = 0, left = 0;
    for (int i = 0; i < 300; ++i) {
      ShapeSet shapes;
      shapes.meshes.resize(1);
      TriangleMesh& mesh = shapes.meshes[0].mesh;
      const Vec3d place = random.in_cube(setting.place), a = random.direction() * setting.size;
      Vec3d b = random.direction() * setting.size;
      mesh.positions.assign({Vec3f(place), Vec3f(place + a), Vec3f(place + a + b), Vec3f(place + b)});
      mesh.corners.assign({0, 1, 2, 0, 2, 3});
      const EmbreeIntersector intersector(shapes, EmbreeOptions{});
      const Vec3d at =
          place + a * 0.5 + b * 0.5 + (a + b) * random.uniform(-0.45, 0.45) + a * random.uniform(-1e-3, 1e-3);
      const Vec3f origin(at + random.direction() * setting.size);
      const Vec3f direction(unit(at - Vec3d(origin)));
      const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
      if (hit.geometry == kNoGeometry) continue;
      const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
      const Vec3f side = point.geometric_normal.dot(direction) < 0 ? point.geometric_normal : -point.geometric_normal;
      for (int k = 0; k < 16; ++k, ++left) {
        // The four corners are rounded, so the quad is bent by up to two ulp of the place: a ray lower than that over
        // its own triangle may meet the other one.
        const Vec3f leaving = random.leaving(side);
        const double bend = 8 * 0x1p-24 * (setting.place + 2 * setting.size) / setting.size;
        if (leaving.dot(side) < 4 * bend) continue;
        false_hits += intersector.occluded_one(offset_origin(point, side), leaving, kInfinity);
      }
    }
    EXPECT_EQ(false_hits, 0) << "size " << setting.size << " place " << setting.place;
    EXPECT_GT(left, 3000);
  }
}

TEST(SelfIntersection, NearbySurfacesAreStillFound) {
  // Concentric spheres with a gap of 1e-4 of the radius (a fixed offset of 9e-5 of it fails): a ray that enters the
  // outer one meets the inner one next; and sheets as close as 1e-4 of their size.
  RandomRays random(7);
  for (const double radius : {1e-4, 1.0, 1e6}) {
    ShapeSet shapes;
    const auto r = static_cast<float>(radius);
    shapes.spheres.center_radius.assign({{0, 0, 0, r}, {0, 0, 0, r * (1 - 1e-4f)}});
    shapes.spheres.shape.assign(2, 0);
    const EmbreeIntersector intersector(shapes, EmbreeOptions{});
    int entered = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d out = random.direction();
      const Vec3f origin(out * radius * 3.0), direction(unit(-out + random.in_cube(0.25)));
      const Hit outer = intersector.intersect_one(origin, direction, kInfinity);
      if (outer.geometry == kNoGeometry) continue;
      ASSERT_EQ(outer.primitive, 0u);
      const SurfacePoint point = surface_at(shapes, origin, direction, outer, false);
      // Steep enough to meet the inner one: sin i < 1 - 1e-4.
      if (-point.geometric_normal.dot(direction) < 0.05f) continue;
      const Hit inner = intersector.intersect_one(offset_origin(point, -point.geometric_normal), direction, kInfinity);
      ASSERT_EQ(inner.primitive, 1u) << radius;
      ++entered;
      EXPECT_LT(inner.distance, radius * 1e-4 / 0.04);
      // And back out from the inner one.
      const SurfacePoint deeper = surface_at(shapes, point.position, direction, inner, false);
      const Hit back =
          intersector.intersect_one(offset_origin(deeper, deeper.geometric_normal), deeper.geometric_normal, kInfinity);
      ASSERT_EQ(back.primitive, 0u);
    }
    EXPECT_GT(entered, 1000);

    ShapeSet sheets;
    sheets.meshes.resize(2);
    for (int k = 0; k < 2; ++k) {
      TriangleMesh& mesh = sheets.meshes[static_cast<std::size_t>(k)].mesh;
      const float z = r * (k == 0 ? 0 : -1e-4f);
      mesh.positions.assign({{-r, -r, z}, {r, -r, z}, {0, r, z}});
      mesh.corners.assign({0, 1, 2});
    }
    const EmbreeIntersector pair(sheets, EmbreeOptions{});
    for (int i = 0; i < 500; ++i) {
      const Vec3f direction(unit(Vec3d(0, 0, -1) + random.in_cube(0.4)));
      const Vec3f origin(static_cast<float>(radius * random.uniform(-0.1, 0.1)),
                         static_cast<float>(radius * random.uniform(-0.3, 0)), 0.2f * r);
      const Hit first = pair.intersect_one(origin, direction, kInfinity);
      ASSERT_EQ(first.geometry, kFirstMeshGeometry);
      const SurfacePoint point = surface_at(sheets, origin, direction, first, false);
      const Hit second = pair.intersect_one(offset_origin(point, {0, 0, -1}), direction, kInfinity);
      ASSERT_EQ(second.geometry, kFirstMeshGeometry + 1);
    }
  }
}

}  // namespace
}  // namespace raytree
