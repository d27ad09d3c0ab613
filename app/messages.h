// What the program says: results to standard output, everything else to standard error.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/error.h"

namespace raytree::app {

/// Writes text to standard output and flushes it. Throws Error (failure) when it does not arrive (closed, disk full).
void print_result(const std::string& text);

/// One line on standard error.
void print_message(const std::string& line);

/// "raytree: error: ..." on standard error.
void print_error(const std::string& message);

/// "warning: file:line: object: ... (N in all)", one line each, the number where something is counted; without `all`,
/// the first few and how many more there are.
void print_warnings(const Warnings& warnings, bool all);

/// "1,234,567".
std::string grouped(std::uint64_t count);
/// "12.3 MiB".
std::string readable_bytes(std::uint64_t bytes);
/// "0.42 s", "3:07 min" or "2:03:07 h".
std::string readable_seconds(double seconds);

}  // namespace raytree::app
