#include "benchmarks/resident_memory.h"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace raytree::benchmarks {
namespace {

/// Sets the process's high-water mark back to what is resident now. False: not possible here.
bool reset_high_water_mark() {
  const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  constexpr char kHighWaterMark = '5';
  const bool written = write(file, &kHighWaterMark, 1) == 1;
  close(file);
  return written;
}

}  // namespace

std::optional<std::uint64_t> status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return 1024 * std::stoull(line.substr(key.size() + 1));
  return std::nullopt;
}

PeakMemory::PeakMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  if (reset_high_water_mark()) floor_ = status_bytes("VmRSS");
}

std::optional<std::uint64_t> PeakMemory::bytes() const {
  const std::optional<std::uint64_t> mark = status_bytes("VmHWM");
  if (!floor_ || !mark) return std::nullopt;
  return *mark > *floor_ ? *mark - *floor_ : 0;
}

}  // namespace raytree::benchmarks
