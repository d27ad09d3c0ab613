#include "geometry/surface_of_revolution.h"

#include <array>
#include <numbers>

namespace raytree {

std::vector<BezierPatch> revolve(std::span<const BezierCurve> profile) {
  constexpr double kRoot2 = std::numbers::sqrt2;
  // Raised from (1, 0), (1, 1), (0, 1) with weights 1, 1/sqrt(2), 1.
  constexpr double kHandle = 2 - kRoot2, kWeight = (1 + kRoot2) / 3;
  constexpr std::array<double, 4> kWeights{1, kWeight, kWeight, 1};
  // Toward the quarter's beginning and its end; whole numbers where they can be, so that quarters meet exactly.
  constexpr std::array<double, 4> kBegin{1, 1, kHandle, 0}, kEnd{0, kHandle, 1, 1};
  constexpr std::array<std::array<double, 2>, 5> kAxes{{{1, 0}, {0, -1}, {-1, 0}, {0, 1}, {1, 0}}};  // x and z

  std::vector<BezierPatch> patches;
  patches.reserve(4 * profile.size());
  for (const BezierCurve& curve : profile)
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      BezierPatch& patch = patches.emplace_back();
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i) {
          const double radius = curve.points[j].x;
          const double x = kBegin[i] * kAxes[quarter][0] + kEnd[i] * kAxes[quarter + 1][0];
          const double z = kBegin[i] * kAxes[quarter][1] + kEnd[i] * kAxes[quarter + 1][1];
          patch.points[4 * j + i] = {radius * x, curve.points[j].y, radius * z};
          patch.weights[4 * j + i] = curve.weights[j] * kWeights[i];
        }
    }
  return patches;
}

}  // namespace raytree
