// What ran where: version, compiler, processor, memory of this process, clock since launch.
#pragma once

#include <cstdint>
#include <string>

namespace raytree::app {

struct Machine {
  std::string processor;     ///< model name; "unknown" where the system does not tell
  int hardware_threads = 0;  ///< that this process may use
  std::string compiler;
  std::string build_type;
};
Machine machine();

/// "0.1.0".
std::string version();
/// "raytree 0.1.0 (g++ 12.2.0, Release)".
std::string version_text();

/// Largest memory that this process has had so far, bytes.
std::uint64_t peak_memory_bytes();

/// Seconds since the program's own code began to run.
double seconds_since_launch();

}  // namespace raytree::app
