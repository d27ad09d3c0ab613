// Whitted's adaptive sampling against closed forms: how much of a pixel a half-plane and a disc cover; and what it
// costs beside a regular grid. What falls between samples is the stability suite's
// (benchmarks/stability/sampling_cases.cpp).
#include "renderer/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/angle.h"
#include "renderer/builtin_scenes.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

double value_at(const Film& film, int x, int y) { return color_at(film, x, y).r; }

/// A leaf that an edge crosses is off by at most half of its area: with one corner in, the mean of its corners is 1/4
/// and the share between 0 and 1/2; with two, 1/2 and the share between 0 and 1. A straight edge crosses less than
/// 2 * 2^levels of the pixel's 4^levels leaves.
double largest_edge_error(int levels) { return std::pow(0.5, levels); }
/// The same where the leaves' errors are independent, as along an edge that runs across the lattice.
double typical_edge_error(int levels) {
  return std::sqrt(2) * std::pow(2, levels / 2.0) * 0.5 * std::pow(0.25, levels);
}

/// Share of a unit square on the side to which the unit normal (a, b) points away, the edge passing at signed distance
/// d from the middle (catalogue of failures, closed forms).
double half_plane_share(double a, double b, double d) {
  a = std::abs(a), b = std::abs(b);
  if (a < b) std::swap(a, b);
  const double k = (a - b) / 2, h = (a + b) / 2;
  const double share = std::abs(d) <= k  ? 0.5 - std::abs(d) / a
                       : std::abs(d) < h ? (h - std::abs(d)) * (h - std::abs(d)) / (2 * a * b)
                                         : 0;
  return d < 0 ? 1 - share : share;
}

TEST(AdaptiveSampling, HalfPlaneCoversWhatItsClosedFormSays) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-3, 3);
  for (const int levels : {2, 3, 4, 5}) {
    double square_sum = 0;
    int edge_pixels = 0;
    for (const double angle : {0.0, 11.0, 20.0, 33.0, 45.0, 63.0, 78.0, 90.0, 127.0, 200.0, 311.0}) {
      const double a = std::cos(angle * kDegree), b = std::sin(angle * kDegree);
      const double shift = offset(random);
      SceneDescription scene = white_on_black(24);
      scene.render.adaptive.levels = levels;
      // White where a x + b y > shift: a square far larger than the frame.
      const Vec3d middle(a * shift, b * shift, 0), in(a * 200, b * 200, 0), along(-b * 200, a * 200, 0);
      scene.shapes = {mesh_shape(triangles({Vec3f(middle - along), Vec3f(middle + along), Vec3f(middle + along + in),
                                            Vec3f(middle - along + in)},
                                           {0, 1, 2, 0, 2, 3}),
                                 "white")};
      const RenderResult result = rendered(std::move(scene));
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
          const double distance = shift - (a * (x + 0.5 - 12) + b * (12 - y - 0.5));
          const double expected = half_plane_share(a, b, distance), value = value_at(result.film, x, y);
          ASSERT_NEAR(value, expected, largest_edge_error(levels) + 1e-5)
              << angle << " degrees, levels " << levels << ", pixel " << x << ", " << y;
          ASSERT_EQ(result.film.plane(ChannelGroup::alpha, 0)[pixel_index(result.film, x, y)],
                    static_cast<float>(value));
          if (expected <= 0 || expected >= 1 || std::fmod(angle, 45) == 0) continue;
          square_sum += (value - expected) * (value - expected);
          ++edge_pixels;
        }
    }
    const double rms = std::sqrt(square_sum / edge_pixels);
    RecordProperty("rms_levels_" + std::to_string(levels), std::to_string(rms));
    EXPECT_LE(rms, typical_edge_error(levels)) << "levels " << levels << ", " << edge_pixels << " pixels";
    EXPECT_GT(edge_pixels, 200);
  }
}

/// Share of the unit square at (x0, y0) that the disc of radius r about the origin covers, by slices.
double disc_share(double x0, double y0, double r) {
  constexpr int kSlices = 2000;
  double sum = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double x = x0 + (i + 0.5) / kSlices;
    const double half = std::sqrt(std::max(0.0, r * r - x * x));
    sum += std::max(0.0, std::min(y0 + 1, half) - std::max(y0, -half));
  }
  return sum / kSlices;
}

TEST(AdaptiveSampling, DiscsAndSpheresCoverWhatTheirClosedFormSays) {
  for (const double radius : {2.3, 3.7, 9.1, 14.6})
    for (const bool is_sphere : {false, true}) {
      SceneDescription scene = white_on_black(32);
      const Vec3d center(0.37, -0.21, 0);
      if (is_sphere)
        scene.shapes = {shape(SphereShape{center, radius}, "white")};
      else
        scene.shapes = {shape(DiscShape{center, {0, 0, 1}, radius}, "white")};
      const int levels = scene.render.adaptive.levels;
      const RenderResult result = rendered(std::move(scene));
      double sum = 0;
      // A cap of the disc that bulges through a side between two corners may stay unseen: at most this area.
      const double cap = 1 / (12 * radius) * 1.1;
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
          const double value = value_at(result.film, x, y);
          sum += value;
          EXPECT_NEAR(value, disc_share(x - 16 - center.x, 16 - y - 1 - center.y, radius),
                      largest_edge_error(levels) + cap)
              << radius << " at " << x << ", " << y;
        }
      // Some 8 r 2^levels leaves lie on the rim, each off by half of its area at most; three times the deviation of
      // independent errors, and the four caps.
      const double rim = 3 * std::sqrt(8 * radius * std::pow(2, levels)) * 0.5 * std::pow(0.25, levels);
      EXPECT_NEAR(sum, kPi * radius * radius, rim + 4 * cap) << radius;
    }
}

/// Mean of a checker of unit squares (1 where the cells' sum is even) over pixel (x, y) of a camera at height 1 that
/// looks level along -z, field of view 90 degrees: rows integrated exactly in x, many rows a pixel.
double checker_share(int size, int x, int y) {
  constexpr int kRows = 400;
  // Integral from 0 to t of a square wave of period 2 that is 1 on [0, 1).
  const auto wave = [](double t) { return std::floor(t / 2) + std::min(t / 2 - std::floor(t / 2), 0.5) * 2; };
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double down = (y + (i + 0.5) / kRows) / (size / 2.0) - 1;  // tangent of the angle below the horizon
    const double depth = 1 / down;
    const double left = (x / (size / 2.0) - 1) * depth, right = ((x + 1) / (size / 2.0) - 1) * depth;
    double share = (wave(right) - wave(left)) / (right - left);
    if (static_cast<std::int64_t>(std::floor(-depth)) % 2 != 0) share = 1 - share;
    sum += share;
  }
  return sum / kRows;
}

TEST(AdaptiveSampling, ACheckerTowardTheHorizonKeepsItsAreaMean) {
  const int size = 64;
  const auto traced = [&](const Antialiasing& antialias, const AdaptiveSampling& adaptive, bool filtered) {
    CameraDescription camera;
    camera.position = {0, 1, 0};
    camera.target = {0, 1, -1};
    camera.field_of_view = 90;
    SceneDescription scene = dark_scene(size, camera);
    CheckerPattern checker;
    checker.even = Rgb(1), checker.odd = Rgb(0);
    checker.filtered = filtered;
    scene.ambient = Rgb(1);
    scene.materials = {material("checker", checker)};
    scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 1, 0}}, "checker")};
    scene.render.antialias = antialias;
    scene.render.adaptive = adaptive;
    return rendered(std::move(scene));
  };
  struct Errors {
    double near = 0, far = 0, mean = 0;
    std::uint64_t samples = 0;
  };
  const auto errors_of = [&](const RenderResult& result) {
    Errors errors;
    double near_count = 0, far_count = 0;
    for (int y = size / 2; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double d = value_at(result.film, x, y) - checker_share(size, x, y);
        errors.mean += d / (size * size / 2.0);
        // From the eighth row below the horizon on a square is higher than a pixel.
        (y < size / 2 + 8 ? errors.far : errors.near) += d * d;
        ++(y < size / 2 + 8 ? far_count : near_count);
      }
    errors.near = std::sqrt(errors.near / near_count);
    errors.far = std::sqrt(errors.far / far_count);
    errors.samples = result.statistics.samples;
    return errors;
  };
  constexpr Antialiasing kNone{Antialiasing::Method::none, 1}, kSquares{Antialiasing::Method::grid, 3},
      kFine{Antialiasing::Method::grid, 8}, kWhitted{Antialiasing::Method::whitted, 1};
  const AdaptiveSampling usual, forced{0.1, 4, 3};
  const auto measured = [&](const char* name, const Antialiasing& antialias, const AdaptiveSampling& adaptive,
                            bool filtered) {
    const Errors errors = errors_of(traced(antialias, adaptive, filtered));
    const std::string prefix = std::string(filtered ? "filtered_" : "points_") + name;
    RecordProperty(prefix + "_near", std::to_string(errors.near));
    RecordProperty(prefix + "_far", std::to_string(errors.far));
    RecordProperty(prefix + "_mean", std::to_string(errors.mean));
    RecordProperty(prefix + "_samples", std::to_string(double(errors.samples) / (size * size / 2)));
    return errors;
  };

  // Two edges a pixel where squares are larger than pixels; there the samples are points with the filter and without.
  const Errors usual_points = measured("whitted", kWhitted, usual, false),
               usual_filtered = measured("whitted", kWhitted, usual, true);
  EXPECT_LE(usual_points.near, 2 * typical_edge_error(4));
  EXPECT_LE(usual_filtered.near, 2 * typical_edge_error(4));
  // Beyond, a point is as good as a coin, and points that agree by chance deceive. Filtered ones do not: y pixels below
  // the horizon a pixel reaches over L = 32 / y^2 squares, so what it covers and what its corners show differ from 1/2
  // by up to 1 / (2 L), 1 / sqrt(3) of that in the mean square, and the mean of four corners by half as much. In the
  // first three rows, L >= 5, corners hardly differ and a pixel may be left as it is: off by sqrt(5 / 12) / (2 L) at
  // most, which is 1/16 in the third. Further down they differ by enough for the third level, whose 9 x 9 points leave
  // 1/18.
  EXPECT_LE(usual_filtered.far, 1.0 / 16);
  EXPECT_LE(usual_filtered.far, usual_points.far * 2 / 3);
  EXPECT_LE(usual_filtered.samples, usual_points.samples * 4 / 5);
  EXPECT_LE(std::abs(usual_filtered.mean), 1.0 / 255);
  EXPECT_LE(std::abs(usual_points.mean), 1.0 / 255);

  // 9 x 9 points leave 1/18.
  EXPECT_LE(measured("minimum_3", kWhitted, forced, false).far, 1.0 / 18);
  EXPECT_LE(measured("minimum_3", kWhitted, forced, true).far, 1.0 / 18);

  // One filtered sample a pixel, or nine, tell more than 64 points.
  const Errors fine = measured("grid_8", kFine, usual, false);
  for (const auto& [name, antialias] : {std::pair{"none", kNone}, {"grid_3", kSquares}}) {
    const Errors points = measured(name, antialias, usual, false), filtered = measured(name, antialias, usual, true);
    EXPECT_LE(filtered.far, fine.far) << name;
    EXPECT_LE(filtered.near, fine.near) << name;
    EXPECT_LE(filtered.far, points.far / 8) << name;
    EXPECT_LE(std::abs(filtered.mean), 1e-4) << name;
  }
  EXPECT_LT(usual_filtered.samples, fine.samples / 2);
}

// --- what equal corners hide ---

TEST(AdaptiveSampling, ObjectsAndNormalsOfEqualColorAreToldApart) {
  const auto samples = [](ShapeDescription second) {
    SceneDescription scene = white_on_black(32);
    scene.shapes = {shape(PlaneShape{{0, 0, -20}, {0, 0, 1}}, "white"), std::move(second)};
    return rendered(std::move(scene)).statistics.samples;
  };
  const std::uint64_t bare = samples(shape(PlaneShape{{0, 0, -30}, {0, 0, 1}}, "white"));
  // The same color everywhere: only the object at the corners tells of the disc, only the normals of the roof's ridge.
  EXPECT_GT(samples(shape(DiscShape{{0, 0, 0}, {0, 0, 1}, 10}, "white")), bare + 5 * 2 * 10);
  const auto roof =
      triangles({{-99, -99, -99}, {0, -99, -50}, {0, 99, -50}, {-99, 99, -99}, {99, -99, -99}, {99, 99, -99}},
                {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2});
  SceneDescription scene = white_on_black(32);
  scene.shapes = {mesh_shape(roof, "white")};
  scene.shapes[0].transform = translation({0.3, 0, 0});
  EXPECT_GE(rendered(std::move(scene)).statistics.samples, bare + 2 * 32);
}

TEST(AdaptiveSampling, AnEdgeThatEntersThroughASideIsFollowed) {
  // A corner of a square lies in the pixel that its tip reaches through one side: the pixel's own corners are black,
  // its neighbour's division shows white on the common side.
  SceneDescription scene = white_on_black(8);
  scene.shapes = {mesh_shape(triangles({{0.5f, 0.8f, 0}, {-4.5f, -9.2f, 0}, {5.5f, -9.2f, 0}}, {0, 1, 2}), "white")};
  const RenderResult result = rendered(std::move(scene));
  // Above the axis the tip is a triangle of height .8 and base .8 about x = .5.
  EXPECT_NEAR(value_at(result.film, 4, 3), 0.32, largest_edge_error(4));
}

// --- the other channels ---

TEST(AdaptiveSampling, ChannelsFollowTheSamplesByArea) {
  SceneDescription scene = white_on_black(32);
  scene.materials.push_back(material("gray", Rgb(0.25f)));
  scene.materials[0].reflection = Rgb(0.5f);
  scene.background = ConstantBackground{Rgb(0.5f)};
  scene.render.cutoff = 0.2;
  scene.shapes = {shape(DiscShape{{0.3, 0.2, 0}, {0, 0, 1}, 7}, "white"),
                  shape(DiscShape{{9, 0, 1}, {0, 0, 1}, 5}, "gray"),
                  shape(SphereShape{{-12.3, 12.4, 0}, 0.03}, "gray")};
  const RenderResult result = rendered(std::move(scene));
  expect_finite(result.film);
  const Film& film = result.film;
  std::uint64_t rays = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const std::size_t i = pixel_index(film, x, y);
      rays += film.id_plane(ChannelGroup::ray_count)[i];
      const float alpha = film.plane(ChannelGroup::alpha, 0)[i];
      const float depth = film.plane(ChannelGroup::depth, 0)[i];
      EXPECT_GE(alpha, 0);
      EXPECT_LE(alpha, 1 + 1e-6f);
      EXPECT_LE(film.plane(ChannelGroup::truncation, 0)[i], 0.2f * (1 + 1e-6f));
      if (alpha > 0) {
        EXPECT_GE(depth, 9 - 1e-4f);
        EXPECT_LE(depth, 10 + 1e-4f);
        const Vec3f normal(film.plane(ChannelGroup::normal, 0)[i], film.plane(ChannelGroup::normal, 1)[i],
                           film.plane(ChannelGroup::normal, 2)[i]);
        EXPECT_NEAR(normal.length(), 1, 1e-5);
      } else {
        EXPECT_EQ(depth, std::numeric_limits<float>::infinity());
      }
      const std::uint32_t object = film.id_plane(ChannelGroup::object_id)[i];
      EXPECT_EQ(film.id_plane(ChannelGroup::material_id)[i], object == 3 ? 2 : object);
      EXPECT_TRUE(alpha <= 0.51f || object != 0) << x << ", " << y;
      EXPECT_TRUE(alpha >= 0.49f || object == 0) << x << ", " << y;
    }
  EXPECT_EQ(rays, result.statistics.total_rays());
  EXPECT_EQ(result.statistics.rays[0], result.statistics.samples);
  // The speck's pixel: its area and the background's rest.
  const double area = kPi * 0.03 * 0.03;
  EXPECT_NEAR(film.plane(ChannelGroup::alpha, 0)[pixel_index(film, 3, 3)], area, 1e-6);
  EXPECT_NEAR(value_at(film, 3, 3), 0.5 * (1 - area) + 0.25 * area, 1e-6);
}

TEST(AdaptiveSampling, SettingsOutOfRangeAreRefused) {
  for (const AdaptiveSampling& bad :
       {AdaptiveSampling{-1, 4, 0}, AdaptiveSampling{NAN, 4, 0}, AdaptiveSampling{0.1, 7, 0},
        AdaptiveSampling{0.1, -1, 0}, AdaptiveSampling{0.1, 2, 3}}) {
    SceneDescription scene = white_on_black(4);
    scene.render.adaptive = bad;
    try {
      prepared(std::move(scene));
      ADD_FAILURE() << bad.threshold << " " << bad.levels << " " << bad.minimum_level;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("render.adaptive"), std::string::npos) << error.what();
    }
  }
}

TEST(AdaptiveSampling, LevelZeroTracesTheCornersOfPixels) {
  SceneDescription scene = white_on_black(20);
  scene.shapes = {shape(SphereShape{{0.2, 0.1, 0}, 7}, "white")};
  scene.render.adaptive.levels = 0;
  const RenderResult result = rendered(std::move(scene));
  EXPECT_EQ(result.statistics.samples, 21u * 21u);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      int inside = 0;
      for (int corner = 0; corner < 4; ++corner) {
        const double dx = x + (corner & 1) - 10 - 0.2, dy = 10 - y - (corner >> 1) - 0.1;
        inside += dx * dx + dy * dy < 49;
      }
      EXPECT_EQ(value_at(result.film, x, y), inside / 4.0);
    }
}

// --- what it costs ---

double display_rms(const Film& a, const Film& b) {
  double sum = 0;
  const int count = a.window().width * a.window().height;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < count; ++i) {
      const auto shown = [&](const Film& film) {
        return std::sqrt(std::clamp(double(film.plane(ChannelGroup::color, c)[i]), 0.0, 1.0));
      };
      sum += (shown(a) - shown(b)) * (shown(a) - shown(b));
    }
  return std::sqrt(sum / (3.0 * count));
}
double linear_rms(const Film& a, const Film& b) {
  double sum = 0;
  const int count = a.window().width * a.window().height;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < count; ++i) {
      const double d = double(a.plane(ChannelGroup::color, c)[i]) - b.plane(ChannelGroup::color, c)[i];
      sum += d * d;
    }
  return std::sqrt(sum / (3.0 * count));
}

/// Rays of Whitted's method over those of a grid of equal error are a third at most, on the display-like scale and in
/// linear light. `scene` makes the scene anew each time, with the settings of Whitted's method that count; the picture
/// that errors are taken against has `converged` x `converged` samples a pixel.
template <class MakeScene>
void expect_a_third_of_a_grids_rays(const MakeScene& make_scene, int converged_grid) {
  const auto traced = [&](const Antialiasing& antialias) {
    SceneDescription scene = make_scene();
    scene.render.antialias = antialias;
    return rendered(std::move(scene), {ChannelGroup::color});
  };
  const RenderResult converged = traced({Antialiasing::Method::grid, converged_grid});
  const RenderResult adaptive = traced({Antialiasing::Method::whitted, 1});
  const auto rays = [](const RenderResult& result) { return static_cast<double>(result.statistics.total_rays()); };
  using Error = double (*)(const Film&, const Film&);
  struct Measure {
    const char* name;
    Error error;
    double reached, last_error = 0, last_rays = 0, equal_rays = 0;
  };
  Measure measures[] = {{"display", display_rms, display_rms(adaptive.film, converged.film)},
                        {"linear", linear_rms, linear_rms(adaptive.film, converged.film)}};
  // The first grid that is as good, and between it and the one before the rays that the error takes, on logarithmic
  // scales.
  for (int n = 1; n <= 12 && (measures[0].equal_rays == 0 || measures[1].equal_rays == 0); ++n) {
    const RenderResult grid = traced({Antialiasing::Method::grid, n});
    for (Measure& m : measures) {
      const double error = m.error(grid.film, converged.film);
      if (m.equal_rays == 0 && error <= m.reached)
        m.equal_rays = n == 1 ? rays(grid)
                              : m.last_rays * std::pow(rays(grid) / m.last_rays, std::log(m.reached / m.last_error) /
                                                                                     std::log(error / m.last_error));
      m.last_error = error, m.last_rays = rays(grid);
    }
  }
  for (const Measure& m : measures) {
    ASSERT_GT(m.equal_rays, 0) << m.name << ": no grid is as good as " << m.reached;
    EXPECT_LE(rays(adaptive), m.equal_rays / 3) << m.name << " error " << m.reached;
    testing::Test::RecordProperty(std::string(m.name) + "_error", std::to_string(m.reached));
    testing::Test::RecordProperty(std::string(m.name) + "_rays_over_grid",
                                  std::to_string(rays(adaptive) / m.equal_rays));
  }
  const double pixels = double(adaptive.film.window().width) * adaptive.film.window().height;
  testing::Test::RecordProperty("samples_per_pixel",
                                std::to_string(static_cast<double>(adaptive.statistics.samples) / pixels));
}

// The scene as it is, at its own size and the default settings: a seventh.
TEST(AdaptiveSampling, CostsAThirdOfAGridAtMostOnTheSceneAsItIs) {
  const SceneDescription scene = builtin_scene("spheres-1980");
  EXPECT_EQ(scene.render.adaptive.threshold, AdaptiveSampling().threshold);
  EXPECT_EQ(scene.render.adaptive.levels, AdaptiveSampling().levels);
  EXPECT_EQ(scene.render.adaptive.minimum_level, AdaptiveSampling().minimum_level);
  // 11 is prime, so that none of the smaller grids' samples but middles are among the converged picture's; its own
  // error is a third of what is compared, and adds to both alike.
  expect_a_third_of_a_grids_rays([] { return builtin_scene("spheres-1980"); }, 11);
}

SceneDescription small_spheres_1980(bool filtered, double threshold, int width, int height) {
  SceneDescription scene = builtin_scene("spheres-1980");
  scene.image = {width, height};
  std::get<CheckerPattern>(scene.materials.back().diffuse).filtered = filtered;
  scene.render.adaptive.threshold = threshold;
  return scene;
}

// In small pictures more pixels lie on an edge, and more rays are due. Points of the checker for both: filtered, its
// edges cost a grid nothing, and what is compared is the filter.
TEST(AdaptiveSampling, CostsAThirdOfAGridAtMostAtEqualError) {
  expect_a_third_of_a_grids_rays([] { return small_spheres_1980(false, 0.1, 160, 120); }, 24);
}

TEST(AdaptiveSampling, CostsAThirdOfAGridAtMostOnTheFilteredChecker) {
  expect_a_third_of_a_grids_rays([] { return small_spheres_1980(true, 0.05, 320, 240); }, 24);
}

}  // namespace
}  // namespace raytree
