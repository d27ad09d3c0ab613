// A polygon mesh as files hold it: n-gons, shared positions, optional normals and texture coordinates with
// index arrays of their own, named groups. Triangles for tracing are made of it by triangulation.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/buffer.h"
#include "geometry/subdivision_cage.h"
#include "geometry/vec.h"

namespace raytree {

/// A run of faces under one name (OBJ `g`/`o`/`usemtl`), in file order; runs do not overlap.
struct FaceGroup {
  std::string name;
  std::string material;  ///< OBJ `usemtl`; empty: none named
  std::uint32_t first_face = 0;
  std::uint32_t face_count = 0;
};

struct PolygonMesh {
  /// Added to every position, in double: a float array cannot hold 1e6 m and millimetres at once.
  Vec3d origin{0, 0, 0};
  Buffer<Vec3f> positions;  ///< [vertex_count], relative to origin, scene units

  /// [face_count], each >= 3; empty when every face is a triangle.
  Buffer<std::uint32_t> face_sizes;
  Buffer<std::uint32_t> corners;  ///< [sum of face sizes], indices into positions, counter-clockwise from outside

  Buffer<Vec3f> normals;  ///< need not be unit; empty: the file has none
  /// [corner_count], indices into normals; empty with normals present: a normal per position.
  Buffer<std::uint32_t> normal_corners;

  Buffer<Vec2f> texture_coordinates;      ///< empty: the file has none
  Buffer<std::uint32_t> texture_corners;  ///< as normal_corners

  std::vector<FaceGroup> groups;  ///< empty: no groups named

  /// OBJ `mtllib`: what follows the word, in file order; one name, or several between blanks.
  std::vector<std::string> material_libraries;

  /// The file's OpenSubdiv tags (OBJ `t`), which make a cage of the mesh where somebody subdivides it; absent: none.
  std::optional<SubdivisionRules> subdivision;

  bool all_triangles() const { return face_sizes.empty(); }
  std::size_t face_count() const { return all_triangles() ? corners.size() / 3 : face_sizes.size(); }
};

/// Bounds of the positions with the origin added; empty box for an empty mesh. Runs on all cores of the arena.
Bounds3d bounds(const PolygonMesh& mesh);

/// Bytes held by the arrays.
std::size_t memory_bytes(const PolygonMesh& mesh);

}  // namespace raytree
