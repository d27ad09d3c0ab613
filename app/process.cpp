#include "app/process.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>

#include "geometry/stopwatch.h"
#include "renderer/machine.h"

namespace raytree::app {
namespace {

const Clock::time_point kLaunch = Clock::now();

}  // namespace

std::string version() { return RAYTREE_VERSION; }

std::string version_text() {
  const Machine here = machine();
  return fmt::format("raytree {} ({}, {})", version(), here.compiler, here.build_type);
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

double seconds_since_launch() { return seconds_since(kLaunch); }

}  // namespace raytree::app
