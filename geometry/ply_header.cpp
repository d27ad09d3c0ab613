#include "geometry/ply_header.h"

#include <array>
#include <utility>

#include "geometry/mesh_checks.h"
#include "geometry/text_scanning.h"

namespace raytree::ply {
namespace {

using namespace text;

/// Elements and properties that a header may list: a description takes several times the memory of its line.
constexpr std::size_t kMostHeaderEntries = 65536;

bool type_named(std::string_view name, Type& type) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> kNames = {{{"char", Type::int8},
                                                                         {"uchar", Type::uint8},
                                                                         {"short", Type::int16},
                                                                         {"ushort", Type::uint16},
                                                                         {"int", Type::int32},
                                                                         {"uint", Type::uint32},
                                                                         {"float", Type::float32},
                                                                         {"double", Type::float64},
                                                                         {"int8", Type::int8},
                                                                         {"uint8", Type::uint8},
                                                                         {"int16", Type::int16},
                                                                         {"uint16", Type::uint16},
                                                                         {"int32", Type::int32},
                                                                         {"uint32", Type::uint32},
                                                                         {"float32", Type::float32},
                                                                         {"float64", Type::float64}}};
  for (const auto& [known, value] : kNames)
    if (name == known) {
      type = value;
      return true;
    }
  return false;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name, Warnings& warnings)
      : bytes_(bytes), name_(name), warnings_(warnings) {}

  Header read() {
    read_lines();
    assign_roles();
    check_sizes();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message, std::int64_t line = 0) const {
    throw Error(ErrorKind::bad_input, {name_, line, {}}, message);
  }

  /// The next header line; false at the end of the file. Lines end with a line feed, a carriage return before it being
  /// a blank, so that binary data may begin with either; with a lone carriage return where the first line does.
  bool next_line(std::string_view& line) {
    if (cursor_ >= bytes_.size()) return false;
    if (header_.lines == 0) {
      const std::size_t first_end = bytes_.find_first_of("\r\n");
      if (first_end != std::string_view::npos && bytes_[first_end] == '\r' && bytes_.substr(first_end + 1, 1) != "\n")
        header_.newline = '\r';
    }
    const std::size_t end = std::min(bytes_.find(header_.newline, cursor_), bytes_.size());
    line = bytes_.substr(cursor_, end - cursor_);
    cursor_ = std::min(end + 1, bytes_.size());
    ++header_.lines;
    return true;
  }

  static std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    const char* p = line.data();
    const char* const end = p + line.size();
    for (;;) {
      p = skip_blanks(p, end);
      if (p == end) return words;
      words.push_back(word_at(p, end));
      p += words.back().size();
    }
  }

  void read_lines() {
    std::string_view line;
    if (!next_line(line) || words_of(line) != std::vector<std::string_view>{"ply"})
      fail("not a PLY file: it does not begin with a line 'ply'");
    bool has_format = false;
    std::int64_t unknown_lines = 0;
    std::size_t entries = 0;
    const auto count_entry = [&] {
      if (++entries > kMostHeaderEntries) fail("more than 65536 elements and properties in the header", header_.lines);
    };
    for (;;) {
      if (!next_line(line)) fail("the header has no end_header line", header_.lines);
      const std::int64_t number = header_.lines;
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        if (words.size() < 2) fail("the format line names no format", number);
        if (words[1] == "ascii")
          header_.format = Format::ascii;
        else if (words[1] == "binary_little_endian")
          header_.format = Format::little_endian;
        else if (words[1] == "binary_big_endian")
          header_.format = Format::big_endian;
        else
          fail("unknown format " + in_quotes(words[1]) + "; known are ascii, binary_little_endian, binary_big_endian",
               number);
        has_format = true;
      } else if (words[0] == "element") {
        count_entry();
        std::int64_t count = 0;
        if (words.size() < 3) fail("an element line is 'element NAME COUNT'", number);
        const char* const end = words[2].data() + words[2].size();
        if (scan_integer(words[2].data(), end, count) != end || count < 0)
          fail(in_quotes(words[2]) + " is not a count of elements", number);
        header_.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(count), {}, Use::skipped, 0});
      } else if (words[0] == "property") {
        count_entry();
        if (header_.elements.empty()) fail("a property before the first element", number);
        Property property;
        const bool is_list = words.size() > 1 && words[1] == "list";
        if (words.size() < (is_list ? 5u : 3u))
          fail("a property line is 'property TYPE NAME' or 'property list TYPE TYPE NAME'", number);
        property.is_list = is_list;
        const auto read_type = [&](std::string_view word, Type& type) {
          if (!type_named(word, type))
            fail("unknown type " + in_quotes(word) + "; known are char, uchar, short, ushort, int, uint, float, double",
                 number);
        };
        if (is_list) read_type(words[2], property.count_type);
        read_type(words[is_list ? 3 : 1], property.type);
        property.name = words[is_list ? 4 : 2];
        header_.elements.back().properties.push_back(std::move(property));
      } else {
        if (unknown_lines++ == 0) {
          warnings_.push_back({{name_, number, {}},
                               "unknown header lines skipped, the first is " + in_quotes(words[0]) +
                                   "; known are format, comment, obj_info, element, property, end_header"});
        }
        warnings_.back().count = unknown_lines;
      }
    }
    if (!has_format) fail("the header has no format line", header_.lines);
    header_.body = bytes_.substr(cursor_);
  }

  void assign_roles() {
    bool has_vertices = false, has_faces = false;
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      Element& element = header_.elements[i];
      if (element.name == "vertex" && !has_vertices) {
        has_vertices = true;
        header_.vertex_element = i;
        element.use = Use::vertices;
      } else if (element.name == "face" && !has_faces) {
        has_faces = true;
        header_.face_element = i;
        element.use = Use::faces;
      }
    }
    if (!has_vertices) fail("the header names no element 'vertex'");
    if (!has_faces || header_.faces().count == 0) fail("no faces in this file (a point cloud is not drawn)");

    Element& vertices = header_.elements[header_.vertex_element];
    Element& faces = header_.elements[header_.face_element];
    std::array<int, kRoles> seen{};
    constexpr std::pair<std::string_view, Role> kRoleNames[] = {
        {"x", Role::x},   {"y", Role::y},   {"z", Role::z},         {"nx", Role::nx},
        {"ny", Role::ny}, {"nz", Role::nz}, {"u", Role::u},         {"v", Role::v},
        {"s", Role::u},   {"t", Role::v},   {"texture_u", Role::u}, {"texture_v", Role::v},
    };
    for (Property& property : vertices.properties)
      for (const auto& [known, role] : kRoleNames)
        if (property.name == known && !property.is_list && seen[static_cast<int>(role)]++ == 0) property.role = role;
    const auto has = [&](Role role) { return seen[static_cast<int>(role)] > 0; };
    if (!has(Role::x) || !has(Role::y) || !has(Role::z)) fail("the element 'vertex' lacks a property x, y or z");
    header_.has_normals = has(Role::nx) && has(Role::ny) && has(Role::nz);
    header_.has_texture = has(Role::u) && has(Role::v);
    std::string unused;
    std::int64_t unused_count = 0;
    for (Property& property : vertices.properties) {
      const bool is_normal = property.role >= Role::nx && property.role <= Role::nz;
      const bool is_texture = property.role == Role::u || property.role == Role::v;
      if ((is_normal && !header_.has_normals) || (is_texture && !header_.has_texture)) property.role = Role::none;
      // float32 values are exact in the mesh: only others can gain from an origin.
      if (property.role >= Role::x && property.role <= Role::z && property.type != Type::float32) header_.wide = true;
      note_unused(property.role == Role::none, property, unused, unused_count);
    }
    if (unused_count > 0) warnings_.push_back({{name_, 0, {}}, "vertex properties not used: " + unused});

    bool found = false;
    for (std::size_t i = 0; i < faces.properties.size(); ++i) {
      const Property& property = faces.properties[i];
      if (found || !property.is_list || (property.name != "vertex_indices" && property.name != "vertex_index"))
        continue;
      faces.indices = i;
      found = true;
    }
    if (!found) fail("the element 'face' lacks a list vertex_indices (or vertex_index)");
    unused.clear();
    unused_count = 0;
    for (std::size_t i = 0; i < faces.properties.size(); ++i)
      note_unused(i != faces.indices, faces.properties[i], unused, unused_count);
    if (unused_count > 0) warnings_.push_back({{name_, 0, {}}, "face properties not used: " + unused});
  }

  static void note_unused(bool is_unused, const Property& property, std::string& names, std::int64_t& count) {
    if (!is_unused) return;
    if (++count <= 8)
      names += (count > 1 ? ", " : "") + in_quotes(property.name);
    else if (count == 9)
      names += ", ...";
  }

  void check_sizes() const {
    std::uint64_t left = header_.body.size();
    for (const Element& element : header_.elements) {
      // Ascii: every value takes a digit and a separator, but for the file's last.
      const std::uint64_t least =
          header_.format == Format::ascii ? 2 * element.properties.size() : element.least_bytes();
      if (least == 0) continue;
      const std::uint64_t available = left + (header_.format == Format::ascii ? 1 : 0);
      if (element.count > available / least)
        fail("the file is too short for the " + std::to_string(element.count) + " elements '" + element.name +
             "' that its header promises");
      left -= std::min(left, element.count * least);
    }
    if (header_.vertices().count >= kNoIndex || header_.faces().count >= kNoIndex)
      fail("more than 4294967294 vertices or faces in one mesh");
  }

  std::string_view bytes_;
  const std::string& name_;
  Warnings& warnings_;
  std::size_t cursor_ = 0;
  Header header_;
};

}  // namespace

Header read_header(std::string_view bytes, const std::string& name, Warnings& warnings) {
  return HeaderReader(bytes, name, warnings).read();
}

}  // namespace raytree::ply
