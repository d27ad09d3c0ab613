// Whitted's tree of rays, a tile at a time: generations of rays are intersected, shaded and spawned in batches; weights
// multiply down the tree, so light is added straight to the sample and nothing recurses.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/film.h"
#include "renderer/render.h"
#include "renderer/scene.h"

namespace raytree {

/// Rays in flight at once. A queue pops so many of its newest rays and pushes at most twice as many, so it never holds
/// more than kBatchSize times the tree's depth.
inline constexpr std::size_t kBatchSize = 1024;

/// Traces tiles of one scene on one thread. What a tile yields depends on the scene, the settings and the tile's place
/// alone.
class TileTracer {
 public:
  /// `film` and `options` must outlive the tracer; several tracers write disjoint tiles of one film.
  TileTracer(const Scene& scene, const RenderOptions& options, Film& film);
  ~TileTracer();
  TileTracer(TileTracer&&) noexcept;

  /// Traces the tile whose upper left pixel is (x0, y0) and writes what lies in the film's window. False: stopped on
  /// the way.
  bool trace(int x0, int y0);

  const RenderStatistics& statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace raytree
