// The pixels of the tile under way: weighted sums of samples, and how they become the film's channels.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/film.h"
#include "renderer/ray_tree.h"
#include "renderer/render.h"

namespace raytree {

inline constexpr int kTilePixels = kTileSize * kTileSize;

/// What `channels` need of each sample.
SampleRecords records_for(const ChannelSet& channels);

/// Pixels stand at [y * kTileSize + x] of the tile.
class TileSums {
 public:
  explicit TileSums(const SampleRecords& records);

  void clear();

  /// Adds sample i of `results`. A radiance that is not finite counts as 0; false tells of it.
  bool add(int pixel, const SampleResults& results, std::size_t i) {
    const bool finite = add_color(pixel, 1, results.radiance[i]);
    if (!truncation_.empty()) add_truncation(pixel, 1, results.truncation[i]);
    if (!ray_counts_.empty()) add_rays(pixel, results.ray_counts[i]);
    return finite;
  }
  bool add_color(int pixel, double weight, const Rgb& radiance) {
    if (!is_finite(radiance)) return false;
    color_[pixel].add(weight, radiance);
    return true;
  }
  void add_truncation(int pixel, double weight, const Rgb& bound) { truncation_[pixel].add(weight, bound); }
  void add_rays(int pixel, std::uint32_t count) { ray_counts_[pixel] += count; }
  /// `hit` must have hit something.
  void add_first_hit(int pixel, double weight, const FirstHit& hit);
  /// The ids of the pixel.
  void set_ids(int pixel, std::uint32_t object, std::uint32_t material) {
    first_hits_[pixel].object = object, first_hits_[pixel].material = material;
  }

  bool has_truncation() const { return !truncation_.empty(); }
  bool has_first_hits() const { return !first_hits_.empty(); }
  bool has_ray_counts() const { return !ray_counts_.empty(); }

  /// Writes the pixels of the tile at (x0, y0) that lie in the film's window; `weight` is what a pixel's samples weigh
  /// together.
  void resolve(int x0, int y0, double weight, Film& film) const;

 private:
  struct ColorSum {
    double r = 0, g = 0, b = 0;
    void add(double weight, const Rgb& c) { r += weight * c.r, g += weight * c.g, b += weight * c.b; }
  };
  struct FirstHitSum {
    double weight = 0, depth = 0, normal[3] = {0, 0, 0}, albedo[3] = {0, 0, 0};
    std::uint32_t object = 0, material = 0;
  };

  std::vector<ColorSum> color_, truncation_;
  std::vector<FirstHitSum> first_hits_;
  std::vector<std::uint32_t> ray_counts_;
};

}  // namespace raytree
