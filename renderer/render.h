// From a prepared scene to a film: tiles over threads, and what it cost. The whole pipeline on one screen stands in
// render.cpp.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "renderer/film.h"
#include "renderer/scene.h"

namespace raytree {

inline constexpr int kTileSize = 32;  ///< pixels; tiles lie on a lattice anchored at the frame's origin

enum class RayKind : std::uint8_t { primary, shadow, reflected, refracted };
inline constexpr int kRayKindCount = 4;

struct RenderStatistics {
  std::array<std::uint64_t, kRayKindCount> rays{};  ///< traced, by RayKind
  std::uint64_t samples = 0;                        ///< of the eye
  std::uint64_t eye_hits = 0;                       ///< of `samples`: that see something
  std::uint64_t rays_through_backs = 0;             ///< of the refracted ones: eye, reflected and refracted rays that
                                                    ///< go on behind the back of a one-sided surface
  std::uint64_t branches_cut = 0;                   ///< by the cutoff's allowance
  std::uint64_t branches_at_depth_limit = 0;        ///< not spawned since the tree was at its depth
  std::uint64_t not_finite_samples = 0;             ///< counted as 0
  int deepest_level = 0;
  double wall_seconds = 0;          ///< of the tracing phase
  double thread_seconds = 0;        ///< summed over threads
  double intersection_seconds = 0;  ///< of thread_seconds: inside the intersector
  double shading_seconds = 0;       ///< of thread_seconds: surfaces, materials, lights, spawning
  int threads = 0;

  std::uint64_t total_rays() const;
  double overhead_seconds() const { return thread_seconds - intersection_seconds - shading_seconds; }
};

/// Called from worker threads (one at a time) after each tile.
struct RenderProgress {
  std::uint64_t tiles_done = 0, tiles_total = 0;
  std::uint64_t rays = 0;
};

struct RenderOptions {
  PixelWindow window;  ///< of the frame; empty: the whole frame
  /// [frame height][frame width] 0 for pixels that are left out and stay 0; empty: none is. With a grid's samples only:
  /// Whitted's corners belong to several pixels. Packets are filled otherwise, so others may change in their last bits.
  std::span<const std::uint8_t> pixels;
  ChannelSet channels{ChannelGroup::color};
  int threads = 0;                    ///< 0: all of the arena
  std::uint64_t tile_order_seed = 0;  ///< 0: row by row; else shuffled: pixels must not depend on it
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const RenderProgress&)> on_progress;
};

struct RenderResult {
  Film film;
  RenderStatistics statistics;
  bool complete = true;  ///< false: stopped; tiles not traced are 0
};

/// Renders the scene's image. Throws Error (bad_input) for a window that does not lie in the frame and for `pixels`
/// that do not fit; does not throw once tracing has begun.
RenderResult render(const Scene& scene, const RenderOptions& options);

}  // namespace raytree
