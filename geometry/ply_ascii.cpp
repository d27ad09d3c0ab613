// Ascii PLY bodies: parsed in parallel under the assumption that every element has its own line, and once more token by
// token, in sequence, where a file breaks that assumption; errors are found there.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

#include "geometry/ply_body.h"
#include "geometry/text_scanning.h"

namespace raytree::ply {
namespace {

using namespace text;

/// Calls line(begin, end) for each line that is not blank, as long as it returns true.
template <class Function>
bool for_each_line(const char* p, const char* end, char newline, Function&& line) {
  while (p != end) {
    const char* line_end = static_cast<const char*>(std::memchr(p, newline, static_cast<std::size_t>(end - p)));
    if (!line_end) line_end = end;
    const char* const begin = skip_blanks(p, line_end);
    if (begin != line_end && !line(begin, line_end)) return false;
    p = line_end == end ? end : line_end + 1;
  }
  return true;
}

const char* skip_word(const char* p, const char* end) {
  while (p != end && !is_space(*p)) ++p;
  return p;
}

/// Whether a scanned value ends where a word must.
bool ends(const char* p, const char* end) { return p && (p == end || is_space(*p)); }

/// An index or count in ascii, whatever its type's spelling ("3" or "3.0").
const char* scan_count(const char* p, const char* end, std::int64_t& value) {
  const char* after = scan_integer(p, end, value);
  if (ends(after, end)) return after;
  double number = 0;
  after = scan_double(p, end, number);
  if (!ends(after, end)) return nullptr;
  value = as_index(number);
  return value < 0 ? nullptr : after;
}

struct Chunk {
  const char* begin;
  const char* end;
  std::size_t lines = 0;       // that are not blank
  std::size_t first_line = 0;  // what stands before
  std::size_t corners = 0;
  std::size_t first_corner = 0;
  bool all_triangles = true;
  Bounds3d box;
};

class AsciiReader : BodyReader {
 public:
  using BodyReader::BodyReader;

  /// Whether the body has one element a line.
  bool read() {
    if (read_lines()) return true;
    read_tokens();
    return false;
  }

 private:
  /// The parallel way. False, with nothing decided, where the file is not one element a line or has any other fault.
  bool read_lines() {
    const std::vector<const char*> borders = chunk_borders(header_.body, header_.newline);
    std::vector<Chunk> chunks(borders.size() - 1);
    const auto for_each_chunk = [&](auto&& function) {
      tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t i) { function(chunks[i]); });
    };
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      chunks[i].begin = borders[i];
      chunks[i].end = borders[i + 1];
    }
    for_each_chunk([&](Chunk& chunk) {
      for_each_line(chunk.begin, chunk.end, header_.newline, [&](const char*, const char*) { return ++chunk.lines; });
    });
    std::size_t lines = 0;
    for (Chunk& chunk : chunks) {
      chunk.first_line = lines;
      lines += chunk.lines;
    }
    std::vector<std::uint64_t> element_ends;
    std::uint64_t items = 0;
    for (const Element& element : header_.elements) {
      items += element.properties.empty() ? 0 : element.count;
      element_ends.push_back(items);
    }
    if (lines < items) return false;

    // Corners are counted first, so that the arrays get their final size at once.
    std::atomic<bool> good = true;
    const auto for_each_item = [&](Chunk& chunk, auto&& function) {
      std::uint64_t item = chunk.first_line;
      std::size_t e = 0;
      while (e < header_.elements.size() && item >= element_ends[e]) ++e;
      const bool all = for_each_line(chunk.begin, chunk.end, header_.newline, [&](const char* p, const char* end) {
        while (e < header_.elements.size() && item >= element_ends[e]) ++e;
        if (e == header_.elements.size()) return true;  // beyond the last element
        const std::uint64_t first = element_ends[e] - header_.elements[e].count;
        return function(header_.elements[e], static_cast<std::size_t>(item++ - first), p, end);
      });
      if (!all) good = false;
    };
    for_each_chunk([&](Chunk& chunk) {
      if (!good) return;
      for_each_item(chunk, [&](const Element& element, std::size_t, const char* p, const char* end) {
        if (element.use != Use::faces) return true;
        std::int64_t count = 0;
        for (std::size_t i = 0; i <= element.indices; ++i) {
          count = 0;
          const bool is_list = element.properties[i].is_list;
          if (is_list) {
            const char* const after = scan_count(p, end, count);
            if (!after || count < 0 || count > end - p) return false;
            p = skip_blanks(after, end);
          }
          if (i == element.indices) break;
          for (std::int64_t skipped = is_list ? 0 : -1; skipped < count; ++skipped)
            p = skip_blanks(skip_word(skip_blanks(p, end), end), end);
        }
        chunk.corners += static_cast<std::size_t>(count);
        chunk.all_triangles = chunk.all_triangles && count == 3;
        return true;
      });
    });
    if (!good) return false;
    std::size_t corners = 0;
    bool all_triangles = true;
    for (Chunk& chunk : chunks) {
      chunk.first_corner = corners;
      corners += chunk.corners;
      all_triangles = all_triangles && chunk.all_triangles;
    }
    allocate_faces(corners, all_triangles);

    const auto parse_all = [&](bool only_vertices) {
      for_each_chunk([&](Chunk& chunk) {
        if (!good) return;
        std::size_t corner = chunk.first_corner;
        for_each_item(chunk, [&](const Element& element, std::size_t item, const char* p, const char* end) {
          if (element.use == Use::skipped || (only_vertices && element.use == Use::faces)) return true;
          std::string ignored;
          p = parse_item(element, item, p, end, corner, chunk.box, ignored);
          return p && skip_blanks(p, end) == end;
        });
      });
    };
    parse_all(false);
    if (!good) return false;
    Bounds3d box;
    for (const Chunk& chunk : chunks) box.extendBy(chunk.box);
    mesh_.origin = mesh_origin(box);
    if (mesh_.origin != Vec3d(0, 0, 0)) parse_all(true);
    if (lines > items)
      warnings_.push_back(
          {{name_, 0, {}}, "lines after the last element dropped", static_cast<std::int64_t>(lines - items)});
    return true;
  }

  /// Parses one vertex or face at p and returns where it ends; nullptr, with `error` set, where it is at fault. Values
  /// may stand on any number of lines. `corner` counts the corners written.
  const char* parse_item(const Element& element, std::size_t item, const char* p, const char* end, std::size_t& corner,
                         Bounds3d& box, std::string& error) {
    double values[kRoles] = {};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& property = element.properties[i];
      p = skip_spaces(p, end);
      if (p == end) {
        error = "the data end inside this element";
        return nullptr;
      }
      if (!property.is_list) {
        if (property.role == Role::none) {
          p = skip_word(p, end);
          continue;
        }
        const char* const after = scan_double(p, end, values[static_cast<int>(property.role)]);
        if (!ends(after, end)) {
          error = in_quotes(word_at(p, end)) + " is not a number";
          return nullptr;
        }
        p = after;
        continue;
      }
      std::int64_t count = 0;
      const char* const after = scan_count(p, end, count);
      if (!after || count < 0) {
        error = in_quotes(word_at(p, end)) + " is not a list's count";
        return nullptr;
      }
      p = after;
      const bool is_indices = element.use == Use::faces && i == element.indices;
      if (is_indices && !mesh_.all_triangles()) mesh_.face_sizes[item] = static_cast<std::uint32_t>(count);
      for (std::int64_t k = 0; k < count; ++k) {
        p = skip_spaces(p, end);
        if (p == end) {
          error = "the data end inside this list of " + std::to_string(count);
          return nullptr;
        }
        if (!is_indices) {
          p = skip_word(p, end);
          continue;
        }
        std::int64_t index = 0;
        const char* const behind = scan_count(p, end, index);
        if (!behind || index < 0 || static_cast<std::uint64_t>(index) >= header_.vertices().count) {
          error = in_quotes(word_at(p, end)) + " is not the index of a vertex: it must be in 0.." +
                  std::to_string(static_cast<std::int64_t>(header_.vertices().count) - 1);
          return nullptr;
        }
        mesh_.corners[corner++] = static_cast<std::uint32_t>(index);
        p = behind;
      }
    }
    if (element.use == Use::vertices) {
      for (const Property& property : element.properties)
        if (property.role != Role::none)
          *target(property.role, item) =
              static_cast<float>(values[static_cast<int>(property.role)] - shift(property.role));
      extend_finite(box, values[1], values[2], values[3]);
    }
    return p;
  }

  /// The sequential way, token by token over line ends: counts the corners first, then parses.
  void read_tokens() {
    const char* const end = header_.body.data() + header_.body.size();
    const auto fail_at = [&](const char* p, const std::string& message, const Element& element, std::size_t item) {
      p = std::min(skip_spaces(p, end), end);
      fail(message, line_number(bytes_, p, header_.newline), item_name(element, item));
    };
    const auto skip_item = [&](const char* p, const Element& element, std::size_t item, std::int64_t& indices) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        std::int64_t words = 1;
        p = skip_spaces(p, end);
        if (element.properties[i].is_list) {
          const char* const after = scan_count(p, end, words);
          if (!after || words < 0)
            fail_at(
                p,
                p == end ? "the data end before this element" : in_quotes(word_at(p, end)) + " is not a list's count",
                element, item);
          if (words > end - after)
            fail_at(p, "the data end inside this list of " + std::to_string(words), element, item);
          if (i == element.indices) indices = words;
          p = after;
        }
        for (; words > 0; --words) {
          p = skip_spaces(p, end);
          if (p == end) fail_at(p, "the data end inside this element", element, item);
          p = skip_word(p, end);
        }
      }
      return p;
    };
    const char* p = header_.body.data();
    std::size_t corners = 0;
    bool all_triangles = true;
    std::vector<const char*> begins;
    for (const Element& element : header_.elements) {
      begins.push_back(p);
      for (std::size_t item = 0; item < element.count && !element.properties.empty(); ++item) {
        std::int64_t indices = 0;
        p = skip_item(p, element, item, indices);
        if (element.use != Use::faces) continue;
        corners += static_cast<std::size_t>(indices);
        all_triangles = all_triangles && indices == 3;
      }
    }
    const char* const after = p;
    allocate_faces(corners, all_triangles);
    if (all_triangles) mesh_.face_sizes.clear();
    mesh_.origin = Vec3d(0, 0, 0);
    for (const bool only_vertices : {false, true}) {
      Bounds3d box;
      std::size_t corner = 0;
      for (std::size_t e = 0; e < header_.elements.size(); ++e) {
        const Element& element = header_.elements[e];
        if (element.use == Use::skipped || (only_vertices && element.use == Use::faces)) continue;
        p = begins[e];
        for (std::size_t item = 0; item < element.count; ++item) {
          std::string error;
          const char* const next = parse_item(element, item, p, end, corner, box, error);
          if (!next) fail_at(p, error, element, item);
          p = next;
        }
      }
      if (only_vertices) break;
      mesh_.origin = mesh_origin(box);
      if (mesh_.origin == Vec3d(0, 0, 0)) break;
    }
    warnings_.push_back(
        {{name_, header_.lines + 1, {}}, "the file does not hold one element a line: read in sequence"});
    const char* const rest = skip_spaces(after, end);
    if (rest != end)
      warnings_.push_back(
          {{name_, line_number(bytes_, rest, header_.newline), {}}, "text after the last element dropped"});
  }
};

}  // namespace

bool read_ascii_body(const Header& header, std::string_view bytes, const std::string& name, Warnings& warnings,
                     PolygonMesh& mesh) {
  return AsciiReader(header, bytes, name, warnings, mesh).read();
}

std::int64_t ascii_line(const Header& header, std::string_view bytes, const Element& wanted, std::size_t item) {
  std::uint64_t line = item;
  for (const Element& element : header.elements) {
    if (&element == &wanted) break;
    if (!element.properties.empty()) line += element.count;
  }
  std::int64_t result = 0;
  for_each_line(header.body.data(), header.body.data() + header.body.size(), header.newline,
                [&](const char* p, const char*) {
                  if (line-- != 0) return true;
                  result = line_number(bytes, p, header.newline);
                  return false;
                });
  return result;
}

}  // namespace raytree::ply
