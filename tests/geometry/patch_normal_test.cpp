// Normals where P_u x P_v vanishes: rows 8, 9 and 10 of the catalogue of failures, each method against the limit of the
// normals around the place. What each test measures it prints.
#include "geometry/patch_normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "geometry/angle.h"
#include "geometry/bezier_patch.h"
#include "geometry/coons_patch.h"
#include "geometry/patch_reader.h"
#include "tests/patch_samples.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using namespace test;

constexpr DegenerateNormal kRemedies[] = {DegenerateNormal::none, DegenerateNormal::gouraud,
                                          DegenerateNormal::first_order, DegenerateNormal::limit};

template <class Patch>
Vec3d normal(const Patch& patch, double u, double v, DegenerateNormal method) {
  return patch_normal(patch, evaluate(patch, u, v), u, v, derivative_scale(patch), method);
}

/// Over 65 places of a singular edge (or one place 65 times): how many have no normal, and how far the others are from
/// the truth at most, in degrees.
struct NormalError {
  int without = 0;
  double worst = 0;
};

template <class Patch, class Place, class Truth>
NormalError outcome(const char* row, const Patch& patch, DegenerateNormal method, const Place& place,
                    const Truth& truth) {
  constexpr const char* kRemedyNames[] = {"none", "Gouraud", "first order", "limit"};
  NormalError result;
  for (int i = 0; i <= 64; ++i) {
    const Vec2d at = place(i / 64.0);
    const Vec3d found = normal(patch, at.x, at.y, method);
    if (found == Vec3d(0, 0, 0))
      ++result.without;
    else
      result.worst = std::max(result.worst, degrees_between(found, truth(i / 64.0)));
  }
  std::printf("%s, %s: %d of 65 without a normal, others off by up to %.3g degrees\n", row,
              kRemedyNames[static_cast<int>(method)], result.without, result.worst);
  return result;
}

// Row 8: one edge is a point, the tip of a cone of 45 degrees.
TEST(DegenerateNormals, AtTheTipOfACone) {
  const std::vector<BezierCurve> profile{straight({1, 0, 0}, {0, 1, 0})};
  const BezierPatch patch = revolve(profile)[0];
  const auto tip = [](double t) { return Vec2d(t, 1); };
  // The patch begins on +x and turns toward -z.
  const auto truth = [&](double t) {
    const Vec3d around = evaluate(patch, t, 0).position;
    return Vec3d(around.x, 1, around.z);
  };
  EXPECT_EQ(outcome("row 8, cone", patch, DegenerateNormal::none, tip, truth).without, 65);
  // One normal for the whole tip, (1, 1, -1): off by acos(2 / sqrt(6)) at both ends.
  const NormalError gouraud = outcome("row 8, cone", patch, DegenerateNormal::gouraud, tip, truth);
  EXPECT_EQ(gouraud.without, 0);
  EXPECT_NEAR(gouraud.worst, std::acos(2 / std::sqrt(6.0)) * 180 / kPi, 1e-9);
  for (const DegenerateNormal method : {DegenerateNormal::first_order, DegenerateNormal::limit}) {
    const NormalError better = outcome("row 8, cone", patch, method, tip, truth);
    EXPECT_EQ(better.without, 0);
    EXPECT_LE(better.worst, 1e-12);
  }
}

// Row 8 where the surface is smooth: the pole of a sphere.
TEST(DegenerateNormals, AtThePoleOfASphere) {
  const BezierPatch patch = sphere_patches()[4];
  const auto pole = [](double t) { return Vec2d(t, 1); };
  const auto truth = [](double) { return Vec3d(0, 1, 0); };
  EXPECT_EQ(outcome("row 8, sphere", patch, DegenerateNormal::none, pole, truth).without, 65);
  for (const DegenerateNormal method :
       {DegenerateNormal::gouraud, DegenerateNormal::first_order, DegenerateNormal::limit}) {
    const NormalError found = outcome("row 8, sphere", patch, method, pole, truth);
    EXPECT_EQ(found.without, 0);
    EXPECT_LE(found.worst, 1e-12);
  }
}

// Row 9: the two boundaries that end in the collapsed edge are tangent there. Smooth: half a bowl whose boundaries make
// one straight line through the tip; its rulings start in all directions between.
TEST(DegenerateNormals, AtATipBetweenOppositeTangents) {
  Monomials a = no_monomials();
  // x = u (1 - 2 v), y = 2 u v (1 - v), z = u^2
  a[0][1] = {1, 0, 0};
  a[1][1] = {-2, 2, 0};
  a[2][1] = {0, -2, 0};
  a[0][2] = {0, 0, 1};
  const BezierPatch patch = patch_of_monomials(a);
  const auto tip = [](double t) { return Vec2d(0, t); };
  const auto truth = [](double) { return Vec3d(0, 0, 1); };
  EXPECT_EQ(outcome("row 9, bowl", patch, DegenerateNormal::none, tip, truth).without, 65);
  EXPECT_EQ(outcome("row 9, bowl", patch, DegenerateNormal::gouraud, tip, truth).without, 65);
  for (const DegenerateNormal method : {DegenerateNormal::first_order, DegenerateNormal::limit}) {
    const NormalError better = outcome("row 9, bowl", patch, method, tip, truth);
    EXPECT_EQ(better.without, 0);
    EXPECT_LE(better.worst, 1e-12);
  }
}

// Row 9, a cusp: the boundaries leave the tip in one direction, and so do all curves between. The first derivatives of
// P_u x P_v vanish too.
TEST(DegenerateNormals, AtACusp) {
  Monomials a = no_monomials();
  // x = u, y = (v - 1/2) u^2, z = u + u^2: on the cylinder z = x + x^2, so the normal at the tip is (-1, 0, 1).
  a[0][1] = {1, 0, 1};
  a[0][2] = {0, -0.5, 1};
  a[1][2] = {0, 1, 0};
  const BezierPatch patch = patch_of_monomials(a);
  const auto tip = [](double t) { return Vec2d(0, t); };
  const auto truth = [](double) { return Vec3d(-1, 0, 1); };
  for (const DegenerateNormal method :
       {DegenerateNormal::none, DegenerateNormal::gouraud, DegenerateNormal::first_order})
    EXPECT_EQ(outcome("row 9, cusp", patch, method, tip, truth).without, 65);
  const NormalError limit = outcome("row 9, cusp", patch, DegenerateNormal::limit, tip, truth);
  EXPECT_EQ(limit.without, 0);
  EXPECT_LE(limit.worst, 1e-12);
}

// Row 10: P_u and P_v parallel in a corner of a smooth surface.
TEST(DegenerateNormals, WhereThePartialsAreParallel) {
  Monomials a = no_monomials();
  // x = u + v, y = v^2 - u^2, z = x + y: a plane with normal (-1, -1, 1).
  a[0][1] = a[1][0] = {1, 0, 1};
  a[0][2] = {0, -1, -1};
  a[2][0] = {0, 1, 1};
  const BezierPatch patch = patch_of_monomials(a);
  const auto corner = [](double) { return Vec2d(0, 0); };
  const auto truth = [](double) { return Vec3d(-1, -1, 1); };
  for (const DegenerateNormal method : {DegenerateNormal::none, DegenerateNormal::gouraud})
    EXPECT_EQ(outcome("row 10", patch, method, corner, truth).without, 65);
  for (const DegenerateNormal method : {DegenerateNormal::first_order, DegenerateNormal::limit}) {
    const NormalError better = outcome("row 10", patch, method, corner, truth);
    EXPECT_EQ(better.without, 0);
    EXPECT_LE(better.worst, 1e-12);
  }
}

// The same holds at collapsed edges of Coons patches, on every side and with the surface turned inside out.
TEST(DegenerateNormals, OfCoonsPatchesAndOnEverySide) {
  const BezierPatch octant = sphere_patches()[4];
  const auto backwards = [](BezierCurve curve) {
    std::reverse(curve.points.begin(), curve.points.end());
    std::reverse(curve.weights.begin(), curve.weights.end());
    return curve;
  };
  CoonsPatch patch{side_curve(octant, 0), backwards(side_curve(octant, 2)), backwards(side_curve(octant, 3)),
                   side_curve(octant, 1)};
  const auto turned_around = [&](const CoonsPatch& p) {
    return CoonsPatch{backwards(p.top), backwards(p.bottom), backwards(p.right), backwards(p.left)};
  };
  struct PoleCase {
    CoonsPatch patch;
    Vec2d pole;
    double up;
  };
  const PoleCase cases[] = {{patch, {0.3, 1}, 1},
                            {turned_around(patch), {0.3, 0}, 1},
                            {transposed(patch), {1, 0.3}, -1},
                            {transposed(turned_around(patch)), {0, 0.3}, -1}};
  for (const PoleCase& one : cases) {
    EXPECT_EQ(normal(one.patch, one.pole.x, one.pole.y, DegenerateNormal::none), Vec3d(0, 0, 0));
    for (const DegenerateNormal method :
         {DegenerateNormal::gouraud, DegenerateNormal::first_order, DegenerateNormal::limit})
      EXPECT_LE(degrees_between(normal(one.patch, one.pole.x, one.pole.y, method), {0, one.up, 0}), 1e-10);
  }
}

// On the way to the pole and to the cusp no normal jumps: where the methods change over, both are off by no more than
// kVanishedNormal has them.
TEST(DegenerateNormals, ChangeOverWithoutAJump) {
  const BezierPatch octant = sphere_patches()[4];
  for (double distance = 0.1; distance > 1e-18; distance /= 3) {
    const double v = 1 - distance;
    const Vec3d found = normal(octant, 0.3, v, DegenerateNormal::limit);
    // The sphere's own normal there. A few times 1.5e-8 rad, 8.5e-7 degrees.
    EXPECT_LE(degrees_between(found, evaluate(octant, 0.3, v).position), 4 * 8.5e-7) << distance;
  }
  Monomials a = no_monomials();
  a[0][1] = {1, 0, 1};
  a[0][2] = {0, -0.5, 1};
  a[1][2] = {0, 1, 0};
  const BezierPatch cusp = patch_of_monomials(a);
  for (double u = 0.1; u > 1e-18; u /= 3) {
    const Vec3d found = normal(cusp, u, 0.3, DegenerateNormal::limit);
    // P_u x P_v is u^2 (-1 - 2 u, 0, 1). It vanishes at u = 2e-4 by the scale's measure, where its derivative takes
    // over: 2 u (-1, 0, 1) + 6 u^2 (-1, 0, 0), off by u more than the truth is.
    const double turn = u * 180 / kPi;
    EXPECT_LE(degrees_between(found, {-1 - 2 * u, 0, 1}), u < 1e-3 ? 2 * turn + 1e-6 : 1e-6) << u;
  }
}

TEST(DegenerateNormals, WithoutAreaThereIsNone) {
  BezierPatch line;
  for (std::size_t i = 0; i < 16; ++i) line.points[i] = Vec3d(double(i % 4), 0, 0);
  const BezierPatch point;
  for (const DegenerateNormal method : kRemedies) {
    EXPECT_EQ(normal(line, 0.5, 0.5, method), Vec3d(0, 0, 0));
    EXPECT_EQ(normal(point, 0, 1, method), Vec3d(0, 0, 0));
  }
}

// The knob of the teapot's lid and the center of its base: the axis, which is also what the normals around tend to.
TEST(DegenerateNormals, OfTheTeapot) {
  int tips = 0;
  for (const auto& path : test_data_files("patches")) {
    if (path.filename() != "newell_teapot.bpt") continue;
    Warnings warnings;
    for (const BezierPatch& patch : read_patch_file(path.string(), warnings)) {
      // Both are the first row of their patches; z is up.
      if (patch.points[0] != patch.points[3] || patch.points[0] != patch.points[1]) continue;
      ++tips;
      const Vec3d axis(0, 0, patch.points[0].z > 1 ? 1 : -1);
      for (int i = 0; i <= 8; ++i) {
        const double u = i / 8.0;
        EXPECT_EQ(normal(patch, u, 0, DegenerateNormal::none), Vec3d(0, 0, 0));
        EXPECT_LE(degrees_between(normal(patch, u, 0, DegenerateNormal::limit), axis), 1e-12);
        EXPECT_LE(degrees_between(normal(patch, u, 0, DegenerateNormal::first_order), axis), 1e-12);
        EXPECT_LE(degrees_between(normal(patch, u, 0, DegenerateNormal::gouraud), axis), 1e-12);
        // Normals nearby are off by the way there times the curvature.
        for (const double v : {1e-3, 1e-5})
          EXPECT_LE(degrees_between(normal(patch, u, v, DegenerateNormal::none), axis), 400 * v) << v;
      }
    }
    EXPECT_EQ(tips, 8) << "quarters of the lid and of the base";
  }
  if (tips == 0) std::fprintf(stderr, "LEFT OUT: the teapot's tips\n");
}

}  // namespace
}  // namespace raytree
