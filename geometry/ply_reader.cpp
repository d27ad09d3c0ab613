// The PLY reader. The header is checked against the file's size before anything is allocated. Binary data: vertices
// are converted in parallel at a fixed stride; faces, whose sizes vary, are walked once for their offsets and then
// converted in parallel. Ascii data: parsed in parallel under the assumption that every element has its own line, and
// once more token by token, in sequence, where a file breaks that assumption; errors are found there.
#include "geometry/ply_reader.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/mesh_checks.h"
#include "geometry/text_scanning.h"

namespace raytree {
namespace {

using namespace text;

/// Elements and properties that a header may list: a description takes several times the memory of its line.
constexpr std::size_t kMostHeaderEntries = 65536;

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Format { ascii, little_endian, big_endian };

std::size_t size_of(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<int>(type)];
}

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

/// What a vertex property becomes.
enum class Role { none, x, y, z, nx, ny, nz, u, v };
constexpr int kRoles = 9;

struct Property {
  std::string name;
  Type type = Type::float32;  // of the value, or of a list's entries
  bool is_list = false;
  Type count_type = Type::uint8;
  Role role = Role::none;
};

enum class Use { skipped, vertices, faces };

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  Use use = Use::skipped;
  std::size_t indices = 0;  // faces: which property holds the corners

  bool has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const Property& p) { return p.is_list; });
  }
  /// Least bytes that one item takes in a binary file: lists empty.
  std::size_t least_bytes() const {
    std::size_t sum = 0;
    for (const Property& p : properties) sum += size_of(p.is_list ? p.count_type : p.type);
    return sum;
  }
};

template <class T>
T load(const char* p, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), p, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <class Function>
decltype(auto) with_type(Type type, Function&& function) {
  switch (type) {
    case Type::int8:
      return function(std::int8_t{});
    case Type::uint8:
      return function(std::uint8_t{});
    case Type::int16:
      return function(std::int16_t{});
    case Type::uint16:
      return function(std::uint16_t{});
    case Type::int32:
      return function(std::int32_t{});
    case Type::uint32:
      return function(std::uint32_t{});
    case Type::float32:
      return function(float{});
    case Type::float64:
      break;
  }
  return function(double{});
}

/// A value used as a count or an index; -1 for what is none (negative, fractional, beyond 32 bits).
template <class T>
std::int64_t as_index(T value) {
  constexpr double kLimit = 4294967295.0;
  if constexpr (std::is_floating_point_v<T>) {
    const double v = static_cast<double>(value);
    return v >= 0 && v <= kLimit && v == std::floor(v) ? static_cast<std::int64_t>(v) : -1;
  } else {
    return value < T(0) ? -1 : static_cast<std::int64_t>(value);
  }
}

std::int64_t load_index(Type type, const char* p, bool swap) {
  return with_type(type, [&](auto zero) { return as_index(load<decltype(zero)>(p, swap)); });
}

void extend_finite(Bounds3d& box, double x, double y, double z) {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (std::abs(x) <= kMax && std::abs(y) <= kMax && std::abs(z) <= kMax) box.extendBy(Vec3d(x, y, z));
}

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name, Warnings& warnings)
      : bytes_(bytes), name_(name), warnings_(warnings) {}

  PolygonMesh parse() {
    read_header();
    assign_roles();
    check_sizes();
    allocate_vertices();
    if (format_ == Format::ascii)
      read_ascii();
    else
      read_binary();
    warn_skipped();
    const MeshLocator locate{[this](std::size_t i) { return location(Use::vertices, i); },
                             [this](std::size_t i) { return location(Use::faces, i); }};
    settle_mesh(mesh_, name_, locate, warnings_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message, std::int64_t line = 0, std::string object = {}) const {
    throw Error(ErrorKind::bad_input, {name_, line, std::move(object)}, message);
  }

  static std::string item_name(const Element& element, std::size_t item) {
    return element.name + " " + std::to_string(item + 1);
  }

  // ---- header

  /// The next header line; false at the end of the file. Lines end with a line feed, a carriage return before it being
  /// a blank, so that binary data may begin with either; with a lone carriage return where the first line does.
  bool next_line(std::string_view& line) {
    if (cursor_ >= bytes_.size()) return false;
    if (header_lines_ == 0) {
      const std::size_t first_end = bytes_.find_first_of("\r\n");
      if (first_end != std::string_view::npos && bytes_[first_end] == '\r' && bytes_.substr(first_end + 1, 1) != "\n")
        newline_ = '\r';
    }
    const std::size_t end = std::min(bytes_.find(newline_, cursor_), bytes_.size());
    line = bytes_.substr(cursor_, end - cursor_);
    cursor_ = std::min(end + 1, bytes_.size());
    ++header_lines_;
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

  void read_header() {
    std::string_view line;
    if (!next_line(line) || words_of(line) != std::vector<std::string_view>{"ply"})
      fail("not a PLY file: it does not begin with a line 'ply'");
    bool has_format = false;
    std::int64_t unknown_lines = 0;
    std::size_t entries = 0;
    const auto count_entry = [&] {
      if (++entries > kMostHeaderEntries) fail("more than 65536 elements and properties in the header", header_lines_);
    };
    for (;;) {
      if (!next_line(line)) fail("the header has no end_header line", header_lines_);
      const std::int64_t number = header_lines_;
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        if (words.size() < 2) fail("the format line names no format", number);
        if (words[1] == "ascii")
          format_ = Format::ascii;
        else if (words[1] == "binary_little_endian")
          format_ = Format::little_endian;
        else if (words[1] == "binary_big_endian")
          format_ = Format::big_endian;
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
        elements_.push_back({std::string(words[1]), static_cast<std::uint64_t>(count), {}, Use::skipped, 0});
      } else if (words[0] == "property") {
        count_entry();
        if (elements_.empty()) fail("a property before the first element", number);
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
        elements_.back().properties.push_back(std::move(property));
      } else {
        if (unknown_lines++ == 0) {
          warnings_.push_back({{name_, number, {}},
                               "unknown header lines skipped, the first is " + in_quotes(words[0]) +
                                   "; known are format, comment, obj_info, element, property, end_header"});
        }
        warnings_.back().count = unknown_lines;
      }
    }
    if (!has_format) fail("the header has no format line", header_lines_);
    body_ = bytes_.substr(cursor_);
  }

  void assign_roles() {
    for (Element& element : elements_) {
      if (element.name == "vertex" && !vertices_) {
        vertices_ = &element;
        element.use = Use::vertices;
      } else if (element.name == "face" && !faces_) {
        faces_ = &element;
        element.use = Use::faces;
      }
    }
    if (!vertices_) fail("the header names no element 'vertex'");
    if (!faces_ || faces_->count == 0) fail("no faces in this file (a point cloud is not drawn)");

    std::array<int, kRoles> seen{};
    constexpr std::pair<std::string_view, Role> kRoleNames[] = {
        {"x", Role::x},   {"y", Role::y},   {"z", Role::z},         {"nx", Role::nx},
        {"ny", Role::ny}, {"nz", Role::nz}, {"u", Role::u},         {"v", Role::v},
        {"s", Role::u},   {"t", Role::v},   {"texture_u", Role::u}, {"texture_v", Role::v},
    };
    for (Property& property : vertices_->properties)
      for (const auto& [known, role] : kRoleNames)
        if (property.name == known && !property.is_list && seen[static_cast<int>(role)]++ == 0) property.role = role;
    const auto has = [&](Role role) { return seen[static_cast<int>(role)] > 0; };
    if (!has(Role::x) || !has(Role::y) || !has(Role::z)) fail("the element 'vertex' lacks a property x, y or z");
    has_normals_ = has(Role::nx) && has(Role::ny) && has(Role::nz);
    has_texture_ = has(Role::u) && has(Role::v);
    std::string unused;
    std::int64_t unused_count = 0;
    for (Property& property : vertices_->properties) {
      const bool is_normal = property.role >= Role::nx && property.role <= Role::nz;
      const bool is_texture = property.role == Role::u || property.role == Role::v;
      if ((is_normal && !has_normals_) || (is_texture && !has_texture_)) property.role = Role::none;
      // float32 values are exact in the mesh: only others can gain from an origin.
      if (property.role >= Role::x && property.role <= Role::z && property.type != Type::float32) wide_ = true;
      note_unused(property.role == Role::none, property, unused, unused_count);
    }
    if (unused_count > 0) warnings_.push_back({{name_, 0, {}}, "vertex properties not used: " + unused, unused_count});

    bool found = false;
    for (std::size_t i = 0; i < faces_->properties.size(); ++i) {
      const Property& property = faces_->properties[i];
      if (found || !property.is_list || (property.name != "vertex_indices" && property.name != "vertex_index"))
        continue;
      faces_->indices = i;
      found = true;
    }
    if (!found) fail("the element 'face' lacks a list vertex_indices (or vertex_index)");
    unused.clear();
    unused_count = 0;
    for (std::size_t i = 0; i < faces_->properties.size(); ++i)
      note_unused(i != faces_->indices, faces_->properties[i], unused, unused_count);
    if (unused_count > 0) warnings_.push_back({{name_, 0, {}}, "face properties not used: " + unused, unused_count});
  }

  static void note_unused(bool is_unused, const Property& property, std::string& names, std::int64_t& count) {
    if (!is_unused) return;
    if (++count <= 8)
      names += (count > 1 ? ", " : "") + in_quotes(property.name);
    else if (count == 9)
      names += ", ...";
  }

  void check_sizes() const {
    std::uint64_t left = body_.size();
    for (const Element& element : elements_) {
      // Ascii: every value takes a digit and a separator, but for the file's last.
      const std::uint64_t least = format_ == Format::ascii ? 2 * element.properties.size() : element.least_bytes();
      if (least == 0) continue;
      const std::uint64_t available = left + (format_ == Format::ascii ? 1 : 0);
      if (element.count > available / least)
        fail("the file is too short for the " + std::to_string(element.count) + " elements '" + element.name +
             "' that its header promises");
      left -= std::min(left, element.count * least);
    }
    if (vertices_->count >= kNoIndex || faces_->count >= kNoIndex)
      fail("more than 4294967294 vertices or faces in one mesh");
  }

  void allocate_vertices() {
    mesh_.positions.resize(vertices_->count);
    if (has_normals_) mesh_.normals.resize(vertices_->count);
    if (has_texture_) mesh_.texture_coordinates.resize(vertices_->count);
  }

  void allocate_faces(std::size_t corners, bool all_triangles) {
    if (corners >= kNoIndex) fail("more than 4294967294 corners in one mesh");
    mesh_.corners.resize(corners);
    if (!all_triangles) mesh_.face_sizes.resize(faces_->count);
  }

  [[noreturn]] void fail_index(std::size_t face, std::int64_t line) const {
    fail("a corner is not the index of a vertex: it must be in 0.." +
             std::to_string(static_cast<std::int64_t>(vertices_->count) - 1),
         line, item_name(*faces_, face));
  }

  // ---- binary

  bool swap() const { return (format_ == Format::big_endian) != (std::endian::native == std::endian::big); }

  /// Bytes of one item at p, or 0 if it does not fit before `end` or a count is none. The list at `indices` (if
  /// wanted) comes back as its first entry and its length.
  std::size_t item_bytes(const Element& element, const char* p, const char* end, const char** list,
                         std::uint64_t* list_count) const {
    const char* const begin = p;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& property = element.properties[i];
      const std::size_t head = size_of(property.is_list ? property.count_type : property.type);
      if (head > static_cast<std::size_t>(end - p)) return 0;
      if (property.is_list) {
        const std::int64_t count = load_index(property.count_type, p, swap());
        const std::size_t size = size_of(property.type);
        if (count < 0 || static_cast<std::uint64_t>(count) > static_cast<std::size_t>(end - p - head) / size) return 0;
        if (list && i == element.indices) {
          *list = p + head;
          *list_count = static_cast<std::uint64_t>(count);
        }
        p += static_cast<std::size_t>(count) * size;
      }
      p += head;
    }
    return static_cast<std::size_t>(p - begin);
  }

  static constexpr std::size_t kBlock = 8192;  // elements that one task converts

  /// Where each block of kBlock items begins; the last entry is the element's end. `corner_starts`, for faces: the
  /// number of corners before each block.
  std::vector<const char*> walk(const Element& element, const char* p, const char* end,
                                std::vector<std::size_t>* corner_starts, bool* all_triangles) const {
    std::vector<const char*> starts;
    std::size_t corners = 0;
    // The usual faces, one list and nothing else, have a loop of their own.
    const bool is_simple =
        corner_starts && element.properties.size() == 1 && element.properties[0].count_type == Type::uint8;
    const std::size_t entry = is_simple ? size_of(element.properties[0].type) : 0;
    for (std::size_t item = 0; item < element.count; ++item) {
      if (item % kBlock == 0) {
        starts.push_back(p);
        if (corner_starts) corner_starts->push_back(corners);
      }
      const char* list = nullptr;
      std::uint64_t count = 0;
      std::size_t bytes = 0;
      if (is_simple && p != end) {
        count = static_cast<unsigned char>(*p);
        bytes = 1 + count * entry;
        if (bytes > static_cast<std::size_t>(end - p)) bytes = 0;
      } else {
        bytes = item_bytes(element, p, end, corner_starts ? &list : nullptr, &count);
      }
      if (bytes == 0 && !element.properties.empty())
        fail("the data end inside this element, or a list's count is no count", 0, item_name(element, item));
      if (corner_starts) {
        corners += count;
        *all_triangles = *all_triangles && count == 3;
      }
      p += bytes;
    }
    starts.push_back(p);
    if (corner_starts) corner_starts->push_back(corners);
    return starts;
  }

  void read_binary() {
    const char* p = body_.data();
    const char* const end = p + body_.size();
    for (const Element& element : elements_) {
      if (element.use == Use::faces) {
        p = read_binary_faces(p, end);
        continue;
      }
      if (element.properties.empty()) continue;
      std::vector<const char*> starts;
      const char* after = nullptr;
      if (element.has_list()) {
        starts = walk(element, p, end, nullptr, nullptr);
        after = starts.back();
      } else {
        const std::size_t stride = element.least_bytes();
        if (element.count > static_cast<std::size_t>(end - p) / stride)
          fail("the file is too short for its elements '" + element.name + "'");
        after = p + element.count * stride;
      }
      if (element.use == Use::vertices) {
        Bounds3d box;
        convert_vertices(p, starts, wide_ ? &box : nullptr);
        mesh_.origin = mesh_origin(box);
        if (mesh_.origin != Vec3d(0, 0, 0)) convert_vertices(p, starts, nullptr);
      }
      p = after;
    }
    if (p != end) warnings_.push_back({{name_, 0, {}}, "bytes after the last element dropped", end - p});
  }

  float* target(Role role, std::size_t vertex) {
    switch (role) {
      case Role::x:
      case Role::y:
      case Role::z:
        return &mesh_.positions[vertex].x + (static_cast<int>(role) - static_cast<int>(Role::x));
      case Role::nx:
      case Role::ny:
      case Role::nz:
        return &mesh_.normals[vertex].x + (static_cast<int>(role) - static_cast<int>(Role::nx));
      case Role::u:
      case Role::v:
        return &mesh_.texture_coordinates[vertex].x + (static_cast<int>(role) - static_cast<int>(Role::u));
      case Role::none:
        break;
    }
    return nullptr;
  }

  double shift(Role role) const {
    return role >= Role::x && role <= Role::z ? mesh_.origin[static_cast<int>(role) - static_cast<int>(Role::x)] : 0.0;
  }

  /// Vertices of a fixed size are converted column by column within a block; those with lists (`starts` given) one by
  /// one. `box`, if wanted, receives the bounds of the finite positions.
  void convert_vertices(const char* begin, const std::vector<const char*>& starts, Bounds3d* box) {
    const Element& element = *vertices_;
    const std::size_t stride = element.least_bytes();
    const std::size_t blocks = (element.count + kBlock - 1) / kBlock;
    std::vector<Bounds3d> boxes(box ? blocks : 0);
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
      const std::size_t first = block * kBlock;
      const std::size_t last = std::min<std::size_t>(first + kBlock, element.count);
      std::array<std::vector<double>, 3> wide;  // coordinates before rounding to float, for the bounds
      if (box)
        for (std::vector<double>& column : wide) column.resize(last - first);
      const auto store = [&](const Property& property, std::size_t vertex, auto value) {
        if (box && property.role <= Role::z)
          wide[static_cast<std::size_t>(property.role) - 1][vertex - first] = static_cast<double>(value);
        *target(property.role, vertex) = static_cast<float>(static_cast<double>(value) - shift(property.role));
      };
      if (starts.empty()) {
        std::size_t offset = 0;
        for (const Property& property : element.properties) {
          const char* p = begin + first * stride + offset;
          offset += size_of(property.type);
          if (property.role == Role::none) continue;
          with_type(property.type, [&](auto zero) {
            using T = decltype(zero);
            if constexpr (std::is_same_v<T, float>) {
              if (!box && shift(property.role) == 0) {
                copy_floats(p, stride, target(property.role, first), last - first,
                            property.role == Role::u || property.role == Role::v ? 2 : 3);
                return;
              }
            }
            for (std::size_t vertex = first; vertex < last; ++vertex, p += stride)
              store(property, vertex, load<T>(p, swap()));
          });
        }
      } else {
        const char* p = starts[block];
        for (std::size_t vertex = first; vertex < last; ++vertex)
          for (const Property& property : element.properties) {
            if (property.is_list) {
              p += size_of(property.count_type) +
                   static_cast<std::size_t>(load_index(property.count_type, p, swap())) * size_of(property.type);
              continue;
            }
            if (property.role != Role::none)
              with_type(property.type, [&](auto zero) { store(property, vertex, load<decltype(zero)>(p, swap())); });
            p += size_of(property.type);
          }
      }
      if (box)
        for (std::size_t i = 0; i < last - first; ++i) extend_finite(boxes[block], wide[0][i], wide[1][i], wide[2][i]);
    });
    for (const Bounds3d& part : boxes) box->extendBy(part);
  }

  void copy_floats(const char* from, std::size_t stride, float* to, std::size_t count, std::size_t to_stride) const {
    const bool swapped = swap();
    for (std::size_t i = 0; i < count; ++i) to[i * to_stride] = load<float>(from + i * stride, swapped);
  }

  const char* read_binary_faces(const char* p, const char* end) {
    const Element& element = *faces_;
    std::vector<std::size_t> corner_starts;
    bool all_triangles = true;
    const std::vector<const char*> starts = walk(element, p, end, &corner_starts, &all_triangles);
    allocate_faces(corner_starts.back(), all_triangles);
    const Type type = element.properties[element.indices].type;
    const std::size_t blocks = starts.size() - 1;
    std::vector<std::size_t> bad(blocks, element.count);  // first face with a bad index, per block
    const bool is_plain = all_triangles && element.properties.size() == 1 && size_of(type) == 4 &&
                          type != Type::float32 && element.properties[0].count_type == Type::uint8;
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
      const std::size_t first = block * kBlock;
      const std::size_t last = std::min<std::size_t>(first + kBlock, element.count);
      const char* at = starts[block];
      std::uint32_t* out = mesh_.corners.data() + corner_starts[block];
      const std::size_t vertex_count = vertices_->count;
      if (is_plain) {
        // Read as unsigned, a negative index is 2^31 or more: out of range under this limit.
        const bool is_signed = type == Type::int32;
        const bool swapped = swap();
        const std::size_t limit = is_signed ? std::min<std::size_t>(vertex_count, std::size_t(1) << 31) : vertex_count;
        for (std::size_t face = first; face < last; ++face, at += 13, out += 3) {
          for (int i = 0; i < 3; ++i) {
            out[i] = load<std::uint32_t>(at + 1 + 4 * i, swapped);
            if (out[i] >= limit) bad[block] = std::min(bad[block], face);
          }
        }
        return;
      }
      for (std::size_t face = first; face < last; ++face) {
        const char* list = nullptr;
        std::uint64_t count = 0;
        at += item_bytes(element, at, end, &list, &count);
        with_type(type, [&](auto zero) {
          using T = decltype(zero);
          for (std::uint64_t i = 0; i < count; ++i) {
            const std::int64_t index = as_index(load<T>(list + i * sizeof(T), swap()));
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count) bad[block] = std::min(bad[block], face);
            *out++ = static_cast<std::uint32_t>(index);
          }
        });
        if (!all_triangles) mesh_.face_sizes[face] = static_cast<std::uint32_t>(count);
      }
    });
    for (const std::size_t face : bad)
      if (face != element.count) fail_index(face, 0);
    return starts.back();
  }

  // ---- ascii

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

  /// Calls line(begin, end) for each line that is not blank, as long as it returns true.
  template <class Function>
  static bool for_each_line(const char* p, const char* end, char newline, Function&& line) {
    while (p != end) {
      const char* line_end = static_cast<const char*>(std::memchr(p, newline, static_cast<std::size_t>(end - p)));
      if (!line_end) line_end = end;
      const char* const begin = skip_blanks(p, line_end);
      if (begin != line_end && !line(begin, line_end)) return false;
      p = line_end == end ? end : line_end + 1;
    }
    return true;
  }

  static const char* skip_word(const char* p, const char* end) {
    while (p != end && !is_space(*p)) ++p;
    return p;
  }

  /// Whether a scanned value ends where a word must.
  static bool ends(const char* p, const char* end) { return p && (p == end || is_space(*p)); }

  /// An index or count in ascii, whatever its type's spelling ("3" or "3.0").
  static const char* scan_count(const char* p, const char* end, std::int64_t& value) {
    const char* after = scan_integer(p, end, value);
    if (ends(after, end)) return after;
    double number = 0;
    after = scan_double(p, end, number);
    if (!ends(after, end)) return nullptr;
    value = as_index(number);
    return value < 0 ? nullptr : after;
  }

  void read_ascii() {
    if (!read_ascii_lines()) read_ascii_tokens();
  }

  /// The parallel way. False, with nothing decided, where the file is not one element a line or has any other fault.
  bool read_ascii_lines() {
    const std::vector<const char*> borders = chunk_borders(body_, newline_);
    std::vector<Chunk> chunks(borders.size() - 1);
    const auto for_each_chunk = [&](auto&& function) {
      tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t i) { function(chunks[i]); });
    };
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      chunks[i].begin = borders[i];
      chunks[i].end = borders[i + 1];
    }
    for_each_chunk([&](Chunk& chunk) {
      for_each_line(chunk.begin, chunk.end, newline_, [&](const char*, const char*) { return ++chunk.lines; });
    });
    std::size_t lines = 0;
    for (Chunk& chunk : chunks) {
      chunk.first_line = lines;
      lines += chunk.lines;
    }
    std::vector<std::uint64_t> element_ends;
    std::uint64_t items = 0;
    for (const Element& element : elements_) {
      items += element.properties.empty() ? 0 : element.count;
      element_ends.push_back(items);
    }
    if (lines < items) return false;

    // Corners are counted first, so that the arrays get their final size at once.
    std::atomic<bool> good = true;
    const auto for_each_item = [&](Chunk& chunk, auto&& function) {
      std::uint64_t item = chunk.first_line;
      std::size_t e = 0;
      while (e < elements_.size() && item >= element_ends[e]) ++e;
      const bool all = for_each_line(chunk.begin, chunk.end, newline_, [&](const char* p, const char* end) {
        while (e < elements_.size() && item >= element_ends[e]) ++e;
        if (e == elements_.size()) return true;  // beyond the last element
        const std::uint64_t first = element_ends[e] - elements_[e].count;
        return function(elements_[e], static_cast<std::size_t>(item++ - first), p, end);
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
    by_lines_ = true;
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
        if (!behind || index < 0 || static_cast<std::uint64_t>(index) >= vertices_->count) {
          error = in_quotes(word_at(p, end)) + " is not the index of a vertex: it must be in 0.." +
                  std::to_string(static_cast<std::int64_t>(vertices_->count) - 1);
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
  void read_ascii_tokens() {
    const char* const end = body_.data() + body_.size();
    const auto fail_at = [&](const char* p, const std::string& message, const Element& element, std::size_t item) {
      p = std::min(skip_spaces(p, end), end);
      fail(message, line_number(bytes_, p, newline_), item_name(element, item));
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
    const char* p = body_.data();
    std::size_t corners = 0;
    bool all_triangles = true;
    std::vector<const char*> begins;
    for (const Element& element : elements_) {
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
      for (std::size_t e = 0; e < elements_.size(); ++e) {
        const Element& element = elements_[e];
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
        {{name_, header_lines_ + 1, {}}, "the file does not hold one element a line: read in sequence"});
    const char* const rest = skip_spaces(after, end);
    if (rest != end)
      warnings_.push_back({{name_, line_number(bytes_, rest, newline_), {}}, "text after the last element dropped"});
  }

  // ---- messages

  void warn_skipped() {
    for (const Element& element : elements_)
      if (element.use == Use::skipped && element.count > 0)
        warnings_.push_back({{name_, 0, {}},
                             "elements " + in_quotes(element.name) + " skipped",
                             static_cast<std::int64_t>(element.count)});
  }

  /// The line of an item in ascii files of one element a line; elsewhere its number.
  SourceLocation location(Use use, std::size_t item) const {
    const Element& wanted = use == Use::faces ? *faces_ : *vertices_;
    SourceLocation result{name_, 0, item_name(wanted, item)};
    if (!by_lines_) return result;
    std::uint64_t line = item;
    for (const Element& element : elements_) {
      if (&element == &wanted) break;
      if (!element.properties.empty()) line += element.count;
    }
    for_each_line(body_.data(), body_.data() + body_.size(), newline_, [&](const char* p, const char*) {
      if (line-- != 0) return true;
      result.line = line_number(bytes_, p, newline_);
      return false;
    });
    return result;
  }

  std::string_view bytes_;
  const std::string& name_;
  Warnings& warnings_;
  std::size_t cursor_ = 0;  // while reading the header
  std::int64_t header_lines_ = 0;
  char newline_ = '\n';
  std::string_view body_;
  Format format_ = Format::ascii;
  std::vector<Element> elements_;
  Element* vertices_ = nullptr;
  Element* faces_ = nullptr;
  bool has_normals_ = false, has_texture_ = false;
  bool wide_ = false;      // positions have more precision than float
  bool by_lines_ = false;  // ascii, one element a line
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_ply(std::string_view bytes, const std::string& name, Warnings& warnings) {
  return PlyParser(bytes, name, warnings).parse();
}

}  // namespace raytree
