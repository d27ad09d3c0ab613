// How much memory the process has, as the kernel counts it: resident pages and their high-water mark.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace raytree::benchmarks {

/// A figure of /proc/self/status, bytes: "VmRSS", "VmHWM". None where the system has no such file or figure.
std::optional<std::uint64_t> status_bytes(const std::string& key);

/// What a stretch of work has at most, above what the process held when it began. Memory that was freed before then is
/// given back to the system first, so that the stretch cannot live on it unseen.
///
/// One at a time: the kernel keeps one mark for the whole process, so what other threads take counts, too. Its counts
/// lag behind by some 64 pages a core; where nothing is measured below a quarter of a MiB, that is nothing.
class PeakMemory {
 public:
  /// Begins. A kernel or container that lets no process set its mark back (/proc/self/clear_refs, Linux 4.0) has none.
  PeakMemory();
  /// So far, bytes. None where there is no mark.
  std::optional<std::uint64_t> bytes() const;

 private:
  std::optional<std::uint64_t> floor_;
};

}  // namespace raytree::benchmarks
