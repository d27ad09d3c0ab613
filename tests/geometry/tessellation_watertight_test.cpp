// No crack: rays from inside closed tessellations of unequal rates, aimed at edges, at vertices and into facets, all
// hit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "app/sanitized.h"
#include "geometry/embree_intersector.h"
#include "geometry/patch_surface.h"
#include "geometry/subdivision_surface.h"
#include "geometry/surface.h"
#include "geometry/surface_of_revolution.h"
#include "geometry/tessellation.h"
#include "geometry/tessellation_rates.h"
#include "tests/geometry/analytic_surfaces.h"
#include "tests/geometry/subdivision_cages.h"
#include "tests/geometry/tessellation_views.h"

namespace raytree {
namespace {

enum class AimedAt { facets, edges, vertices };

/// How many of `count` rays from inside leave the mesh. inside: a point for a target.
std::size_t escapes(const TriangleMesh& mesh, const EmbreeIntersector& tracer, AimedAt aim, std::size_t count,
                    const std::function<Vec3d(const Vec3d& target, std::minstd_rand&)>& inside, Coherence coherence,
                    unsigned seed = 17) {
  std::minstd_rand random(static_cast<unsigned>(aim) + seed);
  std::uniform_real_distribution<double> unit_interval(0, 1);
  constexpr std::size_t kBatch = 1024;
  RayBatch rays(kBatch);
  HitBatch hits(kBatch);
  std::size_t escaped = 0;
  for (std::size_t done = 0; done < count; done += kBatch) {
    rays.size = 0;
    while (rays.size < kBatch) {
      const std::uint32_t* corners = &mesh.corners[3 * (random() % mesh.triangle_count())];
      const Vec3d a(mesh.positions[corners[0]]), b(mesh.positions[corners[1]]), c(mesh.positions[corners[2]]);
      double u = unit_interval(random), v = unit_interval(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d target = aim == AimedAt::vertices ? a
                           : aim == AimedAt::edges  ? a + (b - a) * u
                                                    : a + (b - a) * u + (c - a) * v;
      const Vec3d origin = inside(target, random);
      rays.push(Vec3f(origin), Vec3f(unit(target - Vec3d(Vec3f(origin)))), std::numeric_limits<float>::infinity());
    }
    tracer.intersect(rays, coherence, hits);
    for (std::size_t i = 0; i < kBatch; ++i) escaped += hits.geometry[i] == kNoGeometry;
  }
  return escaped;
}

/// Rays of each kind at surfaces of random rates: few enough for a quick test.
constexpr std::size_t kQuickRays = 50'000;

/// Facets around a vertex share it bit for bit; but Embree's test of a ray that passes a corner within its rounding may
/// say no for all of them: of rays aimed at corners exactly docs/stability.md allows so many to slip through.
constexpr double kLostAtVertices = 0.02;

void expect_none_escapes(const char* name, const ParametricSurface& surface,
                         const std::function<Vec3d(const Vec3d&, std::minstd_rand&)>& inside) {
  TessellationRates rates = uniform_rates(surface, 1);
  std::minstd_rand random(5);
  for (std::uint16_t& rate : rates.edges) rate = static_cast<std::uint16_t>(1 + random() % 40);
  for (auto& inner : rates.inner) inner = {std::uint16_t(1 + random() % 40), std::uint16_t(1 + random() % 40)};
  ShapeSet shapes;
  shapes.meshes.resize(1);
  shapes.meshes[0].mesh = tessellate(surface, rates);
  const EmbreeIntersector tracer(shapes, {});
  const std::size_t count = kQuickRays;
  for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
    const auto run = [&](AimedAt aim) { return escapes(shapes.meshes[0].mesh, tracer, aim, count, inside, coherence); };
    const std::size_t facets = run(AimedAt::facets), edges = run(AimedAt::edges), vertices = run(AimedAt::vertices);
    std::printf("%s, %zu triangles, %zu rays each: escaped through facets %zu, edges %zu, vertices %zu\n", name,
                shapes.meshes[0].mesh.triangle_count(), count, facets, edges, vertices);
    EXPECT_EQ(facets, 0u);
    EXPECT_EQ(edges, 0u);
    EXPECT_LE(static_cast<double>(vertices), kLostAtVertices * static_cast<double>(count));
  }
}

Vec3d in_ball(std::minstd_rand& random, double radius) {
  std::uniform_real_distribution<double> interval(-radius, radius);
  for (;;) {
    const Vec3d p(interval(random), interval(random), interval(random));
    if (p.length() < radius) return p;
  }
}

TEST(TessellationWatertight, NoRayEscapesFromASphere) {
  expect_none_escapes("sphere", test::octant_sphere(),
                      [](const Vec3d&, std::minstd_rand& random) { return in_ball(random, 0.3); });
}

TEST(TessellationWatertight, NoRayEscapesFromATorus) {
  // From the tube's axis near the target: rates of 1 to 40 over seven faces around leave a ball of 0.2 there inside.
  expect_none_escapes("torus", test::torus(7, 5), [](const Vec3d& target, std::minstd_rand& random) {
    const Vec3d ring = Vec3d(target.x, 0, target.z).normalized() * (test::kTorusRadius * 0.97);
    return ring + in_ball(random, 0.1);
  });
}

TEST(TessellationWatertight, NoRayEscapesFromACylinder) {
  expect_none_escapes("cylinder", test::cylinder(7),
                      [](const Vec3d&, std::minstd_rand& random) { return in_ball(random, 0.5); });
}

/// A closed cage: two tips of `n` faces, kites between them, and 2n vertices of three faces about its waist.
PolygonMesh closed_star_cage(int n) {
  PolygonMesh mesh;
  mesh.positions = {{0, 1.3f, 0}, {0, -1.3f, 0}};
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = kPi * i / n;
    mesh.positions.push_back(Vec3f(Vec3d(std::cos(angle), i % 2 == 0 ? 0.25 : -0.25, -std::sin(angle))));
  }
  const auto waist = [&](int i) { return static_cast<std::uint32_t>(2 + (i + 2 * n) % (2 * n)); };
  for (int i = 0; i < 2 * n; i += 2) {
    samples::add_face(mesh, {0, waist(i), waist(i + 1), waist(i + 2)});
    samples::add_face(mesh, {1, waist(i + 1), waist(i), waist(i - 1)});
  }
  return mesh;
}

struct ClosedModel {
  std::string name;
  std::unique_ptr<ParametricSurface> surface;
};

/// Models without a boundary about the origin, a ball of radius 0.1 within each.
std::vector<ClosedModel> closed_models() {
  Warnings warnings;
  std::vector<ClosedModel> models;
  const auto add_cage = [&](const std::string& name, const PolygonMesh& cage, const SubdivisionRules& rules) {
    models.push_back({name, make_subdivision_surface(cage, rules, {}, warnings)});
  };
  add_cage("cube", samples::cube_cage(), {});
  for (const int n : {3, 5, 12}) add_cage("star " + std::to_string(n), closed_star_cage(n), {});
  PolygonMesh tetrahedron;
  tetrahedron.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  tetrahedron.corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  SubdivisionRules loop;
  loop.scheme = SubdivisionScheme::loop;
  add_cage("tetrahedron, loop", tetrahedron, loop);
  // A vase from the axis to the axis: both its ends are tips.
  const std::vector<BezierCurve> profile{
      {{Vec3d(0, -1, 0), Vec3d(0.9, -1, 0), Vec3d(1.4, -0.2, 0), Vec3d(0.6, 0.3, 0)}},
      {{Vec3d(0.6, 0.3, 0), Vec3d(0.3, 0.6, 0), Vec3d(0.6, 1, 0), Vec3d(0, 1, 0)}}};
  std::vector<SurfacePatch> patches;
  for (const BezierPatch& patch : revolve(profile)) patches.emplace_back(patch);
  models.push_back(
      {"lathe", std::make_unique<PatchSurface>(std::move(patches), PatchSurfaceOptions(), SourceLocation(), warnings)});
  EXPECT_TRUE(warnings.empty());
  return models;
}

TEST(TessellationWatertight, NoneOfTenMillionRaysEscapes) {
  const std::size_t all_rays = kAddressSanitized ? 200'000 : 10'000'000;
  const auto inside = [](const Vec3d&, std::minstd_rand& random) { return in_ball(random, 0.1); };
  const std::vector<ClosedModel> models = closed_models();
  const auto kinds = {EmbreeOptions::Primitives::triangles, EmbreeOptions::Primitives::quads};
  // As the models, both kinds of geometry, both ways to follow packets, and faces and edges share them.
  const std::size_t count = all_rays / (models.size() * 2 * 2 * 2) + 1;
  std::size_t shot = 0, escaped = 0;
  unsigned seed = 1980;
  for (const ClosedModel& model : models) {
    SCOPED_TRACE(model.name);
    ShapeSet shapes;
    shapes.meshes.resize(1);
    TriangleMesh& mesh = shapes.meshes[0].mesh;
    mesh =
        tessellate(*model.surface, rates_for_view(*model.surface, test::perspective({2, 3, 5}, 960, 540), 0.25).rates);
    for (Vec3f& p : mesh.positions) p = Vec3f(Vec3d(p) + mesh.origin);
    for (const EmbreeOptions::Primitives kind : kinds) {
      EmbreeOptions options;
      options.primitives = kind;
      const EmbreeIntersector tracer(shapes, options);
      for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
        seed += 3;  // one for each aim: no ray is shot twice
        for (const AimedAt aim : {AimedAt::facets, AimedAt::edges}) {
          const std::size_t lost = escapes(mesh, tracer, aim, count, inside, coherence, seed);
          EXPECT_EQ(lost, 0u) << (aim == AimedAt::edges ? "edges" : "facets");
          escaped += lost, shot += count;
        }
        const std::size_t corner_rays = count / 10;
        const std::size_t lost = escapes(mesh, tracer, AimedAt::vertices, corner_rays, inside, coherence, seed);
        std::printf("%s: %zu triangles, %zu of %zu rays at vertices escape\n", model.name.c_str(),
                    mesh.triangle_count(), lost, corner_rays);
        EXPECT_LE(static_cast<double>(lost), kLostAtVertices * static_cast<double>(corner_rays));
      }
    }
  }
  std::printf("%zu rays at facets and edges, %zu escaped\n", shot, escaped);
  EXPECT_GE(shot, all_rays);
}

}  // namespace
}  // namespace raytree
