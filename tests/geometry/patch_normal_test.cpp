// Normals where P_u x P_v vanishes: of Coons patches, on the way there, and where there is no surface. Each method
// against the limit of the normals around is the stability suite's (benchmarks/stability/degenerate_patch_cases.cpp).
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

// At collapsed edges of Coons patches, on every side and with the surface turned inside out.
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
