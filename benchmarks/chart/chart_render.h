// One render of a chart: prepared and traced under a clock, with what it took.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <thread>

#include "benchmarks/chart/chart_settings.h"
#include "renderer/render.h"

namespace raytree::benchmarks {

/// A stop that comes when another one does, or when the time is up.
class TimeLimit {
 public:
  /// outer: may be null. seconds: from now.
  TimeLimit(const std::atomic<bool>* outer, double seconds);
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  const std::atomic<bool>& stop() const { return stop_; }

 private:
  std::atomic<bool> stop_{false}, finished_{false};
  std::thread thread_;  ///< last: it uses the members above
};

struct ChartRender {
  bool complete = false;                     ///< false: stopped; what follows then means nothing
  double cpu_seconds = 0, wall_seconds = 0;  ///< of preparing and tracing together, all threads
  double build_seconds = 0;                  ///< of these: the intersector's build, wall
  std::array<std::uint64_t, kRayKindCount> rays{};
  std::uint64_t samples = 0, branches_at_depth_limit = 0;
  /// Most resident memory while preparing and tracing, above the process without the render. None: not known here.
  std::optional<std::uint64_t> peak_bytes;
  std::uint64_t film_bytes = 0, array_bytes = 0, tracer_bytes = 0;  ///< by their sizes, what is left when all is ready
  Film film{0, 0, {}, {}};

  std::uint64_t total_rays() const;
};

/// Prepares and renders once; `pixels` as in RenderOptions. Warnings of the scene go to `warnings`. A run that `stop`
/// ended is not complete.
ChartRender render_timed(ChartScene scene, int threads, const std::atomic<bool>* stop, Warnings& warnings,
                         std::span<const std::uint8_t> pixels = {});

}  // namespace raytree::benchmarks
