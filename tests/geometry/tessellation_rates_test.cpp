// Rates chosen by error: the claim "at most so many pixels from the limit" measured by dense sampling, the economy of
// the rates against closed forms, and what a view counts as a pixel.
#include "geometry/tessellation_rates.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "geometry/angle.h"
#include "geometry/tessellation_error.h"
#include "tests/geometry/analytic_surfaces.h"
#include "tests/geometry/tessellation_views.h"
#include "tests/mesh_expectations.h"

namespace raytree {
namespace {

using test::everywhere, test::perspective;

constexpr double kErrorTolerance = 0.25;

TessellationError error_of(const ParametricSurface& surface, const TessellationRates& rates,
                           const TessellationView& view) {
  return measure_tessellation(surface, rates, tessellate(surface, rates), view, kErrorTolerance);
}

TEST(TessellationView, PixelsAreThoseOfTheProjection) {
  const TessellationView view = perspective({3, 4, 9}, 640, 480);
  const auto project = [&](const Vec3d& p) {
    const Vec3d d = p - view.eye;
    return Vec2d(d.dot(view.right), d.dot(view.up)) / (d.dot(view.forward) * view.pixel);
  };
  for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, -2, 1.5), Vec3d(-2, 1, -3)})
    for (const Vec3d& d : {Vec3d(1e-6, 0, 0), Vec3d(0, 1e-6, 0), Vec3d(-1e-6, 2e-6, 0.5e-6)}) {
      // 1e-6 at distance 10 is linear to 1e-7 of itself; differences of positions of 1e3 pixels are good to 1e-13.
      const double seen = (project(p + d) - project(p)).length();
      EXPECT_NEAR(view.pixels(p, d), std::max(seen, d.length() / (4 * view.pixel * (p - view.eye).dot(view.forward))),
                  1e-6 * seen + 1e-9);
    }
  // Along the line of sight nothing moves in the picture: a quarter of the length counts.
  const Vec3d away = view.forward * 1e-3;
  EXPECT_NEAR(view.pixels({0, 0, 0}, away), 1e-3 / (4 * view.pixel * view.eye.length()), 1e-9);
}

TEST(TessellationView, WhatTheFrameLeavesOutCountsAQuarter) {
  const TessellationView view = perspective({0, 0, 10}, 200, 100);
  const Vec3d d(0, 1e-3, 0);
  const double edge = 10 * view.pixel * 50;
  const double seen = view.pixels({0, edge * 1.05, 0}, d);
  EXPECT_NEAR(seen, 1e-3 / (10 * view.pixel), 1e-9);
  EXPECT_NEAR(view.pixels({0, edge * 1.2, 0}, d) / seen, 0.25 * 10 / std::hypot(10, edge * 1.2), 1e-9);
  EXPECT_NEAR(view.pixels({0, 0, 20}, d) / seen, 0.25, 1e-9);  // as far behind the eye
  EXPECT_TRUE(std::isfinite(view.pixels(view.eye, d)));
  TessellationView flat = view;
  flat.projection = TessellationView::Projection::orthographic;
  EXPECT_NEAR(flat.pixels({0, 0, 20}, d), 1e-3 / view.pixel, 1e-9);
  EXPECT_NEAR(flat.pixels({0, 1, 0}, d), 1e-3 / view.pixel / 4, 1e-9);
}

TEST(TessellationView, TheWayToTheWorldCounts) {
  TessellationView view = everywhere(0.5);
  view.to_world.setScale(Vec3d(2, 3, 4));
  EXPECT_DOUBLE_EQ(view.pixels({1, 1, 1}, {0, 0, 1}), 8);
  EXPECT_DOUBLE_EQ(view.pixels({1, 1, 1}, {1, 0, 0}), 4);
}

TEST(TessellationError, IsTheSagittaOfACylinder) {
  // k facets around: 1 - cos(pi / k) away at the middle of each, where samples lie; normals interpolated between two
  // that are 2t apart, t = pi / k, are off most where tan(e) = ... ; the series is t^3 / (9 sqrt 3) * sqrt 3 / ... so
  // it is found here by its own formula at the quarters.
  for (const std::uint32_t sides : {6u, 9u})
    for (const int rate : {2, 5}) {
      const test::AnalyticSurface surface = test::cylinder(sides);
      const TessellationError error = error_of(surface, uniform_rates(surface, rate), everywhere(0.01));
      const double t = kPi / (sides * rate);
      EXPECT_NEAR(error.largest.distance, 1 - std::cos(t), 3e-7);  // positions of float, about 1
      EXPECT_NEAR(error.largest.pixels, 100 * (1 - std::cos(t)), 3e-5);
      const double quarter = std::abs(std::atan(0.5 * std::tan(t)) - t / 2);
      EXPECT_NEAR(error.largest.angle, quarter, 4e-7);
      // A pixel is 0.01: the normal turns by at least 0.01 a pixel, less than 4/255.
      EXPECT_NEAR(error.largest.shading, quarter / kTurnPerPixel, 4e-5);
      EXPECT_EQ(error.faces, sides + 2);
      EXPECT_EQ(error.samples, error.triangles * 12);
    }
}

TEST(TessellationError, SeamsAreWhatSharedPointsAreOff) {
  const test::AnalyticSurface surface = test::torus(6, 5);
  const TessellationRates rates = uniform_rates(surface, 4);
  TriangleMesh mesh = tessellate(surface, rates);
  const auto seam = [&] { return measure_tessellation(surface, rates, mesh, everywhere(0.01), kErrorTolerance).seam; };
  EXPECT_LE(seam(), 1e-3);
  mesh.positions[0].y += 0.03f;  // a corner of four faces
  EXPECT_NEAR(seam(), 3, 1e-3);
}

TEST(FacetDeviation, ACuspIsOffByNoMoreThanItsFacetIsWide) {
  // Corners whose normals agree, and one that is turned over between them: half a circle, within the way to a corner.
  const TessellationView view = everywhere(0.5);
  const std::array<FacetCorner, 3> corners{{{{0, 0, 0}, {0, 0, 1}}, {{2, 0, 0}, {0, 0, 1}}, {{0, 2, 0}, {0, 0, 1}}}};
  const SampledFacet facet(view, {0, 0, 0}, corners, {});
  SurfaceSample sample;
  sample.position = {1, 0, 0};
  sample.normal = {0, 0, -1};
  const FacetDeviation deviation = facet.at(sample, {0.5, 0.5, 0});
  EXPECT_NEAR(deviation.angle, kPi, 1e-6);
  EXPECT_NEAR(deviation.shading, kPi / (2 / 2.0), 1e-6);  // chords of 2 in 2 pixels
}

TEST(TessellationError, OfAnNGonIsThatOfItsParaboloid) {
  // Over a triangle with the edge vectors e, y = -h (x^2 + z^2) deviates from the plane by h |e|^2 / 4 at the middle of
  // an edge: for any cut into subfaces the largest deviation is that of the longest edge, or of the inside, at most
  // h / 3 * |e|^2. Distances are at most the heights and at least these times the least slope's cosine.
  const double height = 0.3;
  for (const std::uint32_t sides : {3u, 5u, 6u, 11u}) {
    const test::AnalyticSurface surface = test::dome(sides, height);
    for (const int rate : {1, 2, 3, 4, 7}) {
      const TessellationRates rates = uniform_rates(surface, rate);
      const TriangleMesh mesh = tessellate(surface, rates);
      double longest = 0;
      for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
        const Vec3d d =
            Vec3d(mesh.positions[mesh.corners[c]]) - Vec3d(mesh.positions[mesh.corners[c % 3 == 2 ? c - 2 : c + 1]]);
        longest = std::max(longest, d.x * d.x + d.z * d.z);
      }
      const TessellationError error = measure_tessellation(surface, rates, mesh, everywhere(1), kErrorTolerance);
      // The rim bulges beyond the outermost facets.
      const double bulge = 1 - std::cos(kPi / (sides * rate));
      EXPECT_LT(error.largest.distance, height / 3 * longest + bulge + 1e-6) << sides << " " << rate;
      EXPECT_GT(error.largest.distance, 0.5 * height / 4 * longest * std::sqrt(1 / (1 + 4 * height * height)));
    }
  }
}

struct Case {
  const char* name;
  test::AnalyticSurface surface;
};
std::vector<Case> cases() {
  return {
      {"torus", test::torus(6, 5)},      {"torus of one face", test::torus(1, 1)}, {"sphere", test::octant_sphere()},
      {"saddle", test::saddle(0.8)},     {"cylinder", test::cylinder(7)},          {"dome of 3", test::dome(3, 0.4)},
      {"dome of 5", test::dome(5, 0.4)}, {"dome of 12", test::dome(12, 0.2)},      {"steep saddle", test::saddle(5)}};
}

TEST(ViewRates, MeasuredErrorKeepsTheTolerance) {
  for (const Case& c : cases())
    for (const double tolerance : {0.25, 1.0})
      for (const TessellationView& view :
           {everywhere(0.01), perspective({2, 3, 7}, 480, 270), perspective({1, 1, 1.8}, 640, 480)}) {
        const ViewRates found = rates_for_view(c.surface, view, tolerance);
        const TessellationError error = error_of(c.surface, found.rates, view);
        EXPECT_EQ(found.coarse_faces, 0u) << c.name;
        EXPECT_LE(error.largest.pixels, tolerance) << c.name;
        if (view.projection == TessellationView::Projection::any_direction) {
          EXPECT_LE(error.largest.shading, tolerance) << c.name;
        }
      }
}

TEST(ViewRates, NoMoreThanACircleNeeds) {
  // For e pixels a circle of R pixels needs k = pi / acos(1 - e / R) segments. The rates aim at 0.75 of the tolerance,
  // so up to 1 / sqrt(0.75) = 1.155 times as many, and are whole numbers a face (7 faces: up to 7 more).
  for (const double radius : {100.0, 500.0, 1000.0}) {
    const test::AnalyticSurface surface = test::cylinder(7);
    const ViewRates found = rates_for_view(surface, everywhere(1 / radius), 0.25);
    std::size_t around = 0;
    for (std::size_t face = 0; face < 7; ++face) around += found.rates.edges[surface.sides(face)[0].edge];
    const double needed = kPi / std::acos(1 - 0.25 / radius);
    EXPECT_GE(double(around), needed);
    EXPECT_LE(double(around), needed * 1.155 + 7);
    // Straight lines are not cut.
    for (std::size_t face = 0; face < 7; ++face) {
      EXPECT_EQ(found.rates.edges[surface.sides(face)[1].edge], 1);
      EXPECT_EQ(found.rates.inner[face][1], 1);
    }
  }
}

TEST(ViewRates, FlatFacesAreNotCut) {
  const test::AnalyticSurface surface = test::saddle(0);
  const ViewRates found = rates_for_view(surface, everywhere(1e-6), 0.25);
  EXPECT_EQ(tessellate(surface, found.rates).triangle_count(), 2u);
}

TEST(ViewRates, TrianglesGrowAsTheToleranceShrinks) {
  // Facets of size h are off by h^2: their number goes with 1 / tolerance, whole rates aside.
  const test::AnalyticSurface surface = test::torus(6, 5);
  const auto count = [&](double tolerance) {
    return double(tessellate(surface, rates_for_view(surface, everywhere(0.002), tolerance).rates).triangle_count());
  };
  EXPECT_NEAR(count(0.1) / count(0.4), 4, 0.6);
}

TEST(ViewRates, WhatIsFarOrUnseenIsCoarser) {
  const test::AnalyticSurface surface = test::torus(6, 5);
  const auto count = [&](const TessellationView& view) {
    return tessellate(surface, rates_for_view(surface, view, 0.25).rates).triangle_count();
  };
  const std::size_t near = count(perspective({0, 2, 8}, 960, 540)), far = count(perspective({0, 20, 80}, 960, 540));
  EXPECT_LT(4 * far, near);
  TessellationView turned = perspective({0, 2, 8}, 960, 540);
  turned.forward = -turned.forward;
  turned.right = -turned.right;
  EXPECT_LT(2 * count(turned), near);
}

TEST(ViewRates, WhatWouldNeedTooManySegmentsIsCounted) {
  const test::AnalyticSurface surface = test::saddle(0.8);
  const ViewRates found = rates_for_view(surface, everywhere(1e-9), 0.25);
  EXPECT_EQ(found.coarse_faces, 1u);
  EXPECT_EQ(found.rates.inner[0][0], kLargestViewRate);
}

TEST(ViewRates, ResultDoesNotDependOnThreads) {
  const test::AnalyticSurface surface = test::torus(13, 11);
  const TessellationView view = perspective({2, 3, 7}, 480, 270);
  const ViewRates expected = tbb::task_arena(1).execute([&] { return rates_for_view(surface, view, 0.1); });
  const TessellationError error = error_of(surface, expected.rates, view);
  for (const int threads : {2, 3, 7}) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 7);
    tbb::task_arena(threads).execute([&] {
      const ViewRates found = rates_for_view(surface, view, 0.1);
      EXPECT_TRUE(test::same_bits(found.rates.edges, expected.rates.edges));
      EXPECT_TRUE(test::same_bits(found.rates.inner, expected.rates.inner));
      EXPECT_EQ(found.coarse_faces, expected.coarse_faces);
      const TessellationError again = error_of(surface, found.rates, view);
      EXPECT_EQ(again.largest.pixels, error.largest.pixels);
      EXPECT_EQ(again.largest.angle, error.largest.angle);
    });
  }
}

}  // namespace
}  // namespace raytree
