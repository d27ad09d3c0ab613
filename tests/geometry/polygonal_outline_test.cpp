// Row 7 of the catalogue of failures: a disc's outline as a polygon of k sides lies up to R (1 - cos(pi / k)) pixels
// inside. Without a remedy k is a matter of taste; with ours it follows from the tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "geometry/angle.h"
#include "geometry/patch_surface.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_rates.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

/// The sphere's outline seen along z, by directions: how far inside the unit circle it stays at most.
double outline_error(const TriangleMesh& mesh) {
  constexpr int kDirections = 20000;
  std::vector<double> reach(kDirections, 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vec3f a = mesh.positions[mesh.corners[i]], b = mesh.positions[mesh.corners[i % 3 == 2 ? i - 2 : i + 1]];
    // Edges near the outline alone; points along each reach out in their direction.
    if (std::hypot(a.x, a.y) < 0.8f || std::hypot(b.x, b.y) < 0.8f) continue;
    const double turn = std::atan2(double(a.x) * double(b.y) - double(a.y) * double(b.x),
                                   double(a.x) * double(b.x) + double(a.y) * double(b.y));
    const double first = std::atan2(double(a.y), double(a.x)) / (2 * kPi) * kDirections;
    const double last = first + turn / (2 * kPi) * kDirections;
    for (double k = std::ceil(std::min(first, last)); k <= std::max(first, last); ++k) {
      const double angle = k / kDirections * 2 * kPi, c = std::cos(angle), s = std::sin(angle);
      // Where the edge's line meets the ray at that angle.
      const Vec2d p(double(a.x), double(a.y)), d(double(b.x) - double(a.x), double(b.y) - double(a.y));
      const double across = d.x * s - d.y * c;
      const double t = across != 0 ? (p.y * c - p.x * s) / across : 0;
      const double r = (p.x + d.x * t) * c + (p.y + d.y * t) * s;
      const auto index = static_cast<std::size_t>((static_cast<long>(k) % kDirections + kDirections) % kDirections);
      reach[index] = std::max(reach[index], r);
    }
  }
  double worst = 0;
  for (const double r : reach) worst = std::max(worst, 1 - r);
  return worst;
}

TEST(PolygonalOutline, FollowsTheToleranceAtAnySize) {
  Warnings warnings;
  const std::vector<BezierPatch> patches = test::sphere_patches();
  const PatchSurface sphere({patches.begin(), patches.end()}, {}, {}, warnings);
  for (const double radius : {100.0, 500.0, 1000.0}) {
    // Off: a rate chosen once, four patches around with 8 segments each, whatever the size.
    const TriangleMesh fixed = tessellate_uniformly(sphere, 8);
    TessellationView view;
    view.projection = TessellationView::Projection::orthographic;
    view.eye = {0, 0, 5};
    view.pixel = 1 / radius;
    view.half_width = view.half_height = 1.2 * radius;
    const TriangleMesh cut = tessellate(sphere, rates_for_view(sphere, view, 0.25).rates);
    const double off = radius * outline_error(fixed), on = radius * outline_error(cut);
    std::printf("disc of %4.0f px: 32 sides %.2f px off (closed form %.2f), by the tolerance %.2f px, %zu triangles\n",
                radius, off, radius * (1 - std::cos(kPi / 32)), on, cut.triangle_count());
    EXPECT_LE(on, 0.25);
    // The patches' parameter is not the angle: sides differ by up to a seventh in length.
    EXPECT_NEAR(off, radius * (1 - std::cos(kPi / 32)), 0.35 * off);
    if (radius > 100) {
      EXPECT_GT(off, 1);
    }
  }
}

}  // namespace
}  // namespace raytree
