#include "benchmarks/chart/chart_render.h"

#include <time.h>

#include <chrono>
#include <numeric>
#include <utility>

#include "benchmarks/chart/error_metrics.h"
#include "benchmarks/resident_memory.h"
#include "geometry/stopwatch.h"

namespace raytree::benchmarks {
namespace {

/// Processor time of all threads of the process.
double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

TimeLimit::TimeLimit(const std::atomic<bool>* outer, double seconds)
    : thread_([this, outer, seconds, start = Clock::now()] {
        constexpr std::chrono::milliseconds kPause(5);
        while (!finished_ && !stop_) {
          if ((outer != nullptr && *outer) || seconds_since(start) >= seconds) stop_ = true;
          std::this_thread::sleep_for(kPause);
        }
      }) {}

TimeLimit::~TimeLimit() {
  finished_ = true;
  thread_.join();
}

std::uint64_t ChartRender::total_rays() const { return std::accumulate(rays.begin(), rays.end(), std::uint64_t{0}); }

ChartRender render_timed(ChartScene scene, int threads, const std::atomic<bool>* stop, Warnings& warnings,
                         std::span<const std::uint8_t> pixels) {
  ChartRender result;
  scene.prepare.threads = threads;
  scene.prepare.stop = stop;
  RenderOptions options;
  options.channels = kChartChannels;
  options.threads = threads;
  options.stop = stop;
  options.pixels = pixels;
  const PeakMemory memory;
  const double cpu_start = process_seconds();
  const Clock::time_point start = Clock::now();
  try {
    const Scene prepared = prepare(std::move(scene.description), scene.prepare, warnings);
    RenderResult rendered = render(prepared, options);
    result.wall_seconds = seconds_since(start);
    result.cpu_seconds = process_seconds() - cpu_start;
    result.peak_bytes = memory.bytes();
    result.complete = rendered.complete;
    result.build_seconds = prepared.seconds.build;
    result.rays = rendered.statistics.rays;
    result.samples = rendered.statistics.samples;
    result.branches_at_depth_limit = rendered.statistics.branches_at_depth_limit;
    result.film_bytes = rendered.film.memory_bytes();
    result.array_bytes = prepared.summary.array_bytes;
    result.tracer_bytes = prepared.summary.intersector_bytes;
    result.film = std::move(rendered.film);
  } catch (const Error&) {
    // Preparing says that it was stopped by an error of its own.
    if (stop == nullptr || !*stop) throw;
  }
  return result;
}

}  // namespace raytree::benchmarks
