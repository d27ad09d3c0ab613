// Runs the built program as a shell would: its own process, both streams caught, signals sent on request.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace raytree::test {

struct ProgramResult {
  int status = -1;  ///< exit status; 128 + signal for a process that a signal ended
  std::string out, err;
  double seconds = 0;  ///< from launch to end
  double seconds_after_signal = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< resident; not less than what this process had when it launched the other
};

struct ProgramOptions {
  int signal = 0;           ///< sent once `signal_after` has passed; 0: none. What this process ignores is heard
  double signal_after = 0;  ///< seconds
  std::string signal_on;    ///< sent once standard error holds this instead; empty: by the clock
  bool close_stdout = false;
  int terminal_columns = 0;              ///< not 0: standard error is a terminal of this width
  std::string input_folder;              ///< working folder; empty: this process's
  std::vector<std::string> environment;  ///< NAME=VALUE, added
};

/// Runs `raytree` with these arguments to its end.
ProgramResult run_program(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// `words` and then `more`.
std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more);

/// Expects bad input: status 2, nothing on standard output, one error line that holds every part.
void expect_bad_input(const std::vector<std::string>& arguments, const std::vector<std::string>& parts);

void write_text(const std::string& path, const std::string& text);

}  // namespace raytree::test
