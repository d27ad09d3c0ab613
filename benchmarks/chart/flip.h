// FLIP, the difference that a viewer sees who flips between two pictures: Andersson, Nilsson, Akenine-Moller,
// Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for Alternating Images", 2020, for display-referred
// pictures. Written from that description alone; docs/chart.md says what it was checked against.
#pragma once

#include <vector>

#include "geometry/angle.h"

namespace raytree::benchmarks {

/// A screen of 3840 pixels over 0.7 m, seen from 0.7 m: the paper's own conditions. 67.02.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840 / 0.7) * kDegree;

/// What FLIP needs of one picture; made once for a picture that is compared often. All planes [height][width].
struct FlipPicture {
  int width = 0, height = 0;
  std::vector<float> lightness, a, b;  ///< CIELAB of the color as the eye resolves it, a and b after Hunt
  std::vector<float> edges, points;    ///< magnitudes of the detectors
};

/// srgb: [height][width][3], sRGB code values in [0, 1]; others are clamped.
FlipPicture flip_picture(int width, int height, const std::vector<float>& srgb,
                         double pixels_per_degree = kFlipPixelsPerDegree);

/// [height][width], each in [0, 1]; 0: nobody sees a difference. The pictures are of one size.
std::vector<float> flip_map(const FlipPicture& reference, const FlipPicture& test);
double flip_mean(const FlipPicture& reference, const FlipPicture& test);

}  // namespace raytree::benchmarks
