// Sphere, disc, cylinder and cone near and far, alone (tested beside Embree) and among many (Embree's own): row 44 of
// the catalogue of failures. The truth is each shape's closed form in long double, for the ray as floats hold it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "geometry/embree_intersector.h"
#include "geometry/ray_batch.h"
#include "geometry/surface.h"

namespace raytree {
namespace {

enum class Kind { sphere, disc, cylinder, cone };
constexpr const char* kNames[] = {"sphere", "disc", "cylinder", "cone"};

/// Sphere of radius 1, disc of radius 1 across y, cylinder of radius 1 and height 2 along y, cone of 45 degrees from
/// radius 1 at y = -1/2 to its tip at y = 1/2; all about the origin.
void add(ShapeSet& shapes, Kind kind, const Vec3f& center) {
  switch (kind) {
    case Kind::sphere:
      shapes.spheres.center_radius.push_back({center.x, center.y, center.z, 1});
      shapes.spheres.shape.push_back(0);
      break;
    case Kind::disc:
      shapes.discs.center_radius.push_back({center.x, center.y, center.z, 1});
      shapes.discs.normal.push_back({0, 1, 0});
      shapes.discs.shape.push_back(0);
      break;
    case Kind::cylinder:
      shapes.cones.base_radius.push_back({center.x, center.y - 1, center.z, 1});
      shapes.cones.apex_radius.push_back({center.x, center.y + 1, center.z, 1});
      shapes.cones.shape.push_back(0);
      break;
    case Kind::cone:
      shapes.cones.base_radius.push_back({center.x, center.y - 0.5f, center.z, 1});
      shapes.cones.apex_radius.push_back({center.x, center.y + 0.5f, center.z, 0});
      shapes.cones.shape.push_back(0);
      break;
  }
}

using Real = long double;
struct Point {
  Real x, y, z;
};

/// What the ray meets first of the shape, and whether it passes all of the shape's borders and grazing places by more
/// than `margin`, so that a rounding cannot change it.
struct Truth {
  bool hit = false, clear = false;
  Point position{}, normal{};
};

Truth truth(Kind kind, const Vec3d& origin, const Vec3d& direction, Real margin) {
  const Point o{origin.x, origin.y, origin.z}, d{direction.x, direction.y, direction.z};
  const auto at = [&](Real t) { return Point{o.x + t * d.x, o.y + t * d.y, o.z + t * d.z}; };
  Truth result;
  if (kind == Kind::disc) {
    const Point p = at(-o.y / d.y);
    const Real r = std::sqrt(p.x * p.x + p.z * p.z);
    result = {r<1, std::abs(r - 1)> margin, p, {0, 1, 0}};
    return result;
  }
  // a t^2 + 2 b t + c = 0; s: whether y counts as the others do; the radius is r0 + k y.
  const Real s = kind == Kind::sphere ? 1 : 0, r0 = kind == Kind::cone ? 0.5L : 1, k = kind == Kind::cone ? -1 : 0;
  const Real radius = r0 + k * o.y, climb = k * d.y;
  const Real a = d.x * d.x + d.z * d.z + s * d.y * d.y - climb * climb;
  const Real b = o.x * d.x + o.z * d.z + s * o.y * d.y - radius * climb;
  const Real c = o.x * o.x + o.z * o.z + s * o.y * o.y - radius * radius;
  const Real q = b * b - a * c;
  // The half chord is sqrt(q) / |a|.
  result.clear = std::abs(q) > margin * a * a && std::abs(a) > margin;
  if (q < 0) return result;
  const Real height = kind == Kind::sphere ? 2 : kind == Kind::cylinder ? 1 : 0.5L;
  Real nearest = std::numeric_limits<Real>::infinity();
  for (const Real t : {(-b - std::sqrt(q)) / a, (-b + std::sqrt(q)) / a}) {
    const Real y = at(t).y;
    if (std::abs(std::abs(y) - height) <= margin) result.clear = false;
    if (std::abs(y) < height) nearest = std::min(nearest, t);
  }
  result.hit = std::isfinite(nearest);
  if (!result.hit) return result;
  const Point p = result.position = at(nearest);
  const Real across = std::sqrt(p.x * p.x + p.z * p.z);
  if (kind == Kind::sphere) result.normal = p;
  if (kind == Kind::cylinder) result.normal = {p.x, 0, p.z};
  if (kind == Kind::cone)
    result.normal = {p.x / across / std::sqrt(2.0L), 1 / std::sqrt(2.0L), p.z / across / std::sqrt(2.0L)};
  return result;
}

double distance(const Vec3f& a, const Point& b) {
  return static_cast<double>(std::hypot(std::hypot(a.x - b.x, a.y - b.y), a.z - b.z));
}

TEST(QuadricDistance, NearAndFarTheClosedFormHolds) {
  std::mt19937_64 engine(44);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> gauss;
  for (const Kind kind : {Kind::sphere, Kind::disc, Kind::cylinder, Kind::cone})
    for (const bool among_many : {false, true}) {
      ShapeSet shapes;
      add(shapes, kind, {0, 0, 0});
      // Nine more, out of every ray's way, and Embree holds them all.
      for (int i = 0; among_many && i < 9; ++i) add(shapes, kind, {300000.f + 10 * static_cast<float>(i), 0, 0});
      const EmbreeIntersector intersector(shapes, {});
      for (const double away : {3.0, 1e2, 1e4, 1e5}) {
        // The Embree sphere's t is off by up to 2.7e-2 radii at 1e5 (row 44), which decides hits that close to the
        // outline; the others are solved in double.
        const Real margin = 1e-3 + away * 1e-6;
        double worst_position = 0, worst_normal = 0;
        int hits = 0, wrong = 0;
        for (int i = 0; i < 4000; ++i) {
          const Vec3d from(gauss(engine), gauss(engine), gauss(engine));
          const Vec3f origin(unit(Vec3d(-std::abs(from.x), from.y, from.z)) * away);
          const Vec3d target = Vec3d(uniform(engine), uniform(engine), uniform(engine)) * 0.8;
          const Vec3f direction(unit(target - Vec3d(origin)));
          const Vec3d d = unit(Vec3d(direction));
          if (std::abs(d.y) < 0.05) continue;  // along the disc's plane
          const Truth expected = truth(kind, Vec3d(origin), d, margin);
          if (!expected.clear) continue;
          const Hit hit = intersector.intersect_one(origin, direction, kInfinity);
          if ((hit.geometry != kNoGeometry) != expected.hit) {
            ++wrong;
            continue;
          }
          if (!expected.hit) continue;
          ++hits;
          const SurfacePoint point = surface_at(shapes, origin, direction, hit, false);
          worst_position = std::max(worst_position, distance(point.position, expected.position));
          worst_normal = std::max(worst_normal, distance(point.geometric_normal, expected.normal));
        }
        std::printf("row 44, %s%s at %g: %d hits, %d wrong, position off by %.2g, normal by %.2g degrees\n",
                    kNames[static_cast<int>(kind)], among_many ? " among many" : "", away, hits, wrong, worst_position,
                    worst_normal * 57.3);
        EXPECT_GT(hits, 200);
        EXPECT_EQ(wrong, 0);
        // A few roundings of float of coordinates up to 1. In double the ray's point nearest to the shape is off by
        // roundings of the distance, and the half chord, sqrt(margin) at least, by that over itself.
        const double half_chord = std::sqrt(1e-3);
        const double tolerance = 4 * kRoundoff + 16 * 0x1p-53 * away / half_chord;
        EXPECT_LE(worst_position, tolerance);
        EXPECT_LE(worst_normal, tolerance);
      }
    }
}

}  // namespace
}  // namespace raytree
