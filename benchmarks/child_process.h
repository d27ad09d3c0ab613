// Runs a program and says how long it took and how much memory it had.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raytree::benchmarks {

struct ChildResult {
  int status = 0;                ///< exit status; 128 + the signal's number where one ended it
  double start_clock = 0;        ///< steady clock just before the launch, seconds
  double wall_seconds = 0;       ///< from launch to its end
  std::uint64_t peak_bytes = 0;  ///< largest resident memory
  std::string output;            ///< what it wrote to stdout
  std::string errors;            ///< what it wrote to stderr
};

/// Runs words[0] with the arguments that follow, stdin closed to /dev/null. `scratch` holds what it writes until it has
/// been read. Throws Error (failure) when it cannot be started.
///
/// A process that is launched from a large one counts as large itself (Linux adds the launcher's resident memory to
/// the child's high-water mark), so peak_bytes is right only where the caller's own memory is less.
ChildResult run_child(const std::vector<std::string>& words, const std::filesystem::path& scratch);

/// The same by way of a small process, `launcher` with the argument kLaunchFlag, so that peak_bytes is right.
ChildResult run_child_apart(const std::string& launcher, const std::vector<std::string>& words,
                            const std::filesystem::path& scratch);
inline constexpr const char* kLaunchFlag = "--launch-apart";

/// What the program does when its first word is kLaunchFlag: runs the words after the scratch folder that comes first,
/// and returns the text that run_child_apart() reads.
std::string launch_apart(const std::vector<std::string>& words);

/// Throws Error (failure) with the end of its messages unless its status is 0.
void require_success(const ChildResult& result, const std::string& what);

}  // namespace raytree::benchmarks
