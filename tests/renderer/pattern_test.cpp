// Colors that vary: stripes and noise where they should be, and all patterns seen through a pixel against the mean of
// what the pixel covers.
#include "renderer/pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "geometry/angle.h"
#include "renderer/noise.h"
#include "tests/renderer/test_scenes.h"

namespace raytree {
namespace {

using namespace test;

/// A wall in the plane z = 0 of ambient color alone.
SceneDescription wall(const ColorPattern& pattern, int size, double height) {
  SceneDescription scene = dark_scene(size, front_camera(height));
  scene.ambient = Rgb(1);
  scene.materials = {material("m", pattern)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 0, 1}}, "m")};
  return scene;
}

TEST(Pattern, StripesRunAcrossTheirDirection) {
  StripesPattern stripes;
  stripes.even = Rgb(1, 0, 0), stripes.odd = Rgb(0, 1, 0);
  stripes.size = 0.7171;  // no sample lies on an edge
  stripes.direction = {3, 4, 0};
  stripes.offset = {0.2, -0.1, 5};
  for (const bool smooth : {false, true}) {
    stripes.smooth = smooth;
    stripes.filtered = false;
    const RenderResult result = rendered(wall(stripes, 40, 8));
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double px = (x + 0.5 - 20) * 0.2, py = (20 - y - 0.5) * 0.2;
        const double stripe = ((px - 0.2) * 0.6 + (py + 0.1) * 0.8) / 0.7171;
        const double share =
            smooth ? 0.5 + 0.5 * std::sin(kPi * stripe) : (static_cast<int>(std::floor(stripe)) % 2 == 0 ? 1 : 0);
        expect_color(color_at(result.film, x, y), Rgb(static_cast<float>(share), static_cast<float>(1 - share), 0),
                     smooth ? 2e-6 : 0);
      }
  }
}

TEST(Pattern, StripesAndNoiseGoByTextureCoordinates) {
  auto mesh = triangles({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
  mesh->texture_coordinates.assign({Vec2f(0, 0), Vec2f(4, 0), Vec2f(4, 4), Vec2f(0, 4)});
  const auto traced = [&](const ColorPattern& pattern) {
    SceneDescription scene = dark_scene(16, front_camera(2));
    scene.ambient = Rgb(1);
    scene.materials = {material("m", pattern)};
    scene.shapes = {mesh_shape(std::make_shared<PolygonMesh>(*mesh), "m")};
    return rendered(std::move(scene));
  };
  StripesPattern stripes;
  stripes.even = Rgb(1), stripes.odd = Rgb(0);
  stripes.space = PatternSpace::uv;
  stripes.direction = {0, 1, 0};
  NoisePattern noise;
  noise.low = Rgb(0), noise.high = Rgb(1);
  noise.space = PatternSpace::uv;
  noise.octaves = 2, noise.contrast = 1, noise.seed = 4;
  const RenderResult striped = traced(stripes), noisy = traced(noise);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(color_at(striped.film, x, y).r, (15 - y) / 4 % 2 == 0 ? 1 : 0);
      const double n = octave_noise({2, 0.5, 4}, {(x + 0.5) / 4, (16 - y - 0.5) / 4, 0}, 0).value;
      EXPECT_NEAR(color_at(noisy.film, x, y).r, 0.5 + 0.5 * n, 2e-6);
    }
}

TEST(Pattern, ACheckersCellsAreWhatOnePointAfterTheOtherShows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-4, 4), reach(-1, 1);
  std::array<int, 3> counts{};  // odd, several cells, even
  int blurred = 0;
  for (const bool filtered : {true, false})
    for (const auto plane : {CheckerPattern::Plane::xy, CheckerPattern::Plane::xz, CheckerPattern::Plane::yz})
      for (int round = 0; round < 2000; ++round) {
        CheckerPattern checker;
        checker.even = Rgb(0.25f, 0.5f, 1), checker.odd = Rgb(1, 0.125f, 0);
        checker.size = 0.7, checker.offset = {0.3, -0.1};
        checker.plane = plane, checker.filtered = filtered;
        const Pattern pattern = make_pattern(checker, Vec3d(0.5, -1, 2));
        ASSERT_TRUE(pattern.has_cells());
        // Windows from none at all to several cells, places among them where cells meet.
        const float width = round % 5 == 0 ? 0.0f : std::ldexp(1.0f, round % 12 - 10);
        const auto vector = [&](auto&& value) { return Vec3f(value(random), value(random), value(random)); };
        SampleLanes samples;
        for (std::size_t i = 0; i < kLanes; ++i) {
          const Vec3f at = vector(place);
          samples.position.set(i, round % 7 == 0 ? Vec3f(std::round(at.x), std::round(at.y), std::round(at.z)) : at);
          samples.edge.set(i, vector(reach) * width);
          samples.other_edge.set(i, vector(reach) * width);
          samples.leaves_edges[i] = (round / 2) % 2;
        }
        std::int32_t cells[kLanes];
        pattern.find_cells(samples, cells);
        for (std::size_t i = 0; i < kLanes; ++i) {
          SurfacePoint point;
          point.position = samples.position[i];
          const Footprint footprint{samples.edge[i], samples.other_edge[i], samples.leaves_edges[i] != 0};
          const Rgb color = pattern.at(point, footprint, nullptr);
          ASSERT_TRUE(cells[i] == 1 || cells[i] == 0 || cells[i] == -1);
          ++counts[static_cast<std::size_t>(cells[i] + 1)];
          if (cells[i] != 0)
            ASSERT_EQ(color, cells[i] > 0 ? checker.even : checker.odd);
          else
            blurred += color != checker.even && color != checker.odd;
        }
      }
  EXPECT_GT(counts[0], 10000);
  EXPECT_GT(counts[2], 10000);
  // What is left to be looked at one by one are mixtures, but where the window has just reached the border.
  EXPECT_GT(counts[1], 10000);
  EXPECT_GT(blurred, counts[1] * 9 / 10);
}

TEST(Pattern, NoCellsAreFoundInWhatIsNotACheckerOverPositions) {
  CheckerPattern over_texture;
  over_texture.plane = CheckerPattern::Plane::uv;
  for (const ColorPattern& pattern :
       {ColorPattern(over_texture), ColorPattern(StripesPattern()), ColorPattern(NoisePattern()), ColorPattern(Rgb(1))})
    EXPECT_FALSE(make_pattern(pattern, Vec3d(0, 0, 0)).has_cells()) << pattern.index();
}

TEST(Pattern, NoiseMixesItsTwoColorsByItsShare) {
  NoisePattern noise;
  noise.low = Rgb(0, 0.5f, 1), noise.high = Rgb(1, 0.5f, 0);
  noise.size = 0.25, noise.octaves = 3, noise.gain = 0.6, noise.seed = 12, noise.offset = {0.3, 0.1, -0.7};
  noise.filtered = false;
  for (const double contrast : {0.0, 1.5, 100.0}) {
    noise.contrast = contrast;
    const RenderResult result = rendered(wall(noise, 32, 4));
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const Vec3d place((x + 0.5 - 16) * 0.125, (16 - y - 0.5) * 0.125, 0);
        const double n = octave_noise({3, 0.6, 12}, (place - noise.offset) * 4, 0).value;
        const double share = std::clamp(0.5 + 0.5 * contrast * n, 0.0, 1.0);
        expect_color(color_at(result.film, x, y), Rgb(static_cast<float>(share), 0.5f, static_cast<float>(1 - share)),
                     2e-6 * (1 + contrast));
      }
  }
}

TEST(Pattern, KeepsItsDigitsFarFromTheWorldsOrigin) {
  const Vec3d far(1048576, -2097152, 4194304);  // exact in binary
  const auto traced = [&](ColorPattern pattern, const Vec3d& at) {
    if (auto* stripes = std::get_if<StripesPattern>(&pattern)) stripes->offset += at;
    if (auto* noise = std::get_if<NoisePattern>(&pattern)) noise->offset += at;
    if (auto* checker = std::get_if<CheckerPattern>(&pattern)) checker->offset += Vec2d(at.x, at.y);
    CameraDescription camera = front_camera(3);
    camera.position += at, camera.target += at;
    SceneDescription scene = dark_scene(48, camera);
    scene.ambient = Rgb(1);
    scene.materials = {material("m", pattern)};
    scene.shapes = {shape(SphereShape{at, 1}, "m")};
    return rendered(std::move(scene));
  };
  StripesPattern stripes;
  stripes.size = 0.11, stripes.direction = {1, 2, 3}, stripes.smooth = true;
  NoisePattern noise;
  noise.size = 0.2;
  CheckerPattern checker;
  checker.size = 0.3, checker.plane = CheckerPattern::Plane::xy;
  for (const ColorPattern& pattern : {ColorPattern(stripes), ColorPattern(noise), ColorPattern(checker)}) {
    const RenderResult here = traced(pattern, {0, 0, 0}), there = traced(pattern, far);
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 48; ++x)
        // Positions agree to float's last bits, 2^-22; colors change by at most their span over 1/50 of a unit; offsets
        // in the file have eight digits after the point there.
        EXPECT_NEAR(color_at(here.film, x, y).r, color_at(there.film, x, y).r, 100 * 0x1p-22) << pattern.index();
  }
}

// --- through the pixel ---

/// The floor toward the horizon from a height of 1, turned about the vertical so that squares run every way.
SceneDescription floor_scene(const ColorPattern& pattern, double turn, const Antialiasing& antialias) {
  CameraDescription camera;
  camera.position = {0.3, 1, 0.2};
  camera.target = camera.position + Vec3d(std::sin(turn), -0.35, -std::cos(turn));
  camera.field_of_view = 60;
  SceneDescription scene = dark_scene(48, camera);
  scene.ambient = Rgb(1);
  scene.materials = {material("m", pattern)};
  scene.shapes = {shape(PlaneShape{{0, 0, 0}, {0, 1, 0}}, "m")};
  scene.render.antialias = antialias;
  return scene;
}

/// Over the pixels that `mean` shows the floor alone in: the one sample of a pixel on the horizon sees one or none.
double rms(const Film& film, const Film& mean) {
  double sum = 0;
  int floor = 0;
  const int count = film.window().width * film.window().height;
  for (int i = 0; i < count; ++i) {
    if (mean.plane(ChannelGroup::alpha, 0)[i] < 1 - 1e-5f) continue;
    ++floor;
    const double d = double(film.plane(ChannelGroup::color, 0)[i]) - mean.plane(ChannelGroup::color, 0)[i];
    sum += d * d;
  }
  EXPECT_GT(floor, count / 2);
  return std::sqrt(sum / floor);
}

/// What taking a pixel's outline on the floor for a parallelogram costs. y pixels below the horizon, f pixels being the
/// distance at which a pixel sees its own size, the floor lies f / y away and a pixel is L = f / y^2 long; its ends are
/// off by half the second derivative over half a pixel, L / (4 y), or by as much as tells cells apart, 1. An end that
/// is off by e changes the mean by at most e / (2 L) either way; two ends, independent, and as much again for the
/// sides.
/// `cell`: the larger edge of a cell.
double parallelogram_error(double f, int rows, double cell = 1) {
  double squares = 0;
  for (int row = 0; row < rows; ++row) {
    const double y = row + 0.5, error = std::min(1 / (4 * y), cell * y * y / f);
    squares += 4 * error * error / 4;
  }
  return std::sqrt(squares / rows);
}

template <class Kind>
Kind black_and_white() {
  Kind pattern;
  pattern.even = Rgb(1), pattern.odd = Rgb(0);
  return pattern;
}

TEST(Pattern, OneFilteredSampleAPixelIsTheMeanOfWhatThePixelCovers) {
  const Antialiasing one{Antialiasing::Method::none, 1}, many{Antialiasing::Method::grid, 24};
  StripesPattern stripes = black_and_white<StripesPattern>();
  stripes.direction = {1, 0, 0.5}, stripes.size = 0.6;
  StripesPattern smooth = stripes;
  smooth.smooth = true;
  const CheckerPattern checker = black_and_white<CheckerPattern>();
  int index = 0;
  for (const ColorPattern& filtered : {ColorPattern(checker), ColorPattern(stripes), ColorPattern(smooth)})
    for (const double turn : {0.0, 0.4, kPi / 4}) {
      ColorPattern bare = filtered;
      std::visit(
          []<class T>(T& pattern) {
            if constexpr (!std::same_as<T, Rgb>) pattern.filtered = false;
          },
          bare);
      const RenderResult mean = rendered(floor_scene(bare, turn, many));
      const double error = rms(rendered(floor_scene(filtered, turn, one)).film, mean.film),
                   bare_error = rms(rendered(floor_scene(bare, turn, one)).film, mean.film);
      RecordProperty("filtered_" + std::to_string(index), std::to_string(error));
      RecordProperty("point_" + std::to_string(index++), std::to_string(bare_error));
      // The horizon stands .35 / tan(30 degrees) of half the picture above its middle. The grid's own mean is off by
      // less than 1/300: two edges a pixel and 24 rows of points.
      EXPECT_LE(error, parallelogram_error(24 / std::tan(kPi / 6), 38) + 1.0 / 300)
          << filtered.index() << " turned " << turn;
      EXPECT_GE(bare_error, 4 * error) << filtered.index() << " turned " << turn;
    }
}

TEST(Pattern, TheMeanIsThatOfTheCellsAsTheShapesTransformStretchesThem) {
  Matrix44d turned;
  turned.rotate(Vec3d(0, 0.7, 0));
  CheckerPattern checker = black_and_white<CheckerPattern>();
  const auto traced = [&](bool filtered, const Antialiasing& antialias) {
    checker.filtered = filtered;
    SceneDescription scene = floor_scene(checker, 0.4, antialias);
    scene.shapes[0].transform = scaling({1.5, 1, 0.5}) * turned * translation({0.2, 0, 0.3});
    return rendered(std::move(scene));
  };
  const Antialiasing one{Antialiasing::Method::none, 1}, many{Antialiasing::Method::grid, 24};
  const RenderResult mean = traced(false, many);
  const double error = rms(traced(true, one).film, mean.film), bare_error = rms(traced(false, one).film, mean.film);
  RecordProperty("filtered", std::to_string(error));
  RecordProperty("point", std::to_string(bare_error));
  // The grid's own mean: twice as many edges as of square cells at most.
  EXPECT_LE(error, parallelogram_error(24 / std::tan(kPi / 6), 38, 1.5) + 2.0 / 300);
  EXPECT_GE(bare_error, 4 * error);
}

TEST(Pattern, ScaledWithItsShapeItIsAPatternOfThatSize) {
  // Noise fades by the window's width in the shape's own space; factors of two change no digit.
  NoisePattern noise;
  CheckerPattern checker = black_and_white<CheckerPattern>();
  for (const auto& [small, large] : {std::pair<ColorPattern, ColorPattern>{noise, noise}, {checker, checker}}) {
    ColorPattern scaled = large;
    std::visit(
        []<class T>(T& pattern) {
          if constexpr (!std::same_as<T, Rgb>) pattern.size = 4;
        },
        scaled);
    SceneDescription scene = floor_scene(small, 0.3, {Antialiasing::Method::none, 1});
    scene.shapes[0].transform = scaling(Vec3d(4));
    const RenderResult moved = rendered(std::move(scene)),
                       described = rendered(floor_scene(scaled, 0.3, {Antialiasing::Method::none, 1}));
    EXPECT_EQ(differing_pixels(moved.film, described.film), 0u);
  }
}

TEST(Pattern, FilteredNoiseIsCalmInTheDistance) {
  NoisePattern noise;
  noise.low = Rgb(0), noise.high = Rgb(1);
  noise.size = 0.05;
  const auto traced = [&](bool filtered) {
    noise.filtered = filtered;
    return rendered(floor_scene(noise, 0.3, {Antialiasing::Method::none, 1}));
  };
  const RenderResult calm = traced(true), rough = traced(false);
  double calm_squares = 0, rough_squares = 0;
  int count = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const float depth = calm.film.plane(ChannelGroup::depth, 0)[pixel_index(calm.film, x, y)];
      if (!(depth > 20 && depth < 1e6)) continue;  // cells are smaller than a fifth of a pixel's height from there on
      ++count;
      calm_squares += std::pow(color_at(calm.film, x, y).r - 0.5, 2);
      rough_squares += std::pow(color_at(rough.film, x, y).r - 0.5, 2);
    }
  ASSERT_GT(count, 40);
  EXPECT_EQ(calm_squares, 0);
  EXPECT_GT(std::sqrt(rough_squares / count), 0.15);
}

TEST(Pattern, AmbientPatternOfItsOwnIsFilteredToo) {
  SceneDescription scene = floor_scene(Rgb(0), 0.4, {Antialiasing::Method::none, 1});
  scene.materials[0].ambient = black_and_white<CheckerPattern>();
  const RenderResult ambient = rendered(std::move(scene)),
                     diffuse =
                         rendered(floor_scene(black_and_white<CheckerPattern>(), 0.4, {Antialiasing::Method::none, 1}));
  EXPECT_EQ(rms(ambient.film, diffuse.film), 0);
}

TEST(Pattern, InAMirrorItIsTakenAtPoints) {
  // Nothing is known of how wide a ray is further down the tree; there anti-aliasing has the work.
  SceneDescription scene = floor_scene(black_and_white<CheckerPattern>(), 0.4, {Antialiasing::Method::none, 1});
  scene.materials.push_back(material("mirror", Rgb(0)));
  scene.materials[1].reflection = Rgb(1);
  scene.shapes.push_back(shape(DiscShape{{0.3, 1, -0.6}, {0, 0, 1}, 5}, "mirror"));
  const RenderResult result = rendered(std::move(scene));
  int seen = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x)
      if (result.film.id_plane(ChannelGroup::object_id)[pixel_index(result.film, x, y)] == 2) {
        const float value = color_at(result.film, x, y).r;
        EXPECT_TRUE(value == 0 || value == 1) << value;
        seen += value == 1;
      }
  EXPECT_GT(seen, 50);
}

}  // namespace
}  // namespace raytree
