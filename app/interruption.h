// Ctrl-C and kill: the signals are taken by a thread of their own, which asks the work to stop and, when it does not
// within the grace time, removes what is unfinished and ends the process.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace raytree::app {

/// Seconds that the work has to stop by itself after a signal; the promise to the user is one second in all.
inline constexpr double kGraceSeconds = 0.7;

class Interruption {
 public:
  /// Blocks SIGINT, SIGTERM and SIGHUP (unless that is ignored, as under nohup) for this thread and all that it starts
  /// from now on, so it must come before any other thread exists, and begins to listen. `before_exit` runs in the
  /// listening thread when the process is ended from there: it must not wait.
  explicit Interruption(std::function<void()> before_exit);
  /// Stops listening.
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// True once a signal has come: what prepare() and render() watch.
  const std::atomic<bool>& stop() const { return stop_; }
  /// The signal that came; 0: none.
  int signal() const { return signal_; }

 private:
  void listen();

  std::function<void()> before_exit_;
  std::atomic<bool> stop_{false};
  std::atomic<int> signal_{0};
  std::atomic<bool> finished_{false};
  std::thread thread_;  ///< last: it uses the members above
};

}  // namespace raytree::app
