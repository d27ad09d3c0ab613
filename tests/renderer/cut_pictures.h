// Two pictures of one scene and of the same samples, one with branches of the ray tree cut and one without: what was
// cut is bounded, pixel by pixel and channel by channel.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/renderer/test_scenes.h"

namespace raytree::test {

/// Channels that expect_cut_within_its_bound() looks at.
inline ChannelSet cut_channels() { return {ChannelGroup::color, ChannelGroup::truncation, ChannelGroup::ray_count}; }

/// Rays of the pixel and of those about it, whose samples on the common border are its own too.
inline double rays_about(const Film& film, int x, int y) {
  const PixelWindow& window = film.window();
  double rays = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, window.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, window.width - 1); ++i)
      rays += film.id_plane(ChannelGroup::ray_count)[pixel_index(film, i, j)];
  return rays;
}

/// 0 <= uncut - cut <= truncation channel <= cutoff, but for what additions round. `samples`: of each pixel, those on
/// its border among them. Adds the pixels that something was cut from to `cut_pixels`.
inline void expect_cut_within_its_bound(const Film& cut, const Film& uncut, double cutoff, int samples,
                                        const std::string& what, std::uint64_t& cut_pixels) {
  for (int y = 0; y < cut.window().height; ++y)
    for (int x = 0; x < cut.window().width; ++x) {
      const Rgb a = color_at(uncut, x, y), b = color_at(cut, x, y), t = color_at(cut, x, y, ChannelGroup::truncation);
      const double rays = rays_about(uncut, x, y);
      const float values[3][3] = {{a.r, b.r, t.r}, {a.g, b.g, t.g}, {a.b, b.b, t.b}};
      bool any = false;
      for (const auto& [all, kept, bound] : values) {
        // Both sums add the same terms, save those cut, in float: each addition rounds the sum by half an ulp, and a
        // ray makes at most two (its ambient share and its light or background), a sample two of its pixel's mean.
        const double roundings = (2 * rays + 2 * samples + 2) * 0x1p-24, tolerance = roundings * std::max(all, kept);
        const double lost = double(all) - kept;
        ASSERT_GE(lost, -tolerance) << what << " pixel " << x << "," << y;
        ASSERT_LE(lost, bound + tolerance) << what << " pixel " << x << "," << y;
        // The truncation channel is such a sum itself; shares are differences that round too.
        ASSERT_LE(bound, cutoff * (1 + roundings)) << what;
        any |= bound > 0;
      }
      cut_pixels += any;
    }
}

}  // namespace raytree::test
