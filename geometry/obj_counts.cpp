#include "geometry/obj_counts.h"

#include <array>
#include <cstdint>

#include "geometry/obj_statements.h"
#include "geometry/text_scanning.h"

namespace raytree {
namespace {

/// What a character is in a face: the pass that counts looks at each once.
enum FaceCharacter : std::uint8_t { kOrdinary = 0, kBlank = 1, kSlash = 2, kComment = 4 };
constexpr auto kFaceCharacters = [] {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t c = 0; c < table.size(); ++c)
    table[c] = text::is_blank(static_cast<char>(c)) ? kBlank : c == '/' ? kSlash : c == '#' ? kComment : kOrdinary;
  return table;
}();

void count_face(const char* p, const char* end, ObjCounts& counts) {
  std::size_t corners = 0;
  unsigned before = kBlank, slashes = 0;
  bool texture = false, normal = false;
  for (; p != end; ++p) {
    const unsigned now = kFaceCharacters[static_cast<unsigned char>(*p)];
    if (now == kComment) break;
    if (before == kBlank) {
      corners += now != kBlank;
      slashes = 0;
    }
    // a/b names texture coordinates, a//c and a/b/c a normal.
    const bool first_behind_slash = before == kSlash && now == kOrdinary;
    texture |= first_behind_slash & (slashes == 1);
    normal |= first_behind_slash & (slashes == 2);
    slashes += now == kSlash;
    before = now;
  }
  counts.names_texture |= texture;
  counts.names_normals |= normal;
  ++counts.faces;
  counts.corners += corners;
  counts.all_triangles = counts.all_triangles && corners == 3;
}

}  // namespace

ObjCounts count_obj(const char* begin, const char* end, char newline) {
  ObjCounts counts;
  for_each_obj_statement(begin, end, newline, [&](ObjStatement kind, const char* p, const char* line_end, const char*) {
    if (kind == ObjStatement::position)
      ++counts.positions;
    else if (kind == ObjStatement::normal)
      ++counts.normals;
    else if (kind == ObjStatement::texture_coordinates)
      ++counts.texture_coordinates;
    else if (kind == ObjStatement::face)
      count_face(p, line_end, counts);
    return true;
  });
  return counts;
}

}  // namespace raytree
