// FLIP against a second formulation of its publication, written out in double precision without a step in common, and
// against what its authors' own program prints.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/chart/flip.h"
#include "geometry/angle.h"

namespace raytree::benchmarks {
namespace {

using Color = std::array<double, 3>;
using ColorImage = std::vector<Color>;  ///< [kRows][kColumns]

constexpr int kColumns = 48, kRows = 32;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(std::clamp(y, 0, kRows - 1)) * kColumns +
         static_cast<std::size_t>(std::clamp(x, 0, kColumns - 1));
}

/// Two halves of different hue with a texture, all in levels of 255. The test's picture has the border a pixel further,
/// the texture shifted, a bright line left out and a square of another hue.
std::vector<float> drawn(bool test) {
  std::vector<float> srgb;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      std::array<int, 3> color = x < (test ? 25 : 24) ? std::array{200, 120, 60} : std::array{40, 90, 160};
      for (int& level : color) level += (7 * x + 13 * y + (test ? 5 : 0)) % 32;
      if (!test && y == 20) color = {250, 250, 250};
      if (test && x >= 4 && x < 10 && y >= 4 && y < 10) color = {color[2], color[0], color[1]};
      for (const int level : color) srgb.push_back(static_cast<float>(level) / 255);
    }
  return srgb;
}

double sum_of(const std::vector<float>& map) {
  double sum = 0;
  for (const float error : map) sum += static_cast<double>(error);
  return sum;
}

// ---- the second formulation: filters as sums over the plane, CIELAB by kappa and epsilon, inverses as decimals ----

/// From XYZ relative to white: the CIE's own constants.
Color lab_of(const Color& xyz) {
  constexpr double kEpsilon = 216.0 / 24389, kKappa = 24389.0 / 27;
  const auto f = [](double t) { return t > kEpsilon ? std::pow(t, 1.0 / 3) : (kKappa * t + 16) / 116; };
  return {116 * f(xyz[1]) - 16, 500 * (f(xyz[0]) - f(xyz[1])), 200 * (f(xyz[1]) - f(xyz[2]))};
}

/// Linear Rec.709 to XYZ over that of white: rows of the matrix over their sums.
Color relative_of(const Color& rgb) {
  return {(0.412386563 * rgb[0] + 0.357591491 * rgb[1] + 0.180450491 * rgb[2]) / 0.950428545,
          0.212636822 * rgb[0] + 0.715182982 * rgb[1] + 0.072180196 * rgb[2],
          (0.019330620 * rgb[0] + 0.119197164 * rgb[1] + 0.950372587 * rgb[2]) / 1.088900371};
}

/// And back; decimals as the authors' program has them.
Color linear_of(const Color& relative) {
  const double x = 0.950428545 * relative[0], y = relative[1], z = 1.088900371 * relative[2];
  return {3.241003275 * x - 1.537398934 * y - 0.498615861 * z, -0.969224334 * x + 1.875930071 * y + 0.041554224 * z,
          0.055639423 * x - 0.204011202 * y + 1.057148933 * z};
}

Color opponent_of(const Color& rgb) {
  const Color xyz = relative_of(rgb);
  return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

Color clamped_lab_with_hunt(const Color& opponent) {
  const double y = (opponent[0] + 16) / 116;
  Color rgb = linear_of({y + opponent[1] / 500, y, y - opponent[2] / 200});
  for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
  Color lab = lab_of(relative_of(rgb));
  lab[1] *= lab[0] / 100;
  lab[2] *= lab[0] / 100;
  return lab;
}

double distance_of(const Color& p, const Color& q) {
  return std::abs(p[0] - q[0]) + std::sqrt((p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

struct Written {
  ColorImage seen;                                 ///< CIELAB with Hunt's factor
  std::vector<std::array<double, 2>> edge, point;  ///< along x and y
};

Written written_out(const std::vector<float>& srgb, double per_degree) {
  ColorImage image(at(kColumns - 1, kRows - 1) + 1);
  for (std::size_t i = 0; i < image.size(); ++i) {
    Color rgb;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto code = static_cast<double>(srgb[3 * i + c]);
      rgb[c] = code > 0.04045 ? std::pow((code + 0.055) / 1.055, 2.4) : code / 12.92;
    }
    image[i] = opponent_of(rgb);
  }
  constexpr double kA[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}}, kB[3][2] = {{.0047, 1e-5}, {.0053, 1e-5}, {.04, .025}};
  const double deviation = 0.082 / 2 * per_degree;
  const int far = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * per_degree));
  const int near = static_cast<int>(std::ceil(3 * deviation));
  Written result;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      Color filtered{}, total{};
      for (int j = -far; j <= far; ++j)
        for (int i = -far; i <= far; ++i)
          for (std::size_t c = 0; c < 3; ++c) {
            const double square = (i * i + j * j) / (per_degree * per_degree);
            double weight = 0;
            for (int k = 0; k < 2; ++k)
              weight += kA[c][k] * std::sqrt(kPi / kB[c][k]) * std::exp(-kPi * kPi * square / kB[c][k]);
            filtered[c] += weight * image[at(x + i, y + j)][c];
            total[c] += weight;
          }
      for (std::size_t c = 0; c < 3; ++c) filtered[c] /= total[c];
      result.seen.push_back(clamped_lab_with_hunt(filtered));
      // Sums over positive and negative weights apart, each over its own total.
      std::array<double, 2> edge{}, point{};
      double edge_total = 0, positive_total = 0, negative_total = 0;
      for (int j = -near; j <= near; ++j)
        for (int i = -near; i <= near; ++i) {
          const double bell = std::exp(-(i * i + j * j) / (2 * deviation * deviation));
          edge_total += i > 0 ? i * bell : 0;
          const double bend = (i * i / (deviation * deviation) - 1) * bell;
          (bend > 0 ? positive_total : negative_total) += std::abs(bend);
        }
      for (int j = -near; j <= near; ++j)
        for (int i = -near; i <= near; ++i) {
          const double bell = std::exp(-(i * i + j * j) / (2 * deviation * deviation));
          const double light = (image[at(x + i, y + j)][0] + 16) / 116;
          edge[0] -= light * i * bell / edge_total;
          edge[1] -= light * j * bell / edge_total;
          for (std::size_t axis = 0; axis < 2; ++axis) {
            const int step = axis == 0 ? i : j;
            const double bend = (step * step / (deviation * deviation) - 1) * bell;
            point[axis] += light * bend / (bend > 0 ? positive_total : negative_total);
          }
        }
      result.edge.push_back(edge);
      result.point.push_back(point);
    }
  return result;
}

double magnitude(const std::array<double, 2>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1]); }

double written_error(const Written& reference, const Written& test, std::size_t i) {
  const double largest = std::pow(
      distance_of(clamped_lab_with_hunt(opponent_of({0, 1, 0})), clamped_lab_with_hunt(opponent_of({0, 0, 1}))), 0.7);
  const double color = std::pow(distance_of(reference.seen[i], test.seen[i]), 0.7) / largest;
  const double mapped = color < 0.4 ? 0.95 * color / 0.4 : 0.95 + 0.05 * (color - 0.4) / 0.6;
  const double feature = std::max(std::abs(magnitude(reference.edge[i]) - magnitude(test.edge[i])),
                                  std::abs(magnitude(reference.point[i]) - magnitude(test.point[i])));
  return std::pow(mapped, 1 - std::sqrt(feature / std::sqrt(2.0)));
}

// Pictures hold floats, 6e-8 of their value, in planes that are filtered twice: some 1e-6 of CIELAB's 100. A root of
// the distance (to the power .7) and one of the feature multiply what is small; where both pictures are far apart, as
// here, by less than 10.
TEST(FlipWrittenOut, AgreesInEveryPixel) {
  for (const double per_degree : {kFlipPixelsPerDegree, 30.0}) {
    const std::vector<float> map = flip_map(flip_picture(kColumns, kRows, drawn(false), per_degree),
                                            flip_picture(kColumns, kRows, drawn(true), per_degree));
    const Written reference = written_out(drawn(false), per_degree), test = written_out(drawn(true), per_degree);
    for (std::size_t i = 0; i < map.size(); ++i)
      ASSERT_NEAR(static_cast<double>(map[i]), written_error(reference, test, i), 2e-5) << i << " at " << per_degree;
  }
}

// ---- what single parts of it are known to do ----

/// The CIELAB that a picture was resolved to, back in the opponent space that its filters work in.
Color resolved_opponent(const FlipPicture& picture, int x, int y) {
  const std::size_t i = at(x, y);
  const auto cube = [](double v) { return v * v * v; };
  const auto lightness = static_cast<double>(picture.lightness[i]);
  const double f = (lightness + 16) / 116, hunt = lightness / 100;
  const double of_x = cube(f + static_cast<double>(picture.a[i]) / hunt / 500), of_y = cube(f),
               of_z = cube(f - static_cast<double>(picture.b[i]) / hunt / 200);
  return {116 * of_y - 16, 500 * (of_x - of_y), 200 * (of_y - of_z)};
}

/// A wave of `period` pixels along x about a gray, in one channel of the opponent space.
FlipPicture wave(std::size_t channel, int period, double amplitude) {
  std::vector<float> srgb;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      Color opponent{30.4, 0, 0};
      opponent[channel] += amplitude * std::cos(2 * kPi * x / period);
      const double light = (opponent[0] + 16) / 116;
      for (const double value : linear_of({light + opponent[1] / 500, light, light - opponent[2] / 200}))
        srgb.push_back(
            static_cast<float>(value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055));
    }
  return flip_picture(kColumns, kRows, srgb);
}

/// How much of a wave the eye resolves.
double share_left(std::size_t channel, int period) {
  constexpr double kAmplitude = 8;
  const FlipPicture picture = wave(channel, period, kAmplitude);
  const double crest = resolved_opponent(picture, kColumns / 2, kRows / 2)[channel];
  const double trough = resolved_opponent(picture, kColumns / 2 + period / 2, kRows / 2)[channel];
  return (crest - trough) / (2 * kAmplitude);
}

// The publication gives contrast sensitivity over the frequency f in cycles a degree, and filters by its transform: a
// wave is left a1 exp(-b1 f^2) + a2 exp(-b2 f^2) of its height, each a taken sqrt(b) times in the plane. Blue-yellow
// filters end where 3 standard deviations do, which takes up to .01.
TEST(FlipSensitivity, IsThePublishedFunctionOfFrequency) {
  for (const int period : {4, 6, 8, 12, 24}) {
    const double f = kFlipPixelsPerDegree / period;
    EXPECT_NEAR(share_left(0, period), std::exp(-0.0047 * f * f), 1e-3) << period;
    EXPECT_NEAR(share_left(1, period), std::exp(-0.0053 * f * f), 1e-3) << period;
    const double wide = 34.1 * std::sqrt(0.04), narrow = 13.5 * std::sqrt(0.025);
    EXPECT_NEAR(share_left(2, period),
                (wide * std::exp(-0.04 * f * f) + narrow * std::exp(-0.025 * f * f)) / (wide + narrow), 0.01)
        << period;
  }
}

/// White where `is_white` says so, black elsewhere.
template <class IsWhite>
FlipPicture black_and_white(IsWhite&& is_white) {
  std::vector<float> srgb;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) srgb.insert(srgb.end(), 3, is_white(x, y) ? 1.0f : 0.0f);
  return flip_picture(kColumns, kRows, srgb);
}

// Weights of one sign add up to 1: the detector of edges says 1 beside an edge of black and white, that of points says
// 1 on a line that all its negative weights lie in (standard deviation .041 degrees = 2.75 pixels: 5 pixels wide).
TEST(FlipDetectors, SayOneOfWhatTheyAreMadeFor) {
  const FlipPicture edge = black_and_white([](int x, int) { return x >= kColumns / 2; });
  for (const int x : {kColumns / 2 - 1, kColumns / 2}) EXPECT_NEAR(edge.edges[at(x, 9)], 1, 1e-6);
  EXPECT_NEAR(edge.edges[at(4, 9)], 0, 1e-6);
  const FlipPicture line = black_and_white([](int, int y) { return std::abs(y - kRows / 2) <= 2; });
  EXPECT_NEAR(line.points[at(20, kRows / 2)], 1, 1e-6);
  EXPECT_NEAR(line.edges[at(20, kRows / 2)], 0, 1e-6);
}

// Colors at .4 of the largest distance, to the power .7, are mapped to .95: a gray of L = 203.30167 x .4^(1 / .7)
// against black.
TEST(FlipMapping, HasItsKneeWhereItIsPublished) {
  const double lightness = 203.30167 * std::pow(0.4, 1 / 0.7);
  const double code = 1.055 * std::pow(std::pow((lightness + 16) / 116, 3), 1 / 2.4) - 0.055;
  const auto uniform = [](double value) {
    return flip_picture(kColumns, kRows, std::vector<float>(3 * kColumns * kRows, static_cast<float>(value)));
  };
  EXPECT_NEAR(flip_mean(uniform(0), uniform(code)), 0.95, 1e-6);
  // Above it the map rises more slowly: L = 64.69513 for a code .1 larger.
  const double largest = std::pow(203.30167, 0.7);
  EXPECT_NEAR(flip_mean(uniform(0), uniform(code + 0.1)),
              0.95 + 0.05 * (std::pow(64.69513, 0.7) - 0.4 * largest) / (0.6 * largest), 1e-6);
}

// ---- the authors' program ----

/// What the authors' Python program (LDR-FLIP of github.com/NVlabs/flip, 2021, single precision; its filters summed
/// directly in place of OpenCV's) prints for the two pictures.
struct PublishedPixel {
  int x, y;
  double error;
};
struct PublishedMap {
  double per_degree, mean, least, most;
  std::array<PublishedPixel, 9> pixels;
};
const PublishedMap kPublished[] = {{67.02064327658226,
                                    0.235084,
                                    0.012061,
                                    0.972976,
                                    {{{7, 7, 0.972976},
                                      {24, 4, 0.411787},
                                      {24, 20, 0.691640},
                                      {40, 20, 0.782176},
                                      {40, 28, 0.056749},
                                      {0, 0, 0.112898},
                                      {47, 31, 0.192267},
                                      {15, 25, 0.147084},
                                      {3, 6, 0.618538}}}},
                                   {30,
                                    0.261462,
                                    0.063226,
                                    0.981496,
                                    {{{7, 7, 0.966364},
                                      {24, 4, 0.596839},
                                      {24, 20, 0.934073},
                                      {40, 20, 0.981489},
                                      {40, 28, 0.066003},
                                      {0, 0, 0.118664},
                                      {47, 31, 0.324119},
                                      {15, 25, 0.101074},
                                      {3, 6, 0.417375}}}}};

// Theirs rounds more, and prints six digits.
TEST(FlipOfItsAuthors, PrintsTheSame) {
  for (const PublishedMap& published : kPublished) {
    const std::vector<float> map = flip_map(flip_picture(kColumns, kRows, drawn(false), published.per_degree),
                                            flip_picture(kColumns, kRows, drawn(true), published.per_degree));
    EXPECT_NEAR(sum_of(map) / static_cast<double>(map.size()), published.mean, 1e-5);
    const auto [least, most] = std::minmax_element(map.begin(), map.end());
    EXPECT_NEAR(static_cast<double>(*least), published.least, 2e-5);
    EXPECT_NEAR(static_cast<double>(*most), published.most, 2e-5);
    for (const PublishedPixel& pixel : published.pixels)
      EXPECT_NEAR(static_cast<double>(map[at(pixel.x, pixel.y)]), pixel.error, 2e-5) << pixel.x << ", " << pixel.y;
  }
}

TEST(FlipOfItsAuthors, SeesAsManyPixelsADegree) { EXPECT_NEAR(kFlipPixelsPerDegree, 67.02064327658226, 1e-12); }

}  // namespace
}  // namespace raytree::benchmarks
