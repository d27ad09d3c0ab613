// Interpolation inside polygons: what each way reproduces, and how scan lines depend on rotation (row 14 of the
// catalogue of failures: a square with the values 1, 0, 1, 0).
#include "geometry/facet_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "geometry/angle.h"

namespace raytree {
namespace {

using Polygon = std::vector<Vec3f>;
using Weigher = std::function<void(const Polygon&, const Vec3f&, std::vector<float>&)>;

/// Rows along x, seen along -z from far away.
const ScanPlane kRows{{0, 1, 0}, {1, 0, 0}, false, {}, {}};

std::vector<float> weights_of(const Weigher& weigher, const Polygon& polygon, const Vec3f& point) {
  std::vector<float> weights(polygon.size(), -1.0f);
  weigher(polygon, point, weights);
  return weights;
}
const Weigher kMeanValue = [](const Polygon& p, const Vec3f& at, std::vector<float>& w) {
  mean_value_weights(p, at, w);
};
const Weigher kScanLine = [](const Polygon& p, const Vec3f& at, std::vector<float>& w) {
  EXPECT_TRUE(scanline_weights(p, at, kRows, w));
};
const Weigher kBilinear = [](const Polygon& p, const Vec3f& at, std::vector<float>& w) { bilinear_weights(p, at, w); };

Polygon regular(int count, double turn, double radius = 1) {
  Polygon polygon;
  for (int i = 0; i < count; ++i)
    polygon.push_back(
        Vec3f(Vec3d(std::cos(turn + 2 * kPi * i / count), std::sin(turn + 2 * kPi * i / count), 0) * radius));
  return polygon;
}

/// The value at the center of a square of the values 1, 0, 1, 0 that is turned by so many degrees.
double center_value(const Weigher& weigher, double degrees) {
  const std::vector<float> weights = weights_of(weigher, regular(4, kPi / 4 + degrees * kDegree), {0, 0, 0});
  return weights[0] + weights[2];
}

double swing(const Weigher& weigher) {
  double least = 1, most = 0;
  for (int degrees = -90; degrees <= 90; degrees += 5) {
    const double value = center_value(weigher, degrees);
    least = std::min(least, value), most = std::max(most, value);
  }
  return most - least;
}

// Level, the scan line through the center runs between the middles of two edges, 1/2 each; on its corner it runs
// between two corners, both 1 or both 0, by the way it was turned.
TEST(FacetWeights, ScanLinesDependOnRotationAndTheOthersDoNot) {
  EXPECT_NEAR(center_value(kScanLine, 0), 0.5, 1e-6);
  EXPECT_NEAR(center_value(kScanLine, 44.999), 0, 1e-3);
  EXPECT_NEAR(center_value(kScanLine, -44.999), 1, 1e-3);
  std::printf("  square 1, 0, 1, 0, center over rotation: swing %.3f by scan lines, %.2g bilinear, %.2g mean value\n",
              swing(kScanLine), swing(kBilinear), swing(kMeanValue));
  EXPECT_NEAR(swing(kScanLine), 1, 1e-3);  // 1/2 to either side
  EXPECT_LT(swing(kBilinear), 1e-6);
  EXPECT_LT(swing(kMeanValue), 1e-6);
}

TEST(FacetWeights, PointsAreTheWeightedMeanOfCornersWhateverTheMethod) {
  std::mt19937 random(1971);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    // A convex polygon in any plane, far from even.
    const int count = 3 + trial % 6;
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back(2 * kPi * (i + 0.8 * unit(random)) / count);
    const Vec3d u = Vec3d(unit(random), unit(random), unit(random)).normalized();
    const Vec3d v = u.cross(Vec3d(0, 0, 1)).normalized(), middle(3 * unit(random), 5, -2);
    Polygon polygon;
    for (const double angle : angles)
      polygon.push_back(Vec3f(middle + u * (2 * std::cos(angle)) + v * std::sin(angle)));
    Vec3d point(0, 0, 0);
    double sum = 0;
    for (const Vec3f& corner : polygon) {
      const double weight = unit(random) + 1e-3;
      point += Vec3d(corner) * weight;
      sum += weight;
    }
    const Vec3f at(point / sum);
    std::vector<Weigher> methods{kMeanValue, kScanLine};
    if (count == 4) methods.push_back(kBilinear);
    for (const Weigher& method : methods) {
      const std::vector<float> weights = weights_of(method, polygon, at);
      Vec3d mean(0, 0, 0);
      double total = 0;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        EXPECT_GE(weights[i], -1e-6f);
        mean += Vec3d(polygon[i]) * double(weights[i]);
        total += weights[i];
      }
      EXPECT_NEAR(total, 1, 1e-5);
      worst = std::max(worst, (mean - Vec3d(at)).length());
    }
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(FacetWeights, MeanValueCoordinatesOfATriangleAreBarycentric) {
  const Polygon triangle{{0, 0, 0}, {4, 0, 1}, {1, 3, -2}};
  for (const auto& [b, c] :
       {std::pair(0.2f, 0.3f), std::pair(0.0f, 0.5f), std::pair(1.0f, 0.0f), std::pair(0.4f, 0.6f)}) {
    const Vec3f at = triangle[0] * (1 - b - c) + triangle[1] * b + triangle[2] * c;
    const std::vector<float> weights = weights_of(kMeanValue, triangle, at);
    EXPECT_NEAR(weights[0], 1 - b - c, 1e-5);
    EXPECT_NEAR(weights[1], b, 1e-5);
    EXPECT_NEAR(weights[2], c, 1e-5);
  }
}

TEST(FacetWeights, CornersHaveTheirOwnValueAndEdgesTheirTwoEnds) {
  for (const int count : {3, 4, 5, 8}) {
    const Polygon polygon = regular(count, 0.3);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t next = (i + 1) % polygon.size();
      EXPECT_NEAR(weights_of(kMeanValue, polygon, polygon[i])[i], 1, 1e-5);
      const std::vector<float> middle = weights_of(kMeanValue, polygon, (polygon[i] + polygon[next]) * 0.5f);
      EXPECT_NEAR(middle[i], 0.5, 1e-5);
      EXPECT_NEAR(middle[next], 0.5, 1e-5);
      if (count == 4) {
        EXPECT_NEAR(weights_of(kBilinear, polygon, polygon[i])[i], 1, 1e-5);
      }
    }
  }
}

// The bilinear patch of a trapezoid: at its parameters (u, v) the weights are (1-u)(1-v), u(1-v), uv, (1-u)v.
TEST(FacetWeights, BilinearWeightsAreThoseOfThePatch) {
  for (const Polygon& quad : {Polygon{{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}}, regular(4, 0.1),
                              Polygon{{0, 0, 0}, {1, 0, 0.5}, {1.2f, 1.5f, 1}, {0, 1, 0.25f}}})
    for (const double u : {0.0, 0.25, 0.7, 1.0})
      for (const double v : {0.0, 0.5, 0.9, 1.0}) {
        const std::array<double, 4> exact{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
        Vec3d at(0, 0, 0);
        for (std::size_t i = 0; i < 4; ++i) at += Vec3d(quad[i]) * exact[i];
        const std::vector<float> weights = weights_of(kBilinear, quad, Vec3f(at));
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(weights[i], exact[i], 1e-4) << u << " " << v;
      }
}

TEST(FacetWeights, ConcavePolygonsKeepFiniteWeightsThatAddUp) {
  const Polygon dart{{0, 0, 0}, {2, 1, 0}, {0, 4, 0}, {0.5f, 1, 0}};
  for (const Vec3f& at : {Vec3f(1, 1, 0), Vec3f(0.6f, 0.5f, 0), Vec3f(0.5f, 2.5f, 0), Vec3f(0.55f, 1.0f, 0)})
    for (const Weigher& method : {kMeanValue, kScanLine, kBilinear}) {
      double total = 0;
      for (const float weight : weights_of(method, dart, at)) total += weight;
      EXPECT_NEAR(total, 1, 1e-5);
    }
}

// Polygons were projected before they were shaded: halfway in the picture between depths 1 and 3 lies a quarter of the
// way in space, and the shade there is the mean all the same.
TEST(FacetWeights, ScanLinesAreLinearInAPerspectivePicture) {
  const Polygon floor{{-1, -1, -1}, {1, -1, -1}, {3, -1, -3}, {-3, -1, -3}};
  const ScanPlane scan{{0, 1, -2.0f / 3}, {1, 0, 0}, true, {0, 0, 0}, {0, 0, -1}};
  // y / z = -1 at the near edge and -1/3 at the far one: their mean -2/3 is met at z = -1.5.
  std::vector<float> weights(4);
  ASSERT_TRUE(scanline_weights(floor, {0, -1, -1.5f}, scan, weights));
  for (const float weight : weights) EXPECT_NEAR(weight, 0.25, 1e-6);
}

TEST(FacetWeights, AScanLineBeyondThePolygonSaysSo) {
  std::vector<float> weights(4);
  EXPECT_FALSE(scanline_weights(regular(4, 0), {0, 2, 0}, kRows, weights));
}

}  // namespace
}  // namespace raytree
