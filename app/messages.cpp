#include "app/messages.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace raytree::app {

void print_result(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Error(ErrorKind::failure, {"standard output", 0, ""}, std::strerror(errno));
}

void print_message(const std::string& line) {
  // In one call, so that lines of several processes on one terminal do not mix.
  const std::string whole = line + "\n";
  std::fwrite(whole.data(), 1, whole.size(), stderr);
  std::fflush(stderr);
}

void print_error(const std::string& message) { print_message("raytree: error: " + message); }

void print_warnings(const Warnings& warnings, bool all) {
  constexpr std::size_t kShown = 12;
  const std::size_t shown = all ? warnings.size() : std::min(kShown, warnings.size());
  for (std::size_t i = 0; i < shown; ++i) {
    std::string line = "warning: " + located_message(warnings[i].where, warnings[i].message);
    if (warnings[i].count > 0)
      line += fmt::format(" ({} in all)", grouped(static_cast<std::uint64_t>(warnings[i].count)));
    print_message(line);
  }
  if (shown < warnings.size())
    print_message(fmt::format("warning: {} more (--verbose shows all)", warnings.size() - shown));
}

std::string grouped(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
    digits.insert(static_cast<std::size_t>(i), ",");
  return digits;
}

std::string readable_bytes(std::uint64_t bytes) {
  const char* const units[] = {"KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  double value = static_cast<double>(bytes) / 1024;
  int unit = 0;
  while (value >= 1024 && unit < 3) value /= 1024, ++unit;
  return fmt::format("{:.1f} {}", value, units[unit]);
}

std::string readable_seconds(double seconds) {
  if (!(seconds < 59.95)) {
    if (!std::isfinite(seconds) || seconds > 1e9) return "?";
    const auto whole = static_cast<std::int64_t>(seconds + 0.5);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
  }
  if (seconds < 0.0995) return fmt::format("{:.1f} ms", seconds * 1e3);
  return fmt::format("{:.2f} s", seconds);
}

}  // namespace raytree::app
