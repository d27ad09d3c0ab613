#include "renderer/render.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <numeric>
#include <random>
#include <vector>

#include "geometry/stopwatch.h"
#include "renderer/float_mode.h"
#include "renderer/tile_tracer.h"

namespace raytree {
namespace {

struct TilePlace {
  int x0, y0;
};

/// The tiles of the frame's lattice that touch the window.
std::vector<TilePlace> tiles_of(const PixelWindow& window, std::uint64_t order_seed) {
  std::vector<TilePlace> tiles;
  for (int y = window.y0 / kTileSize * kTileSize; y < window.y0 + window.height; y += kTileSize)
    for (int x = window.x0 / kTileSize * kTileSize; x < window.x0 + window.width; x += kTileSize)
      tiles.push_back({x, y});
  if (order_seed != 0) std::shuffle(tiles.begin(), tiles.end(), std::mt19937_64(order_seed));
  return tiles;
}

void add(RenderStatistics& sum, const RenderStatistics& part) {
  for (int i = 0; i < kRayKindCount; ++i) sum.rays[i] += part.rays[i];
  sum.samples += part.samples;
  sum.eye_hits += part.eye_hits;
  sum.rays_through_backs += part.rays_through_backs;
  sum.branches_cut += part.branches_cut;
  sum.branches_at_depth_limit += part.branches_at_depth_limit;
  sum.not_finite_samples += part.not_finite_samples;
  sum.deepest_level = std::max(sum.deepest_level, part.deepest_level);
  sum.thread_seconds += part.thread_seconds;
  sum.intersection_seconds += part.intersection_seconds;
  sum.shading_seconds += part.shading_seconds;
}

}  // namespace

std::uint64_t RenderStatistics::total_rays() const {
  return std::accumulate(rays.begin(), rays.end(), std::uint64_t(0));
}

RenderResult render(const Scene& scene, const RenderOptions& options) {
  const ImageDescription& image = scene.description.image;
  PixelWindow window = options.window;
  if (window.width == 0 && window.height == 0) window = {0, 0, image.width, image.height};
  if (window.x0 < 0 || window.y0 < 0 || window.width <= 0 || window.height <= 0 ||
      window.width > image.width - window.x0 || window.height > image.height - window.y0)
    throw Error(ErrorKind::bad_input, {scene.description.name, 0, "image"},
                fmt::format("the window {}x{}+{}+{} does not lie in the frame of {}x{}", window.width, window.height,
                            window.x0, window.y0, image.width, image.height));

  if (!options.pixels.empty()) {
    const SourceLocation place{scene.description.name, 0, "image"};
    if (options.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      throw Error(ErrorKind::bad_input, place, "the pixels to be traced are not as many as the frame's");
    if (scene.description.render.antialias.method == Antialiasing::Method::whitted)
      throw Error(ErrorKind::bad_input, place, "pixels are left out with a grid's samples only, not with Whitted's");
  }

  RenderResult result{Film(image.width, image.height, window, options.channels), {}, true};
  const std::vector<TilePlace> tiles = tiles_of(window, options.tile_order_seed);
  const auto start = Clock::now();

  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  tbb::enumerable_thread_specific<TileTracer> tracers([&] { return TileTracer(scene, options, result.film); });
  std::mutex progress_mutex;
  RenderProgress progress{0, tiles.size(), 0};
  std::atomic<bool> complete{true};
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const FlushDenormals flush;
          TileTracer& tracer = tracers.local();
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            if (options.stop != nullptr && options.stop->load(std::memory_order_relaxed)) {
              complete = false;
              return;
            }
            const std::uint64_t rays_before = tracer.statistics().total_rays();
            if (!tracer.trace(tiles[i].x0, tiles[i].y0)) {
              complete = false;
              return;
            }
            if (options.on_progress) {
              std::lock_guard lock(progress_mutex);
              ++progress.tiles_done;
              progress.rays += tracer.statistics().total_rays() - rays_before;
              options.on_progress(progress);
            }
          }
        },
        tbb::simple_partitioner());
  });

  for (const TileTracer& tracer : tracers) add(result.statistics, tracer.statistics());
  result.statistics.threads = arena.max_concurrency();
  result.statistics.wall_seconds = seconds_since(start);
  result.complete = complete;
  return result;
}

}  // namespace raytree
