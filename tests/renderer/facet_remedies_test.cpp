// What remedies of interpolated normals leave as it was, and the bounds they keep. What they mend is measured by the
// stability suite (`shadow-terminator`, `mirrored-below-facet`, `light-from-behind`).
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/facet_shading.h"
#include "renderer/scene_fields.h"
#include "tests/renderer/facet_scenes.h"

namespace raytree {
namespace {

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

}  // namespace
}  // namespace raytree
