// Numbers and indices of OBJ statements, with what is wrong in words. In the header because they take much of the time
// of reading.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "geometry/text_scanning.h"

namespace raytree {

/// Reads `count` numbers; returns the place after them, nullptr with `error` set otherwise.
inline const char* scan_obj_numbers(const char* p, const char* end, double* values, int count, int required,
                                    std::string& error) {
  for (int i = 0; i < count; ++i) {
    p = text::skip_blanks(p, end);
    if (p == end || *p == '#') {
      if (i >= required) return p;
      error = "expected " + std::to_string(required) + " numbers, found " + std::to_string(i);
      return nullptr;
    }
    const char* const after = text::scan_double(p, end, values[i]);
    if (!after || (after != end && !text::is_blank(*after) && *after != '#')) {
      error = text::in_quotes(text::word_at(p, end)) + " is not a number";
      return nullptr;
    }
    p = after;
  }
  return p;
}

/// Reads one index and checks it; `seen` of `total` elements stand before this line.
inline const char* scan_obj_index(const char* p, const char* end, std::size_t seen, std::size_t total, const char* what,
                                  std::uint32_t& index, std::string& error) {
  std::int64_t value = 0;
  const char* const after = text::scan_integer(p, end, value);
  if (!after) {
    error = text::in_quotes(text::word_at(p, end)) +
            " is not a corner of a face (vertex, vertex/texture, vertex//normal or "
            "vertex/texture/normal)";
    return nullptr;
  }
  const std::int64_t zero_based = value > 0 ? value - 1 : static_cast<std::int64_t>(seen) + value;
  if (value == 0 || zero_based < 0 || zero_based >= static_cast<std::int64_t>(total)) {
    error = std::string("the face refers to ") + what + " " + std::to_string(value) + "; " +
            (value == 0 ? std::string("indices begin at 1")
                        : "there are " + std::to_string(value < 0 ? seen : total) +
                              (value < 0 ? " before this line" : " in the file"));
    return nullptr;
  }
  index = static_cast<std::uint32_t>(zero_based);
  return after;
}

}  // namespace raytree
