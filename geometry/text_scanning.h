// Numbers and lines of mesh text: scanners for doubles and integers that depend on no locale, and the division of a
// text into chunks at line ends for parallel parsing. What the lines mean is the readers' business.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace raytree::text {

/// Blank within a line: space, tab, carriage return, vertical tab, form feed.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
inline bool is_space(char c) { return is_blank(c) || c == '\n'; }
inline bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

inline const char* skip_blanks(const char* p, const char* end) {
  while (p != end && is_blank(*p)) ++p;
  return p;
}
inline const char* skip_spaces(const char* p, const char* end) {
  while (p != end && is_space(*p)) ++p;
  return p;
}

/// The cases that scan_double leaves out: many digits, large exponents, inf, nan, "1.#QNAN".
const char* scan_double_slowly(const char* begin, const char* end, double& value);

/// Powers of ten that a double holds exactly.
inline constexpr double kExactPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Reads a decimal number at `begin` (no blanks before it) and returns where it ends, or nullptr if there is none.
/// Correctly rounded. Out of range: infinity or zero, with the sign. Accepts a leading plus, "inf" and "nan" in any
/// case.
inline const char* scan_double(const char* begin, const char* end, double& value) {
  const char* p = begin;
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  std::uint64_t mantissa = 0;
  const char* const whole = p;
  for (; p != end && is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
  std::ptrdiff_t digits = p - whole;
  std::ptrdiff_t exponent = 0;
  if (p != end && *p == '.') {
    const char* const fraction = ++p;
    for (; p != end && is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<unsigned>(*p - '0');
    exponent = fraction - p;
    digits += p - fraction;
  }
  if (digits == 0 || digits > 19 || (p != end && *p == '#')) return scan_double_slowly(begin, end, value);
  if (p != end && (*p == 'e' || *p == 'E')) {
    const char* q = p + 1;
    const bool negative_exponent = q != end && *q == '-';
    if (q != end && (*q == '-' || *q == '+')) ++q;
    const char* const exponent_digits = q;
    std::ptrdiff_t written = 0;
    for (; q != end && is_digit(*q) && q - exponent_digits < 5; ++q) written = written * 10 + (*q - '0');
    if (q == exponent_digits || (q != end && is_digit(*q))) return scan_double_slowly(begin, end, value);
    exponent += negative_exponent ? -written : written;
    p = q;
  }
  // Clinger's exact case: both operands are exact in double, so the one operation rounds correctly.
  if (mantissa > (std::uint64_t(1) << 53) || exponent < -22 || exponent > 22)
    return scan_double_slowly(begin, end, value);
  const double magnitude = exponent < 0 ? static_cast<double>(mantissa) / kExactPowersOfTen[-exponent]
                                        : static_cast<double>(mantissa) * kExactPowersOfTen[exponent];
  value = negative ? -magnitude : magnitude;
  return p;
}

/// Reads a decimal integer with optional sign at `begin`; nullptr if there is none or it has more than 18 digits.
inline const char* scan_integer(const char* begin, const char* end, std::int64_t& value) {
  const char* p = begin;
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  const char* const digits = p;
  std::int64_t magnitude = 0;
  for (; p != end && is_digit(*p) && p - digits < 18; ++p) magnitude = magnitude * 10 + (*p - '0');
  if (p == digits || (p != end && is_digit(*p))) return nullptr;
  value = negative ? -magnitude : magnitude;
  return p;
}

inline constexpr std::size_t kChunkBytes = std::size_t(1) << 18;  ///< of text that one task parses

/// Borders of chunks of about kChunkBytes: the first is the text's begin, the last its end, each between begins a line.
/// A line end after a backslash is no border, so that a continued line stays in one chunk.
std::vector<const char*> chunk_borders(std::string_view text, char newline);

/// One-based line of a place in the text.
std::int64_t line_number(std::string_view text, const char* place, char newline);

/// The text between quotes for a message: at most 40 characters, what cannot be printed as '?'.
std::string in_quotes(std::string_view text);

/// The word that starts at `begin`: up to the next space.
std::string_view word_at(const char* begin, const char* end);

}  // namespace raytree::text
