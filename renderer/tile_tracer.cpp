#include "renderer/tile_tracer.h"

#include <algorithm>
#include <chrono>

#include "geometry/stopwatch.h"
#include "renderer/features.h"

namespace raytree {
namespace {

/// Eye samples are traced in blocks of so many along x and y, which makes a packet of eight.

/// Adaptive sampling looks at what samples hit, whatever the channels are.
SampleRecords records_for(const ChannelSet& channels, const Antialiasing& antialias) {
  SampleRecords records = raytree::records_for(channels);
  records.first_hits |= antialias.method == Antialiasing::Method::whitted;
  return records;
}

}  // namespace

TileTracer::TileTracer(const Scene& scene, const RenderOptions& options, Film& film)
    : scene_(scene),
      pixels_(options.pixels),
      film_(film),
      samples_(scene, records_for(options.channels, scene.description.render.antialias), options.stop),
      sums_(options.channels) {
  if (scene.description.render.antialias.method == Antialiasing::Method::whitted) adaptive_.emplace(scene);
  positions_.reserve(kBatchSize);
  places_.reserve(kBatchSize);
}

bool TileTracer::trace(int x0, int y0) {
  const auto start = Clock::now();
  const Antialiasing& antialias = scene_.description.render.antialias;
  sums_.clear();
  if (adaptive_) {
    if (!adaptive_->trace(x0, y0, samples_, sums_)) return false;
    sums_.resolve(x0, y0, 1, film_);
  } else {
    const int grid = antialias.method == Antialiasing::Method::grid ? antialias.grid_size : 1;
    if (!trace_grid(x0, y0, grid)) return false;
    sums_.resolve(x0, y0, grid * grid, film_);
  }
  samples_.statistics().thread_seconds += seconds_since(start);
  return true;
}

/// grid x grid samples a pixel, at the centers of equal cells.
bool TileTracer::trace_grid(int x0, int y0, int grid) {
  const ImageDescription& image = scene_.description.image;
  const int width = std::min(kTileSize, image.width - x0) * grid;
  const int height = std::min(kTileSize, image.height - y0) * grid;
  spacing_ = 1.0f / static_cast<float>(grid);
  pixel_of_.resize(static_cast<std::size_t>(kTileSize) * grid);
  for (std::size_t i = 0; i < pixel_of_.size(); ++i) pixel_of_[i] = static_cast<int>(i) / grid;
  positions_.clear();
  places_.clear();
  for (int block_y = 0; block_y < height; block_y += kBlockHeight)
    for (int block_x = 0; block_x < width; block_x += kBlockWidth) {
      if (positions_.size() + kBlockWidth * kBlockHeight > kBatchSize && !finish_chunk()) return false;
      for (int y = block_y; y < std::min(block_y + kBlockHeight, height); ++y)
        for (int x = block_x; x < std::min(block_x + kBlockWidth, width); ++x) {
          const int pixel_x = pixel_of_[x], pixel_y = pixel_of_[y];
          if (!wants(x0 + pixel_x, y0 + pixel_y)) continue;
          positions_.emplace_back(static_cast<float>(x0) + (static_cast<float>(x) + 0.5f) * spacing_,
                                  static_cast<float>(y0) + (static_cast<float>(y) + 0.5f) * spacing_);
          places_.push_back({static_cast<std::uint16_t>(pixel_y * kTileSize + pixel_x),
                             x - pixel_x * grid == grid / 2 && y - pixel_y * grid == grid / 2});
        }
    }
  return finish_chunk();
}

/// Traces the chunk's samples and adds them to their pixels. False: stopped.
bool TileTracer::finish_chunk() {
  if (!samples_.trace(positions_, spacing_)) return false;
  const SampleResults& results = samples_.results();
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (!sums_.add(places_[i].pixel, results, i)) ++samples_.statistics().not_finite_samples;
  if (kFeatures.first_hit_channels && sums_.has_first_hits())
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const FirstHit& hit = results.first_hits[i];
      if (hit.object == 0) continue;
      sums_.add_first_hit(places_[i].pixel, 1, hit);
      if (places_[i].center && sums_.has_ids()) sums_.set_ids(places_[i].pixel, hit.object, hit.material);
    }
  positions_.clear();
  places_.clear();
  return true;
}

}  // namespace raytree
