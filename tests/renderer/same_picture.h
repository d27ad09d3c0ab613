// One picture, however it is traced: what tests of determinism hold whole scenes to.
#pragma once

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <string>
#include <utility>

#include "tests/renderer/test_scenes.h"

namespace raytree::test {

/// Traces a scene on 1, 2, 3 and 7 threads, its tiles in five orders, and six of its windows by themselves: every
/// channel of every pixel must have the same bits. `what` names the scene in messages.
inline void expect_the_same_picture_always(SceneDescription description, const std::string& what,
                                           const PrepareOptions& preparing = {}) {
  const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 7);
  const Scene scene = prepared(std::move(description), nullptr, preparing);
  RenderOptions options;
  options.channels = all_channels();
  options.threads = 1;
  const RenderResult reference = render(scene, options);
  ASSERT_TRUE(reference.complete);
  for (const int threads : {1, 2, 3, 7})
    for (const std::uint64_t seed : {0u, 1u, 99u, 2026u, 0xfedcba98u}) {
      options.threads = threads;
      options.tile_order_seed = seed;
      const RenderResult result = render(scene, options);
      EXPECT_EQ(differing_pixels(reference.film, result.film), 0u)
          << what << " threads " << threads << " seed " << seed;
      EXPECT_EQ(result.statistics.rays, reference.statistics.rays);
      EXPECT_EQ(result.statistics.branches_cut, reference.statistics.branches_cut);
      EXPECT_EQ(result.statistics.threads, threads);
    }
  const int w = scene.description.image.width, h = scene.description.image.height;
  for (const PixelWindow& window :
       {PixelWindow{0, 0, 1, 1}, PixelWindow{33, 17, 30, 30}, PixelWindow{31, 31, 2, 2},
        PixelWindow{w - 1, h - 1, 1, 1}, PixelWindow{5, h - 4, w - 5, 3}, PixelWindow{32, 0, 32, 32}}) {
    options.window = window;
    options.threads = 3;
    options.tile_order_seed = 7;
    const RenderResult crop = render(scene, options);
    EXPECT_EQ(differing_pixels(reference.film, crop.film), 0u)
        << what << " crop " << window.width << "x" << window.height << "+" << window.x0 << "+" << window.y0;
    EXPECT_EQ(crop.film.window().width, window.width);
  }
}

}  // namespace raytree::test
