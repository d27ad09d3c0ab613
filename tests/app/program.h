// Runs the built program as a shell would: its own process, both streams caught, signals sent on request.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raytree::test {

struct ProgramResult {
  int status = -1;  ///< exit status; 128 + signal for a process that a signal ended
  std::string out, err;
  double seconds = 0;  ///< from launch to end
  double seconds_after_signal = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< resident; not less than what this process had when it launched the other
};

struct ProgramOptions {
  int signal = 0;           ///< sent once `signal_after` has passed; 0: none
  double signal_after = 0;  ///< seconds
  bool close_stdout = false;
  int terminal_columns = 0;              ///< not 0: standard error is a terminal of this width
  std::string input_folder;              ///< working folder; empty: this process's
  std::vector<std::string> environment;  ///< NAME=VALUE, added
};

/// Runs `raytree` with these arguments to its end.
ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// A folder of its own, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Names of the files in it, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path folder_;
};

std::string file_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

}  // namespace raytree::test
