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
  struct ColorSum {
    double r = 0, g = 0, b = 0;
    void add(double weight, const Rgb& c) { r += weight * c.r, g += weight * c.g, b += weight * c.b; }
  };

  /// Of what `channels` need.
  explicit TileSums(const ChannelSet& channels);

  void clear();

  /// Adds sample i of `results`. A radiance that is not finite counts as 0; false tells of it.
  bool add(int pixel, const SampleResults& results, std::size_t i) {
    const bool finite = is_finite(results.radiance[i]);
    if (finite) color_[pixel].add(1, results.radiance[i]);
    if (!truncation_.empty()) add_truncation(pixel, 1, results.truncation[i]);
    if (!ray_counts_.empty()) add_rays(pixel, results.ray_counts[i]);
    return finite;
  }
  void add_color(int pixel, const ColorSum& sum) {
    color_[pixel].r += sum.r, color_[pixel].g += sum.g, color_[pixel].b += sum.b;
  }
  void add_truncation(int pixel, double weight, const Rgb& bound) { truncation_[pixel].add(weight, bound); }
  void add_rays(int pixel, std::uint32_t count) { ray_counts_[pixel] += count; }
  /// `hit` must have hit something.
  void add_first_hit(int pixel, double weight, const FirstHit& hit) {
    covered_[pixel] += weight;
    if (!surfaces_.empty()) surfaces_[pixel].add(weight, hit);
  }
  /// The ids of the pixel.
  void set_ids(int pixel, std::uint32_t object, std::uint32_t material) { ids_[pixel] = {object, material}; }

  bool has_truncation() const { return !truncation_.empty(); }
  bool has_first_hits() const { return !covered_.empty(); }
  bool has_ids() const { return !ids_.empty(); }
  bool has_ray_counts() const { return !ray_counts_.empty(); }

  /// Writes the pixels of the tile at (x0, y0) that lie in the film's window; `weight` is what a pixel's samples weigh
  /// together.
  void resolve(int x0, int y0, double weight, Film& film) const;

 private:
  /// Of what was hit.
  struct SurfaceSum {
    double depth = 0, normal[3] = {0, 0, 0}, albedo[3] = {0, 0, 0};
    void add(double weight, const FirstHit& hit);
  };
  struct Ids {
    std::uint32_t object = 0, material = 0;
  };

  std::vector<ColorSum> color_, truncation_;
  std::vector<double> covered_;  ///< weight of the samples that hit something
  std::vector<SurfaceSum> surfaces_;
  std::vector<Ids> ids_;
  std::vector<std::uint32_t> ray_counts_;
};

}  // namespace raytree
