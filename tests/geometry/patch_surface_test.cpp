// Patches as one surface: what is shared, what is collapsed, what is sharp, and which way is out.
#include "geometry/patch_surface.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <set>

#include "geometry/angle.h"
#include "geometry/open_edges.h"
#include "geometry/patch_reader.h"
#include "geometry/tessellation.h"
#include "tests/geometry/surface_samples.h"
#include "tests/patch_samples.h"
#include "tests/reader_checks.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using namespace test;

PatchSurface surface_of(const std::vector<BezierPatch>& patches, const PatchSurfaceOptions& options = {}) {
  Warnings warnings;
  PatchSurface surface({patches.begin(), patches.end()}, options, {"test", 0, ""}, warnings);
  EXPECT_TRUE(warnings.empty());
  return surface;
}

/// A flat square [x, x + 1] x [0, 1] in z = slope * max(x, 0).
BezierPatch square(double x, double slope) {
  BezierPatch patch;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const double at = x + double(i) / 3;
      patch.points[4 * j + i] = {at, double(j) / 3, slope * std::max(at, 0.0)};
    }
  return patch;
}

/// Every edge's uses: sides with their face.
std::map<std::uint32_t, std::vector<std::pair<std::size_t, std::size_t>>> uses_of_edges(const PatchSurface& surface) {
  std::map<std::uint32_t, std::vector<std::pair<std::size_t, std::size_t>>> uses;
  for (std::size_t face = 0; face < surface.face_count(); ++face)
    for (std::size_t side = 0; side < 4; ++side) uses[surface.sides(face)[side].edge].emplace_back(face, side);
  return uses;
}

/// Shared edges run once each way between the same vertices and through the same points.
void expect_consistent(const PatchSurface& surface) {
  for (const auto& [edge, uses] : uses_of_edges(surface)) {
    EXPECT_LT(edge, surface.edge_count());
    EXPECT_LE(uses.size(), 2u);
    if (uses.size() < 2) continue;
    const auto at = [&, &uses = uses](std::size_t k) { return surface.sides(uses[k].first)[uses[k].second]; };
    const auto end = [&, &uses = uses](std::size_t k) {
      return surface.sides(uses[k].first)[(uses[k].second + 1) % 4].vertex;
    };
    EXPECT_NE(at(0).reversed, at(1).reversed);
    EXPECT_EQ(at(0).vertex, end(1));
    EXPECT_EQ(at(1).vertex, end(0));
    EXPECT_EQ(at(0).sharp_edge, at(1).sharp_edge);
    for (int i = 0; i <= 8; ++i) {
      const Vec3f a = test::sample_at(surface, uses[0].first, side_parameter(uses[0].second, i / 8.0)).position;
      const Vec3f b = test::sample_at(surface, uses[1].first, side_parameter(uses[1].second, 1 - i / 8.0)).position;
      // Both rounded from doubles that agree to a few ulp of double: at most one ulp of float apart.
      EXPECT_LE((a - b).length(), 2 * std::numeric_limits<float>::epsilon() * std::max(a.length(), 1e-3f));
    }
  }
}

TEST(PatchSurface, JoinsPatchesAlongEqualControlPoints) {
  const PatchSurface surface = surface_of({square(-1, 0), square(0, 0)});
  EXPECT_EQ(surface.vertex_count(), 6u);
  EXPECT_EQ(surface.edge_count(), 7u);
  const FaceEdge right = surface.sides(0)[1], left = surface.sides(1)[3];
  EXPECT_EQ(right.edge, left.edge);
  EXPECT_NE(right.reversed, left.reversed);
  EXPECT_FALSE(right.sharp_edge) << "one plane";
  EXPECT_TRUE(surface.sides(0)[0].sharp_edge) << "a boundary";
  expect_consistent(surface);
  EXPECT_EQ(test::sample_at(surface, 1, {0.5, 0.5}).normal, Vec3f(0, 0, 1));
}

TEST(PatchSurface, JoinsWhatSinglePrecisionCannotTellApart) {
  std::vector<BezierPatch> patches{square(-1, 0), square(0, 0)};
  // The extent is 2: places are the same up to 2.4e-7.
  for (const auto& [gap, edges] : {std::pair(1e-7, 7u), {1e-6, 8u}}) {
    std::vector<BezierPatch> moved = patches;
    for (Vec3d& p : moved[1].points) p.y += gap;
    EXPECT_EQ(surface_of(moved).edge_count(), edges) << gap;
  }
}

TEST(PatchSurface, CreasesWhereNormalsDiffer) {
  // 0.5 and 2 degrees, about the default of 1.
  for (const double degrees : {0.5, 2.0}) {
    const PatchSurface surface = surface_of({square(-1, 0), square(0, std::tan(degrees * kDegree))});
    const bool sharp = degrees > kPatchCreaseAngle;
    EXPECT_EQ(surface.sides(0)[1].sharp_edge, sharp);
    EXPECT_EQ(surface.sides(1)[3].sharp_edge, sharp);
    EXPECT_EQ(surface.sides(0)[1].sharp_vertex, sharp);
    EXPECT_FALSE(surface.sides(0)[0].sharp_vertex) << "a corner of one patch alone";
    PatchSurfaceOptions wide;
    wide.crease_angle = 3;
    EXPECT_FALSE(surface_of({square(-1, 0), square(0, 0.03)}, wide).sides(0)[1].sharp_edge);
  }
}

// Row 11 of the catalogue: patches that meet at a right angle, as a T-tail's do. One normal for both, here that of the
// patch that comes first, is wrong by the whole angle on the other; each its own is right. (A mean would be wrong by 45
// degrees on both.)
TEST(PatchSurface, RightAnglesShareNoNormal) {
  BezierPatch wall;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) wall.points[4 * j + i] = {0, double(j) / 3, double(i) / 3};
  for (const double crease_angle : {180.0, kPatchCreaseAngle}) {
    PatchSurfaceOptions options;
    options.crease_angle = crease_angle;
    const TriangleMesh mesh = tessellate_uniformly(surface_of({square(-1, 0), wall}, options), 4);
    double worst = 0;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
      const std::uint32_t normal = mesh.normal_corners.empty() ? mesh.corners[i] : mesh.normal_corners[i];
      const Vec3d truth = mesh.triangle_faces[i / 3] == 0 ? Vec3d(0, 0, 1) : Vec3d(-1, 0, 0);
      worst = std::max(worst, degrees_between(Vec3d(mesh.normals[normal]), truth));
    }
    std::printf("row 11, crease angle %g: normals off by up to %g degrees\n", crease_angle, worst);
    EXPECT_NEAR(worst, crease_angle == 180 ? 90 : 0, 1e-5);
  }
}

TEST(PatchSurface, WeightsMustAgreeInProportion) {
  std::vector<BezierPatch> patches{square(-1, 0), square(0, 0)};
  for (std::size_t j = 0; j < 4; ++j) patches[0].weights[4 * j + 3] = 2, patches[1].weights[4 * j] = 5;
  EXPECT_EQ(surface_of(patches).edge_count(), 7u);
  patches[0].weights[7] = 3;
  EXPECT_EQ(surface_of(patches).edge_count(), 8u) << "another curve over the same points";
}

TEST(PatchSurface, TheSphereIsClosedAndItsPolesAreVertices) {
  for (const bool flip : {false, true}) {
    PatchSurfaceOptions options;
    options.flip = flip;
    const PatchSurface surface = surface_of(sphere_patches(), options);
    // Two poles and four on the equator; twelve quarter circles and eight edges that are points.
    EXPECT_EQ(surface.vertex_count(), 6u);
    EXPECT_EQ(surface.edge_count(), 12u + 8u);
    expect_consistent(surface);
    int collapsed = 0;
    for (std::size_t face = 0; face < 8; ++face)
      for (std::size_t side = 0; side < 4; ++side) {
        const FaceEdge& here = surface.sides(face)[side];
        EXPECT_FALSE(here.sharp_edge);
        EXPECT_FALSE(here.sharp_vertex);
        if (!surface.sides(face)[side].collapsed) continue;
        ++collapsed;
        EXPECT_EQ(here.vertex, surface.sides(face)[(side + 1) % 4].vertex);
        const Vec3f corner = test::sample_at(surface, face, side_parameter(side, 0)).position;
        for (int i = 0; i <= 100; ++i) {
          const SurfaceSample at = test::sample_at(surface, face, side_parameter(side, i / 100.0));
          EXPECT_EQ(std::memcmp(&at.position, &corner, sizeof corner), 0) << "the same bits";
          EXPECT_NEAR(at.normal.y, (flip ? -1 : 1) * corner.y, 1e-7);
        }
      }
    EXPECT_EQ(collapsed, 8);
    for (std::size_t face = 0; face < 8; ++face) {
      const SurfaceSample at = test::sample_at(surface, face, {0.25, 0.5});
      EXPECT_NEAR(at.position.dot(at.normal), flip ? -1 : 1, 1e-6) << "outward, or inward";
      EXPECT_GT(at.du.cross(at.dv).dot(at.normal), 0) << "right-handed either way";
      EXPECT_EQ(test::texture_at(surface, face, {0.25f, 0.5f}), flip ? Vec2f(0.5f, 0.25f) : Vec2f(0.25f, 0.5f));
    }
  }
}

// A tip halfway between two floats, so that the last bit of a sum in double shows.
TEST(PatchSurface, ACollapsedSideIsOnePointToTheBit) {
  std::mt19937 random(8);
  BezierPatch patch = random_patch(random, true);
  for (std::size_t i = 0; i < 4; ++i) patch.points[i] = {1 + 0x1p-24, 0.5 + 0x1p-25, -1 - 0x3p-24};
  const PatchSurface surface = surface_of({patch});
  ASSERT_TRUE(surface.sides(0)[0].collapsed);
  const Vec3f corner = test::sample_at(surface, 0, {0, 0}).position;
  for (int i = 0; i <= 100; ++i) {
    const Vec3f point = test::sample_at(surface, 0, {i / 100.0, 0}).position;
    EXPECT_EQ(std::memcmp(&point, &corner, sizeof corner), 0) << i;
  }
}

TEST(PatchSurface, TheTipOfAConeIsSharp) {
  const std::vector<BezierCurve> profile{straight({1, 0, 0}, {0, 1, 0})};
  const PatchSurface surface = surface_of(revolve(profile));
  for (std::size_t face = 0; face < 4; ++face) {
    EXPECT_TRUE(surface.sides(face)[2].collapsed);
    EXPECT_FALSE(surface.sides(face)[1].sharp_edge) << "smooth from quarter to quarter";
    EXPECT_TRUE(surface.sides(face)[2].sharp_edge) << "the tip has another normal for every ruling";
    EXPECT_TRUE(surface.sides(face)[2].sharp_vertex);
    EXPECT_TRUE(surface.sides(face)[3].sharp_vertex);
    EXPECT_FALSE(surface.sides(face)[0].sharp_vertex);
  }
}

TEST(PatchSurface, TessellatesWithoutACrackOrATriangleWithoutArea) {
  for (const int rate : {1, 2, 5, 16}) {
    const TriangleMesh mesh = tessellate_uniformly(surface_of(sphere_patches()), rate);
    // An octant has 2 rate^2 facets, less the ones along its pole.
    EXPECT_EQ(mesh.triangle_count(), std::size_t(8 * (2 * rate * rate - rate)));
    EXPECT_EQ(count_open_edges(mesh), 0) << "at rate " << rate;
    // Two poles, four corners on the equator, twelve edges and eight insides.
    EXPECT_EQ(mesh.positions.size(), std::size_t(6 + 12 * (rate - 1) + 8 * (rate - 1) * (rate - 1)));
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
      const auto at = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.corners[3 * i + k]]); };
      EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).dot(at(0) + at(1) + at(2)), 0) << "outward";
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      EXPECT_LE((mesh.positions[i] - mesh.normals[i]).length(), 1e-6f) << "on the unit sphere both are the same";
  }
}

// Two collapsed sides, and all four, which makes a closed bag of one patch: what has no area is left out.
TEST(PatchSurface, TessellatesWhatIsCollapsedMoreThanOnce) {
  BezierPatch lens, bag;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) lens.points[4 * j + i] = {double(i) * double(j) * double(3 - j), double(j), 0};
  bag.points[5] = {-1, -1, 1}, bag.points[6] = {1, -1, 2}, bag.points[9] = {-1, 1, 3}, bag.points[10] = {1, 1, 1};
  EXPECT_EQ(tessellate_uniformly(surface_of({lens}), 4).triangle_count(), std::size_t(2 * 4 * 4 - 2 * 4));
  const PatchSurface surface = surface_of({bag});
  EXPECT_EQ(surface.vertex_count(), 1u);
  const TriangleMesh mesh = tessellate_uniformly(surface, 4);
  EXPECT_EQ(mesh.positions.size(), 1u + 3 * 3);
  EXPECT_EQ(count_open_edges(mesh), 0);
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    EXPECT_TRUE(mesh.corners[i] != mesh.corners[i + 1] && mesh.corners[i + 1] != mesh.corners[i + 2] &&
                mesh.corners[i + 2] != mesh.corners[i]);
}

TEST(PatchSurface, TheTipOfAConeShadesRoundly) {
  const std::vector<BezierCurve> profile{straight({1, 0, 0}, {0, 1, 0})};
  const TriangleMesh mesh = tessellate_uniformly(surface_of(revolve(profile)), 8);
  double worst = 0;
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const Vec3f& n = mesh.normals[mesh.normal_corners[i]];
    EXPECT_NEAR(n.y, std::sqrt(0.5), 1e-6);
    // Each corner's normal points along its own facet's: within the quarter's eighth that the facet covers.
    const std::size_t t = i / 3 * 3;
    const auto at = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.corners[t + k]]); };
    worst = std::max(worst, degrees_between(Vec3d(n), (at(1) - at(0)).cross(at(2) - at(0))));
  }
  // Rational quarters run unevenly, up to 13 degrees a step of 1/8; off by less than one step at the edge of a facet.
  EXPECT_LE(worst, 13);
}

TEST(PatchSurface, FarAwayNothingIsLost) {
  std::vector<BezierPatch> patches = sphere_patches();
  const Vec3d far(1e6, -2e6, 3e6);
  for (BezierPatch& patch : patches)
    for (Vec3d& p : patch.points) p += far;
  const PatchSurface surface = surface_of(patches);
  EXPECT_EQ(surface.vertex_count(), 6u);
  expect_consistent(surface);
  // Moving the control points rounded them to half an ulp of 3e6.
  for (std::size_t face = 0; face < 8; ++face)
    EXPECT_NEAR((Vec3d(test::sample_at(surface, face, {0.25, 0.5}).position) + surface.origin() - far).length(), 1,
                1e-8 + 1e-7);
}

TEST(PatchSurface, EveryNormalIsUnitWhateverIsAskedFor) {
  std::vector<BezierPatch> patches = sphere_patches();
  BezierPatch line, point;
  for (std::size_t i = 0; i < 16; ++i) line.points[i] = Vec3d(double(i % 4), 0, 0);
  patches.push_back(line);
  patches.push_back(point);
  for (const DegenerateNormal method :
       {DegenerateNormal::none, DegenerateNormal::gouraud, DegenerateNormal::first_order, DegenerateNormal::limit}) {
    PatchSurfaceOptions options;
    options.degenerate_normals = method;
    Warnings warnings;
    const PatchSurface surface({patches.begin(), patches.end()}, options, {}, warnings);
    for (std::size_t face = 0; face < surface.face_count(); ++face)
      for (const double u : {0.0, 0.3, 1.0})
        for (const double v : {0.0, 0.3, 1.0})
          EXPECT_NEAR(test::sample_at(surface, face, {u, v}).normal.length(), 1, 1e-6) << face << ' ' << u << ' ' << v;
  }
}

TEST(PatchSurface, RefusesWhatIsNoSurface) {
  const auto make = [](std::vector<SurfacePatch> patches) {
    Warnings warnings;
    PatchSurface(std::move(patches), {}, {"test.json", 7, "shapes.a"}, warnings);
  };
  const auto expect_refused = [&](const std::vector<SurfacePatch>& patches, const std::string& part) {
    expect_refusal([&] { make(patches); }, "test.json", 7, part);
  };
  expect_refused({}, "at least one patch");
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BezierPatch patch = square(0, 0);
    patch.points[7].y = bad;
    expect_refused({square(0, 0), patch}, "patch 2: a control point is not finite");
    patch = square(0, 0);
    patch.weights[3] = bad;
    expect_refused({patch}, "patch 1: a weight is not positive");
  }
  BezierPatch patch = square(0, 0);
  patch.weights[0] = 0;
  expect_refused({patch}, "patch 1: a weight is not positive");
  CoonsPatch coons{side_curve(square(0, 0), 0), side_curve(square(0, 0), 0), side_curve(square(0, 0), 0),
                   side_curve(square(0, 0), 0)};
  expect_refused({coons}, "do not meet in the corners");
}

TEST(PatchSurface, WarnsOfPatchesInsideOut) {
  std::vector<BezierPatch> patches{square(-1, 0), transposed(square(0, 0))};
  Warnings warnings;
  PatchSurface({patches.begin(), patches.end()}, {}, {}, warnings);
  EXPECT_EQ(found_warning(warnings, "inside out"), "0 x1");
}

TEST(PatchSurface, OfTheTeapot) {
  bool found = false;
  for (const auto& path : test_data_files("patches")) {
    if (path.filename() != "newell_teapot.bpt") continue;
    found = true;
    Warnings warnings;
    const std::vector<BezierPatch> patches = read_patch_file(path.string(), warnings);
    const PatchSurface surface = surface_of(patches);
    expect_consistent(surface);
    std::size_t boundary = 0, collapsed = 0, creases = 0;
    double widest = 0;
    for (const auto& [edge, uses] : uses_of_edges(surface)) {
      const auto [face, side] = uses[0];
      if (surface.sides(face)[side].collapsed)
        ++collapsed;
      else if (uses.size() == 1)
        ++boundary;
      else {
        if (surface.sides(face)[side].sharp_edge) ++creases;
        for (int i = 0; i <= 16; ++i)
          widest = std::max(
              widest,
              degrees_between(
                  Vec3d(test::sample_at(surface, uses[0].first, side_parameter(uses[0].second, i / 16.0)).normal),
                  Vec3d(test::sample_at(surface, uses[1].first, side_parameter(uses[1].second, 1 - i / 16.0)).normal)));
      }
    }
    EXPECT_EQ(surface.edge_count(), 76u);
    EXPECT_EQ(collapsed, 8u) << "lid and base";
    EXPECT_EQ(boundary, 16u) << "rim 4, lid 4, both ends of handle and spout 2 each";
    std::printf("teapot: normals of neighbors differ by up to %.3g degrees\n", widest);
    EXPECT_EQ(creases, 0u);
    EXPECT_EQ(surface.vertex_count(), 37u);
    // Outside is away from the axis, or from the body's middle.
    for (std::size_t face = 4; face < 12; ++face) {
      const SurfaceSample at = test::sample_at(surface, face, {0.5, 0.5});
      EXPECT_GT(at.normal.x * at.position.x + at.normal.y * at.position.y, 0) << face;
    }
    EXPECT_GT(test::sample_at(surface, 20, {0.5, 0}).normal.z, 0.999f) << "the lid's knob";
    EXPECT_LT(test::sample_at(surface, 28, {0.5, 0}).normal.z, -0.999f) << "the base";
  }
  if (!found) std::fprintf(stderr, "LEFT OUT: the teapot as a surface\n");
}

}  // namespace
}  // namespace raytree
