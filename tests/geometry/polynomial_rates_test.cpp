// Rates in closed form: against the surfaces' own, against what dense sampling finds, and what they refuse to tell.
#include "geometry/polynomial_rates.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "geometry/facet_deviation.h"
#include "geometry/patch_surface.h"
#include "geometry/subdivision_surface.h"
#include "geometry/tessellation_error.h"
#include "geometry/tessellation_rates.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/geometry/surface_samples.h"
#include "tests/geometry/tessellation_views.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using test::everywhere, test::perspective;

/// z = (bend_u x^2 + bend_v y^2) / 2 + twist x y over [0, 1]^2, as a Bezier patch.
BezierPatch paraboloid(double bend_u, double bend_v, double twist) {
  BezierPatch patch;
  // The polar form of x^2 at thirds: control points of t^2 are 0, 0, 1/3, 1.
  constexpr std::array<double, 4> kSquares{0, 0, 1.0 / 3, 1};
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = double(i) / 3, y = double(j) / 3;
      patch.points[4 * j + i] = {x, y, (bend_u * kSquares[i] + bend_v * kSquares[j]) / 2 + twist * x * y};
    }
  return patch;
}

const std::array<FaceEdge, 4> kSmoothSides{};

TEST(PolynomialRates, OfAShallowParaboloidAreThoseOfItsSagitta) {
  // Along u facets of width 1 / n are off by bend / (8 n^2), along v by nothing. A slope of 1e-3 changes no normal part
  // by more than 1e-6 of it; normals turn less than 4/255 a pixel and are off by less than a thousandth of that.
  const double bend = 1e-3, pixel = 1e-6;
  const TessellationView view = everywhere(pixel);
  const RateGoal goal{view, {0, 0, 0}, 0.25};
  const double segments = std::sqrt(bend / 8 / (0.25 * kPolynomialAim * pixel));
  RateDemand demand;
  ASSERT_EQ(demand_of_polynomial(paraboloid(bend, 0, 0), kSmoothSides, goal, demand), PolynomialDemand::found);
  EXPECT_NEAR(demand.inner[0], segments, 1e-4 * segments);
  EXPECT_EQ(demand.inner[1], 1);
  EXPECT_NEAR(demand.sides[0], segments, 1e-4 * segments);
  EXPECT_NEAR(demand.sides[2], segments, 1e-4 * segments);
  EXPECT_EQ(demand.sides[1], 1);
  // Both ways the two share the tolerance; a twist counts for both.
  ASSERT_EQ(demand_of_polynomial(paraboloid(bend, bend, 0), kSmoothSides, goal, demand), PolynomialDemand::found);
  EXPECT_NEAR(demand.inner[0], std::sqrt(2.0) * segments, 1e-4 * segments);
  EXPECT_NEAR(demand.inner[1], std::sqrt(2.0) * segments, 1e-4 * segments);
  ASSERT_EQ(demand_of_polynomial(paraboloid(0, 0, bend), kSmoothSides, goal, demand), PolynomialDemand::found);
  EXPECT_NEAR(demand.inner[0], std::sqrt(2.0) * segments, 1e-4 * segments);
}

TEST(PolynomialRates, TellFlatTurningAndDegenerateFaces) {
  const TessellationView view = everywhere(1e-3), coarse = everywhere(10);
  RateDemand demand;
  EXPECT_EQ(demand_of_polynomial(paraboloid(0, 0, 0), kSmoothSides, {view, {0, 0, 0}, 0.25}, demand),
            PolynomialDemand::found);
  EXPECT_EQ(demand.largest(), 1);
  // Seen so small, one facet may span a turn of more than 45 degrees.
  EXPECT_EQ(demand_of_polynomial(paraboloid(2, 0, 0), kSmoothSides, {coarse, {0, 0, 0}, 0.25}, demand),
            PolynomialDemand::turns_much);
  BezierPatch tip = paraboloid(1, 1, 0);
  for (std::size_t i = 0; i < 4; ++i) tip.points[i] = {0, 0, 0};
  EXPECT_EQ(demand_of_polynomial(tip, kSmoothSides, {view, {0, 0, 0}, 0.25}, demand), PolynomialDemand::degenerate);
}

TEST(PolynomialRates, OutlinesAreCutWhereTheSurfaceEnds) {
  // A flat patch whose bottom side bulges in its plane.
  BezierPatch patch = paraboloid(0, 0, 0);
  patch.points[1].y = patch.points[2].y = -0.2;
  const TessellationView view = everywhere(1e-3);
  const RateGoal goal{view, {0, 0, 0}, 0.25};
  std::array<FaceEdge, 4> sides = kSmoothSides;
  RateDemand demand;
  ASSERT_EQ(demand_of_polynomial(patch, sides, goal, demand), PolynomialDemand::found);
  EXPECT_LT(demand.sides[0], 3);
  sides[0].sharp_edge = true;
  ASSERT_EQ(demand_of_polynomial(patch, sides, goal, demand), PolynomialDemand::found);
  // y = -0.6 t (1 - t): the second derivative is 1.2, at its middle across the side.
  EXPECT_GE(demand.sides[0], std::sqrt(1.2 / 8 / (0.25 * kPolynomialAim * 1e-3)) * 0.9);
}

/// Faces that are polynomials have the surface's own points and tangents; returns how many there are.
std::size_t expect_polynomials_of(const ParametricSurface& surface, double tolerance) {
  std::size_t count = 0;
  for (std::size_t face = 0; face < surface.face_count(); ++face) {
    BezierPatch patch;
    if (surface.sides(face).empty() || !surface.polynomial_patch(face, patch)) continue;
    ++count;
    for (const double u : {0.0, 0.3, 1.0})
      for (const double v : {0.0, 0.6, 1.0}) {
        const SurfaceSample sample = test::sample_at(surface, face, {u, v});
        const PatchDerivatives at = evaluate(patch, u, v);
        EXPECT_LE((at.position - Vec3d(sample.position)).length(), tolerance);
        EXPECT_LE((at.du - Vec3d(sample.du)).length(), 8 * tolerance);
        EXPECT_LE((at.dv - Vec3d(sample.dv)).length(), 8 * tolerance);
      }
  }
  return count;
}

TEST(PolynomialPatches, AreTheFacesThatTheyStandFor) {
  Warnings warnings;
  // Coordinates up to 8 in single precision: sums of sixteen products are good to a few 2^-21.
  constexpr double kRounding = 4e-6;
  EXPECT_EQ(expect_polynomials_of(*make_subdivision_surface(test::torus_cage(8, 5), {}, {}, warnings), kRounding), 40u);
  // With boundaries and sharp corners, which end the splines; where corners are rounded off their faces are none.
  SubdivisionRules corners;
  corners.boundary = BoundaryRule::edge_and_corner;
  const PolygonMesh grid = test::grid_cage(5, 4, 1);
  EXPECT_EQ(expect_polynomials_of(*make_subdivision_surface(grid, corners, {}, warnings), kRounding), 12u);
  EXPECT_EQ(expect_polynomials_of(*make_subdivision_surface(grid, {}, {}, warnings), kRounding), 8u);
  EXPECT_EQ(expect_polynomials_of(*make_subdivision_surface(test::cube_cage(), {}, {}, warnings), kRounding), 0u);
  std::vector<SurfacePatch> patches{paraboloid(1, 2, 3), paraboloid(1, 2, 3), paraboloid(1, 2, 3)};
  std::get<BezierPatch>(patches[1]).weights[5] = 2;
  for (std::size_t i = 0; i < 4; ++i) std::get<BezierPatch>(patches[2]).points[i] = {0, 0, 0};
  EXPECT_EQ(expect_polynomials_of(PatchSurface(std::move(patches), {}, {}, warnings), kRounding), 1u)
      << "neither a rational patch nor one with a tip";
}

struct RegularCase {
  const char* name;
  std::unique_ptr<ParametricSurface> surface;
};
std::vector<RegularCase> regular_cases() {
  Warnings warnings;
  std::vector<RegularCase> cases;
  cases.push_back({"torus", make_subdivision_surface(test::torus_cage(8, 5), {}, {}, warnings)});
  cases.push_back({"fine torus", make_subdivision_surface(test::torus_cage(40, 20), {}, {}, warnings)});
  cases.push_back({"bumps", make_subdivision_surface(test::grid_cage(9, 8, 1), {}, {}, warnings)});
  cases.push_back({"steep bumps", make_subdivision_surface(test::grid_cage(6, 6, 6), {}, {}, warnings)});
  SubdivisionRules creased;
  creased.creases = {{{0, 7, 14, 21}, kInfiniteSharpness}, {{8, 9, 10, 11, 12}, kInfiniteSharpness}};
  cases.push_back({"creased bumps", make_subdivision_surface(test::grid_cage(7, 6, 2), creased, {}, warnings)});
  std::vector<SurfacePatch> patches;
  for (const double bend : {0.2, 1.0, 3.0}) {
    BezierPatch patch = paraboloid(bend, -bend, bend / 2);
    patch.points[5] += Vec3d(0.2, 0.1, bend);
    patches.emplace_back(patch);
  }
  cases.push_back({"patches", std::make_unique<PatchSurface>(std::move(patches), PatchSurfaceOptions(),
                                                             SourceLocation(), warnings)});
  return cases;
}

TEST(PolynomialRates, WhatTheyPromiseIsMeasured) {
  double nearest_distance = 0, nearest_shading = 0;
  // Views in which facets are from two to two hundred pixels long.
  for (const RegularCase& c : regular_cases())
    for (const double tolerance : {0.25, 1.0})
      for (const TessellationView& view : {everywhere(0.1), everywhere(0.02), everywhere(0.004), everywhere(0.0008),
                                           perspective({4, 5, 9}, 640, 360), perspective({2, 1, 12}, 1920, 1080)}) {
        const ViewRates found = rates_for_view(*c.surface, view, tolerance);
        const TriangleMesh mesh = tessellate(*c.surface, found.rates);
        const TessellationError error = measure_tessellation(*c.surface, found.rates, mesh, view, tolerance);
        EXPECT_EQ(found.coarse_faces, 0u) << c.name;
        EXPECT_LE(error.largest.pixels, tolerance) << c.name << " " << view.pixel;
        EXPECT_LE(error.regular.shading, tolerance) << c.name << " " << view.pixel;
        EXPECT_EQ(error.regular.over, 0u);
        nearest_distance = std::max(nearest_distance, error.largest.pixels / tolerance);
        nearest_shading = std::max(nearest_shading, error.regular.shading / tolerance);
      }
  std::printf("closed form: up to %.3f of the tolerance in distance, %.3f in shading\n", nearest_distance,
              nearest_shading);
}

}  // namespace
}  // namespace raytree
