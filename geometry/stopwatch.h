// Wall time, for what is measured and reported.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>

namespace raytree {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds since it was made.
class WallTime {
 public:
  double seconds() const { return seconds_since(start_); }

 private:
  Clock::time_point start_ = Clock::now();
};

/// Seconds that the calling thread ran since it was made, for code of microseconds on a machine that does other things
/// too: where it had to wait for a core, its processor time counts; else the wall's, which takes less to look at.
class RunningTime {
 public:
  double seconds() const {
    const double wall = wall_.seconds();
    return std::min(wall, processor_seconds() - processor_start_);
  }

 private:
  static double processor_seconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double processor_start_ = processor_seconds();
  WallTime wall_;  ///< last: it begins when the other clock has been read
};

}  // namespace raytree
