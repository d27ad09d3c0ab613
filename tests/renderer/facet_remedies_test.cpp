// Remedies of interpolated normals, on and off: false shadows where light grazes a smooth shape made of facets (row 18
// of the catalogue of failures), mirrored rays that lead below their facet (row 17), light from behind (row 19).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/facet_shading.h"
#include "renderer/scene_fields.h"
#include "tests/renderer/facet_scenes.h"

namespace raytree {
namespace {

struct Shadows {
  int lit = 0, falsely_dark = 0;  ///< pixels
  double share() const { return double(falsely_dark) / lit; }
};

/// Pixels whose interpolated normal faces the light, on a sphere that nothing else shadows, and those of them in the
/// dark.
Shadows false_shadows(int sides, ShadowTerminator terminator, ShadingMethod method, const Vec3d& to_light) {
  SceneDescription scene = test::headlit_scene(test::faceted_sphere(sides, sides / 2, method), 240, 240, 2.1);
  scene.lights = {test::directional_light(-to_light)};
  scene.render.facets.shadow_terminator = terminator;
  const Film film = test::rendered(scene).film;
  Shadows shadows;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 240; ++x) {
      const Rgb normal = test::color_at(film, x, y, ChannelGroup::normal);
      if (Vec3d(normal.r, normal.g, normal.b).dot(to_light.normalized()) < 1e-3) continue;
      ++shadows.lit;
      shadows.falsely_dark += test::color_at(film, x, y).g == 0;
    }
  return shadows;
}

TEST(FacetRemedies, ShadowRaysFromTheSmoothSurfaceLeaveNoFalseShadow) {
  const Vec3d to_light(1, 0.4, 0.3);
  for (const int sides : {8, 16, 32, 64, 128}) {
    const Shadows classic = false_shadows(sides, ShadowTerminator::classic, ShadingMethod::phong, to_light);
    const Shadows offset = false_shadows(sides, ShadowTerminator::offset, ShadingMethod::phong, to_light);
    const Shadows limit = false_shadows(sides, ShadowTerminator::offset, ShadingMethod::limit, to_light);
    std::printf(
        "  row 18: k = %3d: false shadow %.2f %% of lit pixels classic, %.2f %% offset, %.2f %% offset with limit\n",
        sides, 100 * classic.share(), 100 * offset.share(), 100 * limit.share());
    EXPECT_GT(classic.share(), 0.3 / sides);
    EXPECT_EQ(offset.falsely_dark, 0) << sides;
    EXPECT_LT(limit.share(), 0.002) << sides;
  }
}

TEST(FacetRemedies, TrueShadowsStayWhereTheyAre) {
  // A disc in the light's way: its shadow on the sphere is the same with and without the remedy, but for its border.
  const auto picture = [](ShadowTerminator terminator) {
    SceneDescription scene = test::headlit_scene(test::faceted_sphere(32, 16, ShadingMethod::phong), 120, 120, 2.1);
    scene.lights = {test::directional_light({-1, -0.4, -1})};
    scene.shapes.push_back(test::shape(DiscShape{{3, 1.2, 3}, {1, 0.4, 1}, 0.4}, "paint", "disc"));
    scene.render.facets.shadow_terminator = terminator;
    return test::green(scene);
  };
  const std::vector<float> classic = picture(ShadowTerminator::classic), offset = picture(ShadowTerminator::offset);
  int dark = 0, differing = 0;
  for (std::size_t i = 0; i < classic.size(); ++i) {
    dark += classic[i] == 0 && offset[i] == 0;
    differing += (classic[i] == 0) != (offset[i] == 0);
  }
  EXPECT_GT(dark, 900);
  EXPECT_LT(differing, 250);
}

/// What a mirror sphere's eye rays do: how many of them there are, and how many are mirrored to below their facet.
struct Mirrored {
  int hits = 0, below = 0;
  double lowest = 1;  ///< least cosine between a mirrored ray and its facet's normal
};
Mirrored mirrored_rays(int sides, FacetReflections reflections, ShadingMethod method = ShadingMethod::phong) {
  SceneDescription description = test::headlit_scene(test::faceted_sphere(sides, sides / 2, method), 400, 400, 2.1);
  description.materials[0].reflection = Rgb(1);
  description.render.facets.reflections = reflections;
  const Scene scene = test::prepared(description);
  FacetShading facets(scene);
  RayBatch rays(400);
  HitBatch hits(400);
  Mirrored result;
  for (int y = 0; y < 400; ++y) {
    for (std::size_t x = 0; x < 400; ++x) {
      Vec3f origin, direction;
      scene.camera.ray(float(x) + 0.5f, float(y) + 0.5f, origin, direction);
      rays.set(x, origin, direction, std::numeric_limits<float>::infinity());
    }
    rays.size = 400;
    scene.intersector->intersect(rays, Coherence::coherent, hits);
    facets.begin_batch();
    std::size_t p = 0;
    for (std::size_t x = 0; x < 400; ++x) {
      if (hits.geometry[x] == kNoGeometry) continue;
      const Vec3f direction = rays.direction(x);
      SurfacePoint surface = surface_at(*scene.shapes, rays.origin(x), direction, hits[x], false);
      facets.add(p, hits[x], direction, true, surface);
      ShadingPoint point = shading_point(surface, direction, scene.materials[0]);
      facets.bend(p++, point);
      const double height = branches(point).reflected.dot(point.surface.geometric_normal);
      ++result.hits;
      result.below += height < -1e-6;
      result.lowest = std::min(result.lowest, height);
    }
  }
  return result;
}

TEST(FacetRemedies, ConsistentNormalsMirrorNoRayBelowItsFacet) {
  for (const int sides : {16, 32, 64, 128}) {
    const Mirrored classic = mirrored_rays(sides, FacetReflections::classic),
                   clamped = mirrored_rays(sides, FacetReflections::clamped),
                   consistent = mirrored_rays(sides, FacetReflections::consistent),
                   limit = mirrored_rays(sides, FacetReflections::consistent, ShadingMethod::limit);
    std::printf("  row 17: k = %3d: %.1e of mirrored rays lead below their facet classic, %d clamped, %d consistent\n",
                sides, double(classic.below) / classic.hits, clamped.below, consistent.below);
    const double theta = kPi / sides;
    EXPECT_GT(classic.below, 0);
    EXPECT_LE(double(classic.below) / classic.hits, std::pow(std::sin(2 * theta), 2));
    EXPECT_EQ(clamped.below, 0);
    EXPECT_EQ(consistent.below, 0);
    EXPECT_EQ(limit.below, 0);
  }
}

// R = (g + rho b) N - rho I is unit, at the angle acos g from N, and above every facet that N may belong to.
TEST(FacetRemedies, ConsistentNormalsKeepTheirBoundForAnyRay) {
  std::mt19937 random(2010);
  std::uniform_real_distribution<double> unit_interval(0, 1);
  const auto random_above = [&](const Vec3d& side) {
    for (;;) {
      const Vec3d v(2 * unit_interval(random) - 1, 2 * unit_interval(random) - 1, 2 * unit_interval(random) - 1);
      if (v.length() > 1e-3 && v.length() < 1 && v.dot(side) > 0) return v.normalized();
    }
  };
  double lowest = 1;
  for (int trial = 0; trial < 200000; ++trial) {
    const Vec3d facet = random_above({0, 0, 1}), normal = random_above(facet), viewer = random_above(facet);
    // Any bound that holds will do; often the tightest.
    const double cosine = normal.dot(facet), least = trial % 2 == 0 ? cosine : cosine * unit_interval(random);
    const Vec3d bent(consistent_normal(Vec3f(normal), Vec3f(viewer), float(least)));
    const Vec3d mirrored = bent * (2 * bent.dot(viewer)) - viewer;
    lowest = std::min(lowest, mirrored.dot(facet));
  }
  EXPECT_GT(lowest, -1e-5);
  // With nothing to keep away from, the mirror is a plain one.
  const Vec3f normal(0, 0.6f, 0.8f), viewer(0, 0, 1);
  EXPECT_LT((consistent_normal(normal, viewer, 1) - normal).length(), 1e-6);
}

// A clamp lets reflections jump where two facets meet; consistent normals are the same from both sides of an edge,
// since the least cosine is, and keep above both.
TEST(FacetRemedies, ConsistentNormalsAreContinuousAcrossEdges) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-1, 1);
  double jump_clamped = 0, lowest = 1;
  for (int trial = 0; trial < 20000; ++trial) {
    const double bend = 0.5 + 0.4 * angle(random);
    const Vec3d left(-std::sin(bend), 0, std::cos(bend)), right(std::sin(bend), 0, std::cos(bend));
    const Vec3d normal = Vec3d(0.7 * angle(random), 0.7 * angle(random), 1).normalized();
    const Vec3d viewer = Vec3d(angle(random), angle(random), 0.3 + 0.3 * angle(random)).normalized();
    if (viewer.dot(left) <= 0 || viewer.dot(right) <= 0) continue;
    const Vec3f mirrored = reflected_direction(Vec3f(-viewer), Vec3f(normal));
    jump_clamped = std::max(
        jump_clamped, double((kept_on_side(mirrored, Vec3f(left)) - kept_on_side(mirrored, Vec3f(right))).length()));
    const auto least = static_cast<float>(std::min(normal.dot(left), normal.dot(right)));
    const Vec3f bent = consistent_normal(Vec3f(normal), Vec3f(viewer), least);
    const Vec3f consistent = reflected_direction(Vec3f(-viewer), bent);
    lowest = std::min<double>(lowest, std::min(consistent.dot(Vec3f(left)), consistent.dot(Vec3f(right))));
  }
  std::printf("  row 17: directions jump across an edge by up to %.2f clamped, by 0 consistent\n", jump_clamped);
  EXPECT_GT(jump_clamped, 0.3);
  EXPECT_GT(lowest, -1e-6);
}

// Row 19: a sheet whose normals lean is lit from its other side by the shading normal alone.
TEST(FacetRemedies, NoLightComesThroughASheetFromBehind) {
  auto mesh = test::grid_mesh(1, 2, [](int, int) { return 0.0; });
  mesh->normals.assign(4, Vec3f(Vec3d(0.8, 0, 0.6)));
  ShapeDescription sheet = test::mesh_shape(std::move(mesh), "paint", NormalSource::file);
  for (const ShadingMethod method : {ShadingMethod::flat, ShadingMethod::gouraud, ShadingMethod::phong}) {
    sheet.shading = method;
    SceneDescription scene = test::headlit_scene(sheet, 20, 20, 2.2);
    scene.lights = {test::directional_light({-1, 0, 0.5})};  // from behind, on the side that the normals lean to
    EXPECT_EQ(test::largest(test::green(scene)), 0) << enum_name(method);
  }
}

}  // namespace
}  // namespace raytree
