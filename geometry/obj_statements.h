// The statements of an OBJ file: lines, those that a backslash continues joined, and what their first word says they
// are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "geometry/text_scanning.h"

namespace raytree {

enum class ObjStatement : std::uint8_t {
  none,  // blank or comment
  position,
  normal,
  texture_coordinates,
  face,
  group,
  material,
  silent,  // concerns other programs or the next reader: smoothing groups and display hints
  library,
  subdivision_tag,
  line_or_point,
  free_form,
  unknown
};

/// The statement's kind by its first word; `p` moves behind that word.
inline ObjStatement classify_obj_statement(const char*& p, const char* end) {
  p = text::skip_blanks(p, end);
  if (p == end || *p == '#') return ObjStatement::none;
  // The words that fill files, before any comparison of strings.
  const auto word_has = [&](std::ptrdiff_t letters) {
    return end - p == letters || (end - p > letters && (text::is_blank(p[letters]) || p[letters] == '#'));
  };
  if (*p == 'f' && word_has(1)) return p += 1, ObjStatement::face;
  if (*p == 'v') {
    if (word_has(1)) return p += 1, ObjStatement::position;
    if (word_has(2) && p[1] == 'n') return p += 2, ObjStatement::normal;
    if (word_has(2) && p[1] == 't') return p += 2, ObjStatement::texture_coordinates;
  }
  const char* word_end = p;
  while (word_end != end && !text::is_space(*word_end) && *word_end != '#') ++word_end;
  const std::string_view word(p, static_cast<std::size_t>(word_end - p));
  p = word_end;
  if (word == "g" || word == "o") return ObjStatement::group;
  if (word == "usemtl") return ObjStatement::material;
  if (word == "mtllib") return ObjStatement::library;
  if (word == "t") return ObjStatement::subdivision_tag;
  if (word == "l" || word == "p") return ObjStatement::line_or_point;
  for (const std::string_view other : {"s", "mg", "bevel", "c_interp", "d_interp", "lod", "usemap", "maplib",
                                       "shadow_obj", "trace_obj", "ctech", "stech", "call", "csh"})
    if (word == other) return ObjStatement::silent;
  for (const std::string_view other : {"vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",
                                       "hole", "scrv",   "sp",  "end",  "con",  "bzp",  "bsp",   "cdc",  "cdp",  "res"})
    if (word == other) return ObjStatement::free_form;
  return ObjStatement::unknown;
}

/// Calls statement(kind, begin, end, source) for each logical line; [begin, end) follows the first word, `source` is
/// the place in the text for messages. Continued lines are joined in a scratch string. Stops when it returns false.
template <class Function>
void for_each_obj_statement(const char* p, const char* const end, char newline, Function&& statement) {
  std::string joined;
  while (p != end) {
    const char* line_end = static_cast<const char*>(std::memchr(p, newline, static_cast<std::size_t>(end - p)));
    const char* next = line_end ? line_end + 1 : end;
    if (!line_end) line_end = end;
    const char* begin = p;
    const char* const source = p;
    const auto continued = [](const char* from, const char* to) {
      while (to > from && to[-1] == '\r') --to;
      return to > from && to[-1] == '\\';
    };
    if (continued(p, line_end) && *text::skip_blanks(p, line_end) != '#') {
      joined.clear();
      for (;;) {
        const char* to = line_end;
        const bool more = continued(p, to);
        if (more) {
          while (to[-1] == '\r') --to;
          --to;
        }
        joined.append(p, to);
        joined += ' ';
        p = next;
        if (!more || p == end) break;
        line_end = static_cast<const char*>(std::memchr(p, newline, static_cast<std::size_t>(end - p)));
        next = line_end ? line_end + 1 : end;
        if (!line_end) line_end = end;
      }
      begin = joined.data();
      line_end = joined.data() + joined.size();
    }
    const ObjStatement kind = classify_obj_statement(begin, line_end);
    if (kind != ObjStatement::none && !statement(kind, begin, line_end, source)) return;
    p = next;
  }
}

}  // namespace raytree
