// The few calls that every test of the renderer makes: describe (benchmarks/samples/scenes.h), prepare, render, look at
// a pixel.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/samples/scenes.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree::test {

using namespace samples;

inline constexpr double kFloatError = 0x1p-20;  ///< of radiance about 1: a dozen roundings of half an ulp

inline ChannelSet all_channels() {
  ChannelSet channels;
  for (int i = 0; i < kChannelGroupCount; ++i) channels.add(static_cast<ChannelGroup>(i));
  return channels;
}

inline Scene prepared(SceneDescription description, Warnings* warnings = nullptr, const PrepareOptions& options = {}) {
  Warnings dropped;
  return prepare(std::move(description), options, warnings != nullptr ? *warnings : dropped);
}

inline RenderResult rendered(SceneDescription description, const ChannelSet& channels = all_channels()) {
  const Scene scene = prepared(std::move(description));
  RenderOptions options;
  options.channels = channels;
  return render(scene, options);
}

inline void expect_color(Rgb actual, Rgb expected, double tolerance, const std::string& what = "") {
  EXPECT_NEAR(actual.r, expected.r, tolerance) << what << " red";
  EXPECT_NEAR(actual.g, expected.g, tolerance) << what << " green";
  EXPECT_NEAR(actual.b, expected.b, tolerance) << what << " blue";
}

/// No plane of the film holds a NaN, and only depth an infinity.
inline void expect_finite(const Film& film) {
  const std::size_t pixels =
      static_cast<std::size_t>(film.window().width) * static_cast<std::size_t>(film.window().height);
  for (int g = 0; g < kChannelGroupCount; ++g) {
    const auto group = static_cast<ChannelGroup>(g);
    if (!film.channels().has(group) || holds_ids(group)) continue;
    for (std::size_t p = 0; p < plane_names(group).size(); ++p) {
      const float* plane = film.plane(group, static_cast<int>(p));
      std::size_t bad = 0;
      for (std::size_t i = 0; i < pixels; ++i)
        bad += std::isnan(plane[i]) || (std::isinf(plane[i]) && group != ChannelGroup::depth);
      EXPECT_EQ(bad, 0u) << channel_group_name(group) << " plane " << p;
    }
  }
}

/// Number of pixels of `part` (a crop or a whole frame) that differ in any bit of any channel from `whole`.
inline std::size_t differing_pixels(const Film& whole, const Film& part) {
  std::size_t differing = 0;
  const PixelWindow& window = part.window();
  for (int y = window.y0; y < window.y0 + window.height; ++y)
    for (int x = window.x0; x < window.x0 + window.width; ++x) {
      const std::size_t a = pixel_index(whole, x, y), b = pixel_index(part, x, y);
      bool same = true;
      for (int g = 0; g < kChannelGroupCount; ++g) {
        const auto group = static_cast<ChannelGroup>(g);
        if (!part.channels().has(group)) continue;
        if (holds_ids(group))
          same &= whole.id_plane(group)[a] == part.id_plane(group)[b];
        else
          for (int p = 0; p < static_cast<int>(plane_names(group).size()); ++p)
            same &= std::memcmp(whole.plane(group, p) + a, part.plane(group, p) + b, sizeof(float)) == 0;
      }
      differing += !same;
    }
  return differing;
}

}  // namespace raytree::test
