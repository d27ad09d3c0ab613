#include "app/machine.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/info.h>

#include <chrono>
#include <fstream>

namespace raytree::app {
namespace {

using Clock = std::chrono::steady_clock;
const Clock::time_point kLaunch = Clock::now();

std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang++ {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown compiler";
#endif
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) {
      const std::size_t colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  return "unknown";
}

}  // namespace

Machine machine() { return {processor(), tbb::info::default_concurrency(), compiler(), RAYTREE_BUILD_TYPE}; }

std::string version() { return RAYTREE_VERSION; }

std::string version_text() { return fmt::format("raytree {} ({}, {})", version(), compiler(), RAYTREE_BUILD_TYPE); }

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

double seconds_since_launch() { return std::chrono::duration<double>(Clock::now() - kLaunch).count(); }

}  // namespace raytree::app
