// What the readers of ascii and binary PLY bodies share: the mesh they fill, by roles, and their messages.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "geometry/mesh_checks.h"
#include "geometry/ply_header.h"

namespace raytree::ply {

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

inline void extend_finite(Bounds3d& box, double x, double y, double z) {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (std::abs(x) <= kMax && std::abs(y) <= kMax && std::abs(z) <= kMax) box.extendBy(Vec3d(x, y, z));
}

/// "vertex 12": an item by its one-based number.
inline std::string item_name(const Element& element, std::size_t item) {
  return element.name + " " + std::to_string(item + 1);
}

class BodyReader {
 public:
  /// Vertices get their room at once; all of `header`, `bytes` (the whole file) and `name` must outlive the reader.
  BodyReader(const Header& header, std::string_view bytes, const std::string& name, Warnings& warnings,
             PolygonMesh& mesh)
      : header_(header), bytes_(bytes), name_(name), warnings_(warnings), mesh_(mesh) {
    allocate_vertices();
  }

 protected:
  [[noreturn]] void fail(const std::string& message, std::int64_t line = 0, std::string object = {}) const {
    throw Error(ErrorKind::bad_input, {name_, line, std::move(object)}, message);
  }

  void allocate_vertices() {
    mesh_.positions.resize(header_.vertices().count);
    if (header_.has_normals) mesh_.normals.resize(header_.vertices().count);
    if (header_.has_texture) mesh_.texture_coordinates.resize(header_.vertices().count);
  }

  void allocate_faces(std::size_t corners, bool all_triangles) {
    if (corners >= kNoIndex) fail("more than 4294967294 corners in one mesh");
    mesh_.corners.resize(corners);
    if (!all_triangles) mesh_.face_sizes.resize(header_.faces().count);
  }

  [[noreturn]] void fail_index(std::size_t face, std::int64_t line) const {
    fail("a corner is not the index of a vertex: it must be in 0.." +
             std::to_string(static_cast<std::int64_t>(header_.vertices().count) - 1),
         line, item_name(header_.faces(), face));
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

  /// What is subtracted from a value of this role: the mesh's origin from coordinates.
  double shift(Role role) const {
    return role >= Role::x && role <= Role::z ? mesh_.origin[static_cast<int>(role) - static_cast<int>(Role::x)] : 0.0;
  }

  const Header& header_;
  std::string_view bytes_;
  const std::string& name_;
  Warnings& warnings_;
  PolygonMesh& mesh_;
};

/// Fill the mesh's arrays and origin; faces and vertices are not judged beyond their indices. Throw Error (bad_input).
void read_binary_body(const Header& header, std::string_view bytes, const std::string& name, Warnings& warnings,
                      PolygonMesh& mesh);
/// Returns whether the body has one element a line, so that ascii_line() finds it again.
bool read_ascii_body(const Header& header, std::string_view bytes, const std::string& name, Warnings& warnings,
                     PolygonMesh& mesh);

/// The line of an item in an ascii body of one element a line.
std::int64_t ascii_line(const Header& header, std::string_view bytes, const Element& element, std::size_t item);

}  // namespace raytree::ply
