// What tests of readers share: a warning found by its words, refusals with their place, and copies of good text with
// bytes changed and ends cut off.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "geometry/error.h"

namespace raytree::test {

/// "LINE xCOUNT" of the first warning whose message holds `part`; "none".
inline std::string found_warning(const Warnings& warnings, const std::string& part) {
  for (const Warning& warning : warnings)
    if (warning.message.find(part) != std::string::npos)
      return std::to_string(warning.where.line) + " x" + std::to_string(warning.count);
  return "none";
}

/// Expects read() to throw an Error (bad_input) at `line` of `file` whose message holds `part`.
template <class Read>
void expect_refusal(const Read& read, const std::string& file, std::int64_t line, const std::string& part) {
  try {
    read();
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.where().file, file);
    EXPECT_EQ(error.where().line, line);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

/// Calls read(text) with `count` copies of `good` that have three bytes changed, every second one cut off somewhere. An
/// Error (bad_input) is an answer as good as any; nothing else may be thrown.
template <class Read>
void read_damaged_copies(const std::string& good, int count, const Read& read) {
  std::uint32_t state = 1980;
  for (int i = 0; i < count; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) {
      state = state * 1664525u + 1013904223u;
      text[(state >> 8) % text.size()] = static_cast<char>(state >> 24);
    }
    if (i % 2 != 0) text.resize((state >> 10) % text.size());
    try {
      read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  }
}

}  // namespace raytree::test
