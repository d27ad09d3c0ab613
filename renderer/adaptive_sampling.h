// Anti-aliasing as Whitted has it (1980, sec. 3): a pixel is the square between four corner samples, shared with its
// neighbours; where they differ it is divided in four, again and again, and its value is the mean by area. Objects that
// fall between samples are looked for by their outlines. Owns which samples are taken and what they weigh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/ray_tree.h"
#include "renderer/sample_lattice.h"
#include "renderer/scene.h"
#include "renderer/tile_sums.h"

namespace raytree {

/// A radiance on the scale that differences are judged on: display-like, 0 to 1 for what a display shows, not clipped
/// above. The square root stands for a display's curve; kDisplayToe gives it sRGB's slope at black (12.9).
inline constexpr float kDisplayToe = 0.0015f;
Rgb display_like(const Rgb& radiance);

/// Corners on different objects, or whose normals part by more than acos(kNormalCosine), differ at least so much.
inline constexpr float kFormContrast = 0.2f;
inline constexpr float kNormalCosine = 0.9f;

/// Samples tiles adaptively, level by level: all new samples of a level are traced together. What a tile becomes
/// depends on scene, settings and the tile's place alone; so corners on its border are traced by both tiles that share
/// them.
class AdaptiveSampler {
 public:
  explicit AdaptiveSampler(const Scene& scene);

  /// Traces the tile at (x0, y0) and adds its pixels to `sums`, weights of a pixel adding up to 1. `tracer` must record
  /// first hits. False: stopped.
  bool trace(int x0, int y0, SampleTracer& tracer, TileSums& sums);

 private:
  /// A square of a pixel. Lattice units: 2^-levels pixels from the tile's corner.
  struct Square {
    std::array<std::uint32_t, 4> corners;  ///< samples: upper left, upper right, lower left, lower right
    std::uint16_t x, y;                    ///< upper left corner, lattice units
    std::uint16_t level;
    std::uint32_t near_begin, near_end;  ///< of near_: small objects that ask to divide it
  };
  /// A small object too narrow for the last level, in one of its pixels.
  struct TinyPart {
    std::uint32_t pixel;
    std::uint32_t id;   ///< as in FirstHit::object
    double area;        ///< of it in the pixel, pixels; 0 once it is known to be hidden
    double seen;        ///< weight of the samples that see it
    std::uint32_t ray;  ///< the sample at its centroid, where none sees it
  };

  void begin_tile(int x0, int y0);
  void add_pixels();
  void list_small_objects();
  bool divide_level(SampleTracer& tracer);
  bool wants_division(const Square& square) const;
  bool differs_on_a_side(const Square& square) const;
  float contrast(std::span<const std::uint32_t> samples) const;
  bool is_too_much(float contrast, int level) const;
  void divide(const Square& square);
  std::uint32_t sample_at(int x, int y, int pixel);
  std::uint32_t add_sample(const Vec2f& position, int pixel);
  bool trace_new_samples(SampleTracer& tracer, double spacing);
  void sort_leaves();
  bool find_tiny_objects(SampleTracer& tracer);
  void resolve(TileSums& sums);
  void resolve_pixel(int pixel, std::span<const TinyPart> tiny, TileSums& sums);
  std::span<const Square> leaves_of(int pixel) const {
    return {leaves_.data() + leaf_begin_[pixel], leaves_.data() + leaf_begin_[pixel + 1]};
  }
  static double edge(int level) { return kEdges[static_cast<std::size_t>(level)]; }
  /// What each of a leaf's corners weighs in its pixel.
  static double corner_weight(const Square& leaf) { return edge(leaf.level) * edge(leaf.level) / 4; }
  int pixel_of(const Square& square) const { return (square.y >> levels_) * kTileSize + (square.x >> levels_); }

  /// Of a square of a level, pixels: 2^-level.
  static constexpr std::array<double, 16> kEdges = [] {
    std::array<double, 16> edges{};
    for (std::size_t level = 0; level < edges.size(); ++level) edges[level] = 1.0 / static_cast<double>(1 << level);
    return edges;
  }();

  const Scene& scene_;
  const int levels_, minimum_level_;
  const float threshold_;

  // The tile under way.
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;  ///< pixels
  std::vector<Square> squares_, divided_;         ///< of the level under way, of the next one
  std::vector<Square> again_;                     ///< that neighbours' samples divide
  std::vector<Square> leaves_;                    ///< squares that are not divided; in the end pixel after pixel
  std::vector<std::uint32_t> leaf_begin_;         ///< [kTilePixels + 1]
  std::vector<std::uint32_t> near_;               ///< of SmallObjects
  std::vector<std::uint32_t> pixel_near_;         ///< [kTilePixels + 1] the same of each pixel, at the start of near_

  // Its samples, in the order that they were asked for.
  std::vector<Vec2f> positions_;
  std::vector<std::uint16_t> home_;  ///< the pixel that a sample's rays are counted for
  std::vector<Rgb> radiance_;        ///< 0 where it was not finite
  std::vector<Rgb> shown_;           ///< display_like()
  std::vector<Rgb> truncation_;
  std::vector<FirstHit> hits_;
  std::vector<std::uint32_t> ray_counts_;

  SampleLattice level_samples_;  ///< made in the level under way

  std::vector<TinyPart> tiny_;  ///< by pixel

  /// What the samples of the pixel under way see, by weight.
  struct Vote {
    std::uint32_t object, material;
    double weight;
  };
  std::vector<Vote> votes_;
};

}  // namespace raytree
