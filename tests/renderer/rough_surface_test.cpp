// Rough surfaces: the points that choose facets, the facets' slopes, which side rays leave to, and what pictures of
// them must agree with: Phong's highlight, the weights' sum. Quadrature over slopes is the stability suite's
// (benchmarks/stability/rough_cases.cpp).
#include "renderer/rough_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "benchmarks/samples/rough_mirror.h"
#include "geometry/angle.h"
#include "renderer/low_discrepancy.h"
#include "renderer/scene_reader.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

TEST(LowDiscrepancy, EveryDyadicCellOfTheFirstPointsHoldsItsShare) {
  for (const std::uint32_t key : {0u, 1u, 77u, 0xDEADBEEFu, 0xFFFFFFFFu})
    for (int m = 0; m <= 10; ++m)
      for (int columns = 0; columns <= m; ++columns) {
        std::vector<int> cells(std::size_t(1) << m);
        for (std::uint32_t i = 0; i < cells.size(); ++i) {
          const Vec2d p = low_discrepancy_point(i, key);
          ASSERT_TRUE(p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1);
          const auto x = static_cast<std::size_t>(std::ldexp(p.x, columns)),
                     y = static_cast<std::size_t>(std::ldexp(p.y, m - columns));
          ++cells[(x << (m - columns)) + y];
        }
        for (const int count : cells) ASSERT_EQ(count, 1) << "key " << key << ", 2^" << m << " points";
      }
}

TEST(LowDiscrepancy, KeysHaveNothingToDoWithEachOther) {
  // The same indices of many keys, as far as mean, variance and product of coordinates go: of independent uniform
  // numbers they deviate by sqrt(1/12), 1/12 sqrt(.8), 1/12 over sqrt(n).
  constexpr int kKeys = 1 << 14;
  for (const std::uint32_t i : {0u, 1u, 5u, 300u}) {
    double mean = 0, square = 0, product = 0, between = 0;
    for (std::uint32_t key = 0; key < kKeys; ++key) {
      const Vec2d p = low_discrepancy_point(i, mixed_key(key, 0)) - Vec2d(0.5, 0.5);
      const Vec2d q = low_discrepancy_point(i, mixed_key(key, 1)) - Vec2d(0.5, 0.5);
      mean += p.x, square += p.y * p.y, product += p.x * p.y, between += p.x * q.x;
    }
    const double four_sigma = 4 / std::sqrt(double(kKeys));
    EXPECT_NEAR(mean / kKeys, 0, four_sigma * std::sqrt(1.0 / 12)) << i;
    EXPECT_NEAR(square / kKeys, 1.0 / 12, four_sigma * std::sqrt(0.8) / 12) << i;
    EXPECT_NEAR(product / kKeys, 0, four_sigma / 12) << i;
    EXPECT_NEAR(between / kKeys, 0, four_sigma / 12) << i;
  }
}

TEST(LowDiscrepancy, DeviatesAreNormal) {
  constexpr int kKeys = 64, kPoints = 1024;
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::uint32_t key = 0; key < kKeys; ++key)
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const Vec2d p = normal_deviates(low_discrepancy_point(i, key));
      x += p.x, y += p.y, xx += p.x * p.x, yy += p.y * p.y, xy += p.x * p.y;
    }
  // Four standard deviations of independent points, which even ones stay below.
  const double n = kKeys * kPoints, four_sigma = 4 / std::sqrt(n);
  EXPECT_NEAR(x / n, 0, four_sigma);
  EXPECT_NEAR(y / n, 0, four_sigma);
  EXPECT_NEAR(xx / n, 1, four_sigma * std::numbers::sqrt2);
  EXPECT_NEAR(yy / n, 1, four_sigma * std::numbers::sqrt2);
  EXPECT_NEAR(xy / n, 0, four_sigma);
}

TEST(RoughSurface, NoChildLeavesToTheWrongSide) {
  int children_seen = 0;
  for (const float roughness : {0.01f, 0.1f, 0.5f, 1.0f})
    for (const bool thin : {false, true})
      for (const bool leaving : {false, true})
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0, 89.9}) {
          Material glass = rough_mirror(roughness);
          glass.transmission = Rgb(1);
          glass.has_transmission = true;
          glass.index = 1.5f, glass.inverse_index = 1 / 1.5f;
          glass.thin = glass.special_optics = thin, glass.has_inside = !thin;
          const ShadingPoint point = level_point(glass, degrees, leaving);
          const Vec3f& side = point.surface.geometric_normal;
          for (std::uint32_t i = 0; i < 256; ++i) {
            const Branches c = rough_branches(point, plain_relative_index(point), 3, i, 256);
            ASSERT_GE(c.reflected.dot(side), 0);
            ASSERT_NEAR(c.reflected.dot(c.reflected), 1, 1e-5);
            ++children_seen;
            if (is_black(c.refracted_weight)) continue;
            ASSERT_LE(c.refracted.dot(side), 0);
            ASSERT_NEAR(c.refracted.dot(c.refracted), 1, 1e-5);
            ++children_seen;
          }
        }
  EXPECT_GT(children_seen, 4 * 4 * 6 * 256);
}

// The rule for thin rough sheets is the first order in slopes of two refractions at tilted faces.
TEST(RoughSurface, AThinSheetScattersAsTwoTiltedFacesDo) {
  const float n = 1.5f;
  const Vec3d normal(0, 1, 0);
  const TangentFrame frame = tangent_frame(Vec3f(normal));
  for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
    const double angle = degrees * kDegree;
    const Vec3d direction(std::sin(angle), -std::cos(angle), 0);
    for (const double size : {1e-2, 1e-3}) {
      const Vec2d first(0.8 * size, -0.3 * size), second(-0.4 * size, 0.6 * size);
      const auto tilted = [&](const Vec2d& s) {
        return unit(normal - Vec3d(frame.tangent) * s.x - Vec3d(frame.bitangent) * s.y);
      };
      const Vec3d inside = *refracted_direction(direction, tilted(first), 1.0 / n);
      const Vec3d exact = *refracted_direction(inside, tilted(second), double(n));
      const Vec3f scattered =
          thin_scattered(Vec3f(direction), Vec3f(normal), frame, Vec2f((first - second) / std::numbers::sqrt2), n);
      // The second order: slopes squared, amplified as grazing rays are by 1 / cos^2.
      const double tolerance = 2 * size * size / (std::cos(angle) * std::cos(angle)) + 1e-6;
      EXPECT_LT((Vec3d(scattered) - exact).length(), tolerance) << degrees << " " << size;
      EXPECT_GT((Vec3d(scattered) - direction).length(), 0.3 * size) << degrees;
    }
  }
}

// Whitted 1980, sec. 2: sources keep Phong's term, everything else is perturbed. A tie of sigma and n makes the two
// agree: the highlight of a distant light on a ball, and the image of a small bright sphere that stands where the light
// is. sigma^2 = 1 / n with the halfway vector; 1 / (4 n) with the reflected one, which turns twice as far, near the
// normal: elsewhere it turns less across the plane of incidence than along it.
void expect_highlight_is_image(HighlightForm form) {
  constexpr double kSigma = 0.05, kRadius = 0.04;  // of the bright sphere, as an angle
  constexpr int kSize = 96, kSamples = 1024;
  const bool reflected = form == HighlightForm::reflected;
  const double tilt = reflected ? 0 : 40 * kDegree;
  const Vec3d to_light(std::sin(tilt), 0, std::cos(tilt)), halfway = unit(to_light + Vec3d(0, 0, 1));
  CameraDescription camera = front_camera(0.36);
  camera.position.x = camera.target.x = halfway.x;
  SceneDescription lit = dark_scene(kSize, camera);
  lit.render.antialias = {Antialiasing::Method::none, 1};
  lit.render.highlights = form;
  lit.render.rough_samples = kSamples;
  lit.render.cutoff = 0;
  lit.ambient = Rgb(1);
  lit.materials = {material("ball", Rgb(0)), material("lamp", Rgb(1))};
  lit.shapes = {shape(SphereShape{{0, 0, 0}, 1}, "ball")};
  SceneDescription mirrored = lit;
  // The lamp's own width: a disc of radius r / 2 in facets' angles has the variance (r / 2)^2 / 4 along each axis.
  const double variance = kSigma * kSigma + kRadius * kRadius / 16;
  lit.materials[0].highlight = {Rgb(1), 1 / (reflected ? 4 * variance : variance)};
  lit.lights = {directional_light(-to_light)};
  mirrored.materials[0].reflection = Rgb(1);
  mirrored.materials[0].roughness = kSigma;
  mirrored.shapes.push_back(shape(SphereShape{to_light * 1e5, 1e5 * kRadius}, "lamp"));
  const RenderResult phong = rendered(std::move(lit)), image = rendered(std::move(mirrored));

  constexpr int kBins = 8;  // of 1/4 sigma
  double phong_sum[kBins] = {}, image_sum[kBins] = {}, phong_all = 0, image_all = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double u = halfway.x + (x + 0.5 - kSize / 2.0) * 0.36 / kSize, v = (kSize / 2.0 - y - 0.5) * 0.36 / kSize;
      const Vec3d normal(u, v, std::sqrt(1 - u * u - v * v));
      const double angle = std::acos(std::min(1.0, normal.dot(halfway)));
      const int bin = static_cast<int>(angle / (kSigma / 4));
      if (bin >= kBins) continue;
      phong_sum[bin] += color_at(phong.film, x, y).r, phong_all += color_at(phong.film, x, y).r;
      image_sum[bin] += color_at(image.film, x, y).r, image_all += color_at(image.film, x, y).r;
    }
  ASSERT_GT(phong_all, 0);
  ASSERT_GT(image_all, 0);
  for (int bin = 0; bin < kBins; ++bin) {
    // Per facet's solid angle Gaussian slopes have the density exp(-tan^2 a n / 2) / cos^3 a, Phong's term is cos^n a:
    // their ratio is 1 + 3/2 a^2 - n a^4 / 4 +..., 1.5 and 1 % at 2 sigma; against cos^n 2a the fourth orders are
    // equal. The disc differs from a Gaussian of its variance in the fourth order, under 1 %. Then the noise of
    // counting, four times.
    const double hits = image_sum[bin] * kSamples;
    const double tolerance = 0.025 + 4 / std::sqrt(hits);
    EXPECT_GT(hits, 2000) << bin;
    EXPECT_NEAR((image_sum[bin] / image_all) / (phong_sum[bin] / phong_all), 1, tolerance) << "bin " << bin;
  }
}

TEST(RoughSurface, HighlightOfTheHalfwayVectorAndImageOfASmallSphereAgree) {
  expect_highlight_is_image(HighlightForm::halfway);
}
TEST(RoughSurface, HighlightOfTheReflectedVectorAndImageOfASmallSphereAgree) {
  expect_highlight_is_image(HighlightForm::reflected);
}

// A sample's facets share its weight, however many they are, and both children of a pane what Fresnel leaves of it.
TEST(RoughSurface, WeightsAddUp) {
  for (const int samples : {1, 3, 16, 100}) {
    SceneDescription scene = mirror_plane(8, 0.3, samples);
    scene.background = ConstantBackground{Rgb(0.25f, 0.5f, 1)};
    for (const bool pane : {false, true}) {
      scene.materials[0].thin = pane;
      scene.materials[0].fresnel = pane;
      scene.materials[0].transmission = Rgb(pane ? 1.0f : 0.0f);
      const RenderResult result = rendered(scene);
      for (int i = 0; i < 64; ++i)
        // Each of 2 N terms rounds once, and the sum.
        expect_color(color_at(result.film, i % 8, i / 8), Rgb(0.25f, 0.5f, 1), 4 * samples * 0x1p-24);
    }
  }
}

TEST(RoughSurface, SplitsAtTheFirstRoughBounceAlone) {
  SceneDescription scene = mirror_plane(8, 0.05, 7);
  scene.render.depth = 4;
  scene.background = ConstantBackground{Rgb(1)};                             // what can bring no light is not traced
  scene.cameras[0].position = {0, 0.9, 0.3}, scene.cameras[0].height = 0.1;  // between the two
  scene.shapes.push_back(shape(PlaneShape{{0, 1, 0}, {0, -1, 0}}, "mirror"));
  const RenderResult result = rendered(scene);
  EXPECT_EQ(result.statistics.rays[static_cast<int>(RayKind::reflected)], 64u * 7 * 3);
  // A polished mirror before it splits nothing: 1, then 7, then 7.
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "polished", scene.materials[1].roughness = 0;
  scene.shapes[0].material = "polished";
  EXPECT_EQ(rendered(scene).statistics.rays[static_cast<int>(RayKind::reflected)], 64u * (1 + 7 + 7));
}

// Chance is keyed by where a sample lies: the same place, asked for in another way, is the same.
TEST(RoughSurface, ASampleIsKeyedByItsPlace) {
  SceneDescription scene = mirror_plane(40, 0.3, 4);
  scene.background = GradientBackground{};
  const RenderResult centers = rendered(scene);
  scene.render.antialias = {Antialiasing::Method::grid, 1};
  const RenderResult grid = rendered(scene);
  int differing = 0;
  for (int i = 0; i < 1600; ++i) {
    EXPECT_EQ(color_at(centers.film, i % 40, i / 40), color_at(grid.film, i % 40, i / 40));
    differing += i > 0 && !(color_at(grid.film, i % 40, i / 40) == color_at(grid.film, (i - 1) % 40, (i - 1) / 40));
  }
  EXPECT_GT(differing, 1500) << "neighbours have points of their own";
}

// And by the branches taken since: no two ways down a tree, nor two trees a 2^-16 of a pixel apart, share their points.
TEST(RoughSurface, EveryWayDownEveryTreeHasAKeyOfItsOwn) {
  std::set<std::uint32_t> keys;
  std::size_t ways = 0;
  for (const Vec2f& place : {Vec2f(0, 0), Vec2f(0x1p-16f, 0), Vec2f(0, 0x1p-16f), Vec2f(1, 0), Vec2f(0, 1)})
    for (int depth = 0; depth <= 8; ++depth)
      for (int branches = 0; branches < 1 << depth; ++branches) {
        TreePath path = TreePath::of_eye(place);
        for (int level = 0; level < depth; ++level) path = path.child((branches >> level & 1) != 0);
        keys.insert(path.key);
        ++ways;
      }
  EXPECT_EQ(keys.size(), ways);
}

TEST(RoughSurface, ScenesSayWhetherTheyHaveAny) {
  SceneDescription scene = mirror_plane(4, 0.1, 4);
  scene.materials.push_back(material("dull", Rgb(1)));
  const auto uses = [](const Scene& s) {
    return std::count(s.summary.features.begin(), s.summary.features.end(), "rough surfaces") == 1;
  };
  EXPECT_TRUE(prepared(scene).rough_surfaces);
  EXPECT_TRUE(uses(prepared(scene)));
  EXPECT_TRUE(prepared(scene).materials[1].special_optics);
  scene.shapes[0].material = "dull";
  EXPECT_FALSE(prepared(scene).rough_surfaces);
  EXPECT_FALSE(prepared(scene).materials[1].special_optics);
  scene.shapes[0].material = "mirror";
  scene.materials[0].reflection = Rgb(0);
  EXPECT_FALSE(uses(prepared(scene))) << "nothing to perturb";
}

TEST(RoughSurface, BadValuesAreRefusedWithWhatWouldBeRight) {
  const auto refusal = [](SceneDescription scene) -> std::string {
    try {
      prepared(std::move(scene));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const auto read_refusal = [](const std::string& body) -> std::string {
    try {
      read_scene("{\"raytree\": 1,\n" + body + "}", "s.json", "");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(mirror_plane(4, 1.5, 4)), "test.json: materials.mirror: roughness must lie from 0 to 1, not 1.5");
  EXPECT_NE(refusal(mirror_plane(4, std::nan(""), 4)).find("roughness must lie from 0 to 1"), std::string::npos);
  EXPECT_EQ(refusal(mirror_plane(4, 0.1, 0)),
            "test.json: render.rough_samples: rough_samples must lie from 1 to 1024, not 0");
  EXPECT_NE(read_refusal("\"materials\": {\"m\": {\"roughness\": -0.1}}").find("s.json:2: materials.m.roughness"),
            std::string::npos);
  EXPECT_NE(read_refusal("\"render\": {\"rough_samples\": 2000}").find("s.json:2: render.rough_samples"),
            std::string::npos);
}

}  // namespace
}  // namespace raytree
