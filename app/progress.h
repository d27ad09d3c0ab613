// The progress of a render on standard error: a bar on a terminal, a line per 5 % elsewhere, or nothing.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "geometry/stopwatch.h"
#include "renderer/render.h"

namespace raytree::app {

enum class ProgressMode { automatic, bar, plain, none };

class Progress {
 public:
  /// `automatic` is a bar when standard error is a terminal that can redraw a line, else plain.
  explicit Progress(ProgressMode mode);
  /// Ends the line of a bar that is still drawn.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Says what is going on before and after the tracing ("reading dragon.ply"); drawn by the bar alone.
  void phase(const std::string& text);
  /// The tracing begins: speed and time left count from here.
  void begin_tracing();
  /// After a tile; drawn at most ten times a second (bar) or each 5 % (plain). Thread-safe.
  void update(const RenderProgress& done);
  /// Takes the bar off the terminal, so that messages can be written.
  void clear();
  /// For the thread that ends the process while others may still draw: moves on to a fresh line, without waiting.
  void abandon() noexcept;

 private:
  void draw(const std::string& line);

  ProgressMode mode_;
  std::mutex mutex_;
  std::atomic<bool> drawn_{false};  ///< something of a bar stands on the terminal
  Clock::time_point begin_, last_drawn_;
  int last_step_ = 0;  ///< plain: twentieths already told
};

/// "42 %  12.3 Mrays/s  ETA 0.42 s" after `seconds` of tracing.
std::string progress_text(const RenderProgress& done, double seconds);

}  // namespace raytree::app
