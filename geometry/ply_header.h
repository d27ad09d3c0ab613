// The header of a PLY file: which elements stand in the body, of which properties, and what each becomes. Checked
// against the file's size before anything is allocated. What the body holds is left to its readers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/error.h"

namespace raytree::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Format { ascii, little_endian, big_endian };

/// Bytes of a value in a binary file.
inline std::size_t size_of(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<int>(type)];
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

/// A header that has been checked: it has vertices with x, y and z, and faces with a list of corners.
struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;  ///< in the file's order
  std::size_t vertex_element = 0, face_element = 0;
  bool has_normals = false, has_texture = false;
  bool wide = false;       ///< positions have more precision than float
  char newline = '\n';     ///< what ends a line, also in an ascii body
  std::int64_t lines = 0;  ///< of the header
  std::string_view body;   ///< what follows the header

  const Element& vertices() const { return elements[vertex_element]; }
  const Element& faces() const { return elements[face_element]; }
};

/// Reads and checks the header of a whole file. Throws Error (bad_input) with `name` and the line; what is not used is
/// added to warnings.
Header read_header(std::string_view bytes, const std::string& name, Warnings& warnings);

}  // namespace raytree::ply
