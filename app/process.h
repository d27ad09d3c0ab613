// This program and this run of it: version, memory, clock since launch.
#pragma once

#include <cstdint>
#include <string>

namespace raytree::app {

/// "0.1.0".
std::string version();
/// "raytree 0.1.0 (g++ 12.2.0, Release)".
std::string version_text();

/// Largest memory that this process has had so far, bytes.
std::uint64_t peak_memory_bytes();

/// Seconds since the program's own code began to run.
double seconds_since_launch();

}  // namespace raytree::app
