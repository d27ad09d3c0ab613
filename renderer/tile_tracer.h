// From samples to pixels: which samples a tile takes, traced in batches, added up and written to the film.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "renderer/adaptive_sampling.h"
#include "renderer/film.h"
#include "renderer/ray_tree.h"
#include "renderer/render.h"
#include "renderer/scene.h"
#include "renderer/tile_sums.h"

namespace raytree {

/// Traces tiles of one scene on one thread. What a tile yields depends on the scene, the settings and the tile's place
/// alone.
class TileTracer {
 public:
  /// `film` and `options` must outlive the tracer; several tracers write disjoint tiles of one film.
  TileTracer(const Scene& scene, const RenderOptions& options, Film& film);

  /// Traces the tile whose upper left pixel is (x0, y0) and writes what lies in the film's window. False: stopped on
  /// the way.
  bool trace(int x0, int y0);

  const RenderStatistics& statistics() const { return samples_.statistics(); }

 private:
  bool trace_grid(int x0, int y0, int grid);
  /// Whether a pixel of the frame is to be traced.
  bool wants(int x, int y) const {
    return pixels_.empty() || pixels_[static_cast<std::size_t>(y) * scene_.description.image.width + x] != 0;
  }
  bool finish_chunk();

  const Scene& scene_;
  const std::span<const std::uint8_t> pixels_;  ///< as in RenderOptions
  Film& film_;
  SampleTracer samples_;
  TileSums sums_;
  std::optional<AdaptiveSampler> adaptive_;  ///< where the anti-aliasing is Whitted's

  // The chunk of a grid's samples under way.
  struct SamplePlace {
    std::uint16_t pixel;  ///< of the tile
    bool center;          ///< whether the sample stands for its pixel's ids
  };
  std::vector<Vec2f> positions_;
  std::vector<SamplePlace> places_;  ///< [positions_.size()]
  float spacing_ = 1;                ///< of the samples, pixels
  std::vector<int> pixel_of_;        ///< [column or row of samples in the tile] -> of pixels
};

}  // namespace raytree
