// The rare cases of number scanning, and the division of a text into chunks.
#include "geometry/text_scanning.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace raytree::text {
namespace {

// Whether a decimal number that no double holds is too large rather than too small. [begin, end) is its text without
// the sign: the place of its first digit that is not zero, with the exponent added, tells.
bool too_large(const char* begin, const char* end) {
  std::int64_t place = 0;  // of the decimal point, in digits after the first significant one
  bool significant = false, fraction = false;
  const char* p = begin;
  for (; p != end && (is_digit(*p) || *p == '.'); ++p) {
    if (*p == '.') {
      fraction = true;
      continue;
    }
    significant = significant || *p != '0';
    if (!fraction && significant) ++place;
    if (fraction && !significant) --place;
  }
  if (p == end) return place > 0;
  ++p;  // the letter e
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  std::int64_t exponent = 0;
  for (; p != end && is_digit(*p); ++p) exponent = std::min<std::int64_t>(exponent * 10 + (*p - '0'), INT64_MAX / 100);
  return place + (negative ? -exponent : exponent) > 0;
}

}  // namespace

const char* scan_double_slowly(const char* begin, const char* end, double& value) {
  const bool negative = begin != end && *begin == '-';
  const char* const unsigned_begin = begin != end && (*begin == '-' || *begin == '+') ? begin + 1 : begin;
  if (unsigned_begin != end && (*unsigned_begin == '-' || *unsigned_begin == '+')) return nullptr;
  double magnitude = 0;
  const auto [after, status] = std::from_chars(unsigned_begin, end, magnitude);
  if (status == std::errc::invalid_argument) return nullptr;
  if (status == std::errc::result_out_of_range)
    magnitude = too_large(unsigned_begin, after) ? std::numeric_limits<double>::infinity() : 0.0;
  const char* p = after;
  if (p != end && *p == '#') {
    // Older C runtimes write 1.#INF, 1.#IND, 1.#QNAN, some cut to the digits asked for: none is a finite number.
    const char* q = p + 1;
    while (q != end && ((*q >= 'A' && *q <= 'Z') || is_digit(*q))) ++q;
    if (q - p >= 3) {
      magnitude = std::numeric_limits<double>::quiet_NaN();
      p = q;
    }
  }
  value = negative ? -magnitude : magnitude;
  return p;
}

std::vector<const char*> chunk_borders(std::string_view text, char newline) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  std::vector<const char*> borders{begin};
  const char* p = begin;
  while (static_cast<std::size_t>(end - p) > kChunkBytes) {
    p += kChunkBytes;
    for (;;) {
      p = static_cast<const char*>(std::memchr(p, newline, static_cast<std::size_t>(end - p)));
      if (!p) break;
      const char* last = p - 1;
      while (last > borders.back() && *last == '\r') --last;
      ++p;
      if (*last != '\\') break;
    }
    if (!p || p == end) break;
    borders.push_back(p);
  }
  borders.push_back(end);
  return borders;
}

std::int64_t line_number(std::string_view text, const char* place, char newline) {
  return 1 + std::count(text.data(), place, newline);
}

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > 40 ? "...'" : "'");
}

std::string_view word_at(const char* begin, const char* end) {
  const char* p = begin;
  while (p != end && !is_space(*p)) ++p;
  return {begin, static_cast<std::size_t>(p - begin)};
}

}  // namespace raytree::text
