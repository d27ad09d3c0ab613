// What a chart's render says it took, of renders whose needs are known.
#include "benchmarks/chart/chart_render.h"

#include <gtest/gtest.h>

#include "app/sanitized.h"
#include "benchmarks/reference_scenes.h"
#include "tests/benchmarks/chart_samples.h"

namespace raytree::benchmarks {
namespace {

ChartRender rendered(SceneDescription description, int width, int height) {
  description.image = {width, height};
  Warnings warnings;
  return render_timed({std::move(description), {}}, 2, nullptr, warnings);
}

// Of two renders that differ in the film alone, the memory differs by the film: 8 planes of floats.
TEST(ChartRenderMemory, GrowsByTheFilmsSize) {
  // What first renders set up for all, and for each thread that takes a tile: a second one may come late.
  for (int i = 0; i < 4; ++i) rendered(trivial_scene(), 160, 120);
  const ChartRender small = rendered(trivial_scene(), 64, 48), large = rendered(trivial_scene(), 1024, 768);
  if (!small.peak_bytes) GTEST_SKIP() << test::kNoPeakMemory;
  const double film = 8 * 4 * (1024.0 * 768 - 64 * 48);
  EXPECT_EQ(static_cast<double>(large.film_bytes) - static_cast<double>(small.film_bytes), film);
  const double grown = static_cast<double>(*large.peak_bytes) - static_cast<double>(*small.peak_bytes);
  EXPECT_GE(grown, film - 1e6);
  // Threads may work on more tiles of the larger picture at once.
  if (!kAddressSanitized) {
    EXPECT_LE(grown, film + 4e6);
  }
}

// All that is counted by its size is held at once, and more while it is being made; how much more is bounded.
TEST(ChartRenderMemory, HoldsArraysAndTracerAtLeast) {
  // What the first render of a process takes for good (threads, their arenas) is no render's own.
  rendered(terrain_scene(50'000), 64, 48);
  const ChartRender few = rendered(terrain_scene(50'000), 64, 48), many = rendered(terrain_scene(400'000), 64, 48);
  if (!few.peak_bytes) GTEST_SKIP() << test::kNoPeakMemory;
  const auto counted = [](const ChartRender& render) {
    return static_cast<double>(render.film_bytes + render.array_bytes + render.tracer_bytes);
  };
  const double grown = static_cast<double>(*many.peak_bytes) - static_cast<double>(*few.peak_bytes);
  EXPECT_GE(static_cast<double>(*many.peak_bytes), counted(many) - 1e6);
  EXPECT_GE(grown, counted(many) - counted(few) - 2e6);
  if (!kAddressSanitized) {
    EXPECT_LE(grown, 3 * (counted(many) - counted(few)));
  }
}

}  // namespace
}  // namespace raytree::benchmarks
