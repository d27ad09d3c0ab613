// Bounds on facets of bicubic polynomials: never below what dense sampling finds, and no higher than a closed form.
#include "geometry/facet_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "geometry/bezier_patch.h"
#include "tests/geometry/tessellation_views.h"

namespace raytree {
namespace {

using test::everywhere, test::perspective;

SurfaceSample exact_sample(const BezierPatch& patch, const Vec2d& at) {
  const PatchDerivatives derivatives = evaluate(patch, at.x, at.y);
  SurfaceSample sample;
  sample.position = Vec3f(derivatives.position);
  sample.normal = Vec3f(derivatives.du.cross(derivatives.dv).normalized());
  return sample;
}

SampledFacet facet_of(const BezierPatch& patch, const TessellationView& view, const std::array<Vec2f, 3>& at,
                      const std::array<bool, 3>& hard) {
  std::array<FacetCorner, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const SurfaceSample sample = exact_sample(patch, Vec2d(at[k]));
    corners[k] = {Vec3d(sample.position), Vec3d(sample.normal)};
  }
  return SampledFacet(view, {0, 0, 0}, corners, hard);
}

/// The largest of samples `steps` along each edge and inside.
double densely_sampled(const BezierPatch& patch, const SampledFacet& facet, const std::array<Vec2f, 3>& at, int steps) {
  double most = 0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const std::array<double, 3> weights{double(i) / steps, double(j) / steps, double(steps - i - j) / steps};
      const Vec2d place = Vec2d(at[0]) * weights[0] + Vec2d(at[1]) * weights[1] + Vec2d(at[2]) * weights[2];
      most = std::max(most, facet.at(exact_sample(patch, place), weights).pixels);
    }
  return most;
}

TEST(FacetBound, IsTheSagittaOfAParabola) {
  // z = bend x^2 / 2 over [0, 1]^2; control points of t^2 are 0, 0, 1/3, 1.
  constexpr double kBend = 1e-2, kPixel = 1e-5;
  constexpr std::array<double, 4> kSquares{0, 0, 1.0 / 3, 1};
  BezierPatch patch;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i)
      patch.points[4 * j + i] = {double(i) / 3, double(j) / 3, kBend * kSquares[i] / 2};
  const TessellationView view = everywhere(kPixel);
  for (const double size : {1.0, 0.25, 0.1}) {
    const std::array<Vec2f, 3> at{Vec2f(0, 0), Vec2f(float(size), 0), Vec2f(float(size), float(size))};
    const double bound = FacetBound(patch, view, {0, 0, 0}, at).pixels(facet_of(patch, view, at, {}));
    const double sagitta = kBend * size * size / 8 / kPixel;
    // Positions of float, about 1, are off by 2^-24 each: 6e-8 / 1e-5 of a pixel. Facets are tilted by up to 1e-2, and
    // what that leaves along them counts by their turn, as much again: 1e-4 of the whole.
    EXPECT_NEAR(bound, sagitta, 2e-3 * sagitta);
    EXPECT_NEAR(densely_sampled(patch, facet_of(patch, view, at, {}), at, 16), sagitta, 2e-3 * sagitta + 0.02);
  }
}

/// A sheet of about 1 x 1 about the origin whose control points are moved by up to `most` in any direction.
BezierPatch random_patch(std::minstd_rand& random, double most) {
  std::uniform_real_distribution<double> move(-most, most);
  BezierPatch patch;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i)
      patch.points[4 * j + i] = {double(i) / 3 - 0.5 + move(random), double(j) / 3 - 0.5 + move(random), move(random)};
  return patch;
}

TEST(FacetBound, IsNeverBelowWhatDenseSamplingFinds) {
  std::minstd_rand random(1986);
  std::uniform_real_distribution<float> share(0, 1);
  TessellationView turned = perspective({1, 2, 3}, 640, 480);
  turned.to_world.setEulerAngles(Vec3d(0.3, 1.1, -0.4));
  turned.to_world.scale(Vec3d(0.5, 0.7, 0.6));
  TessellationView flat = perspective({1, 2, 3}, 640, 480);
  flat.projection = TessellationView::Projection::orthographic;
  flat.pixel = 1.0 / 400;
  TessellationView beside = perspective({0, 0, 2}, 640, 480);
  beside.forward = Vec3d(1, 0, -0.2).normalized(), beside.right = beside.forward.cross(Vec3d(0, 1, 0)).normalized();
  beside.up = beside.right.cross(beside.forward);
  TessellationView away = perspective({0, 0, 3}, 640, 480);
  away.forward = -away.forward, away.right = -away.right;
  const std::pair<const char*, TessellationView> views[] = {{"everywhere", everywhere(1.0 / 400)},
                                                            {"perspective", perspective({1, 2, 3}, 640, 480)},
                                                            {"near", perspective({0.3, 0.5, 1}, 64, 48)},
                                                            {"turned and scaled", turned},
                                                            {"orthographic", flat},
                                                            {"beside the frame", beside},
                                                            {"behind the eye", away}};
  for (const auto& [name, view] : views) {
    SCOPED_TRACE(name);
    double closest = 0, sum = 0;
    std::size_t small = 0, bounded = 0;
    constexpr std::size_t kPatches = 400;
    for (std::size_t n = 0; n < kPatches; ++n) {
      const BezierPatch patch = random_patch(random, n % 2 == 0 ? 0.05 : 0.3);
      const float size = n % 4 < 2 ? 0.1f : 0.6f;
      const Vec2f corner(share(random) * (1 - size), share(random) * (1 - size));
      std::array<Vec2f, 3> at;
      for (Vec2f& c : at) c = corner + Vec2f(share(random), share(random)) * size;
      if (std::abs((at[1] - at[0]).cross(at[2] - at[0])) < 0.1f * size * size) continue;
      if ((at[1] - at[0]).cross(at[2] - at[0]) < 0) std::swap(at[1], at[2]);
      const SampledFacet facet = facet_of(patch, view, at, {n % 8 == 0, false, false});
      const double bound = FacetBound(patch, view, {0, 0, 0}, at).pixels(facet);
      const double sampled = densely_sampled(patch, facet, at, 16);
      // Coordinates of about 1 in single precision, at most 1e4 pixels a unit.
      EXPECT_LE(sampled, bound + 2e-3);
      if (!std::isfinite(bound)) continue;
      ++bounded;
      closest = std::max(closest, sampled / bound);
      if (n % 4 == 0 && n % 8 != 0) sum += sampled / bound, ++small;
    }
    std::printf("%-18s %zu facets, sampled up to %.3f of the bound; small smooth ones %.3f in the mean\n", name,
                bounded, closest, sum / double(small));
    EXPECT_GT(bounded, kPatches / 2);
    EXPECT_LE(closest, 1.001);
    EXPECT_GT(closest, 0.5) << "random triangles fill half of their boxes or less; right ones reach the bound";
  }
}

TEST(FacetBound, ThereIsNoneAboutTheEye) {
  std::minstd_rand random(4);
  const BezierPatch patch = random_patch(random, 0.1);
  const TessellationView view = perspective({0, 0, 0.01}, 640, 480);
  const std::array<Vec2f, 3> at{Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1)};
  EXPECT_TRUE(std::isinf(FacetBound(patch, view, {0, 0, 0}, at).pixels(facet_of(patch, view, at, {}))));
}

}  // namespace
}  // namespace raytree
