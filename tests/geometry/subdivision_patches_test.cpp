// Bezier patches of surfaces: of subdivision cages against closed forms of their limits and against OpenSubdiv's own
// evaluation; of Coons patches against themselves.
#include "geometry/subdivision_patches.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/patch_surface.h"
#include "geometry/subdivision_surface.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/geometry/surface_samples.h"
#include "tests/patch_samples.h"

namespace raytree {
namespace {

using namespace test;

/// Shares of the cage's size. Whole faces are the same splines, to single precision. What was divided lies beside
/// extraordinary vertices and creases, where the surface's own evaluation takes Gregory patches: those are off by up to
/// 8.4e-6 across the surface (catalogue of failures, 0.5), and by far more along it, parameters being others'.
constexpr double kRegular = 4e-7, kIrregular = 1e-5;

Vec3d point_of(const LimitPatch& piece, double s, double t) { return evaluate(piece.patch, s, t).position; }

/// Every piece against the surface at the same parameters of the same face; and every face covered once.
void expect_pieces_of(const PolygonMesh& mesh, const SubdivisionRules& rules) {
  Warnings warnings;
  const auto surface = make_subdivision_surface(mesh, rules, {}, warnings);
  const std::vector<LimitPatch> pieces = subdivision_patches(mesh, rules, {});
  std::map<std::uint32_t, double> area;
  const double size = bounds(mesh).size().length();
  for (const LimitPatch& piece : pieces) {
    area[piece.face] += piece.along_u.x * piece.along_v.y;
    EXPECT_EQ(piece.domain, surface->domain(piece.face));
    for (const double s : {0.1, 0.5, 0.8})
      for (const double t : {0.2, 0.6}) {
        const SurfaceSample sample = sample_at(*surface, piece.face, piece.face_parameters(s, t));
        const Vec3d off = point_of(piece, s, t) - Vec3d(sample.position);
        const bool divided = piece.along_u.x < (piece.domain == FaceDomain::quad ? 0.5 : 0.25);
        EXPECT_LT(divided ? std::abs(off.dot(Vec3d(sample.normal))) : off.length(),
                  (divided ? kIrregular : kRegular) * size)
            << "face " << piece.face << " at " << piece.face_parameters(s, t).x << " " << piece.face_parameters(s, t).y;
        const PatchDerivatives at = evaluate(piece.patch, s, t);
        EXPECT_GT(at.du.cross(at.dv).dot(Vec3d(sample.normal)), 0);
      }
  }
  for (std::uint32_t face = 0; face < surface->face_count(); ++face) {
    const std::size_t sides = surface->sides(face).size();
    EXPECT_DOUBLE_EQ(area[face], sides == 0 ? 0.0 : sides == 4 ? 1.0 : 0.25 * double(sides));
  }
}

TEST(SubdivisionPatches, AgreeWithTheLimitSurface) {
  expect_pieces_of(torus_cage(8, 5), {});
  expect_pieces_of(grid_cage(5, 4, 1), {});
  expect_pieces_of(cube_cage(), {});
  for (const int n : {3, 5, 6, 7}) expect_pieces_of(star_cage(n), {});
}

TEST(SubdivisionPatches, FollowCreasesCornersHolesAndBoundaries) {
  SubdivisionRules rules;
  rules.creases = {{{0, 1, 3, 2, 0}, kInfiniteSharpness}};
  expect_pieces_of(cube_cage(), rules);
  rules.creases = {{{0, 1, 3}, 2.5}};
  rules.corners = {{7, 3}};
  expect_pieces_of(cube_cage(), rules);
  rules = {};
  rules.holes = {4};
  expect_pieces_of(grid_cage(5, 4, 1), rules);
  for (const BoundaryRule boundary : {BoundaryRule::none, BoundaryRule::edge_only, BoundaryRule::edge_and_corner}) {
    rules = {};
    rules.boundary = boundary;
    expect_pieces_of(grid_cage(6, 5, 1), rules);
  }
  rules = {};
  rules.scheme = SubdivisionScheme::bilinear;
  expect_pieces_of(cube_cage(), rules);
}

TEST(SubdivisionPatches, CutPolygonsInQuads) {
  PolygonMesh pyramid;
  for (int i = 0; i < 5; ++i) pyramid.positions.push_back(Vec3f(Vec3d(std::cos(1.2566 * i), 0, -std::sin(1.2566 * i))));
  pyramid.positions.push_back(Vec3f(0, 1, 0));
  for (std::uint32_t i = 0; i < 5; ++i) add_face(pyramid, {i, (i + 1) % 5, 5});
  add_face(pyramid, {4, 3, 2, 1, 0});
  expect_pieces_of(pyramid, {});
}

/// The limit of the cube's corners, (1, 1, 1) / 2, of its faces' middles, 68 / 81, and of its edges' middles.
TEST(SubdivisionPatches, CubeMeetsItsClosedForms) {
  const std::vector<LimitPatch> pieces = subdivision_patches(cube_cage(), {}, {});
  const auto nearest = [&](const Vec3d& p) {
    double best = 1;
    for (const LimitPatch& piece : pieces)
      for (const double s : {0.0, 1.0})
        for (const double t : {0.0, 1.0}) best = std::min(best, (point_of(piece, s, t) - p).length());
    return best;
  };
  for (const double sign : {-1.0, 1.0}) {
    // Where faces and edges are regular the pieces are exact; at corners what is left is fitted.
    EXPECT_LT(nearest({68.0 / 81 * sign, 0, 0}), 1e-14);
    EXPECT_LT(nearest({0, 0, 68.0 / 81 * sign}), 1e-14);
    EXPECT_LT(nearest({395.0 / 648, 0, 395.0 / 648 * sign}), 1e-14);
    EXPECT_LT(nearest(Vec3d(0.5, 0.5, 0.5) * sign), 1e-7);
  }
}

TEST(SubdivisionPatches, LoopsSchemeHasNone) {
  PolygonMesh tetrahedron;
  tetrahedron.positions = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)};
  tetrahedron.corners = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  SubdivisionRules rules;
  rules.scheme = SubdivisionScheme::loop;
  EXPECT_TRUE(subdivision_patches(tetrahedron, rules, {}).empty());
}

TEST(LimitPatches, CoonsPatchesArePlainBezierPatches) {
  std::mt19937 random(4);
  const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  CoonsPatch coons;
  for (BezierCurve* curve : {&coons.bottom, &coons.top, &coons.left, &coons.right})
    for (Vec3d& p : curve->points) p = {number(), number(), number()};
  coons.left.points[0] = coons.bottom.points[0], coons.right.points[0] = coons.bottom.points[3];
  coons.left.points[3] = coons.top.points[0], coons.right.points[3] = coons.top.points[3];
  Warnings warnings;
  const std::vector<LimitPatch> pieces = PatchSurface({coons}, {}, {}, warnings).limit_patches();
  ASSERT_EQ(pieces.size(), 1u);
  for (const double u : {0.0, 0.3, 1.0})
    for (const double v : {0.0, 0.7, 1.0})
      EXPECT_LT((point_of(pieces[0], u, v) - evaluate(coons, u, v).position).length(), 1e-14);
  coons.top.weights[1] = 2;
  EXPECT_TRUE(PatchSurface({coons}, {}, {}, warnings).limit_patches().empty());
}

}  // namespace
}  // namespace raytree
