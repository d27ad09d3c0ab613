// The limit surface against closed forms: the cube, regular faces, creases and corners (vertices of every valence:
// benchmarks/stability/subdivision_cases.cpp);
// degenerate points; bits at any number of threads; OpenSubdiv's own shapes.
#include "geometry/subdivision_surface.h"

#include <gtest/gtest.h>
#include <opensubdiv/version.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <cstring>

#include "geometry/angle.h"
#include "geometry/mesh_file.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/geometry/surface_samples.h"
#include "tests/test_data.h"

namespace raytree {
namespace {

using test::cube_cage;
using test::degrees_between;

std::unique_ptr<ParametricSurface> limit_surface(const PolygonMesh& mesh, const SubdivisionRules& rules = {}) {
  Warnings warnings;
  return make_subdivision_surface(mesh, rules, {}, warnings);
}

SurfaceSample sample_at(const ParametricSurface& surface, std::size_t face, float u, float v) {
  return test::sample_at(surface, face, Vec2d(double(u), double(v)));
}

double box_size(const PolygonMesh& mesh) { return bounds(mesh).size().length(); }

TEST(SubdivisionSurface, CubeMeetsItsClosedForms) {
  const PolygonMesh cube = cube_cage();
  const auto surface = limit_surface(cube);
  ASSERT_EQ(surface->face_count(), 6u);
  EXPECT_EQ(surface->edge_count(), 12u);
  const double tolerance = 1e-6 * box_size(cube);
  for (std::size_t face = 0; face < 6; ++face) {
    EXPECT_EQ(surface->domain(face), FaceDomain::quad);
    const auto sides = surface->sides(face);
    ASSERT_EQ(sides.size(), 4u);
    const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Vec3d middle(0);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_FALSE(sides[i].sharp_edge || sides[i].sharp_vertex);
      const Vec3d corner(cube.positions[sides[i].vertex]), next(cube.positions[sides[(i + 1) % 4].vertex]);
      middle += corner / 4.0;
      const SurfaceSample at_corner = sample_at(*surface, face, corners[i][0], corners[i][1]);
      EXPECT_LE((Vec3d(at_corner.position) - corner / 2.0).length(), tolerance);
      EXPECT_LE(degrees_between(Vec3d(at_corner.normal), corner.normalized()), 0.02);
      const auto half = [&](int k) { return (corners[i][k] + corners[(i + 1) % 4][k]) / 2; };
      const SurfaceSample at_edge = sample_at(*surface, face, half(0), half(1));
      EXPECT_LE((Vec3d(at_edge.position) - (corner + next) / 2.0 * (395.0 / 648)).length(), tolerance);
      EXPECT_LE(degrees_between(Vec3d(at_edge.normal), (corner + next).normalized()), 0.02);
    }
    const SurfaceSample center = sample_at(*surface, face, 0.5f, 0.5f);
    EXPECT_LE((Vec3d(center.position) - middle * (68.0 / 81)).length(), tolerance);
    EXPECT_LE(degrees_between(Vec3d(center.normal), middle), 0.02);
  }
}

TEST(SubdivisionSurface, RegularFacesAreBicubicBSplines) {
  const PolygonMesh grid = test::grid_cage(4, 4, 1);
  const auto surface = limit_surface(grid);
  const auto weights = [](double t, int derivative) {
    const double s = 1 - t;
    return derivative == 0
               ? std::array<double, 4>{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                       (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6}
               : std::array<double, 4>{-s * s / 2, (3 * t * t - 4 * t) / 2, (-3 * t * t + 2 * t + 1) / 2, t * t / 2};
  };
  for (const float u : {0.0f, 0.2f, 0.5f, 0.9f, 1.0f})
    for (const float v : {0.0f, 0.3f, 0.5f, 0.75f, 1.0f}) {
      const auto blend = [&](int du, int dv) {
        Vec3d sum(0);
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j < 4; ++j)
            sum += Vec3d(grid.positions[4 * i + j]) * (weights(double(u), du)[j] * weights(double(v), dv)[i]);
        return sum;
      };
      const SurfaceSample sample = sample_at(*surface, 4, u, v);  // the middle face of nine
      // Sums of 16 floats of up to 3, weights that add up to 1 (derivatives: 2): a few roundings of 2^-24 each.
      EXPECT_LE((Vec3d(sample.position) - blend(0, 0)).length(), 1e-6);
      EXPECT_LE((Vec3d(sample.du) - blend(1, 0)).length(), 2e-6);
      EXPECT_LE((Vec3d(sample.dv) - blend(0, 1)).length(), 2e-6);
      EXPECT_LE(degrees_between(Vec3d(sample.normal), blend(1, 0).cross(blend(0, 1)).normalized()), 2e-4);
    }
}

TEST(SubdivisionSurface, BoundaryAndCornerRulesHold) {
  // A single quad. Edge and corner: corners stay. Edge only: they become (4 p + e1 + e2) / 6, the end of a B-spline
  // through the boundary's vertices; midpoints of its edges (23 (a + b) + c + d) / 48.
  const PolygonMesh quad = test::grid_cage(2, 2, 0);
  SubdivisionRules rules;
  rules.boundary = BoundaryRule::edge_and_corner;
  EXPECT_LE((sample_at(*limit_surface(quad, rules), 0, 0, 0).position - Vec3f(0, 0, 0)).length(), 1e-6f);
  EXPECT_TRUE(limit_surface(quad, rules)->sides(0)[0].sharp_edge);
  rules.boundary = BoundaryRule::edge_only;
  const auto smooth = limit_surface(quad, rules);
  EXPECT_LE((sample_at(*smooth, 0, 0, 0).position - Vec3f(1.0f / 6, 1.0f / 6, 0)).length(), 1e-6f);
  EXPECT_LE((sample_at(*smooth, 0, 0.5f, 0).position - Vec3f(0.5f, 2.0f / 48, 0)).length(), 1e-6f);
  rules.boundary = BoundaryRule::none;
  EXPECT_TRUE(limit_surface(quad, rules)->sides(0).empty());
  const auto inner = limit_surface(test::grid_cage(4, 4, 0), rules);
  for (std::size_t face = 0; face < 9; ++face) EXPECT_EQ(inner->sides(face).size(), face == 4 ? 4u : 0u);
}

TEST(SubdivisionSurface, ParallelDerivativesAtSmoothCornersHaveNormals) {
  // Row 10 of the catalogue: the corner of a single quad with a rounded boundary, where du and dv are parallel.
  PolygonMesh quad = test::grid_cage(2, 2, 0);
  const auto surface = limit_surface(quad);
  for (const float u : {0.0f, 1.0f})
    for (const float v : {0.0f, 1.0f}) {
      const SurfaceSample sample = sample_at(*surface, 0, u, v);
      EXPECT_LE(Vec3d(sample.du.cross(sample.dv)).length(), 1e-6);
      EXPECT_LE(degrees_between(Vec3d(sample.normal), Vec3d(0, 0, 1)), 0.02);
    }
  // Bent: the expansion's normal is the limit of those nearby.
  quad.positions[0].z = 0.5f;
  const auto bent = limit_surface(quad);
  const SurfaceSample corner = sample_at(*bent, 0, 0, 0);
  const SurfaceSample near = sample_at(*bent, 0, 1e-3f, 1e-3f);
  EXPECT_NEAR(corner.normal.length(), 1, 1e-6);
  EXPECT_LE(degrees_between(Vec3d(corner.normal), Vec3d(near.normal)), 0.3);
}

TEST(SubdivisionSurface, CollapsedEdgesHaveTheirLimitNormals) {
  // Row 8: a bilinear cone patch, its edge v = 1 a point, P = (1 - v) (base(u)) + v tip. At the tip du = 0; the normal
  // of P_uv x P_v is that of the triangle, constant along v.
  PolygonMesh cone;
  cone.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 1}, {0.5f, 1, 1}};
  test::add_face(cone, {0, 1, 2, 3});
  SubdivisionRules rules;
  rules.scheme = SubdivisionScheme::bilinear;
  const auto surface = limit_surface(cone, rules);
  const Vec3d expected = Vec3d(1, 0, 0).cross(Vec3d(0.5, 1, 1)).normalized();
  for (const float u : {0.0f, 0.25f, 1.0f}) {
    EXPECT_EQ(sample_at(*surface, 0, u, 1).du.length(), 0);
    EXPECT_LE(degrees_between(Vec3d(sample_at(*surface, 0, u, 1).normal), expected), 0.02);
  }
  // A face that is a point everywhere, and one that is a line: some unit vector.
  for (const float x : {0.0f, 1.0f}) {
    PolygonMesh nothing;
    nothing.positions = {{0, 0, 0}, {x, 0, 0}, {2 * x, 0, 0}, {x, 0, 0}};
    test::add_face(nothing, {0, 1, 2, 3});
    for (const auto scheme : {SubdivisionScheme::catmark, SubdivisionScheme::bilinear}) {
      rules.scheme = scheme;
      EXPECT_NEAR(sample_at(*limit_surface(nothing, rules), 0, 0.5f, 0.5f).normal.length(), 1, 1e-6);
    }
  }
}

TEST(SubdivisionSurface, InfiniteCreasesHaveANormalForEachFace) {
  // Row 55: the cube's top edges infinitely sharp; the top is flat along them, the corner of a crease is
  // (1, 4, 1) / 6 of the crease's vertices.
  const PolygonMesh cube = cube_cage();
  SubdivisionRules rules;
  rules.creases = {{{4, 5, 7, 6, 4}, kInfiniteSharpness}};
  const auto surface = limit_surface(cube, rules);
  const SurfaceSample top = sample_at(*surface, 5, 0, 0), side = sample_at(*surface, 2, 1, 1);
  const Vec3d corner = (Vec3d(-1, -1, 1) * 4.0 + Vec3d(1, -1, 1) + Vec3d(-1, 1, 1)) / 6.0;
  EXPECT_LE((Vec3d(top.position) - corner).length(), 1e-6);
  const SurfaceSample on_side = sample_at(*surface, 2, 0, 1);
  EXPECT_LE((Vec3d(on_side.position) - corner).length(), 1e-6);
  EXPECT_LE(degrees_between(Vec3d(top.normal), Vec3d(0, 0, 1)), 0.02);
  EXPECT_GT(degrees_between(Vec3d(side.normal), Vec3d(top.normal)), 30);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(surface->sides(5)[i].sharp_edge && surface->sides(5)[i].sharp_vertex);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(surface->sides(4)[i].sharp_edge);
  // Infinity itself is as sharp as 10.
  rules.creases[0].sharpness = std::numeric_limits<double>::infinity();
  EXPECT_EQ(sample_at(*limit_surface(cube, rules), 2, 0, 1).position, on_side.position);
  // A crease angle finds the cube's edges: its faces stay flat, its corners where they are.
  SubdivisionRules angle;
  angle.crease_angle = 45;
  const auto sharp = limit_surface(cube, angle);
  EXPECT_LE((sample_at(*sharp, 0, 0, 0).position - cube.positions[0]).length(), 1e-6f);
  EXPECT_TRUE(sharp->sides(0)[0].sharp_edge);
  angle.crease_angle = 91;
  EXPECT_FALSE(limit_surface(cube, angle)->sides(0)[0].sharp_edge);
}

TEST(SubdivisionSurface, SharpCornersHolesAndMissingCreases) {
  const PolygonMesh cube = cube_cage();
  SubdivisionRules rules;
  rules.corners = {{0, 12}};
  rules.holes = {3};
  rules.creases = {{{0, 7}, 2}};
  Warnings warnings;
  const auto surface = make_subdivision_surface(cube, rules, {}, warnings);
  EXPECT_LE((sample_at(*surface, 0, 0, 0).position - cube.positions[0]).length(), 1e-6f);
  EXPECT_TRUE(surface->sides(0)[0].sharp_vertex);
  EXPECT_TRUE(surface->sides(3).empty());
  EXPECT_EQ(surface->sides(2).size(), 4u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].message.find("does not have"), std::string::npos);
}

TEST(SubdivisionSurface, TextureCoordinatesFollowTheirRule) {
  // Each face of the cube is an island of its own.
  PolygonMesh cube = cube_cage();
  cube.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int face = 0; face < 6; ++face)
    for (std::uint32_t i = 0; i < 4; ++i) cube.texture_corners.push_back(i);
  SubdivisionRules rules;
  for (const auto rule : {FaceVaryingRule::all, FaceVaryingRule::boundaries}) {
    rules.face_varying = rule;
    const auto surface = limit_surface(cube, rules);
    EXPECT_TRUE(surface->has_texture());
    if (rule == FaceVaryingRule::all) {
      EXPECT_LE((test::texture_at(*surface, 1, {0.25f, 0.5f}) - Vec2f(0.25f, 0.5f)).length(), 1e-6f);
    }
    EXPECT_LE((test::texture_at(*surface, 1, {1, 1}) - Vec2f(1, 1)).length(), 1e-6f);
  }
  EXPECT_FALSE(limit_surface(cube_cage())->has_texture());
}

TEST(SubdivisionSurface, TrianglesAndPentagonsHaveSubfaces) {
  PolygonMesh house;  // a prism over a pentagon: two pentagons, five quads
  for (int z = 0; z < 2; ++z)
    for (int i = 0; i < 5; ++i) {
      const double a = 2 * kPi * i / 5;
      house.positions.push_back(Vec3f(Vec3d(std::cos(a), std::sin(a), z)));
    }
  test::add_face(house, {4, 3, 2, 1, 0});
  test::add_face(house, {5, 6, 7, 8, 9});
  for (std::uint32_t i = 0; i < 5; ++i) test::add_face(house, {i, (i + 1) % 5, 5 + (i + 1) % 5, 5 + i});
  const auto surface = limit_surface(house);
  EXPECT_EQ(surface->domain(0), FaceDomain::quad_subfaces);
  EXPECT_EQ(surface->sides(0).size(), 5u);
  // The pentagon's middle (sub-face 0's far corner) is its axis, by symmetry.
  const SurfaceSample middle = sample_at(*surface, 1, 0.5f, 0.5f);
  EXPECT_LE(std::hypot(middle.position.x, middle.position.y), 1e-6f);
  EXPECT_LE(degrees_between(Vec3d(middle.normal), Vec3d(0, 0, 1)), 0.02);

  PolygonMesh tetrahedron;
  tetrahedron.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  tetrahedron.corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  EXPECT_EQ(limit_surface(tetrahedron)->domain(0), FaceDomain::quad_subfaces);
  SubdivisionRules loop;
  loop.scheme = SubdivisionScheme::loop;
  const auto rounded = limit_surface(tetrahedron, loop);
  EXPECT_EQ(rounded->domain(0), FaceDomain::triangle);
  // Loop's limit of a vertex of valence 3: beta = 3/16, P = (1 - w) v + w mean(e), w = 1 / (1 + 3 / (8 * 3 beta / 3)).
  const double w = 1 / (1 + 3 / (8 * (3.0 / 16) * 3));
  const Vec3d expected = Vec3d(1, 1, 1) * (1 - w) + Vec3d(-1, -1, -1) / 3.0 * w;
  EXPECT_LE((Vec3d(sample_at(*rounded, 0, 0, 0).position) - expected).length(), 1e-6);
}

std::vector<SurfaceSample> dense_samples(const ParametricSurface& surface) {
  std::vector<SurfaceSample> all;
  for (std::size_t face = 0; face < surface.face_count(); ++face) {
    if (surface.sides(face).empty()) continue;
    std::vector<Vec2f> parameters;
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j) {
        const Vec2f at(static_cast<float>(i) / 8, static_cast<float>(j) / 8);
        if (surface.domain(face) == FaceDomain::triangle && i + j > 8) continue;
        // Sub-face 0 of an n-gon lies in [0, .5]^2.
        parameters.push_back(surface.domain(face) == FaceDomain::quad_subfaces ? at * 0.5f : at);
      }
    const std::size_t first = all.size();
    all.resize(first + parameters.size());
    surface.evaluate(face, parameters, {all.data() + first, parameters.size()});
  }
  return all;
}

TEST(SubdivisionSurface, HasTheSameBitsAtAnyNumberOfThreadsAndInAnyCompany) {
  PolygonMesh mesh = test::torus_cage(40, 40);
  for (std::uint32_t i = 0; i + 1 < 400; ++i) mesh.positions[i * 3].y += 0.01f;
  const PolygonMesh cages[] = {mesh, test::star_cage(7)};
  for (const PolygonMesh& cage : cages) {
    std::vector<SurfaceSample> first;
    for (const int threads : {1, 2, 3, 7}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
      tbb::task_arena arena(threads);
      std::vector<SurfaceSample> samples;
      arena.execute([&] { samples = dense_samples(*limit_surface(cage)); });
      if (first.empty()) first = samples;
      ASSERT_EQ(samples.size(), first.size());
      EXPECT_EQ(std::memcmp(samples.data(), first.data(), samples.size() * sizeof(SurfaceSample)), 0);
    }
    const auto surface = limit_surface(cage);
    const SurfaceSample alone = sample_at(*surface, 0, 0.375f, 0.625f);
    EXPECT_EQ(std::memcmp(&alone, &first[3 * 9 + 5], sizeof alone), 0);
  }
}

TEST(SubdivisionSurface, CreasesBesideAVertexOfTwoFacesAreRefused) {
  // OpenSubdiv 3.5 reads memory that it never wrote there, and crashes every now and then; 3.6 only where the fold is
  // the end of one infinitely sharp crease.
  PolygonMesh fold;
  fold.positions = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 1}};
  test::add_face(fold, {0, 2, 1, 4});
  test::add_face(fold, {0, 4, 1, 3});
  EXPECT_NEAR(sample_at(*limit_surface(fold), 0, 0.5f, 0.5f).normal.length(), 1, 1e-6);
  for (const double sharpness : {2.0, 10.0}) {
    SubdivisionRules rules;
    rules.creases = {{{0, 4}, sharpness}};
    try {
      const auto surface = limit_surface(fold, rules);
      EXPECT_NEAR(sample_at(*surface, 0, 0.5f, 0.5f).normal.length(), 1, 1e-6);
      EXPECT_GE(OPENSUBDIV_VERSION_NUMBER, sharpness < kInfiniteSharpness ? 30600 : 30700) << "accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("face 0 (counted from 0) has vertex 4"), std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find("leave the crease out"), std::string::npos) << error.what();
    }
  }
}

TEST(SubdivisionSurface, OpenSubdivsShapesHaveASurfaceOrAReason) {
  std::size_t evaluated = 0, refused = 0;
  for (const auto& path : test::test_data_files("subdiv/osd_shapes")) {
    if (path.extension() != ".obj") continue;
    SCOPED_TRACE(path.filename().string());
    Warnings warnings;
    const PolygonMesh mesh = read_mesh_file(path.string(), warnings);
    SubdivisionRules rules = mesh.subdivision.value_or(SubdivisionRules{});
    const std::string name = path.filename().string();
    rules.scheme = name.starts_with("loop")       ? SubdivisionScheme::loop
                   : name.starts_with("bilinear") ? SubdivisionScheme::bilinear
                                                  : SubdivisionScheme::catmark;
    try {
      const auto surface = make_subdivision_surface(mesh, rules, {path.string(), 0, {}}, warnings);
      for (const SurfaceSample& sample : dense_samples(*surface)) {
        ASSERT_TRUE(std::isfinite(sample.position.length2()));
        ASSERT_NEAR(sample.normal.length(), 1, 1e-5);
      }
      ++evaluated;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      std::printf("refused: %s\n", error.what());
      ++refused;
    }
  }
  std::printf("OpenSubdiv's shapes: %zu evaluated, %zu refused\n", evaluated, refused);
  if (evaluated + refused == 0) return;  // without test data
  EXPECT_EQ(evaluated, 76u);
  EXPECT_EQ(refused, 1u) << "catmark_val2_interior";
}

}  // namespace
}  // namespace raytree
